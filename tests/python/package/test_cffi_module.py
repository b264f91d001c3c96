"""The module that loads the library where there is no compiled extension: the package works the same by it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = """
import math
import numpy as np
import arm3r_cpp as arm3r
from arm3r_cpp import _arm3r, _native

assert _arm3r.__file__.endswith("_arm3r.py") and not hasattr(_native.lib, "arm3r_python_tick")
run = arm3r.Scenario.example("moving_wall").run()
print(run.summary["hash"])
user = arm3r.Scenario("format: 1\\ntime: {stop: 0.1}\\n")
steady = user.run(controller=lambda t, state: state.tau_g, rate=100.0)
print(steady.summary["hash"])
print(user.batch({"initial.q": np.zeros((3, 3))})["q2"].tolist())

def stop(t, end, steps):
    raise RuntimeError("enough")

def wrong(t, state):
    raise ValueError("no torque")

for arguments in ({"progress": stop}, {"controller": wrong, "rate": 100.0}):
    try:
        arm3r.Scenario("format: 1\\nsolver: {method: rk4, step: 1.0e-5}\\ntime: {stop: 20}\\n").run(**arguments)
    except (RuntimeError, ValueError) as raised:
        print(raised)
try:
    arm3r.Scenario("format: 2").run()
except arm3r.IncompatibleError as raised:
    print(raised.code)
"""


@pytest.fixture
def folder(root: Path, package: Path, tmp_path: Path) -> Path:
    """Holds the installed package, with the module in the place of the extension."""
    copy = tmp_path / "arm3r_cpp"
    shutil.copytree(package, copy, ignore=shutil.ignore_patterns("_arm3r*.so", "__pycache__"))
    cdef = tmp_path / "cdef.h"
    header = copy / "include/arm3r/arm3r.h"
    subprocess.run(["cc", "-E", "-P", "-xc", "-DARM3R_CDEF", "-DARM3R_API=", header, "-o", cdef], check=True)
    generate = [sys.executable, root / "tools/gen_cffi.py", cdef, copy / "_arm3r.py", "lib/libarm3r.so"]
    subprocess.run(generate, check=True, capture_output=True)
    return tmp_path


def test_the_package_works_by_the_module(folder: Path) -> None:
    program = PROGRAM.replace('assert _arm3r.__file__.endswith("_arm3r.py") and not', "assert")
    expected = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert expected.returncode == 0, expected.stderr
    environment = os.environ | {"PYTHONPATH": str(folder)}
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    assert done.stdout == expected.stdout
    assert "enough\n" in done.stdout and "wrong raised ValueError: no torque\n" in done.stdout
