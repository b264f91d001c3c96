"""Parts that are missing: tests that need them are skipped and counted, or fail where ARM3R_NEED names the part."""

from __future__ import annotations

from pathlib import Path

import pytest
from inner_pytest import run_pytest

CONFTEST = """
from parts import *
from parts import PARTS, Part
PARTS.update(moon=Part(lambda: False, "`make moon`"), earth=Part(lambda: True, ""))
"""
TESTS = """
import pytest
@pytest.mark.needs("moon")
def test_of_the_moon(): pass
@pytest.mark.needs("earth", "moon")
def test_of_both(): pass
@pytest.mark.needs("earth")
def test_of_the_earth(): pass
"""


@pytest.fixture(params=[[], ["-n", "1"]], ids=["alone", "with workers"])
def pytest_with(request: pytest.FixtureRequest, tmp_path: Path):
    """pytest_with(need, tests): pytest's end and output in an empty folder with these tests."""

    def call(need: str, tests: str = TESTS) -> tuple[int, str]:
        return run_pytest(tmp_path, CONFTEST, tests, *request.param, ARM3R_NEED=need)

    return call


def test_tests_of_a_missing_part_are_skipped_and_listed(pytest_with) -> None:
    code, output = pytest_with("")
    assert code == 0 and "1 passed, 2 skipped" in output
    assert "2 tests without moon: `make moon`" in output and "earth:" not in output


def test_a_part_that_is_named_must_be_there(pytest_with) -> None:
    code, output = pytest_with("earth,moon")
    assert code == 1 and "2 errors" in output and "1 passed" in output
    assert "ARM3R_NEED names a part that is missing; get moon: `make moon`" in output


@pytest.mark.sample(2)
@pytest.mark.parametrize(("name", "hint"), [("mon", "did you mean moon?"), ("xxxx", "the parts are page, wasm,")])
def test_an_unknown_name_is_an_error(pytest_with, name: str, hint: str) -> None:
    code, output = pytest_with(name)
    assert code == 4 and "passed" not in output and hint in output
    assert "Traceback" not in output
    code, output = pytest_with("", f"import pytest\n@pytest.mark.needs({name!r})\ndef test_of(): pass")
    assert code == 1 and "passed" not in output and hint in output
