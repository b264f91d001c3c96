"""Small figures for pages: bytes of a PNG, of two panels side by side. pyplot knows nothing of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from io import BytesIO
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.arm_line import arm_line
from ..core.scenario import Scenario
from ..plot.style import ARM, ON_WALL, TIP, TRIPLE, WALL, angle_unit, style
from ..plot.wall_frame import half_sides, wall_frame

if TYPE_CHECKING:
    from ..core.batch import Batch
    from ..core.run import Run

WIDTH, HEIGHT = 6.3, 1.9  # inches on the page
DOTS = 160  # per inch: sharp on screens with two dots a pixel

INFINITE_HALF = 0.5  # m: as much of an infinite wall is drawn


@contextmanager
def _panels(count: int) -> Iterator[tuple[Any, Any, BytesIO]]:
    """A figure, its axes in a row, and where its PNG is when the block has ended."""
    from matplotlib.figure import Figure

    png = BytesIO()
    with style():
        figure = Figure(figsize=(WIDTH, HEIGHT), layout="constrained")
        axes = figure.subplots(1, count, squeeze=False)[0]
        yield figure, axes, png
        figure.savefig(png, format="png", dpi=DOTS)


def of_run(run: Run) -> bytes:
    """The joint angles over time, and beside them the force on the wall or, where there is none, the tip."""
    with _panels(2) as (_, (left, right), png):
        text = run.summary.get("scenario")
        unit = angle_unit(Scenario(text) if text else None)
        _lines(left, run, "q", f"joint angles, {unit.name}", "123", unit.factor)
        force = run["f_on_wall"] if "f_on_wall" in run else np.zeros(1)
        if force.any():
            right.plot(run.t, np.linalg.norm(force, axis=1), color=ON_WALL)
            right.set(xlabel="t, s", ylabel="force on the wall, N")
        else:
            _lines(right, run, "tip", "tip, m", "xyz")
    return png.getvalue()


def _lines(ax: Any, run: Run, name: str, label: str, parts: str, factor: float = 1.0) -> None:
    if name not in run:  # not logged
        return ax.set_axis_off()
    for values, part, look in zip(run[name].T, parts, TRIPLE, strict=True):
        ax.plot(run.t, factor * values, label=part, **look)
    ax.set(xlabel="t, s", ylabel=label)
    ax.legend(ncols=3, loc="lower left", bbox_to_anchor=(0, 1), borderaxespad=0.1)


def of_scenario(scenario: Scenario) -> bytes:
    """The arm in its initial pose and the wall's plate, from the side and from above."""
    arm, q = scenario.arm, scenario["initial.q"]
    line, joints = arm_line(arm, q)
    points, shown = np.vstack([arm.points(q)[0], line]), [0, *(joint + 1 for joint in joints), -1]
    plate = _plate(scenario) if "wall" in scenario else None
    with _panels(2) as (_, axes, png):
        for ax, across, label in zip(axes, (2, 1), "zy", strict=True):
            if plate is not None:
                ax.fill(plate[:, 0], plate[:, across], fc="#dddddd", ec=WALL)
            ax.plot(points[:, 0], points[:, across], color=ARM, marker="o", ms=3, markevery=shown)
            ax.plot(*points[-1, [0, across]], color=TIP, marker="o", ms=4)
            ax.set(xlabel="x, m", ylabel=f"{label}, m", aspect="equal", adjustable="datalim")
    return png.getvalue()


def _plate(scenario: Scenario) -> Any:
    """The corners of the wall's plate at t = 0: (4, 3), m."""
    frame = wall_frame(scenario, [0.0])
    half1, half2 = half_sides(scenario) or (INFINITE_HALF, INFINITE_HALF)
    signs = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]])
    return scenario["wall.point"] + signs[:, :1] * half1 * frame.e1 + signs[:, 1:] * half2 * frame.e2


def of_batch(batch: Batch[Any], column: str) -> bytes | None:
    """A column over the axes. None: there is not one axis of numbers, or two that cross, to draw it over."""
    axes = [(key, np.asarray(values, float)) for key, values in batch.axes.items() if values.dtype.kind == "f"]
    draw = _drawing(batch, column, axes)
    if draw is None or len(batch) < 2:
        return None
    with _panels(1) as (figure, (ax,), png):
        draw(figure, ax)
    return png.getvalue()


def _drawing(batch: Batch[Any], column: str, axes: list[Any]) -> Callable[[Any, Any], None] | None:
    """How the column is drawn: a line over one axis, or colours over two that cross."""
    label = f"{column}, {batch.units[column]}"

    def line(_: Any, ax: Any) -> None:
        order = np.argsort(axes[0][1])
        ax.plot(axes[0][1][order], batch[column][order], marker="." if len(batch) <= 50 else "")
        ax.set(xlabel=axes[0][0], ylabel=label, xscale=_scale(axes[0][1]))

    def colours(figure: Any, ax: Any) -> None:
        (down, rows), (along, columns) = axes
        mesh = ax.pcolormesh(columns.ravel(), rows.ravel(), batch[column], shading="nearest")
        ax.set(xlabel=along, ylabel=down, xscale=_scale(columns), yscale=_scale(rows))
        ax.grid(False)
        figure.colorbar(mesh, ax=ax, label=label)

    shapes = [values.shape for _, values in axes]
    if len(batch.axes) == 1 and shapes == [batch.shape]:
        return line
    if len(batch.shape) == 2 and min(batch.shape) > 1 and shapes == [(batch.shape[0], 1), (batch.shape[1],)]:
        return colours
    return None


def _scale(values: Any) -> str:
    """Logarithmic where positive values span more than a factor of 30."""
    return "log" if values.min() > 0 and values.max() > 30 * values.min() else "linear"
