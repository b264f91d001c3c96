"""The panels of a run by their names, and the figures that are made of them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ..errors import UsageError
from .force_figure import (
    draw_force,
    draw_joint_error,
    draw_path_error,
    draw_residuals,
    draw_stiffness,
    draw_tank,
    draw_torques,
    draw_transient,
    face_panel,
    face_shows_something,
    transient,
)
from .layout import Named, Panel, Size, chosen, lay_out
from .style import (
    AMBER,
    BLACK,
    BLUE,
    GREEN,
    JOINTS,
    PINK,
    RED,
    REFERENCE,
    TIP,
    TRIPLE,
    XYZ,
    explain_contact,
    finish,
    grey_out,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..core.run import Run
    from .force_run import ForceRun
    from .run_figure import RunFigure

FORCE = ("force", "path_error", "joint_error", "torques", "residuals", "stiffness", "tank", "first_contact", "face")
OVERVIEW = ("angles", "tip", "depth", "path_error", "joint_error", "torques", "residuals", "stiffness", "tank",
            "force_on_wall", "energies", "first_contact")  # fmt: skip
BELOW = ("first_contact", "face")
ENERGIES = {  # colour, dashes, width and label of a term of the energy balance
    "work_actuators": (AMBER, "-", 3.2, "work of actuators"),
    "work_wall": (PINK, "-", 2.4, "external work"),
    "energy_kinetic": (BLUE, "-", 1.4, "kinetic"),
    "energy_potential": (RED, "--", 1.4, "Δ potential"),
    "energy_contact": (GREEN, "-.", 1.4, "contact"),
    "energy_dissipated": (BLACK, ":", 1.4, "dissipated"),
}
STILL = 1e-6  # m: a coordinate of the tip that changes less has no panel of its own
LEAST_MILLIMETRES = 2.0  # the panels of the tip's coordinates do not magnify further


def panels_of(run: ForceRun, names: Sequence[str] | None) -> Named:
    """All panels of a run by the names that users choose them by; none where it lacks the columns.

    names: those that are chosen. The legend of the panel of the force holds for that of the first contact, too.
    """
    rows = run.run
    transients = partial(draw_transient, run, legend="force" not in (names or FORCE))
    return {
        "force": [Panel(1.6, partial(draw_force, run))] if run.has_force else [],
        "force_on_wall": [Panel(1.0, partial(draw_force_on_wall, rows))] if has_wall_force(rows) else [],
        "depth": [Panel(0.8, partial(draw_depth, rows))] if "depth" in rows else [],
        "angles": [Panel(1.0, partial(draw_angles, run))] if "q" in rows else [],
        "tip": moving_tip_panels(rows),
        "path_error": [Panel(0.8, partial(draw_path_error, run))] if run.path_error else [],
        "joint_error": [Panel(0.8, partial(draw_joint_error, run))] if run.joint_error else [],
        "torques": [Panel(1.2, partial(draw_torques, run))] if "tau" in rows else [],
        "residuals": [Panel(0.8, partial(draw_residuals, run))] if "residual" in rows else [],
        "stiffness": [Panel(0.8, partial(draw_stiffness, run))] if "stiffness_estimate" in rows else [],
        "tank": [Panel(0.8, partial(draw_tank, run))] if "tank_energy" in rows else [],
        "energies": [Panel(1.0, partial(draw_energies, rows))] if set(ENERGIES) <= set(rows.columns) else [],
        "first_contact": [Panel(1.9, transients)] if run.has_force and transient(run) else [],
        "face": face_panel(run),
    }


def force_figure(run: ForceRun, names: Sequence[str] | None, size: Size) -> RunFigure:
    """
    Raises:
        UsageError: the run does not tell a force, a name is none of a panel that it has, or the figure is too low.
    """
    run.check()
    panels = panels_of(run, names)
    wanted = [name for name in FORCE if panels[name] and (name != "face" or face_shows_something(run))]
    return figure_of(run, panels, names or wanted, size)


def overview_figure(run: ForceRun, names: Sequence[str] | None, size: Size) -> RunFigure:
    """As for `force_figure`, of any run."""
    panels = panels_of(run, names or OVERVIEW)
    left_out = {"energies"} if panels["force_on_wall"] or panels["residuals"] else set()
    left_out |= {"depth"} if panels["path_error"] or panels["joint_error"] else set()
    wanted = [name for name in OVERVIEW if panels[name] and name not in left_out]
    return figure_of(run, panels, names or wanted, size, names_contact=True)


def figure_of(
    run: ForceRun, panels: Named, names: Sequence[str], size: Size, *, names_contact: bool = False
) -> RunFigure:
    """names_contact: whether the legend of the first panel says when there is contact."""
    if not names:
        there = ", ".join(run.run)
        raise UsageError(f"{run.name}: no panel can be drawn of {there}; log more (time.log_columns)", code="usage")
    over_time, below, _ = chosen(panels, names, below=BELOW)
    if over_time and names_contact:
        over_time[0] = over_time[0]._replace(draw=partial(explained, run.run, over_time[0]))
    t = run.run.t
    over_time = greyed_out(run.run, over_time)
    return lay_out(over_time, below, size=size, start=float(t[0]), end=float(t[-1]))


def explained(run: Run, panel: Panel, ax: Axes, room: float) -> None:
    """A panel whose legend says when there is contact."""
    panel.draw(ax, room)
    explain_contact(ax, run, room=room)


def greyed_out(run: Run, panels: Sequence[Panel]) -> list[Panel]:
    """Panels over time that cover what can no longer be trusted; the legend of the first one says so."""

    def draw(panel: Panel, ax: Axes, room: float) -> None:
        panel.draw(ax, room)
        grey_out(ax, run, room=room if panel is panels[0] else None)

    return [panel._replace(draw=partial(draw, panel)) for panel in panels]


# ---- panels of any run ----------------------------------------------------------------------------------------------


def draw_angles(run: ForceRun, ax: Axes, room: float) -> None:
    for i, look in zip(JOINTS, TRIPLE, strict=True):
        ax.plot(run.run.t, run.angle.factor * run.run[f"q{i}"], label=f"$q_{i}$", **look)
    finish(ax, run.run, f"joint angle, {run.angle.name}", room)


def tip_panels(run: Run, *, height: float) -> list[Panel]:
    """One for each coordinate, so that a motion of a millimetre is seen."""
    return [Panel(height, partial(draw_tip, run, c)) for c in XYZ]


def moving_tip_panels(run: Run) -> list[Panel]:
    """One for each coordinate that changes; the legend of the first one names the others."""
    if "tip" not in run:
        return []
    still = [c for c in XYZ if np.ptp(run[f"tip_{c}"]) < STILL]
    shown = [c for c in XYZ if c not in still] or ["x"]
    constant = [f"{c} = {round(1e3 * run[f'tip_{c}'][0], 3) + 0.0:g} mm throughout" for c in still if c not in shown]
    return [Panel(0.6, partial(draw_tip, run, c, constant=constant if c == shown[0] else [])) for c in shown]


def draw_tip(run: Run, c: str, ax: Axes, room: float, *, constant: Sequence[str] = ()) -> None:
    """constant: what the legend says of the coordinates that do not change."""
    tip = 1e3 * run[f"tip_{c}"]
    ax.plot(run.t, tip, color=TIP, label="tip")
    if f"tip_ref_{c}" in run:
        ax.plot(run.t, 1e3 * run[f"tip_ref_{c}"], color=REFERENCE, ls="--", lw=1.0, label="reference")
    if np.ptp(tip) < LEAST_MILLIMETRES:
        middle = (tip.min() + tip.max()) / 2
        ax.set_ylim(middle - LEAST_MILLIMETRES / 2, middle + LEAST_MILLIMETRES / 2)
    for text in constant:
        ax.plot([], [], ls="", label=text)
    finish(ax, run, f"tip {c}, mm", room, legend=bool(constant) or (c == "x" and "tip_ref" in run))


def draw_depth(run: Run, ax: Axes, room: float) -> None:
    ax.plot(run.t, 1e3 * run["depth"], color=TIP)
    ax.axhline(0, color=BLACK, lw=0.8)
    finish(ax, run, "depth, mm", room)


def has_wall_force(run: Run) -> bool:
    return "depth" in run and "f_on_wall" in run


def draw_force_on_wall(run: Run, ax: Axes, room: float) -> None:
    for c, look in zip(XYZ, TRIPLE, strict=True):
        ax.plot(run.t, run[f"f_on_wall_{c}"], label=f"on wall, {c}", **look)
    finish(ax, run, "force, N", room)


def draw_energies(run: Run, ax: Axes, room: float) -> None:
    """Kinetic and potential energy, and every other term of the balance that is not zero throughout."""
    for name, (colour, dashes, width, label) in ENERGIES.items():
        energy = run[name] - run[name][0] if name == "energy_potential" else run[name]
        if np.any(energy) or name in ("energy_kinetic", "energy_potential"):
            ax.plot(run.t, energy, color=colour, ls=dashes, lw=width, label=label)
    finish(ax, run, "energy, J", room)
