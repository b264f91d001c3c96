"""Run every benchmark and gather the rows in out/bench.csv.

python benchmarks/run.py PROGRAM    # arm3r_benchmarks
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parent
ALONE = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}  # numpy's idle threads would take the second core


def script(name: str, *words: str | Path) -> list[str | Path]:
    return [sys.executable, HERE / f"{name}.py", *words]


def rows(*command: str | Path) -> list[str]:
    """The lines that a program prints: the header first."""
    begun = time.perf_counter()
    lines = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=ALONE).stdout.splitlines()
    names = " ".join(Path(word).name for word in command if word != sys.executable)
    print(f"{names}: {time.perf_counter() - begun:.0f} s", file=sys.stderr)
    return lines


def main() -> None:
    program = Path(sys.argv[1])
    commands = [
        [program],
        script("whole_process"),
        script("python_calls"),
        script("one_run"),
        script("user_law"),
        script("many_arms", program),
        script("precision"),
        script("lecture_runs"),
    ]
    if shutil.which("valgrind"):
        commands.append(script("instructions", program))
    print("load before:", *os.getloadavg(), f"on {os.cpu_count()} cores", file=sys.stderr)
    out = ROOT / "out" / "bench.csv"
    out.parent.mkdir(exist_ok=True)
    lines: list[str] = []
    for command in commands:
        header, *values = rows(*command)
        lines += values if lines else [header, *values]
        out.write_text("\n".join(lines) + "\n")  # whatever becomes of the next one
    print("\n".join(lines))
    print("load after:", *os.getloadavg(), "written:", out, file=sys.stderr)


main()
