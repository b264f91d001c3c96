"""The figures that the lecture shows, one function a figure."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from .strobe import strobe
from .style import (
    AMBER,
    BLACK,
    BLUE,
    GREEN,
    JOINTS,
    PINK,
    RED,
    SKY,
    XYZ,
    contact_spans,
    draw,
    event_legend,
    finish,
    panels,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .._native import Floats
    from ..run import Run

NEEDLE = 0.1  # of the run: a contact shorter than this gets a time axis of its own


def has_wall(run: Run) -> bool:
    return "depth" in run.units


def figures(run: Run) -> dict[str, Callable[[Run], Figure]]:
    """The drawing functions that fit the run, by the name of their figure."""
    always: dict[str, Callable[[Run], Figure]] = {
        "tip": tip, "velocities": velocities, "torques": torques, "energies": energies, "strobe": strobe,
    }  # fmt: skip
    return always | {"wall": wall, "contact": contact} if has_wall(run) else always


def tip(run: Run) -> Figure:
    figure, (ax,) = panels(run, [2.4])
    draw(ax, run, [f"tip_{c}" for c in XYZ], list(XYZ))
    finish(ax, run, "tip position, m")
    event_legend(figure, run)
    return figure


def velocities(run: Run) -> Figure:
    figure, (*components, residual) = panels(run, [1.2, 1.2, 1.2, 1.4])
    for ax, c in zip(components, XYZ, strict=True):
        ax.plot(run.t, run[f"tip_v{c}"], color=SKY, lw=3.2, label="transform sensor")
        ax.plot(run.t, run[f"tip_jv{c}"], color=BLACK, lw=1.0, label=r"$J\,\dot q$")
        ax.plot(run.t, run[f"tip_dv{c}"], color=RED, lw=1.4, ls=(0, (1, 2)), label="position differentiated")
        finish(ax, run, f"$v_{c}$, m/s", legend=c == "x")
    distance = {
        r"$J\,\dot q -$ sensor": np.linalg.norm(run["tip_jv"] - run["tip_v"], axis=1),
        "differentiated − sensor": np.linalg.norm(run["tip_dv"] - run["tip_v"], axis=1),
    }
    draw_residuals(residual, run, distance)
    finish(residual, run, "residual, m/s")
    event_legend(figure, run)
    return figure


def draw_residuals(ax: Axes, run: Run, values: dict[str, Floats]) -> None:
    """Sizes on a logarithmic axis; what is exactly zero throughout is said in the legend, as it cannot be drawn."""
    ax.set_yscale("log", nonpositive="mask")
    for (label, size), colour in zip(values.items(), (BLACK, RED), strict=False):
        ax.plot(run.t, size, color=colour, lw=0.9, label=label if np.any(size) else f"{label}: exactly 0")
    if not any(np.any(size) for size in values.values()):
        ax.set_yticks([])


def wall(run: Run) -> Figure:
    figure, (position, depth) = panels(run, [1.6, 1.4])
    draw(position, run, [f"wall_{c}" for c in XYZ], list(XYZ))
    finish(position, run, "wall position, m")
    depth.plot(run.t, run["depth"], color=BLACK)
    finish(depth, run, "depth of tip, m")
    event_legend(figure, run)
    return figure


def contact(run: Run) -> Figure:
    figure, (force, flag) = panels(run, [2.0, 0.8])
    draw(force, run, [f"f_on_wall_{c}" for c in XYZ], [f"on wall, {c}" for c in XYZ])
    finish(force, run, "force, N")
    times, states = [run.t[0], *(e.t for e in run.events), run.t[-1]], [0, *(int(e.type == "make") for e in run.events)]
    flag.step(times, [*states, states[-1]], where="post", color=BLACK)
    flag.set_yticks([0, 1], ["off", "on"])
    flag.set_ylim(-0.2, 1.2)
    finish(flag, run, "contact")
    show_short_contact(flag, run)
    event_legend(figure, run)
    return figure


def show_short_contact(ax: Axes, run: Run) -> None:
    """Narrow the time axis where contact takes so little of the run that it would be a needle."""
    spans = contact_spans(run)
    if not spans:
        return
    start, end = spans[0][0], spans[-1][1]
    if end - start < NEEDLE * (run.t[-1] - run.t[0]):
        ax.set_xlim(start - (end - start) / 2, end + (end - start) / 2)


def torques(run: Run) -> Figure:
    figure, axes = panels(run, [1.2] * 3)
    for ax, i in zip(axes, JOINTS, strict=True):
        ax.plot(run.t, run[f"tau{i}"], color=BLUE, label="applied")
        ax.plot(run.t, run[f"tau_g{i}"], color=RED, ls="--", label="would hold the arm")
        finish(ax, run, rf"$\tau_{i}$, N m", legend=i == "1")
    event_legend(figure, run)
    return figure


def draw_energies(ax: Axes, run: Run) -> None:
    """Kinetic and potential energy, and every other term of the balance that is not zero throughout."""
    terms = (
        ("work_actuators", AMBER, "-", 3.2, "by actuators"),
        ("work_wall", PINK, "-", 2.4, "by wall"),
        ("energy_kinetic", BLUE, "-", 1.4, "kinetic"),
        ("energy_potential", RED, "--", 1.4, "Δ potential"),
        ("energy_contact", GREEN, "-.", 1.4, "contact"),
        ("energy_dissipated", BLACK, ":", 1.4, "dissipated"),
    )
    for name, colour, dashes, width, label in terms:
        energy = run[name] - run[name][0] if name == "energy_potential" else run[name]
        if np.any(energy) or name in ("energy_kinetic", "energy_potential"):
            ax.plot(run.t, energy, color=colour, ls=dashes, lw=width, label=label)


def energies(run: Run) -> Figure:
    figure, (terms, residual) = panels(run, [2.0, 1.2])
    draw_energies(terms, run)
    finish(terms, run, "energy, J")
    draw_residuals(residual, run, {"residual of the energy balance": abs(run["energy_residual"])})
    finish(residual, run, "residual, J")
    event_legend(figure, run)
    return figure
