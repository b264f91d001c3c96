"""Run every benchmark and gather the rows in out/bench.csv.

python benchmarks/run.py [PROGRAM]    # arm3r_benchmarks; where `make bench` builds it, if not given
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parent


def rows(*command: str | Path) -> list[str]:
    """The lines that a program prints: the header first."""
    print("running", *(Path(word).name for word in command if word != sys.executable), file=sys.stderr)
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()


def main() -> None:
    program = Path(sys.argv[1])
    commands = [[program], [sys.executable, HERE / "whole_process.py"], [sys.executable, HERE / "python_calls.py"]]
    if shutil.which("valgrind"):
        commands.append([sys.executable, HERE / "instructions.py", program])
    print("load before:", *os.getloadavg(), f"on {os.cpu_count()} cores", file=sys.stderr)
    tables = [rows(*command) for command in commands]
    lines = [tables[0][0], *(line for table in tables for line in table[1:])]

    out = ROOT / "out" / "bench.csv"
    out.parent.mkdir(exist_ok=True)
    out.write_text("\n".join(lines) + "\n")
    print("\n".join(lines))
    print("load after:", *os.getloadavg(), "written:", out, file=sys.stderr)


main()
