"""The wheels of `make wheels`: named for what is in them, audited, found by pip, and complete without a compiler."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import arm3r_cpp as arm3r
import binary_files
import pytest
from conftest import ROOT
from timing import once_within
from wheel_files import PLATFORMS, on, run, unpacked, wheel

pytestmark = [pytest.mark.gate, pytest.mark.needs("wheels")]

PROCESSORS = {
    "linux-x86_64": "ELF x86_64",
    "linux-aarch64": "ELF aarch64",
    "windows-x86_64": "PE x86_64",
    "macos-arm64": "Mach-O arm64",
    "macos-x86_64": "Mach-O x86_64",
}
EVERY = [pytest.param(name, marks=pytest.mark.needs(name)) if name == "macos-x86_64" else name for name in PLATFORMS]
MACOS = [one for one in EVERY if one == "macos-arm64" or not isinstance(one, str)]
LINUX = sorted(name for name in PLATFORMS if name.startswith("linux"))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("wheels")


def compiled_files(name: str) -> dict[str, bytes]:
    """What a wheel holds for one processor alone."""
    with zipfile.ZipFile(wheel(name)) as archive:
        contents = {member: archive.read(member) for member in archive.namelist()}
    return {member: data for member, data in contents.items() if binary_files.processor(data)}


@pytest.mark.parametrize("name", EVERY)
def test_a_wheel_is_named_for_what_is_in_it(name: str) -> None:
    tag = PLATFORMS[name].wheel_tag
    assert wheel(name).name == f"arm3r_cpp-{arm3r.__version__}-{tag}.whl"
    with zipfile.ZipFile(wheel(name)) as archive:
        [about] = [member for member in archive.namelist() if member.endswith(".dist-info/WHEEL")]
        text = archive.read(about).decode()
    assert re.findall(r"^Tag: (.*)$", text, re.M) == [tag] and "Root-Is-Purelib: false" in text
    files = compiled_files(name)
    assert {binary_files.processor(data) for data in files.values()} == {PROCESSORS[name]}
    assert any(member.startswith("arm3r_cpp/_arm3r") for member in files) == tag.startswith("cp310-abi3-")


@pytest.mark.parametrize("name", EVERY)
def test_a_wheel_is_complete(name: str) -> None:
    """The parts that the package has here, scenarios, page and licences included, and nothing of the build folder."""
    with zipfile.ZipFile(wheel(name)) as archive:
        names = set(archive.namelist())
        licenses = archive.read("arm3r_cpp/share/arm3r/licenses.txt").decode()
    ending = ".exe" if name.startswith("windows") else ""
    library = {"l": "lib/libarm3r.so", "m": "lib/libarm3r.dylib", "w": "bin/libarm3r.dll"}[name[0]]
    parts = [f"bin/arm3r{ending}", library, "include/arm3r/arm3r.h", "lib/cmake/arm3r/arm3rConfig.cmake", "py.typed"]
    assert {f"arm3r_cpp/{part}" for part in parts} <= names
    assert any(re.fullmatch(rf"arm3r_cpp-.*\.data/scripts/arm3r{ending}", member) for member in names)
    files = [
        *(ROOT / "scenarios").rglob("*.yaml"),
        *(ROOT / "docs").glob("*.schema.json"),
        *(ROOT / "docs").glob("*.md"),
    ]
    assert {f"arm3r_cpp/share/arm3r/{path.relative_to(ROOT).as_posix()}" for path in files} <= names
    assert {path.name for path in ROOT.glob("python/arm3r_cpp/*.py")} <= {member.split("/")[-1] for member in names}
    if (ROOT / "build/page/live.html").is_file():
        assert {"arm3r_cpp/share/arm3r/live/live.html", "arm3r_cpp/share/arm3r/live/arm3r.wasm"} <= names
    for words in ("yaml-cpp", "Eigen", "MPL", "LLVM", "mingw-w64"):
        assert words in licenses
    for member, data in compiled_files(name).items():
        assert str(ROOT).encode() not in data, member


@pytest.mark.parametrize("name", LINUX)
def test_the_wheels_of_linux_pass_the_audit(name: str) -> None:
    audit = [sys.executable, "-m", "auditwheel", "show", wheel(name)]
    done = subprocess.run(list(map(str, audit)), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    said = " ".join(done.stdout.split())
    [version] = re.findall(rf'the following platform tag: "manylinux_2_(\d+)_{name.split("-")[1]}"', said)
    assert int(version) <= 28 and PLATFORMS[name].tag.startswith("manylinux_2_28_")  # it may run on older ones, too


@pytest.mark.parametrize("name", MACOS)
def test_files_of_macos_are_signed_and_name_the_oldest_version(name: str) -> None:
    files = compiled_files(name)
    assert len(files) == 3
    for member, data in files.items():
        assert binary_files.oldest_macos(data) == "11.0", member
        if name == "macos-arm64":  # where macOS starts nothing without; zig signs nothing for Intel's
            assert binary_files.has_ad_hoc_signature(data), member
    assert PLATFORMS[name].tag.startswith("macosx_11_0_")
    assert binary_files.search_paths(files["arm3r_cpp/bin/arm3r"]) == ["@loader_path/../lib"]


@pytest.mark.parametrize("name", EVERY)
def test_pip_takes_the_wheel_for_its_system(name: str, tmp_path: Path) -> None:
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--only-binary=:all:", "--target", tmp_path]
    for version in ("3.10", "3.13"):
        choice = ["--platform", PLATFORMS[name].tag, "--python-version", version, "--upgrade"]
        done = subprocess.run(list(map(str, [*pip, *choice, wheel(name)])), capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
    other = PLATFORMS["macos-arm64" if name != "macos-arm64" else "linux-x86_64"].tag
    done = subprocess.run(list(map(str, [*pip, "--platform", other, wheel(name)])), capture_output=True, text=True)
    assert done.returncode != 0 and "is not a supported wheel on this platform" in done.stderr


# ---- installed ------------------------------------------------------------------------------------------------------

NO_PYTHON = {"PATH": "/usr/bin:/bin"}  # what wine itself needs
LAW = "def fcn(q1, q2, q3):\n    return [0.0, 0.0, 0.0]\n"

LAW_IN_CPP = """
#include <pthread.h>
#include <stdexcept>
struct arm3r_law_state;
extern "C" int law(void *user, const arm3r_law_state *, double *) {
    if (user == nullptr) throw std::runtime_error("no user");
    pthread_exit(nullptr);
}
"""
RUN_LAW = """
import ctypes, os, threading, time
import arm3r_cpp as a
law = a.NativeLaw(ctypes.cast(ctypes.CDLL({library!r}).law, ctypes.c_void_p).value, {user})
scenario = a.Scenario("format: 1\\ntime: {{stop: 1}}\\n")
def run():
    try:
        scenario.run(controller=law)
    except a.ControllerError:
        print("the law threw", flush=True)
        os._exit(0)
threading.Thread(target=run, daemon=True).start()
time.sleep(2)
print("alive", flush=True)
os._exit(0)
"""


def bare(folder: Path) -> dict[str, str]:
    """An environment in which no compiler is found."""
    return {"PATH": str(folder / "bin"), "HOME": str(folder), "LANG": "C.UTF-8"}


def install(folder: Path) -> float:
    """Installs the wheel into a new virtual environment and runs the moving wall; the seconds that it took."""
    begun = time.monotonic()
    python = sys.executable if sys.prefix == sys.base_prefix else f"{sys.base_prefix}/bin/python3"
    commands = [
        [python, "-m", "venv", folder],
        [folder / "bin/python", "-m", "pip", "install", "--quiet", wheel("linux-x86_64")],
        [folder / "bin/arm3r", "run", folder / "lib" / "moving_wall.yaml", "-o", folder / "wall.csv"],
    ]
    subprocess.run(list(map(str, commands[0])), check=True, env=bare(folder))
    (folder / "lib/moving_wall.yaml").write_bytes((ROOT / "scenarios/moving_wall.yaml").read_bytes())
    for command in commands[1:]:
        done = subprocess.run(list(map(str, command)), env=bare(folder), capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
    assert "moving-wall: ok" in done.stdout
    return time.monotonic() - begun


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A virtual environment with the wheel in it, and no compiler on its path."""
    folder = tmp_path_factory.mktemp("installed") / "arm"
    install(folder)
    return folder


@pytest.mark.timed
def test_from_nothing_to_the_moving_wall_in_20_s(tmp_path: Path) -> None:
    tries = iter(range(3))
    assert once_within(20, lambda: install(tmp_path / str(next(tries))), tries=3)


def test_an_installed_wheel_computes_the_bits_of_the_native_library(installed: Path) -> None:
    code = "import arm3r_cpp as a; print(a.Scenario.example('moving_wall').run().summary['hash'], a.__file__)"
    done = subprocess.run([installed / "bin/python", "-c", code], env=bare(installed), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    value, file = done.stdout.split()
    assert file.startswith(str(installed)) and value == arm3r.Scenario.example("moving_wall").run().summary["hash"]


def test_the_command_is_a_program_and_no_script(installed: Path) -> None:
    assert binary_files.processor((installed / "bin/arm3r").read_bytes()) == PROCESSORS["linux-x86_64"]


def test_a_controller_in_python_is_handed_over_to_the_python_beside_it(installed: Path, tmp_path: Path) -> None:
    (tmp_path / "law.py").write_text(LAW)
    (tmp_path / "s.yaml").write_text("format: 1\ntime: {stop: 0.1}\n")
    command = [installed / "bin/arm3r", "run", "s.yaml", "--controller", "law.py:fcn"]
    done = subprocess.run(command, cwd=tmp_path, env=bare(installed), capture_output=True, text=True)
    assert done.returncode == 0 and "law.py: fcn(q1, q2, q3)" in done.stdout, done.stdout + done.stderr


MODULE = """
import arm3r_cpp as a
from arm3r_cpp import _arm3r
assert _arm3r.__file__.endswith("_arm3r.py")
print(a.Scenario.example("moving_wall").run().summary["hash"])
a.Scenario("format: 1\\ntime: {stop: 0.1}\\n").run(controller=lambda t, state: state.tau_g, rate=100.0)
"""


def test_the_module_of_the_other_wheels_loads_the_library(installed: Path, tmp_path: Path) -> None:
    """The module of aarch64 in the place of the extension of x86-64: both are made from one header."""
    package = next(installed.glob("lib/python3*/site-packages/arm3r_cpp"))
    shutil.copytree(package, tmp_path / "arm3r_cpp", ignore=shutil.ignore_patterns("_arm3r*.so"))
    with zipfile.ZipFile(wheel("linux-aarch64")) as archive:
        archive.extract("arm3r_cpp/_arm3r.py", tmp_path)
    environment = {**bare(installed), "PYTHONPATH": str(tmp_path)}
    done = subprocess.run([installed / "bin/python", "-c", MODULE], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr  # at its end Python closes the library
    assert done.stdout.strip() == arm3r.Scenario.example("moving_wall").run().summary["hash"]


@pytest.mark.parametrize("user, printed", [(0, "the law threw\n"), (1, "alive\n")], ids=["throws", "ends_its_thread"])
def test_a_law_of_another_compiler(installed: Path, tmp_path: Path, user: int, printed: str) -> None:
    (tmp_path / "law.cpp").write_text(LAW_IN_CPP)
    subprocess.run(["g++", "-shared", "-fPIC", "law.cpp", "-o", "law.so"], check=True, cwd=tmp_path)
    code = RUN_LAW.format(library=str(tmp_path / "law.so"), user=user)
    done = subprocess.run([installed / "bin/python", "-c", code], env=bare(installed), capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, printed), done.stderr


@pytest.mark.parametrize("name", on("linux-x86_64", "linux-aarch64", "windows-x86_64"))
def test_without_a_python_a_controller_is_refused_in_one_line(name: str, folder: Path, tmp_path: Path) -> None:
    program = unpacked(name, folder) / "bin" / ("arm3r.exe" if name.startswith("windows") else "arm3r")
    done = run(name, program, "run", "s.yaml", "--controller", "law.py", cwd=tmp_path, env=NO_PYTHON)
    assert done.returncode == 2 and done.stdout == ""
    [line] = done.stderr.splitlines()
    assert line.startswith("arm3r: error[usage]: --controller is run by the Python package")
