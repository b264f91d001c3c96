"""The parts that `make test` does without where they are missing: how each is found, and how to get it.

A test that needs one carries the mark `needs("wasm")`. It is skipped where the part is missing, and the end of the
run lists what was left out. ARM3R_NEED=page,wasm (`make test NEED=page,wasm`) names parts that must not be missing:
then such a test fails, and says how to get the part."""

from __future__ import annotations

import difflib
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "build" / "page"
WHEELS = Path(__file__).parents[2] / "build" / "wheels"
LEAST_NODE = 20
AARCH64_LIBRARIES = "/usr/aarch64-linux-gnu"  # of Debian's package libgcc-s1-arm64-cross


@dataclass
class Part:
    is_there: Callable[[], bool]
    how_to_get_it: str


def have_modules(*names: str) -> bool:
    return all(find_spec(name) for name in names)


def have_chromium() -> bool:
    """Whether there is a browser of the system for Playwright, which downloads none."""
    return any(shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome"))


def have_node() -> bool:
    if not (node := shutil.which("node")):
        return False
    version = subprocess.run([node, "--version"], capture_output=True, text=True).stdout
    return version.startswith("v") and int(version[1:].split(".")[0]) >= LEAST_NODE


PARTS = {
    "page": Part(
        lambda: (PAGE / "index.html").is_file() and have_chromium() and have_modules("playwright"),
        "`make page`, and the system's package chromium",
    ),
    "wasm": Part(
        lambda: (PAGE / "arm3r.wasm").is_file() and have_node(),
        f"`make page`; it brings node, of which another one must have version {LEAST_NODE} or later",
    ),
    "drake": Part(lambda: have_modules("pydrake"), "`make .venv/gates`, on Linux with x86-64"),
    "notebooks": Part(
        lambda: have_modules("nbclient", "nbformat", "ipykernel"),
        "`pip install nbclient nbformat ipykernel`, which the extra `test` brings",
    ),
    "octave": Part(
        lambda: sys.platform == "linux" and shutil.which("octave-cli") is not None, "the system's package octave"
    ),
    "qemu": Part(lambda: shutil.which("qemu-x86_64") is not None, "the system's package qemu-user"),
    "qemu-aarch64": Part(
        lambda: shutil.which("qemu-aarch64") is not None and Path(AARCH64_LIBRARIES, "lib/libgcc_s.so.1").is_file(),
        "the system's packages qemu-user and libgcc-s1-arm64-cross",
    ),
    "wine": Part(lambda: shutil.which("wine") is not None, "the system's package wine64"),
    "wheels": Part(
        lambda: any((WHEELS / one).is_file() for one in ("built", "tested")) and have_modules("ziglang", "auditwheel"),
        "`make wheels`",
    ),
    "macos-x86_64": Part(
        lambda: any(WHEELS.glob("*-macosx_*_x86_64.whl")), "`make wheels`; `make gates` builds the others"
    ),
    "site": Part(
        lambda: have_modules("sphinx", "myst_nb", "furo", "ziamath"),
        "`pip install 'arm3r_cpp[docs]'`, with Python 3.11 or later",
    ),
}

LEFT_OUT = "left out: "


@cache
def is_there(name: str) -> bool:
    return PARTS[name].is_there()


def checked(names: list[str], where: str) -> list[str]:
    """The names as they are; an unknown one is an error of the command line that suggests the nearest."""
    for name in names:
        if name not in PARTS:
            near = difflib.get_close_matches(name, PARTS, 1)
            hint = f"did you mean {near[0]}?" if near else f"the parts are {', '.join(PARTS)}"
            raise pytest.UsageError(f"{where} names the part {name!r}, which is unknown: {hint}")
    return names


@cache
def needed() -> list[str]:
    """The parts that ARM3R_NEED names."""
    names = os.environ.get("ARM3R_NEED", "").replace(",", " ").split()
    return checked(names, "ARM3R_NEED (make test NEED=...)")


def named_by(test: pytest.Item) -> list[str]:
    names = [name for mark in test.iter_markers("needs") for name in mark.args]
    return checked(names, f"the mark of {test.nodeid}")


# ---- the hooks of pytest, which conftest.py registers ----------------------------------------------------------------


def pytest_configure() -> None:
    needed()


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Does nothing where all parts that a test needs are there."""
    for name in named_by(item):
        if is_there(name):
            continue
        line = f"{name}: {PARTS[name].how_to_get_it}"
        if name in needed():
            pytest.fail(f"ARM3R_NEED names a part that is missing; get {line}", pytrace=False)
        pytest.skip(LEFT_OUT + line)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    reports = terminalreporter.stats.get("skipped", [])
    reasons = [str(report.longrepr[2]) for report in reports if isinstance(report.longrepr, tuple)]
    lines = [reason.partition(LEFT_OUT)[2] for reason in reasons if LEFT_OUT in reason]
    if lines:
        terminalreporter.section("parts left out; `make test NEED=...` makes each that it names an error")
    for line in sorted(set(lines)):
        terminalreporter.line(f"{lines.count(line)} tests without {line}")
