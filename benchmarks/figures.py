"""The figures of docs/benchmarks.md from the table: python benchmarks/figures.py [TABLE.csv]"""

from __future__ import annotations

import csv
import sys
from collections.abc import Callable
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from arm3r_cpp.plot.style import AMBER, BLACK, BLUE, GREEN, PINK, RED, SKY, style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, NullLocator

ROOT = Path(__file__).parent.parent
IMAGES = ROOT / "docs" / "images"
DASHED = {"linestyle": "--", "markerfacecolor": "white"}
# One colour a method and one line a way to run it, in all figures.
LOOKS = {
    "arm3r taylor": {"color": RED, "marker": "o"},
    "arm3r taylor, one by one": {"color": RED, "marker": "o", **DASHED},
    "arm3r dopri5": {"color": AMBER, "marker": "s"},
    "arm3r rk4": {"color": PINK, "marker": "^"},
    "arm3r batch": {"color": PINK, "marker": "^"},
    "arm3r batch, 2 threads": {"color": PINK, "marker": "^", **DASHED},
    "heyoka, batch of 8": {"color": BLUE, "marker": "D"},
    "heyoka, one by one": {"color": BLUE, "marker": "D", **DASHED},
    "scipy DOP853": {"color": BLACK, "marker": "x"},
    "C loop, omp simd": {"color": GREEN, "marker": "v"},
    "MuJoCo rollout": {"color": SKY, "marker": "P"},
    "MuJoCo rollout, 2 threads": {"color": SKY, "marker": "P", **DASHED},
}

Row = dict[str, str]


def lines(rows: list[Row], job: str) -> dict[str, list[Row]]:
    """The measured rows of a job, by who, in the order of LOOKS."""
    found = {who: [row for row in rows if (row["job"], row["who"]) == (job, who) and row["median"]] for who in LOOKS}
    return {who: its for who, its in found.items() if its}


def setting(row: Row) -> float:
    return float(row["setting"].partition("=")[2])


def error(row: Row) -> float:
    return float(row["error"])


def time(row: Row) -> float:
    return float(row["median"])


def draw(axes: Axes, by_who: dict[str, list[Row]], x: Callable[[Row], float], y: Callable[[Row], float]) -> None:
    for who, rows in by_who.items():
        axes.plot([x(row) for row in rows], [y(row) for row in rows], label=who, markersize=5, **LOOKS[who])
    axes.set(xscale="log", yscale="log")
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_minor_formatter(NullFormatter())


def pair(title: str, *, sharey: bool) -> tuple[Figure, list[Axes]]:
    figure, axes = plt.subplots(1, 2, figsize=(9.5, 4.2), sharey=sharey, layout="constrained")
    figure.suptitle(title)
    return figure, list(axes)


def legend(figure: Figure, axes: list[Axes]) -> None:
    """One for both, below."""
    handles = {label: handle for one in axes for handle, label in zip(*one.get_legend_handles_labels(), strict=True)}
    order = [who for who in LOOKS if who in handles]
    figure.legend([handles[who] for who in order], order, loc="outside lower center", ncols=4, frameon=False)


def precision(rows: list[Row]) -> Figure:
    figure, panels = pair("Time a run against the error of its final angles", sharey=True)
    for axes, job in zip(panels, ("2 s of free fall", "10 s, pushed by the wall"), strict=True):
        draw(axes, lines(rows, job), error, time)
        axes.set(title=job, xlabel="largest error of a joint angle at the end (rad)", ylabel="time a run (µs)")
        axes.invert_xaxis()
    legend(figure, panels)
    return figure


def count(rows: list[Row]) -> Figure:
    figure, panels = pair("RK4 steps of 1 ms of n arms at once", sharey=True)
    for axes, job in zip(panels, ("free fall", "compensation and two-way wall"), strict=True):
        draw(axes, lines(rows, f"RK4 step of many arms, {job}"), setting, time)
        axes.set(title=job, xlabel="number of arms n", ylabel="time an arm and step (ns)")
    legend(figure, panels)
    return figure


def stiffness(rows: list[Row]) -> Figure:
    figure, panels = pair("Lecture run, the wall pushing: ten seconds, one make and one break", sharey=False)
    by_who = lines(rows, "lecture run, by stiffness")
    for axes, y, label in zip(
        panels, (time, error), ("time a run (µs)", "error of the final angles (rad)"), strict=True
    ):
        draw(axes, by_who, setting, y)
        axes.set(xlabel="stiffness of the wall (N/m)", ylabel=label)
    legend(figure, panels)
    return figure


def threads(rows: list[Row]) -> Figure:
    """How many times faster two threads are, wherever both were measured; of many arms, the largest number."""
    ratios: dict[str, float] = {}
    of = {(row["job"], row["who"], row["setting"]): row for row in rows if row["median"]}
    for (job, who, its), row in of.items():
        one = of.get((job, who.removesuffix(", 2 threads"), its))
        if who.endswith(", 2 threads") and one:
            ratios[f"{one['who']}\n{job.partition(', ')[2]}"] = time(one) / time(row)
    figure, axes = plt.subplots(figsize=(7, 0.9 + 0.5 * len(ratios)), layout="constrained")
    bars = axes.barh(list(ratios), list(ratios.values()), color=PINK, height=0.6)
    axes.bar_label(bars, fmt="%.2f", padding=3)
    axes.axvline(2, color=BLACK, linestyle=":")
    axes.set(title="Two threads on two cores", xlabel="times faster than one thread", xlim=(0, 2.3))
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    return figure


def main() -> None:
    table = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "out" / "bench.csv"
    with table.open(newline="") as file:
        rows = list(csv.DictReader(file))
    with style():
        for make in (precision, count, stiffness, threads):
            make(rows).savefig(IMAGES / f"bench_{make.__name__}.png", dpi=130)


main()
