"""The tables of docs/benchmarks.md, in Markdown, from the table of a run: python benchmarks/tables.py [TABLE.csv]"""

from __future__ import annotations

import csv
import sys
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).parent.parent
GOALS = 1e-9, 1e-12  # rad
LARGE = "n=4096"

Row = dict[str, str]


def figure(text: str, unit: str) -> str:
    """Three digits: "17.3 ns"."""
    value = float(text)
    return f"{value:.3g} {unit}" if value < 1000 else f"{value:.0f} {unit}"


def markdown(rows: Iterable[Row]) -> None:
    print("| job | who | median | min | times ours | error |\n|---|---|---|---|---|---|")
    shown = ""
    for row in rows:
        job, who = row["job"] if row["job"] != shown else "", row["who"]
        shown = row["job"]
        if not row["median"]:
            print(f"| {job} | {who} | {row['build']} |  |  |  |")
            continue
        unit = row["unit"].replace("us", "µs")
        ours = f"**{who}**" if who.startswith("arm3r") else who
        setting = f", {row['setting']}" if row["setting"] else ""
        times = f"{float(row['times_ours']):.3g}" if row["times_ours"] else ""
        median, least = figure(row["median"], unit), figure(row["min"], unit)
        print(f"| {job} | {ours}{setting} | {median} | {least} | {times} | {row['error']} |")
    print()


def cheapest(rows: list[Row], job: str, goal: float) -> list[Row]:
    """Of each method, the quickest setting that is good enough; the ratio is to ours that leads among them."""
    best: dict[str, Row] = {}
    for row in rows:
        if row["job"] == job and row["error"] and float(row["error"]) <= goal:
            who = row["who"]
            if who not in best or float(row["median"]) < float(best[who]["median"]):
                best[who] = row
    ranked = sorted(best.values(), key=lambda row: float(row["median"]))
    ours = next((float(row["median"]) for row in ranked if row["who"].startswith("arm3r")), float("nan"))
    named = f"{job}, error at most {goal:g} rad"
    return [row | {"job": named, "times_ours": str(float(row["median"]) / ours)} for row in ranked]


def main() -> None:
    table = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "out" / "bench.csv"
    with table.open(newline="") as file:
        rows = list(csv.DictReader(file))
    markdown(row for row in rows if not row["setting"])
    markdown(row for row in rows if row["setting"] == LARGE)
    markdown(
        row for job in ("2 s of free fall", "10 s, pushed by the wall") for g in GOALS for row in cheapest(rows, job, g)
    )
    markdown(row for row in rows if row["job"].startswith("lecture run, stiffness at random"))


main()
