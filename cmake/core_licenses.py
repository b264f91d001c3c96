"""Print the licences of what is compiled into arm3r.wasm beside arm3r itself: python cmake/core_licenses.py YAML_SOURCE

YAML_SOURCE: the folder with the sources of yaml-cpp. Eigen and the C and C++ libraries come from the packages
cmeel-eigen and ziglang of this Python."""

from __future__ import annotations

import sys
import sysconfig
from itertools import takewhile
from pathlib import Path

LINE = "-" * 78


def main(yaml_source: Path) -> int:
    packages = Path(sysconfig.get_path("purelib"))
    libraries = packages / "ziglang" / "lib"
    eigen = packages / "cmeel.prefix" / "include" / "eigen3" / "Eigen" / "Core"
    parts = {
        "arm3r": Path("LICENSE").read_text(),
        "yaml-cpp": (yaml_source / "LICENSE").read_text(),
        "Eigen; its source is that of the package cmeel-eigen, unchanged": head_of(eigen),
        "libc++, libc++abi, libunwind and compiler-rt of LLVM": (libraries / "libcxx" / "LICENSE.TXT").read_text(),
        "wasi-libc": "\n".join((libraries / "libc" / "wasi" / name).read_text() for name in ("LICENSE", "LICENSE-MIT")),
    }
    print(f"\n{LINE}\n\n".join(f"{name}\n\n{text.strip()}\n" for name, text in parts.items()))
    return 0


def head_of(header: Path) -> str:
    """The comment at the head of a C++ file, which names authors and licence."""
    lines = takewhile(lambda line: line.startswith("//"), header.read_text().splitlines())
    return "\n".join(line.removeprefix("//").strip() for line in lines)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
