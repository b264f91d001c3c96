"""Parts that are missing: tests that need them are skipped and counted, or fail where ARM3R_NEED names the part."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

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
        (tmp_path / "conftest.py").write_text(CONFTEST)
        (tmp_path / "test_all.py").write_text(tests)
        (tmp_path / "pytest.ini").write_text("[pytest]\nmarkers = needs")
        environment = {**os.environ, "ARM3R_NEED": need, "PYTHONPATH": str(Path(__file__).parent)}
        command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *request.param]
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr

    return call


def test_tests_of_a_missing_part_are_skipped_and_listed(pytest_with) -> None:
    code, output = pytest_with("")
    assert code == 0 and "1 passed, 2 skipped" in output
    assert "2 tests without moon: `make moon`" in output and "earth:" not in output


def test_a_part_that_is_named_must_be_there(pytest_with) -> None:
    code, output = pytest_with("earth,moon")
    assert code == 1 and "2 errors" in output and "1 passed" in output
    assert "ARM3R_NEED names a part that is missing; get moon: `make moon`" in output


@pytest.mark.parametrize(("name", "hint"), [("mon", "did you mean moon?"), ("xxxx", "the parts are page, wasm,")])
def test_an_unknown_name_is_an_error(pytest_with, name: str, hint: str) -> None:
    code, output = pytest_with(name)
    assert code == 4 and "passed" not in output and hint in output
    assert "Traceback" not in output
    code, output = pytest_with("", f"import pytest\n@pytest.mark.needs({name!r})\ndef test_of(): pass")
    assert code == 1 and "passed" not in output and hint in output
