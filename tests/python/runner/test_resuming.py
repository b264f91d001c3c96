"""A run of the gates that was interrupted goes on: what has passed is not run again, all else is."""

from __future__ import annotations

from pathlib import Path

import pytest
from inner_pytest import run_pytest

TESTS = """
import os, pytest
@pytest.mark.parametrize("i", range(6))
def test_of_a_list(i): print(f"case {i} runs"); assert i != 3 or "MENDED" in os.environ
def test_that_is_skipped(): pytest.skip("for now")
"""


@pytest.fixture(params=[[], ["-n", "2"]], ids=["alone", "with workers"])
def pytest_again(request: pytest.FixtureRequest, tmp_path: Path):
    """pytest_again(name, **variables): the exit status and the output of pytest that goes on with the run of a name."""
    conftest = "import resuming\ndef pytest_configure(config):\n    config.pluginmanager.register(resuming)\n"

    def call(name: str, **variables: str) -> tuple[int, str]:
        resume = str(tmp_path / "made" / f"{name}.passed")
        return run_pytest(tmp_path, conftest, TESTS, "-rA", *request.param, ARM3R_RESUME=resume, **variables)

    return call


def test_what_has_passed_is_left_out(pytest_again) -> None:
    status, output = pytest_again("one")
    assert status == 1 and "1 failed, 5 passed, 1 skipped" in output
    status, output = pytest_again("one")
    assert status == 1 and "1 failed, 1 skipped" in output and "case 3 runs" in output and "case 2 runs" not in output
    assert "5 tests had passed before" in output
    status, output = pytest_again("one", MENDED="1")
    assert status == 0 and "1 passed, 1 skipped" in output


def test_another_run_begins_anew_and_a_finished_one_is_green(pytest_again) -> None:
    assert "6 passed, 1 skipped" in pytest_again("one", MENDED="1")[1]
    assert "6 passed, 1 skipped" in pytest_again("two", MENDED="1")[1]
    status, output = pytest_again("two", MENDED="1")
    assert status == 0 and "passed before" in output
