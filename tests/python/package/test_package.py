"""The installed package: what it holds, what it needs, what it costs, and that others can build on it."""

from __future__ import annotations

import os
import re
import subprocess
from importlib import metadata
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import pytest
import yaml


def _dynamic(file: Path, tag: str) -> set[str]:
    text = subprocess.run(["readelf", "-d", file], check=True, capture_output=True, text=True).stdout
    return set(re.findall(rf"\({tag}\).*\[(.*)\]", text))


def test_one_version_everywhere(root: Path, cli: Any) -> None:
    written = re.search(r'^version = "(.*?)"', (root / "pyproject.toml").read_text(), re.M)[1]
    assert arm3r.__version__ == metadata.version("arm3r_cpp") == written
    assert written in cli("--version").stdout
    citation = yaml.safe_load((root / "CITATION.cff").read_text())
    assert citation["version"] == written
    assert citation["authors"] == [{"name": "the arm3r authors"}]


def test_parts_are_in_place(package: Path) -> None:
    for part in (
        "_arm3r.abi3.so",
        "bin/arm3r",
        "include/arm3r/arm3r.h",
        "lib/libarm3r.so",
        "lib/cmake/arm3r/arm3rConfig.cmake",
        "py.typed",
    ):
        assert (package / part).is_file(), part


def test_libraries_are_found_beside_each_other(package: Path) -> None:
    assert _dynamic(package / "lib/libarm3r.so", "RUNPATH") == {"$ORIGIN"}
    assert _dynamic(package / "bin/arm3r", "RUNPATH") == {"$ORIGIN/../lib"}
    assert _dynamic(package / "_arm3r.abi3.so", "RUNPATH") == {"$ORIGIN/lib"}


def test_executable_stands_on_the_c_interface_alone(package: Path) -> None:
    assert {name for name in _dynamic(package / "bin/arm3r", "NEEDED") if "yaml" in name} == set()


def test_yaml_cpp_is_private(package: Path) -> None:
    (yaml,) = [name for name in _dynamic(package / "lib/libarm3r.so", "NEEDED") if "yaml" in name]
    assert yaml == "libarm3r-yaml-cpp.so"
    assert _dynamic(package / "lib" / yaml, "SONAME") == {yaml}


def test_import_loads_neither_numpy_nor_matplotlib(python: Any) -> None:
    code = "import sys, arm3r_cpp; {} ; print([m for m in ('numpy', 'matplotlib', 'cffi') if m in sys.modules])"
    assert python(code.format("0")).stdout == "[]\n"
    assert "matplotlib" not in python(code.format("arm3r_cpp.Arm, arm3r_cpp.Scenario, arm3r_cpp.Run")).stdout


def test_public_names_resolve() -> None:
    for name in dir(arm3r):
        assert getattr(arm3r, name) is not None
    with pytest.raises(AttributeError, match="Scenario"):
        arm3r.Scenarios  # noqa: B018


def test_console_entry_is_the_executable(scripts: Path, cli: Any) -> None:
    entry = subprocess.run([scripts / "arm3r", "--version"], capture_output=True, text=True)
    assert (entry.returncode, entry.stdout) == (0, cli("--version").stdout)


@pytest.fixture
def build(scripts: Path) -> Any:
    """build("cmake", ...): run a tool, looked for beside Python first."""
    environment = {**os.environ, "PATH": f"{scripts}{os.pathsep}{os.environ['PATH']}"}

    def run(*command: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run(list(map(str, command)), capture_output=True, text=True, env=environment)

    return run


def test_programs_build_through_find_package(root: Path, package: Path, build: Any, tmp_path: Path) -> None:
    def run(*command: object) -> str:
        done = build(*command)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    run("cmake", "-S", root / "tests" / "c", "-B", tmp_path, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={package}")
    run("cmake", "--build", tmp_path)
    assert "-ffp-contract=off" in run(tmp_path / "bits", root / "scenarios" / "moving_wall.yaml")
    assert run(tmp_path / "objects") == ""


def test_fast_math_is_refused(root: Path, build: Any, tmp_path: Path) -> None:
    done = build("cmake", "-S", root, "-B", tmp_path, "-DCMAKE_CXX_FLAGS=-ffast-math")
    assert done.returncode != 0
    assert "CMAKE_CXX_FLAGS holds -ffast-math" in done.stderr
