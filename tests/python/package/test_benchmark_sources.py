"""The program of the benchmarks fits the library: it is compiled by `make bench` alone, which few run."""

from __future__ import annotations

import subprocess
import sysconfig
from pathlib import Path

import pytest


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", ["bench", "contenders", "ours"])
def test_it_compiles(root: Path, name: str) -> None:
    eigen = Path(sysconfig.get_path("purelib")) / "cmeel.prefix" / "include" / "eigen3"
    folders = [f"-I{folder}" for folder in (root / "cpp/include", root / "cpp/src", eigen)]
    names = ['-DBENCH_BUILD="none"', '-DARM3R_VERSION="none"']
    command = ["g++", "-std=c++20", "-fsyntax-only", *names, *folders, root / f"benchmarks/{name}.cpp"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
