"""Run every benchmark and gather the rows in out/bench.csv.

python benchmarks/run.py PROGRAM    # arm3r_benchmarks
python benchmarks/run.py PROGRAM --without-avx512 LIBRARY    # as on a processor without it: out/bench_avx2.csv

LIBRARY is compiled from without_avx512.c; PROGRAM and the package have packs of four (ARM3R_LANES=all).
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parent
# numpy's idle threads would take the second core; modules that are compiled at each import would take longer
ALONE = {"OPENBLAS_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": ""}
HIDDEN = ("AVX512F", "AVX512VL", "AVX512BW", "AVX512CD", "AVX512DQ")  # from the C library


def script(name: str, *words: str | Path) -> list[str | Path]:
    return [sys.executable, HERE / f"{name}.py", *words]


def without_avx512(library: Path) -> dict[str, str]:
    """Environment variables; heyoka's batches of four are its quickest then, 15.8 us a fall beside 19.4 with eight."""
    tunables = "glibc.cpu.hwcaps=" + ",".join(f"-{name}" for name in HIDDEN)
    return {"LD_AUDIT": str(library.resolve()), "GLIBC_TUNABLES": tunables, "HEYOKA_LANES": "4"}


def rows(*command: str | Path, environment: dict[str, str]) -> list[str]:
    """The lines that a program prints: the header first."""
    begun = time.perf_counter()
    environment = {**os.environ, **ALONE, **environment}
    lines = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=environment).stdout.splitlines()
    names = " ".join(Path(word).name for word in command if word != sys.executable)
    print(f"{names}: {time.perf_counter() - begun:.0f} s", file=sys.stderr)
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--without-avx512", type=Path, metavar="LIBRARY")
    words = parser.parse_args()
    program, hides = words.program, words.without_avx512
    commands = [
        [program],
        script("one_run"),
        script("many_arms", program),
        script("precision"),
        script("lecture_runs"),
    ]
    if not hides:  # what does not depend on the width of the registers
        commands += [script("whole_process"), script("python_calls"), script("user_law")]
        if shutil.which("valgrind"):
            commands.append(script("instructions", program))
    print("load before:", *os.getloadavg(), f"on {os.cpu_count()} cores", file=sys.stderr)
    out = ROOT / "out" / ("bench_avx2.csv" if hides else "bench.csv")
    environment = without_avx512(hides) if hides else {}
    out.parent.mkdir(exist_ok=True)
    lines: list[str] = []
    for command in commands:
        header, *values = rows(*command, environment=environment)
        lines += values if lines else [header, *values]
        out.write_text("\n".join(lines) + "\n")  # whatever becomes of the next one
    print("\n".join(lines))
    print("load after:", *os.getloadavg(), "written:", out, file=sys.stderr)


main()
