"""Instructions that a job of arm3r_benchmarks takes, counted by valgrind. CSV out.

    python benchmarks/instructions.py PROGRAM    # arm3r_benchmarks

Only ours are counted: the peers use instructions that valgrind does not know. Packs are counted if the build has them
for the processor that valgrind shows, which has AVX2 alone (ARM3R_LANES=all, or 4).
"""

from __future__ import annotations

import csv
import sys

from callgrind import counts, printed
from table import Table

FEW, MANY = 5_000, 25_000


def counted(program: str, number: str, times: int) -> int:
    return counts([program, "--only", number, str(times)])[0]


def main() -> None:
    program = sys.argv[1]
    table = Table()
    for number, job, who in csv.reader(printed([program, "--list"]).splitlines()):
        if who.startswith("arm3r"):
            each = (counted(program, number, MANY) - counted(program, number, FEW)) / (MANY - FEW)
            table.row(job, f"{who}, instructions", "callgrind", "1", [each])


main()
