"""The figure of two controllers: both runs over each other, and below each quantity the difference."""

from __future__ import annotations

import os
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.scenario import Scenario
from ..plot.layout import Panel, Size, lay_out
from ..plot.run_figure import origin_of, stamp_height
from ..plot.run_part import part_of
from ..plot.style import BLACK, BLUE, JOINTS, RED, TRIPLE, WIDTH, Unit, angle_unit, finish, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..core.comparison import Beside
    from ..core.run import Run

SMALL = 1.0
"""rad, m: differences below are drawn in the unit of small values."""
TORQUE, LENGTH = Unit("N m", 1.0, "N m", 1.0), Unit("m", 1.0, "mm", 1e3)


def figure(
    beside: Beside, *, width: float = WIDTH, height: float | None = None, start: float | None = None,
    end: float | None = None, degrees: bool | None = None, stamp: bool = False,
) -> Figure:  # fmt: skip
    """Joint angles, torques and contact force of both, each with the difference below it, and how far the tips are
    apart.

    Contact is shaded as your run has it. The arguments are those of `arm3r_cpp.plot.overview`.
    """
    with style():
        runs = [part_of(run, start, end) for run in (beside.yours, beside.true) if run]
        origins = [origin_of(run) for run in (beside.yours, beside.true) if run]
        t = max((run.t for run in runs), key=len)
        size = Size(width, height, stamp_height(origins, width) if stamp else 0.0)
        unit = angle_unit(Scenario(runs[0].summary["scenario"]), degrees)
        drawn = lay_out(panels(runs, labels(beside), unit), [], size=size, start=float(t[0]), end=float(t[-1]))
        drawn.set_origin(origins, stamp=stamp)
        return drawn


def labels(beside: Beside) -> list[str]:
    """Of the two runs."""
    file, _, function = beside.name.rpartition(": ")
    name = f"{os.path.basename(file)}: {function}" if file else function
    return [f"solid: {name}", f"dashed: {beside.true_name}, the scenario's"]


def panels(runs: list[Run], words: list[str], angle: Unit) -> list[Panel]:
    """Each quantity of both, and the differences where there are two runs."""
    forces = all("depth" in run for run in runs) and any(np.any(run["f_on_wall"]) for run in runs)
    found = [Panel(1.2, partial(draw_joints, runs, "q", angle, words[: len(runs)]))]
    found += differences(runs, "q", angle)
    found.append(Panel(1.2, partial(draw_joints, runs, "tau", TORQUE, [])))
    found += differences(runs, "tau", TORQUE)
    if forces:
        found.append(Panel(0.9, partial(draw_force, runs)))
    if len(runs) == 2:
        found.append(Panel(0.7, partial(draw_distance, runs)))
    return found


def differences(runs: list[Run], name: str, unit: Unit) -> list[Panel]:
    return [Panel(0.8, partial(draw_differences, runs, name, unit))] if len(runs) == 2 else []


def draw_joints(runs: list[Run], name: str, unit: Unit, words: list[str], ax: Axes, room: float) -> None:
    """A colour a joint; yours solid, the scenario's dashed."""
    quantity, symbol = {"q": ("joint angle", "q"), "tau": ("torque", r"\tau")}[name]
    for run, dashes, lw in zip(runs, ("-", (0, (4, 3))), (1.6, 1.2), strict=False):
        for i, look in zip(JOINTS, TRIPLE, strict=True):
            label = rf"${symbol}_{i}$" if run is runs[0] else None
            ax.plot(run.t, unit.factor * run[f"{name}{i}"], color=look["color"], ls=dashes, lw=lw, label=label)
    for text in words:
        ax.plot([], [], ls="", label=text)
    finish(ax, runs[0], f"{quantity}, {unit.name}", room)


def draw_differences(runs: list[Run], name: str, unit: Unit, ax: Axes, room: float) -> None:
    """Yours less the scenario's, a colour a joint."""
    rows = min(map(len, runs))
    apart = {i: runs[0][f"{name}{i}"][:rows] - runs[1][f"{name}{i}"][:rows] for i in JOINTS}
    factor, name_of_unit = scaled(unit, max(float(np.abs(values).max()) for values in apart.values()))
    for (_, values), look in zip(apart.items(), TRIPLE, strict=True):
        ax.plot(runs[0].t[:rows], factor * values, color=look["color"], lw=1.2)
    finish(ax, runs[0], f"difference, {name_of_unit}", room, legend=False)


def draw_force(runs: list[Run], ax: Axes, room: float) -> None:
    looks: list[dict[str, Any]] = [
        {"color": BLUE, "ls": "-", "lw": 1.8, "label": "yours"},
        {"color": RED, "ls": (0, (4, 3)), "lw": 1.4, "label": "the scenario's"},
    ]
    for run, look in zip(runs, looks, strict=False):
        ax.plot(run.t, np.linalg.norm(run["f_on_wall"], axis=1), **look)
    if len(runs) == 2:
        rows = min(map(len, runs))
        apart = np.linalg.norm(runs[0]["f_on_wall"][:rows] - runs[1]["f_on_wall"][:rows], axis=1)
        ax.plot(runs[0].t[:rows], apart, color=BLACK, lw=0.9, label="size of the difference")
    finish(ax, runs[0], "contact force, N", room)


def draw_distance(runs: list[Run], ax: Axes, room: float) -> None:
    rows = min(map(len, runs))
    apart = np.linalg.norm(runs[0]["tip"][:rows] - runs[1]["tip"][:rows], axis=1)
    factor, name = scaled(LENGTH, float(apart.max()))
    ax.plot(runs[0].t[:rows], factor * apart, color=BLACK, lw=1.2)
    finish(ax, runs[0], f"tips apart, {name}", room, legend=False)


def scaled(unit: Unit, largest: float) -> tuple[float, str]:
    """The factor and the name of the unit in which values up to a largest one, SI units, are drawn."""
    return (unit.small_factor, unit.small_name) if largest < SMALL else (unit.factor, unit.name)
