"""What the wheels of other systems compute has the bits of the native library, as far as they can be run here."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT, scenario_files
from wheel_files import PLATFORMS, RUNNERS, on, run, unpacked, wheels

pytestmark = pytest.mark.gate

RUNS = 8  # of each batch: an emulated processor is slow
COUNT = len(scenario_files())
PAGE = (ROOT / "docs/platforms.md").read_text()
ARGUMENTS = ["--batch", RUNS, *scenario_files()]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("platforms")


@pytest.fixture(scope="module")
def native(bits: Path, folder: Path) -> Path:
    """The hashes of the installed library, which the C++ compiler of this system compiled."""
    output = folder / "native.txt"
    output.write_text(subprocess.run([bits, *map(str, ARGUMENTS)], check=True, capture_output=True, text=True).stdout)
    return output


def compile_bits(name: str, package: Path) -> Path:
    """bits.c as a program for the platform, beside the executable, which finds the library in the same way."""
    windows = name.startswith("windows")
    program = package / "bin" / ("bits.exe" if windows else "bits")
    library = package / "lib" / ("libarm3r.dll.a" if windows else "libarm3r.so")
    command = [wheels.ZIG, "cc", "-target", PLATFORMS[name].target, "-std=c99", "-O1", "-I", package / "include"]
    command += [ROOT / "tests/c/bits.c", library, "-o", program, *([] if windows else ["-Wl,-rpath,$ORIGIN/../lib"])]
    subprocess.run(list(map(str, command)), check=True, capture_output=True)
    return program


def check_bits(native: Path, name: str, printed: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Prints the table, whose last line docs/platforms.md has as well."""
    output = native.with_name(f"{name}.txt")
    output.write_text(printed)
    compare = [sys.executable, ROOT / "tests/c/compare_bits.py", native, output]
    done = subprocess.run(compare, capture_output=True, text=True)
    with capsys.disabled():
        print(f"\n{done.stdout}", end="")
    assert done.returncode == 0, done.stdout
    assert re.search(rf"^\| {name} +\| {COUNT} of {COUNT} +\| {COUNT} of {COUNT} +\|", PAGE, re.M)


@pytest.mark.parametrize("name", on(*RUNNERS))
def test_a_wheel_computes_the_bits_of_the_native_library(
    native: Path, folder: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    done = run(name, compile_bits(name, unpacked(name, folder)), *ARGUMENTS, timeout=3600)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("# ") and " Clang " in done.stdout.splitlines()[0]
    assert done.stdout.splitlines()[0].endswith("ARM3R_LANES=all")
    check_bits(native, name, done.stdout, capsys)


@pytest.mark.needs("wheels", "qemu")
@pytest.mark.parametrize("processor", ["qemu64", "max"])  # registers for two doubles, and for four
def test_narrower_registers_give_the_same_bits(native: Path, folder: Path, processor: str) -> None:
    package = unpacked("linux-x86_64", folder)
    program = compile_bits("linux-x86_64", package)
    some = scenario_files()[::13]
    command = ["qemu-x86_64", "-cpu", processor, program, "--batch", RUNS, *some]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert set(done.stdout.splitlines()[1:]) <= set(native.read_text().splitlines()) and len(some) >= 5


@pytest.mark.needs("wasm")
def test_webassembly_computes_the_bits_of_the_native_library(native: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["node", ROOT / "tests/wasm/bits.mjs", ROOT / "build/page/arm3r.wasm", *ARGUMENTS]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    check_bits(native, "wasm32", done.stdout, capsys)


@pytest.mark.parametrize("name", sorted(PLATFORMS.keys() - RUNNERS.keys()))
def test_what_cannot_be_run_here_is_called_untested(name: str) -> None:
    assert re.search(rf"^\| {name} +\| not run +\| not run +\|", PAGE, re.M)
    install = (ROOT / "docs/install.md").read_text()
    assert re.search(r"^\| macOS.*\| [^|]*not tested", install, re.M)
