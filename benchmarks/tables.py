"""Renew the tables of docs/benchmarks.md: python benchmarks/tables.py [TABLE.csv [WITHOUT_AVX512.csv]]

Each stands between the line <!-- NAME --> and the next empty line. The table of a processor without AVX-512 holds what
depends on the width of its registers.
"""

from __future__ import annotations

import csv
import re
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "docs" / "benchmarks.md"
GOALS = 1e-9, 1e-12  # rad
LARGE = "n=4096"

Row = dict[str, str]


def digits(text: str, unit: str) -> str:
    """Three of them: "17.3 ns"."""
    value = float(text)
    return (f"{value:.3g} {unit}" if value < 1000 else f"{value:.0f} {unit}").strip()


def line(row: Row, job: str) -> str:
    who = f"**{row['who']}**" if row["who"].startswith("arm3r") else row["who"]
    if not row["median"]:
        return f"| {job} | {who} | {row['build']} |  |  |  |"
    setting = f", {row['setting']}" if row["setting"] else ""
    unit = row["unit"].replace("us", "µs")
    times = f"{float(row['times_ours']):.3g}" if row["times_ours"] else ""
    median, least = (digits(row[name], unit) for name in ("median", "min"))
    return f"| {job} | {who}{setting} | {median} | {least} | {times} | {row['error']} |"


def markdown(rows: list[Row]) -> str:
    jobs = [row["job"] for row in rows]
    new = [job if job != before else "" for job, before in zip(jobs, ["", *jobs], strict=False)]
    head = ["| job | who | median | min | times ours | error, rad |", "|---|---|---|---|---|---|"]
    return "\n".join(head + [line(row, job) for row, job in zip(rows, new, strict=True)])


def beside_our_best(rows: list[Row]) -> list[Row]:
    """The measured rows of a job, the quickest first, as multiples of the quickest of ours on one thread."""
    ranked = sorted((row for row in rows if row["median"]), key=lambda row: float(row["median"]))
    alone = (row for row in ranked if row["who"].startswith("arm3r") and not row["who"].endswith(" threads"))
    ours = next((float(row["median"]) for row in alone), float("nan"))
    return [row | {"times_ours": str(float(row["median"]) / ours)} for row in ranked]


def cheapest(rows: list[Row], job: str, goal: float) -> list[Row]:
    """Of each method the quickest setting that is good enough."""
    good = [row for row in rows if row["job"] == job and row["error"] and float(row["error"]) <= goal]
    ranked = beside_our_best(good)
    firsts = {row["who"]: row for row in reversed(ranked)}
    return [row | {"job": f"{job}, error at most {goal:.0e} rad"} for row in ranked if firsts[row["who"]] is row]


def without_avx512(rows: list[Row]) -> dict[str, list[Row]]:
    whole = tables(rows)
    in_ns = [row for row in whole["one after the other"] if row["unit"] == "ns"]
    return {"without avx512": [*in_ns, *whole["many arms"], *whole["precision"], *whole["lecture runs"]]}


def tables(rows: list[Row]) -> dict[str, list[Row]]:
    single = [row for row in rows if not row["setting"]]
    return {
        "one after the other": [row for row in single if row["unit"] != "1"],
        "instructions": [row | {"unit": ""} for row in single if row["unit"] == "1"],
        "many arms": [row for row in rows if row["setting"] == LARGE],
        "precision": [
            row
            for job in ("2 s of free fall", "10 s, pushed by the wall")
            for goal in GOALS
            for row in cheapest(rows, job, goal)
        ],
        "lecture runs": beside_our_best([row for row in rows if row["job"] == "lecture run, stiffness at random"]),
    }


def main() -> None:
    given = [Path(word) for word in sys.argv[1:]]
    of_runs = given or sorted((ROOT / "out").glob("bench*.csv"))  # bench.csv before bench_avx2.csv
    page = PAGE.read_text()
    for source, chosen in zip(of_runs, (tables, without_avx512), strict=False):
        with source.open(newline="") as file:
            page = renewed(page, chosen(list(csv.DictReader(file))))
    PAGE.write_text(page)


def renewed(page: str, of_names: dict[str, list[Row]]) -> str:
    for name, its in of_names.items():
        place = re.compile(rf"(?<=<!-- {name} -->\n).*?(?=\n\n|\n\Z)", re.DOTALL)
        page, found = place.subn(lambda _, its=its: markdown(its), page)
        if found != 1:
            raise SystemExit(f"{PAGE.name}: {found} places for the table <!-- {name} -->, one is needed")
    return page


main()
