"""Print the licences of what is compiled into arm3r.wasm, or into the wheels, beside arm3r itself.

    python tools/core_licenses.py wasm|wheels YAML_SOURCE

YAML_SOURCE: the folder with the sources of yaml-cpp. Eigen and the C and C++ libraries come from the packages
cmeel-eigen and ziglang of this Python."""

from __future__ import annotations

import sys
import sysconfig
from itertools import takewhile
from pathlib import Path

LINE = "-" * 78


def main(product: str, yaml_source: Path) -> int:
    packages = Path(sysconfig.get_path("purelib"))
    zig = packages / "ziglang"
    libraries = zig / "lib"
    eigen = packages / "cmeel.prefix" / "include" / "eigen3" / "Eigen" / "Core"
    parts = {
        "arm3r": Path("LICENSE").read_text(),
        "yaml-cpp": (yaml_source / "LICENSE").read_text(),
        "Eigen; its source is that of the package cmeel-eigen, unchanged": head_of(eigen),
        "libc++, libc++abi, libunwind and compiler-rt of LLVM": (libraries / "libcxx" / "LICENSE.TXT").read_text(),
        "the run-time library of zig": (zig / "LICENSE").read_text(),
    }
    if product == "wasm":
        wasi = libraries / "libc" / "wasi"
        parts["wasi-libc"] = "\n".join((wasi / name).read_text() for name in ("LICENSE", "LICENSE-MIT"))
    else:
        parts["mingw-w64, in the files for Windows"] = (libraries / "libc" / "mingw" / "COPYING").read_text()
    print(f"\n{LINE}\n\n".join(f"{name}\n\n{text.strip()}\n" for name, text in parts.items()))
    return 0


def head_of(header: Path) -> str:
    """The comment at the head of a C++ file, which names authors and licence."""
    lines = takewhile(lambda line: line.startswith("//"), header.read_text().splitlines())
    return "\n".join(line.removeprefix("//").strip() for line in lines)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], Path(sys.argv[2])))
