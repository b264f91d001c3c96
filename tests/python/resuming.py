"""`make gates` goes on where it was interrupted.

ARM3R_RESUME names a file of the tests that have passed: they are left out, and each that passes is added at once."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

VARIABLE = "ARM3R_RESUME"


class Resuming:
    """Leaves out what had passed when this run began: all processes of pytest-xdist must collect the same tests."""

    def __init__(self, passed: set[str]) -> None:
        self._passed = passed

    def pytest_collection_modifyitems(self, config: pytest.Config, items: list[pytest.Item]) -> None:
        config.hook.pytest_deselected(items=[item for item in items if item.nodeid in self._passed])
        items[:] = [item for item in items if item.nodeid not in self._passed]


class Recorder(Resuming):
    """Also adds the name of each test that passes to the file, in the process that starts the others."""

    def __init__(self, path: Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
        super().__init__(set(path.read_text().splitlines()))
        self._path = path
        self._not_passed: set[str] = set()

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.outcome != "passed":
            self._not_passed.add(report.nodeid)
        if report.when == "teardown" and report.nodeid not in self._not_passed:
            with self._path.open("a") as file:
                file.write(f"{report.nodeid}\n")

    @pytest.hookimpl(optionalhook=True)  # pytest-xdist's
    def pytest_configure_node(self, node) -> None:
        node.workerinput["passed"] = sorted(self._passed)

    def pytest_sessionfinish(self, session: pytest.Session, exitstatus: int) -> None:
        if exitstatus == pytest.ExitCode.NO_TESTS_COLLECTED and self._passed:
            session.exitstatus = pytest.ExitCode.OK

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        if self._passed:
            terminalreporter.line(f"{len(self._passed)} tests had passed before, in the run that this one goes on with")


def pytest_configure(config: pytest.Config) -> None:
    if hasattr(config, "workerinput"):
        config.pluginmanager.register(Resuming(set(config.workerinput.get("passed", ()))))
    elif name := os.environ.pop(VARIABLE, None):  # tests that start pytest themselves are not resumed
        config.pluginmanager.register(Recorder(Path(name)))
