"""The figures that users ask for by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from ..errors import UsageError
from .style import WIDTH, style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..core.run import Run
    from .force_run import ForceRun
    from .layout import Size
    from .run_figure import RunFigure


def overview(
    run: Run, *, width: float = WIDTH, height: float | None = None, panels: Sequence[str] | None = None,
    start: float | None = None, end: float | None = None, degrees: bool | None = None, stamp: bool = False,
) -> Figure:  # fmt: skip
    """Joint angles, tip position, tracking errors, torques, observer, tank, and the force on the wall (without a wall:
    the energies), over time.

    Args:
        run: a finished or partial run; panels whose columns it lacks are left out.
        width, height: inches; None: as high as the panels need, at most a page of 9 inches.
        panels: names of those to draw, in order, such as ["angles", "tank"]; a wrong one lists what there is.
        start, end: of the part of the run that is drawn, s; None: its first or last row.
        degrees: whether angles are in degrees; None: where the scenario gives angles of the start or reference in them.
        stamp: write scenario, convention and hash at the foot; in the metadata of a saved file they always are.

    Returns a matplotlib Figure. A notebook shows it as the value of a cell, `arm3r.plot.show(figure)` in a window;
    `plt.show()` does not know it. SI units; contact is shaded, and its beginnings and ends are marked at the times at
    which they were located.

    Raises:
        UsageError: there is no such panel, too few rows lie from start to end, or the height is too small.
    """
    from .run_panels import overview_figure

    def draw(parts: list[ForceRun], size: Size) -> RunFigure:
        return overview_figure(parts[0], panels, size)

    return _figure(draw, [(None, run)], width, height, start, end, degrees, stamp)


def lecture(
    run: Run, *, panels: Sequence[str] | None = None, start: float | None = None, end: float | None = None,
    stamp: bool = False,
) -> dict[str, Figure]:  # fmt: skip
    """The lecture's figures by name: tip, velocities, torques, energies, strobe, and with a wall: wall, contact.

    panels: names of the figures to draw; None: all. The other arguments and what is returned: as for `overview`.

    Raises:
        UsageError: there is no such figure, or too few rows lie from start to end.
    """
    from .lecture_figures import figures
    from .run_figure import origin_of, stamp_height
    from .run_part import part_of

    part = part_of(run, start, end)
    there = figures(part)
    for name in panels or []:
        if name not in there:
            raise UsageError(f"panels: {name}: there is no such figure; there are {', '.join(there)}", code="usage")
    with style():
        origins = [origin_of(run)]
        drawn = {name: there[name](stamp_height(origins, WIDTH) if stamp else 0.0) for name in panels or there}
        for figure in drawn.values():
            figure.set_origin(origins, stamp=stamp)
        return {**drawn}


def force(
    run: Run, *, width: float = WIDTH, height: float | None = None, panels: Sequence[str] | None = None,
    start: float | None = None, end: float | None = None, degrees: bool | None = None, stamp: bool = False,
) -> Figure:  # fmt: skip
    """Force against reference with peak and settling, tracking, torques, observer; the first contact, and the path on
    the wall's face.

    run: a finished or partial run with a wall. width: inches; below 5 the panels stand one under the other. The other
    arguments and what is returned: as for `overview`.

    Raises:
        UsageError: the run has no wall; or as for `overview`.
    """
    from .run_panels import force_figure

    def draw(parts: list[ForceRun], size: Size) -> RunFigure:
        return force_figure(parts[0], panels, size)

    return _figure(draw, [(None, run)], width, height, start, end, degrees, stamp)


def compare(
    runs: Sequence[Run] | Mapping[str, Run], *, width: float = WIDTH, height: float | None = None,
    panels: Sequence[str] | None = None, start: float | None = None, end: float | None = None,
    degrees: bool | None = None, stamp: bool = False,
) -> Figure:  # fmt: skip
    """Runs over each other: force, errors, torques, contact; the first contact, the path on the wall's face; a table.

    runs: two to six with the same wall, by the names they get; in a sequence they are called as their scenarios are.
    The numbers of the table are those of the whole runs. The other arguments and what is returned: as for `overview`.

    Raises:
        UsageError: a run has no wall, or another one; or they are too many; or as for `overview`.
    """
    from .comparison import compare_figure

    def draw(parts: list[ForceRun], size: Size) -> RunFigure:
        return compare_figure(parts, panels, size)

    pairs = list(runs.items()) if isinstance(runs, Mapping) else [(None, run) for run in runs]
    return _figure(draw, pairs, width, height, start, end, degrees, stamp)


def _figure(
    draw: Callable[[list[ForceRun], Size], RunFigure], runs: Sequence[tuple[str | None, Run]], width: float,
    height: float | None, start: float | None, end: float | None, degrees: bool | None, stamp: bool,
) -> Figure:  # fmt: skip
    """What `draw` makes of the parts of the runs from start to end, with their origin in the file's metadata."""
    from .force_run import ForceRun
    from .layout import Size
    from .run_figure import origin_of, stamp_height
    from .run_part import part_of

    with style():
        parts = [ForceRun(part_of(run, start, end), name=name, degrees=degrees) for name, run in runs]
        origins = [origin_of(run) for _, run in runs]
        figure = draw(parts, Size(width, height, stamp_height(origins, width) if stamp else 0.0))
        figure.set_origin(origins, stamp=stamp)
        return figure


def show(*figures: Figure) -> None:
    """Open a window for each figure, and wait until all windows are closed; in a notebook, show the figures there.

    It takes the place of `plt.show()`, which does not know the figures of this package. Open figures of pyplot are
    shown, too. In an interactive session of pyplot (`plt.ion()`) it does not wait.

    Raises:
        UsageError: matplotlib has no windows here, such as on a machine without a screen.
    """
    from .run_figure import has_notebook, open_windows

    if not figures:
        raise UsageError("show: a figure is needed, such as show(overview(run))", code="usage")
    if has_notebook():
        from IPython import display

        display.display(*figures)
    else:
        open_windows(figures)
