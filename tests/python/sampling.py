"""`make test` takes a random sample of long lists of cases, `make gates` takes them whole.

The mark `sample(12)` of a parametrized test keeps 12 of its cases, as the mark of a module 12 of its tests. Which ones,
a seed decides that is new in every run; the end of the run prints it, and ARM3R_SAMPLE=SEED takes the same cases again.
ARM3R_SAMPLE=all takes every case, and so does a command line that names a test (`pytest test_x.py::test_y`)."""

from __future__ import annotations

import os
import random
import secrets
from collections import defaultdict

import pytest

VARIABLE = "ARM3R_SAMPLE"


def seed() -> str:
    """The seed of this run, or "all". The processes of pytest-xdist get that of the one that starts them."""
    return os.environ.setdefault(VARIABLE, str(secrets.randbits(32)))


def lists(items: list[pytest.Item]) -> dict[tuple[str, int], list[pytest.Item]]:
    """The cases that a mark is for, without gates, under the name of their test or module and the number it keeps."""
    found: dict[tuple[str, int], list[pytest.Item]] = defaultdict(list)
    for item in items:
        mark = item.get_closest_marker("sample")
        if mark and not item.get_closest_marker("gate"):
            is_own = mark in item.own_markers
            name = item.nodeid.partition("[" if is_own else "::")[0]
            found[name, mark.args[0]].append(item)
    return found


def left_out(items: list[pytest.Item]) -> set[pytest.Item]:
    left: set[pytest.Item] = set()
    for (name, count), cases in lists(items).items():
        chance = random.Random(f"{seed()} {name}")
        left.update(chance.sample(cases, max(0, len(cases) - count)))
    return left


# ---- the hooks of pytest, which conftest.py registers ----------------------------------------------------------------


def pytest_configure() -> None:
    seed()


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if seed() == "all" or any("::" in argument for argument in config.args):
        return
    left = left_out(items)
    config.hook.pytest_deselected(items=list(left))
    items[:] = [item for item in items if item not in left]


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    if seed() != "all":
        terminalreporter.line(
            f"long lists of cases: {VARIABLE}={seed()} takes the same sample, {VARIABLE}=all every case"
        )
