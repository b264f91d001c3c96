"""Long lists of cases: `make test` takes a random sample that its end names, `make gates` every case."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

CONFTEST = "from sampling import *"
TESTS = """
import pytest
@pytest.mark.sample(4)
@pytest.mark.parametrize("i", range(30))
def test_of_a_list(i): print(f"case {i}.")
@pytest.mark.sample(4)
@pytest.mark.parametrize("i", range(3))
def test_of_a_short_list(i): pass
def test_of_one_case(): pass
"""


@pytest.fixture(params=[[], ["-n", "2"]], ids=["alone", "with workers"])
def pytest_with(request: pytest.FixtureRequest, tmp_path: Path):
    """pytest_with(seed, *arguments): what pytest prints in an empty folder with these tests; seed None: no variable."""
    (tmp_path / "conftest.py").write_text(CONFTEST)
    (tmp_path / "test_all.py").write_text(TESTS)
    (tmp_path / "test_module.py").write_text(TESTS + "\npytestmark = pytest.mark.sample(1)")
    gates = "\n@pytest.mark.gate\n@pytest.mark.parametrize('i', range(9))\ndef test_gate(i): pass\n"
    (tmp_path / "test_gates.py").write_text(TESTS + gates + "pytestmark = pytest.mark.sample(1)")
    (tmp_path / "pytest.ini").write_text("[pytest]\nmarkers =\n  sample\n  gate")

    def call(seed: str | None, *arguments: str) -> str:
        environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[1])}
        environment["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
        environment.pop("ARM3R_SAMPLE", None)
        if seed:
            environment["ARM3R_SAMPLE"] = seed
        command = [
            sys.executable,
            "-m",
            "pytest",
            "-rP",
            "-p",
            "no:cacheprovider",
            "-p",
            "xdist.plugin",
            *request.param,
            *arguments,
        ]
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    return call


def cases_of(output: str) -> list[str]:
    return sorted(re.findall(r"case \d+\.", output))


def test_a_sample_is_drawn_and_named_so_that_it_can_be_drawn_again(pytest_with) -> None:
    output = pytest_with(None, "test_all.py")
    assert "8 passed" in output and len(cases_of(output)) == 4
    (seed,) = re.findall(r"ARM3R_SAMPLE=(\d+)", output)
    assert cases_of(pytest_with(seed, "test_all.py")) == cases_of(output)
    assert len({tuple(cases_of(pytest_with(seed, "test_all.py"))) for seed in "12"}) > 1


def test_all_cases_are_taken_where_that_is_asked(pytest_with) -> None:
    output = pytest_with("all", "test_all.py")
    assert "34 passed" in output and "ARM3R_SAMPLE" not in output
    assert "30 passed" in pytest_with("1", "test_all.py::test_of_a_list")


def test_the_mark_of_a_module_is_for_what_has_none_of_its_own(pytest_with) -> None:
    assert "8 passed" in pytest_with("1", "test_module.py")


def test_gates_are_not_counted(pytest_with) -> None:
    assert "8 passed" in pytest_with("1", "test_gates.py", "-m", "not gate")
