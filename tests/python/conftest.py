"""What the tests share: the installed package, its executable, and the lecture's scenario."""

from __future__ import annotations

import importlib.util
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import arm3r_cpp as arm3r
import page_visitor
import parts
import pytest
import resuming
import sampling
import time_box

signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell that starts tests in the background ignores it

os.environ["ARM3R_OCTAVE"] = ""  # what tests say of files that are not read is the same on every computer

ROOT = Path(__file__).parents[2]
PACKAGE = Path(arm3r.__file__).parent
CALLS = "-O0 -DARM3R_INLINE=inline -DARM3R_INLINE_LAMBDA="
"""Flags of a compiler without inlining, which takes a third of the time."""
QUICK = {"CMAKE_CXX_FLAGS_RELEASE": CALLS, "ARM3R_LANES": "1"}
"""Of CMake: the quickest build, a fifth of the time of the usual one."""


def pytest_configure(config: pytest.Config) -> None:
    config.pluginmanager.register(parts)
    for plugin in (sampling, resuming, time_box, page_visitor):
        config.pluginmanager.register(plugin)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """No process waits at the end for one that runs a long test: these come first."""
    items.sort(key=lambda item: item.get_closest_marker("long") is None)


def scenario_files() -> list[Path]:
    """Every scenario of the repository; sweeps are files of another kind."""
    return sorted(path for path in (ROOT / "scenarios").rglob("*.yaml") if path.parent.name != "sweeps")


def script(path: str) -> ModuleType:
    """A Python file of the repository that no package holds, as a module."""
    spec = importlib.util.spec_from_file_location(Path(path).stem, ROOT / path)
    assert spec and spec.loader
    module = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


Cli = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture(scope="session")
def root() -> Path:
    """The repository."""
    return ROOT


@pytest.fixture(scope="session")
def package() -> Path:
    """The installed package: lib/, bin/, include/ lie in it."""
    return PACKAGE


@pytest.fixture(scope="session")
def executable() -> Path:
    """The C++ program itself, not its Python entry point."""
    return PACKAGE / "bin" / "arm3r"


@pytest.fixture(scope="session")
def scripts() -> Path:
    """Where arm3r, arm3r-plot and cmake stand."""
    return Path(sys.executable).parent


@pytest.fixture(scope="session")
def cli(executable: Path) -> Cli:
    """cli("run", path, ...): run the executable; text in and out, other arguments as subprocess.run's."""

    def call(*arguments: object, **options: object) -> subprocess.CompletedProcess[str]:
        options = {"capture_output": True, "text": True, "timeout": 600, **options}
        return subprocess.run([executable, *map(str, arguments)], **options)

    return call


@pytest.fixture(scope="session")
def python() -> Cli:
    """python(code, **environment): run code in a fresh interpreter."""

    def call(code: str, **environment: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, timeout=600, env={**os.environ, **environment}
        )

    return call


@pytest.fixture(scope="session")
def moving_wall(root: Path) -> Path:
    """The file of the lecture's moving wall."""
    return root / "scenarios" / "moving_wall.yaml"


@pytest.fixture
def lecture(moving_wall: Path) -> arm3r.Scenario:
    """The lecture's moving wall, read afresh."""
    return arm3r.Scenario.load(moving_wall)


@pytest.fixture(scope="session")
def lecture_run(moving_wall: Path) -> arm3r.Run:
    """The lecture's moving wall, run once."""
    return arm3r.Scenario.load(moving_wall).run()


@pytest.fixture(scope="session")
def bits(root: Path, package: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """tests/c/bits.c as a program, linked with the installed library."""
    folder = tmp_path_factory.mktemp("bits")
    program = folder / "bits"
    library = package / "lib"
    command = ["cc", "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", root / "tests/c/bits.c", "-o", program]
    command += [f"-I{package / 'include'}", f"-L{library}", "-larm3r", f"-Wl,-rpath,{library}", "-lm"]
    subprocess.run(command, check=True)
    return program


@pytest.fixture
def written(tmp_path: Path) -> Callable[[str, str], Path]:
    """written(name, text): a file with this text, in a folder of the test."""

    def write(name: str, text: str) -> Path:
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


@pytest.fixture
def command(scripts: Path) -> Cli:
    """command(path, ...): `arm3r verify` of these arguments."""

    def call(*arguments: object) -> subprocess.CompletedProcess[str]:
        words = [scripts / "arm3r", "verify", *map(str, arguments)]
        return subprocess.run(words, capture_output=True, text=True, timeout=600)

    return call
