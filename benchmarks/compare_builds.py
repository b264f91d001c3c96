"""Compare two builds of arm3r: what they answer, to the last bit, and how many instructions they take.

    python benchmarks/compare_builds.py OLD_PYTHON NEW_PYTHON [--instructions] [--programs OLD NEW]

OLD_PYTHON and NEW_PYTHON are interpreters in whose environments one build each is installed. Both run every scenario of
this checkout by every method, batches, sweeps and laws in Python, and print the reference pages, messages, names and
symbols (build_results.py). What only one build has is named and is no difference.

--instructions counts the instructions of the benchmarks' jobs by valgrind (instruction_jobs.py), and --programs those
of two arm3r_benchmarks (instructions.py). A job may take 0.5 % more than before.

Exit code 0: the results are the same and no job takes more; 1: they are not, or a job does.
"""

from __future__ import annotations

import argparse
import csv
import json
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Sequence
from itertools import zip_longest
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
LIMIT = 1.005  # of the instructions before
WIDTH = 160  # of a line that is shown


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", metavar="OLD_PYTHON")
    parser.add_argument("new", metavar="NEW_PYTHON")
    parser.add_argument("--instructions", action="store_true", help="count instructions too; takes some minutes")
    parser.add_argument("--programs", nargs=2, metavar=("OLD", "NEW"), help="two arm3r_benchmarks, counted too")
    options = parser.parse_args()
    pythons = options.old, options.new

    begun = time.perf_counter()
    changed = report(*map(json.loads, outputs([[python, HERE / "build_results.py"] for python in pythons])))
    if options.instructions:
        versions = outputs([[python, "-c", "import platform; print(platform.python_version())"] for python in pythons])
        if note := other_python(*versions):
            print(note)
        counts = map(json.loads, outputs([[python, HERE / "instruction_jobs.py"] for python in pythons]))
        changed |= report_instructions(*counts)
    if options.programs:
        commands = [[sys.executable, HERE / "instructions.py", program] for program in options.programs]
        changed |= report_instructions(*map(counts_of_table, outputs(commands)))
    print(f"compared in {time.perf_counter() - begun:.0f} s")
    return int(changed)


def outputs(commands: Sequence[Sequence[Any]]) -> list[str]:
    """What commands print that run at the same time."""
    running = [subprocess.Popen(words, stdout=subprocess.PIPE, text=True) for words in commands]
    printed = [process.communicate()[0] for process in running]
    for process in running:
        if process.returncode != 0:
            raise SystemExit(f"{' '.join(map(str, process.args))}: ended with exit code {process.returncode}")
    return printed


def other_python(before: str, after: str) -> str:
    """What to know of counts that two versions of Python took; "" for one version."""
    if before == after:
        return ""
    versions = f"{before.strip()} before, {after.strip()} after"
    return f"Python is another one ({versions}): what it does itself counts, too; jobs of Python differ by that alone"


def differing(before: dict[str, str], after: dict[str, str]) -> list[str]:
    """The names of the results that both builds have and that are not the same."""
    return [name for name in before if name in after and before[name] != after[name]]


def report(before: dict[str, str], after: dict[str, str]) -> bool:
    """Print what differs, and what only one build has; whether anything differs."""
    names = differing(before, after)
    for name in names:
        print(f"differs: {name}")
        lines = zip_longest(before[name].splitlines(), after[name].splitlines(), fillvalue="(no more lines)")
        old, new = next((pair for pair in lines if pair[0] != pair[1]), ("other line ends", "other line ends"))
        print(f"    old: {old[:WIDTH]}\n    new: {new[:WIDTH]}")
    for build, only in ("old", before.keys() - after.keys()), ("new", after.keys() - before.keys()):
        for name, count in sorted(Counter(name.partition(": ")[2] or name for name in only).items()):
            print(f"only the {build} build has: {name} ({count} times)")
    print(f"{len(before.keys() & after.keys())} results compared, {len(names)} differ")
    return bool(names)


def counts_of_table(table: str) -> dict[str, float]:
    """Instructions by job, of the table that instructions.py prints."""
    return {f"{row['job']}: {row['who']}": float(row["median"]) for row in csv.DictReader(table.splitlines())}


def report_instructions(before: dict[str, float], after: dict[str, float]) -> bool:
    """Print the instructions of every job that both builds do; whether one takes more than the limit."""
    jobs = {job: after[job] / before[job] for job in before if job in after}
    print(f"{'before':>12} {'after':>12}  ratio  instructions of")
    for job, ratio in jobs.items():
        more = f"  takes more than {LIMIT} times as many" if ratio > LIMIT else ""
        print(f"{before[job]:12.0f} {after[job]:12.0f} {ratio:6.3f}  {job}{more}")
    return any(ratio > LIMIT for ratio in jobs.values())


if __name__ == "__main__":
    sys.exit(main())
