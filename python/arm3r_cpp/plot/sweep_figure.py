"""Figures of a sweep: a metric against an axis, a heat map over a grid of two, a panel an axis over more."""

from __future__ import annotations

import math
from itertools import cycle, product
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.scenario import Scenario
from ..errors import UsageError
from .style import BLACK, LOOKS, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..sweeps.axes import SweepAxis
    from ..sweeps.table import SweepTable
    from .run_figure import Origin, RunFigure

OUTCOME_MARKERS = "xv^sD*P"
WIDE = 100  # listed values that span this factor, by ratios, are drawn on a logarithmic axis


class Drawn(NamedTuple):
    """What varies, as it is drawn: numbers along an axis, or words that tell lines apart."""

    name: str
    values: NDArray[Any]
    unit: str
    geometric: bool

    @property
    def is_number(self) -> bool:
        return self.values.dtype.kind == "f"

    @property
    def words(self) -> str:
        return words_of(self.name, self.unit)

    @property
    def label(self) -> str:
        return f"{self.words}, {self.unit}" if self.unit else self.words


def sweep(table: SweepTable, *, metric: str | None = None, log: bool = False, stamp: bool = False) -> Figure:
    """One metric of a sweep over its axes.

    table: of a finished sweep. metric: a column; None: the first one. log: a logarithmic scale of the metric. stamp:
    write scenario, convention and the hash of the table at the foot; in the metadata of a saved file they always are.
    Runs that did not end ok are marked, and have no value. Returns a matplotlib Figure; `arm3r.plot.show` opens it in a
    window. SI units.

    Raises:
        UsageError: there is no such metric, or nothing of it can be drawn.
    """
    metric = _metric(table, metric, log)
    with style():
        figure = _figure(table, metric, log)
        figure.set_origin([_origin(table)], stamp=stamp)
        return figure


def _figure(table: SweepTable, metric: str, log: bool) -> RunFigure:
    from .run_figure import RunFigure

    drawn = _drawn(table)
    words = [axis for axis in drawn if not axis.is_number]
    numbers = [axis for axis in drawn if axis.is_number]
    if table.mode == "grid" and len(numbers) == 2 and not words:
        figure = RunFigure(figsize=(5.4, 4.2), layout="constrained")
        _heat_map(figure.subplots(), table, metric, *numbers, log=log)
        return figure
    panels = numbers or words[:1]
    figure = RunFigure(figsize=(1.4 + 4.0 * len(panels) ** 0.8, 3.8), layout="constrained")
    grid = figure.subplots(1, len(panels), sharey=True, squeeze=False)
    for ax, axis in zip(grid[0], panels, strict=True):
        joined = table.mode in ("grid", "list") and panels == numbers and len(numbers) == 1
        _curves(ax, table, metric, axis, words if numbers else [], joined=joined)
    grid[0, 0].set_ylabel(_label(table, metric))
    if log:
        grid[0, 0].set_yscale("log")
    _legend(figure, grid[0, 0])
    return figure


def _origin(table: SweepTable) -> Origin:
    from .run_figure import Origin

    scenario = Scenario(table.scenario)
    return Origin(scenario.name, scenario["arm.convention"], table.hash, table.version)


def words_of(key: str, unit: str = "") -> str:
    """A key or a column in words: "wall.contact.stiffness" is "wall contact stiffness", "wall.point[0]" in metres is
    "wall point x", "initial.q[1]" is "initial q 2"."""
    name, _, place = key.partition("[")
    words = name.replace(".", " ").replace("_", " ")
    if not place:
        return words
    number = int(place.rstrip("]"))
    return f"{words} {'xyz'[number] if unit.partition('/')[0] == 'm' and number < 3 else number + 1}"


def _metric(table: SweepTable, metric: str | None, log: bool) -> str:
    metrics = table.names[table.names.index("outcome") + 1 :]
    metric = metric or next(iter(metrics), "")
    if not metric:
        raise UsageError("the sweep kept no metric: there is nothing to draw", code="usage")
    if metric not in metrics:
        raise UsageError(f"--metric {metric}: the sweep kept {', '.join(metrics)}", code="usage")
    values = _values(table, metric)
    if not np.isfinite(values).any():
        raise UsageError(f"--metric {metric}: no run that is ok has a value of it", code="usage")
    if log and not (values > 0).any():
        raise UsageError(f"--log: no value of {metric} is above 0", code="usage")
    return metric


def _values(table: SweepTable, metric: str) -> Any:
    return np.where(table.ok, table[metric], np.nan)


def _label(table: SweepTable, name: str) -> str:
    return f"{words_of(name)}, {table.units[name]}" if table.units[name] else words_of(name)


def _drawn(table: SweepTable) -> list[Drawn]:
    """The axes that take on more than one value; of all, when none does."""
    drawn = [part for axis in table.axes for part in _parts(table, axis)]
    return [part for part in drawn if len(np.unique(part.values)) > 1] or drawn


def _parts(table: SweepTable, axis: SweepAxis) -> list[Drawn]:
    """An axis over several numbers: as words where it takes on few, else each number by itself."""
    names = [name for name in table.names if name == axis.key or name.startswith(f"{axis.key}[")]
    if len(names) > 1 and (axis.count or math.inf) <= len(LOOKS):
        rows = zip(*(table[name].tolist() for name in names), strict=True)
        words = np.array([f"[{', '.join(f'{number:g}' for number in row)}]" for row in rows])
        return [Drawn(axis.key, words, axis.unit, False)]
    return [_drawn_alone(name, table[name], axis) for name in names]


def _drawn_alone(name: str, values: NDArray[Any], axis: SweepAxis) -> Drawn:
    """Where some numbers are infinite, as words."""
    if values.dtype.kind == "f" and not np.isfinite(values).all():
        return Drawn(name, np.array([f"{value:g}" for value in values.tolist()]), axis.unit, False)
    return Drawn(name, values, axis.unit, _is_geometric(axis, values))


def _is_geometric(axis: SweepAxis, values: NDArray[Any]) -> bool:
    if axis.rule != "values" or values.dtype.kind != "f":
        return axis.is_geometric
    known = np.unique(values)
    return known.size > 2 and known[0] > 0 and known[-1] >= WIDE * known[0]


# ---- curves ---------------------------------------------------------------------------------------------------------


def _curves(ax: Axes, table: SweepTable, metric: str, axis: Drawn, words: list[Drawn], *, joined: bool) -> None:
    """The metric against one axis: a line, or points, for each combination of words."""
    values = _values(table, metric)
    for (label, here), (colour, dashes) in zip(_series(words, len(table)), cycle(LOOKS), strict=False):
        order = np.argsort(axis.values[here], kind="stable")
        points: Any = {"marker": ".", "ms": 4, "ls": "", "alpha": 0.6}
        look = {"marker": "o", "ms": 3, "ls": dashes} if joined else points
        ax.plot(axis.values[here][order], values[here][order], color=colour, label=label, **look)
    _mark_failed(ax, table, axis)
    ax.set_xlabel(axis.label)
    if axis.geometric:
        ax.set_xscale("log")


def _series(words: list[Drawn], runs: int) -> list[tuple[str | None, NDArray[np.bool_]]]:
    """The runs of each combination of words, with what to call it; too many of them have one colour."""
    combinations = list(product(*(np.unique(word.values) for word in words)))
    if not words or len(combinations) > len(LOOKS):
        return [(None, np.ones(runs, np.bool_))]
    return [
        (
            ", ".join(f"{word.words} = {chosen}" for word, chosen in zip(words, combination, strict=True)),
            np.all([word.values == chosen for word, chosen in zip(words, combination, strict=True)], axis=0),
        )
        for combination in combinations
    ]


def _mark_failed(ax: Axes, table: SweepTable, axis: Drawn) -> None:
    """At the foot of the panel: where, and how they ended."""
    foot: Any = {"transform": ax.get_xaxis_transform(), "clip_on": False}
    for marker, outcome in zip(OUTCOME_MARKERS, np.unique(table["outcome"][~table.ok]), strict=False):
        x = axis.values[table["outcome"] == outcome]
        ax.plot(x, np.full(len(x), 0.02), marker, color=BLACK, ms=5, mew=1, label=f"{outcome}: {len(x)}", **foot)


def _legend(figure: Any, ax: Axes) -> None:
    handles, labels = ax.get_legend_handles_labels()
    if handles:
        figure.legend(handles, labels, loc="outside upper left", ncols=min(3, len(handles)))


# ---- heat map -------------------------------------------------------------------------------------------------------


def _heat_map(ax: Axes, table: SweepTable, metric: str, right: Drawn, up: Drawn, *, log: bool) -> None:
    x, y = np.unique(right.values), np.unique(up.values)
    place = np.searchsorted(y, up.values), np.searchsorted(x, right.values)
    cells = np.full((len(y), len(x)), np.nan)
    cells[place] = _values(table, metric)
    ax.grid(False)
    ax.set_facecolor("#eeeeee")
    image = ax.pcolormesh(
        _edges(x, right.geometric), _edges(y, up.geometric),
        np.ma.masked_invalid(np.where(cells > 0, cells, np.nan) if log else cells),
        norm="log" if log else "linear", cmap="viridis", rasterized=True,
    )  # fmt: skip
    ax.set(
        xlabel=right.label, ylabel=up.label,
        xscale="log" if right.geometric else "linear", yscale="log" if up.geometric else "linear",
    )  # fmt: skip
    bar = ax.figure.colorbar(image, ax=ax, label=_label(table, metric))
    bar.outline.set_visible(False)
    failed = ~table.ok
    for marker, outcome in zip(OUTCOME_MARKERS, np.unique(table["outcome"][failed]), strict=False):
        here = table["outcome"] == outcome
        label = f"{outcome}: {here.sum()}"
        ax.plot(right.values[here], up.values[here], marker, color=BLACK, ms=4, mew=1, label=label)
    _legend(ax.figure, ax)


def _edges(centres: Any, geometric: bool) -> Any:
    """Borders of the cells around these values."""
    if len(centres) == 1:
        return centres[0] * np.array([0.9, 1.1]) if centres[0] else np.array([-0.5, 0.5])
    at = np.log(centres) if geometric else centres
    half = np.diff(at) / 2
    edges = np.concatenate([[at[0] - half[0]], at[:-1] + half, [at[-1] + half[-1]]])
    return np.exp(edges) if geometric else edges
