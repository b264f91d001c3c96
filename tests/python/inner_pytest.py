"""Pytest within a test: for what this project adds to it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path


def run_pytest(folder: Path, conftest: str, tests: str, *options: str, **environment: str) -> tuple[int, str]:
    """The exit status and the output of pytest in an empty folder with these tests."""
    (folder / "conftest.py").write_text(conftest)
    (folder / "test_all.py").write_text(tests)
    (folder / "pytest.ini").write_text("[pytest]\nmarkers = needs")
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-p", "xdist.plugin", *options]
    variables = {**os.environ, "PYTHONPATH": str(Path(__file__).parent), **environment}
    variables["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"  # half of the time of its start
    done = subprocess.run(command, cwd=folder, env=variables, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr
