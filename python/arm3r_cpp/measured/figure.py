"""A measurement beside runs: each quantity that was measured in a panel, the runs over it."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from .._native import version
from ..core.scenario import Scenario
from ..errors import UsageError
from ..plot.layout import Panel, Size, chosen, lay_out
from ..plot.run_figure import Origin, origin_of, stamp_height
from ..plot.run_part import part_of
from ..plot.style import BLACK, TRIPLE, WIDTH, Unit, angle_unit, finish, legend_above, plain_ticks, style, widen_if_flat
from .reader import Measurement, measurement

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..core.run import Run

MOST_RUNS = 4
DASHES: tuple[Any, ...] = ("-", (0, (5, 2)), (0, (1, 1.5)), (0, (5, 2, 1, 2)))
MEASURED: Any = {"ls": "-", "lw": 2.4, "alpha": 0.35, "solid_capstyle": "round"}
QUANTITIES = {  # of columns that belong together, by the name that they share
    "q": "joint angle, {angle}",
    "qd": "joint rate, {angle}/s",
    "qdd": "joint acceleration, {angle}/s²",
    "tau": "torque, N m",
    "tau_g": "gravity torque, N m",
    "tip": "tip, m",
    "tip_v": "tip velocity, m/s",
    "wall": "wall, m",
    "f_on_tip": "force on the tip, N",
    "f_on_wall": "force on the wall, N",
    "force": "pressing force, N",
    "depth": "depth, m",
}


def measured(
    log: str | os.PathLike[str] | Mapping[str, Any], runs: Sequence[Run] | Mapping[str, Run] = (), *,
    width: float = WIDTH, height: float | None = None, panels: Sequence[str] | None = None,
    start: float | None = None, end: float | None = None, degrees: bool | None = None, stamp: bool = False,
) -> Figure:  # fmt: skip
    """A measurement, and up to four runs over it: a panel for each quantity that was measured.

    Args:
        log: a CSV file with a column `t` or `time` and columns named as those of a run, SI units and radians; or such
            columns as a map. Other columns are left out, with a warning that names them.
        runs: as for `arm3r_cpp.plot.compare`; none: the measurement alone.

    The other arguments and what is returned: as for `arm3r_cpp.plot.overview`; panels are called q, tau, tip, ...

    Raises:
        UsageError: the measurement cannot be read, or as for `overview`.
    """
    found = measurement(log)
    given = dict(runs) if isinstance(runs, Mapping) else {run.summary["name"]: run for run in runs}
    if len(given) > MOST_RUNS:
        raise UsageError(f"{found.name}: up to {MOST_RUNS} runs can be drawn over a measurement, got {len(given)}")
    parts = {name: part_of(run, start, end) for name, run in given.items()}
    kept = (found.t >= _or(start, -np.inf)) & (found.t <= _or(end, np.inf))
    found = Measurement(found.name, found.t[kept], {name: column[kept] for name, column in found.columns.items()})
    if not kept.any():
        raise UsageError(f"{found.name}: no row lies in the time that is asked for", code="usage")
    texts = [run.summary["scenario"] for run in given.values() if run.summary.get("scenario")]
    unit = angle_unit(Scenario(texts[0]) if texts else None, degrees)
    with style():
        named = {name: [Panel(1.2, partial(draw, found, parts, name, unit))] for name in groups(found.columns)}
        over_time, _, _ = chosen(named, panels or list(named), below=())
        first = over_time[0]
        over_time[0] = first._replace(draw=partial(explained, found, parts, first))
        origins = [origin_of(run) for run in given.values()] or [Origin(found.name, "", "none", version)]
        spans = [found.t, *(run.t for run in parts.values())]
        size = Size(width, height, stamp_height(origins, width) if stamp else 0.0)
        drawn = lay_out(over_time, [], size=size, start=min(t[0] for t in spans), end=max(t[-1] for t in spans))
        drawn.set_origin(origins, stamp=stamp)
        return drawn


def _or(value: float | None, other: float) -> float:
    return other if value is None else value


def groups(columns: Mapping[str, Any]) -> dict[str, list[str]]:
    """Columns that belong together, such as q1, q2 and q3, by the name that they share."""
    found: dict[str, list[str]] = {}
    for name in columns:
        stem = name[:-1].rstrip("_") if name[-1] in "123xyz" and len(name) > 1 else name
        stem = "tip_v" if stem in ("tip_v", "tip_jv", "tip_dv") else stem
        found.setdefault(stem if stem in QUANTITIES else name, []).append(name)
    return found


def draw(log: Measurement, runs: Mapping[str, Run], group: str, angle: Unit, ax: Axes, room: float) -> None:
    """A colour a column: the measurement broad and pale, the runs thin."""
    columns = groups(log.columns)[group]
    label = QUANTITIES.get(group, group)
    factor = angle.factor if "{angle}" in label else 1.0
    label = label.format(angle=angle.name)
    for name in columns:
        colour = TRIPLE[max("123xyz".find(name[-1]), 0) % 3]["color"] if len(columns) > 1 else TRIPLE[0]["color"]
        ax.plot(log.t, factor * log.columns[name], color=colour, label=name, **MEASURED)
        for run, dashes in zip(runs.values(), DASHES, strict=False):
            if name in run:
                ax.plot(run.t, factor * run[name], color=colour, ls=dashes, lw=1.2)
    if runs:
        finish(ax, next(iter(runs.values())), label, room)
        return
    ax.set_ylabel(label)
    widen_if_flat(ax)
    plain_ticks(ax)
    legend_above(ax, room=room)


def explained(log: Measurement, runs: Mapping[str, Run], panel: Panel, ax: Axes, room: float) -> None:
    """A panel whose legend says what is measured and what is simulated."""
    panel.draw(ax, room)
    ax.plot([], [], color=BLACK, label=f"measured: {log.name}", **MEASURED)
    for (name, _), dashes in zip(runs.items(), DASHES, strict=False):
        ax.plot([], [], color=BLACK, ls=dashes, lw=1.2, label=name)
    legend_above(ax, room=room)
