"""The figures that the lecture shows: the panels of each."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from .layout import Panel, Size, lay_out
from .run_panels import draw_energies, draw_force_on_wall, explained, greyed_out, tip_panels
from .strobe import strobe
from .style import BLACK, BLUE, JOINTS, RED, SKY, TIP, TRIPLE, XYZ, contact_spans, finish

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .._native import Floats
    from ..core.run import Run
    from .run_figure import RunFigure

NEEDLE = 0.1  # of the run: a contact shorter than this gets a time axis of its own


def has_wall(run: Run) -> bool:
    return "depth" in run


def figures(run: Run) -> dict[str, Callable[[float], RunFigure]]:
    """What draws the figures that fit the run, by their names; the number is what stays free at the foot, inches."""
    panels = {"tip": tip_panels(run, height=1.0), "velocities": velocities(run), "torques": torques(run)}
    panels["energies"] = [Panel(2.0, partial(draw_energies, run)), Panel(1.2, partial(draw_energy_residual, run))]
    if has_wall(run):
        panels["wall"] = [Panel(1.6, partial(draw_wall_position, run)), Panel(1.4, partial(draw_depth, run))]
        panels["contact"] = [Panel(2.0, partial(draw_force_on_wall, run)), Panel(0.8, partial(draw_flag, run))]
    drawn: dict[str, Callable[[float], RunFigure]] = {
        name: partial(over_time, run, name, panels[name]) for name in panels
    }
    return drawn | {"strobe": partial(strobe, run)}


def over_time(run: Run, name: str, panels: list[Panel], foot: float) -> RunFigure:
    start, end = contact_window(run) if name == "contact" else (run.t[0], run.t[-1])
    first = panels[0]._replace(draw=partial(explained, run, panels[0]))
    return lay_out(greyed_out(run, [first, *panels[1:]]), [], size=Size(foot=foot), start=start, end=end)


def contact_window(run: Run) -> tuple[float, float]:
    """The time axis of the contact; narrowed where contact takes so little of the run that it would be a needle."""
    spans = contact_spans(run)
    whole = float(run.t[0]), float(run.t[-1])
    if not spans:
        return whole
    start, end = spans[0][0], spans[-1][1]
    if end - start >= NEEDLE * (whole[1] - whole[0]):
        return whole
    return max(start - (end - start) / 2, whole[0]), min(end + (end - start) / 2, whole[1])


# ---- velocities and torques -----------------------------------------------------------------------------------------


def velocities(run: Run) -> list[Panel]:
    return [
        *(Panel(1.2, partial(draw_velocity, run, c)) for c in XYZ),
        Panel(1.4, partial(draw_velocity_residual, run)),
    ]


def draw_velocity(run: Run, c: str, ax: Axes, room: float) -> None:
    ax.plot(run.t, run[f"tip_v{c}"], color=SKY, lw=3.2, label="transform sensor")
    ax.plot(run.t, run[f"tip_jv{c}"], color=BLACK, lw=1.0, label=r"$J\,\dot q$")
    ax.plot(run.t, run[f"tip_dv{c}"], color=RED, lw=1.4, ls=(0, (1, 2)), label="position differentiated")
    finish(ax, run, f"$v_{c}$, m/s", room, legend=c == "x")


def draw_velocity_residual(run: Run, ax: Axes, room: float) -> None:
    distance = {
        r"$J\,\dot q -$ sensor": np.linalg.norm(run["tip_jv"] - run["tip_v"], axis=1),
        "differentiated − sensor": np.linalg.norm(run["tip_dv"] - run["tip_v"], axis=1),
    }
    draw_residuals(ax, run, distance)
    finish(ax, run, "residual, m/s", room)


def draw_residuals(ax: Axes, run: Run, values: dict[str, Floats]) -> None:
    """Sizes on a logarithmic axis; what is exactly zero throughout is said in the legend, as it cannot be drawn."""
    ax.set_yscale("log", nonpositive="mask")
    for (label, size), colour in zip(values.items(), (BLACK, RED), strict=False):
        ax.plot(run.t, size, color=colour, lw=0.9, label=label if np.any(size) else f"{label}: exactly 0")
    if not any(np.any(size) for size in values.values()):
        ax.set_yticks([])


def torques(run: Run) -> list[Panel]:
    return [Panel(1.2, partial(draw_torque, run, joint)) for joint in JOINTS]


def draw_torque(run: Run, joint: str, ax: Axes, room: float) -> None:
    ax.plot(run.t, run[f"tau{joint}"], color=BLUE, label="applied")
    ax.plot(run.t, run[f"tau_g{joint}"], color=RED, ls="--", label="would hold the arm")
    finish(ax, run, rf"$\tau_{joint}$, N m", room, legend=joint == "1")


def draw_energy_residual(run: Run, ax: Axes, room: float) -> None:
    draw_residuals(ax, run, {"residual of the energy balance": abs(run["energy_residual"])})
    finish(ax, run, "residual, J", room)


# ---- wall and contact -----------------------------------------------------------------------------------------------


def draw_wall_position(run: Run, ax: Axes, room: float) -> None:
    for c, look in zip(XYZ, TRIPLE, strict=True):
        ax.plot(run.t, run[f"wall_{c}"], label=c, **look)
    finish(ax, run, "wall position, m", room)


def draw_depth(run: Run, ax: Axes, room: float) -> None:
    ax.plot(run.t, run["depth"], color=TIP)
    finish(ax, run, "depth of tip, m", room)


def draw_flag(run: Run, ax: Axes, room: float) -> None:
    """The contact of the events, which fall between rows."""
    before = int(bool(run.events) and run.events[0].type == "break")
    times = [run.t[0], *(e.t for e in run.events), run.t[-1]]
    states = [before, *(int(e.type == "make") for e in run.events)]
    ax.step(times, [*states, states[-1]], where="post", color=BLACK)
    ax.set_yticks([0, 1], ["off", "on"])
    ax.set_ylim(-0.2, 1.2)
    finish(ax, run, "contact", room)
