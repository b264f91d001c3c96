"""python tools/wheels.py [PLATFORM...]: wheels for every platform, or for those that are named, into build/wheels.

zig's clang, of the Python package ziglang (extra `wheels`), compiles them on Linux. The wheel of Linux on x86-64 has a
compiled extension for all versions of Python. The others have a module that loads the library, because Python's headers
of those systems are not here. The live page is in them where `make page` has built it."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
import sysconfig
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "build" / "wheels"
SOURCES = ROOT / "build" / "yaml_cpp"
KERNELS = ROOT / "build/ctest/taylor/taylor_kernels.hpp"  # that `make` derives: the same for every platform
PACKAGES = Path(sysconfig.get_path("purelib"))
ZIG = PACKAGES / "ziglang" / "zig"
AT_ONCE = 2
"""wheels: one is configured or packed, which takes one core, while another is compiled"""


@dataclass(frozen=True)
class Platform:
    """Where a wheel can be installed. The last part of zig's target is the oldest glibc or macOS that it runs on."""

    name: str
    target: str  # zig's
    tag: str  # the platform in the name of the wheel
    extension: bool = False

    @property
    def wheel_tag(self) -> str:
        return f"cp310-abi3-{self.tag}" if self.extension else f"py3-none-{self.tag}"

    @property
    def build_folder(self) -> Path:
        return ROOT / "build" / "cross" / self.name


PLATFORMS = [
    Platform(
        "linux-x86_64", "x86_64-linux-gnu.2.28", "manylinux_2_28_x86_64", extension=platform.machine() == "x86_64"
    ),
    Platform("linux-aarch64", "aarch64-linux-gnu.2.28", "manylinux_2_28_aarch64"),
    Platform("windows-x86_64", "x86_64-windows-gnu", "win_amd64"),
    Platform("macos-arm64", "aarch64-macos.11.0", "macosx_11_0_arm64"),
    Platform("macos-x86_64", "x86_64-macos.11.0", "macosx_11_0_x86_64"),
]


def run(*command: object, **environment: str) -> None:
    """Its output goes to standard error, as only the names of wheels belong to standard output."""
    subprocess.run(list(map(str, command)), check=True, cwd=ROOT, stdout=sys.stderr, env={**os.environ, **environment})


def write_licenses() -> Path:
    """The licences of what is compiled into the library, beside arm3r's own."""
    licenses = SOURCES / "licenses.txt"
    with licenses.open("w") as file:
        script = ROOT / "tools" / "core_licenses.py"
        subprocess.run([sys.executable, script, "wheels", SOURCES / "yaml-cpp"], check=True, cwd=ROOT, stdout=file)
    return licenses


def settings(target: Platform) -> dict[str, str]:
    """What scikit-build-core is told."""
    definitions = {
        "CMAKE_TOOLCHAIN_FILE": ROOT / "cmake" / "zig.cmake",
        "ARM3R_ZIG": ZIG,
        "ARM3R_ZIG_TARGET": target.target,
        "ARM3R_YAML_SOURCE": SOURCES / "yaml-cpp",
        "ARM3R_TAYLOR_KERNELS": KERNELS,
        "ARM3R_LICENSES": SOURCES / "licenses.txt",
        "ARM3R_LANES": "all",
        "ARM3R_CFFI": "extension" if target.extension else "module",
        "CMAKE_PREFIX_PATH": PACKAGES,
        "CMAKE_COMPILE_WARNING_AS_ERROR": "ON",
    }
    return {
        "build-dir": str(target.build_folder),
        "wheel.tags": target.wheel_tag,
        **{f"cmake.define.{name}": str(value) for name, value in definitions.items()},
    }


def build(target: Platform) -> Path:
    for old in FOLDER.glob(f"*-{target.tag}.whl"):
        old.unlink()
    call = f"from scikit_build_core import build; build.build_wheel({str(FOLDER)!r}, {settings(target)!r})"
    cores = int(os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", os.cpu_count() or 1))
    run(sys.executable, "-c", call, CMAKE_BUILD_PARALLEL_LEVEL=str(max(1, cores // AT_ONCE)))
    [wheel] = FOLDER.glob(f"*-{target.tag}.whl")
    return wheel


def main(names: list[str]) -> int:
    unknown = set(names) - {target.name for target in PLATFORMS}
    if unknown:
        known = ", ".join(target.name for target in PLATFORMS)
        print(f"{', '.join(sorted(unknown))}: no such platform; there are {known}", file=sys.stderr)
        return 2
    time = subprocess.run(["git", "log", "-1", "--format=%ct"], cwd=ROOT, capture_output=True, text=True).stdout.strip()
    os.environ.setdefault("SOURCE_DATE_EPOCH", time or "315532800")
    FOLDER.mkdir(parents=True, exist_ok=True)
    run(sys.executable, ROOT / "tools" / "yaml_cpp_source.py", SOURCES)
    write_licenses()
    with ThreadPoolExecutor(AT_ONCE) as pool:
        chosen = [target for target in PLATFORMS if not names or target.name in names]
        for wheel in pool.map(build, sorted(chosen, key=lambda one: "x86_64" not in one.name)):  # the longest first
            print(wheel.relative_to(ROOT), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
