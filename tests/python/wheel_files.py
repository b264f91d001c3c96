"""The wheels that `make wheels` or `make gates` has built, unpacked, and what runs their programs on this machine."""

from __future__ import annotations

import os
import subprocess
import zipfile
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from conftest import script
from parts import AARCH64_LIBRARIES, WHEELS

wheels = script("tools/wheels.py")
PLATFORMS = {platform.name: platform for platform in wheels.PLATFORMS}
RUNNERS = {  # of the programs of a platform; macOS has none here
    "linux-x86_64": [],
    "linux-aarch64": ["qemu-aarch64", "-L", AARCH64_LIBRARIES],
    "windows-x86_64": ["wine"],
}
EMULATORS = {"linux-aarch64": "qemu-aarch64", "windows-x86_64": "wine"}
QUIET = {"WINEDEBUG": "-all"}  # wine's own messages


def on(*names: str) -> list[Any]:
    """The parameters of a test that runs programs of these platforms."""
    needs = {name: ["wheels", *([EMULATORS[name]] if name in EMULATORS else [])] for name in names}
    return [pytest.param(name, marks=pytest.mark.needs(*needs[name])) for name in names]


def wheel(name: str) -> Path:
    [file] = WHEELS.glob(f"*-{PLATFORMS[name].tag}.whl")
    return file


@cache
def unpacked(name: str, folder: Path) -> Path:
    """The package arm3r_cpp of a wheel, in `folder`, with programs that may be run."""
    place = folder / name
    with zipfile.ZipFile(wheel(name)) as archive:
        archive.extractall(place)
        for member in archive.infolist():
            os.chmod(place / member.filename, (member.external_attr >> 16) | 0o600)
    return place / "arm3r_cpp"


@cache
def start_wine() -> None:
    """The first start makes wine's folder, and says so among the messages of the program."""
    subprocess.run(["wine", "cmd", "/c", "exit"], env={**os.environ, **QUIET}, capture_output=True, timeout=600)


def run(name: str, *command: object, **options: Any) -> subprocess.CompletedProcess[str]:
    """Runs a program of the platform `name`."""
    if EMULATORS.get(name) == "wine":
        start_wine()
    words = [*RUNNERS[name], *map(str, command)]
    environment = {**os.environ, **QUIET, **options.pop("env", {})}
    options = {"capture_output": True, "encoding": "utf-8", "timeout": 600, **options}
    return subprocess.run(words, env=environment, **options)
