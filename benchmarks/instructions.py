"""Instructions that a job of arm3r_benchmarks takes, counted by valgrind. CSV out.

    python benchmarks/instructions.py PROGRAM    # arm3r_benchmarks

Only ours are counted: the peers use instructions that valgrind does not know.
"""

from __future__ import annotations

import csv
import subprocess
import sys

from callgrind import counts
from table import Table

FEW, MANY = 5_000, 25_000


def counted(program: str, number: str, times: int) -> int:
    return counts([program, "--only", number, str(times)])[0]


def main() -> None:
    program = sys.argv[1]
    listing = subprocess.run([program, "--list"], check=True, capture_output=True, text=True).stdout
    table = Table()
    for number, job, who in csv.reader(listing.splitlines()):
        if who.startswith("arm3r"):
            each = (counted(program, number, MANY) - counted(program, number, FEW)) / (MANY - FEW)
            table.row(job, f"{who}, instructions", "callgrind", "1", [each])


main()
