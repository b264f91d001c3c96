"""The figures that users ask for by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from .lecture_figures import draw_energies, figures, has_wall
from .style import JOINTS, WIDTH, XYZ, draw, event_legend, finish, panels, style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..run import Run


def overview(run: Run) -> Figure:
    """Joint angles, tip position, torques, and the force on the wall (without a wall: the energies), over time.

    run: a finished or partial run. Returns a matplotlib Figure that is not shown. SI units; contact is shaded, make and
    break are marked at the times at which they were located.
    """
    with style():
        figure, (angles, tip, torques, last) = panels(run, [1.3] * 4)
        draw(angles, run, [f"q{i}" for i in JOINTS], [f"$q_{i}$" for i in JOINTS])
        finish(angles, run, "joint angle, rad")
        draw(tip, run, [f"tip_{c}" for c in XYZ], list(XYZ))
        finish(tip, run, "tip position, m")
        draw(torques, run, [f"tau{i}" for i in JOINTS], [rf"$\tau_{i}$" for i in JOINTS])
        finish(torques, run, "torque, N m")
        if has_wall(run):
            draw(last, run, [f"f_on_wall_{c}" for c in XYZ], [f"on wall, {c}" for c in XYZ])
            finish(last, run, "force, N")
        else:
            draw_energies(last, run)
            finish(last, run, "energy, J")
        event_legend(figure, run)
        return figure


def lecture(run: Run) -> dict[str, Figure]:
    """The lecture's figures by name: tip, velocities, torques, energies, strobe, and with a wall: wall, contact.

    run: a finished or partial run. Returns matplotlib Figures that are not shown. SI units.
    """
    with style():
        return {name: figure(run) for name, figure in figures(run).items()}


def force(run: Run, *, width: float = WIDTH) -> Figure:
    """Force against reference with peak and settling, tracking, torques, observer; the first contact, and the path on
    the wall's face.

    run: a finished or partial run with a wall; panels whose columns it lacks are left out. width: inches; below 5 the
    panels stand one under the other. Returns a matplotlib Figure that is not shown. SI units.

    Raises:
        UsageError: the run has no wall.
    """
    from .force_figure import force_figure
    from .force_run import ForceRun

    with style():
        return force_figure(ForceRun(run), width=width)


def compare(runs: Sequence[Run] | Mapping[str, Run], *, width: float = WIDTH) -> Figure:
    """Runs over each other: force, errors, torques, contact; the first contact, the path on the wall's face; a table.

    runs: two to six with the same wall, by the names they get; in a sequence they are called as their scenarios are.
    width: inches. Returns a matplotlib Figure that is not shown. SI units.

    Raises:
        UsageError: a run has no wall, or another one; or they are too many.
    """
    from .comparison import compare_figure
    from .force_run import ForceRun

    pairs = list(runs.items()) if isinstance(runs, Mapping) else [(None, run) for run in runs]
    with style():
        return compare_figure([ForceRun(run, name=name) for name, run in pairs], width=width)
