"""The tip's path on the wall's face, in metres or millimetres from the plate's centre."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .style import BLACK, REFERENCE, TIP, WALL, legend_above

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .._native import Floats
    from .force_run import ForceRun

OFF = "#999999"
WHOLE_PLATE = 0.3  # of the plate's longer side: a path of that size is drawn on the whole of it
MIN_EXTENT = 1e-3  # m: a path is not magnified further
MILLIMETRES = 0.05  # m: below this size

Line = tuple["ForceRun", dict[str, Any], str]


def draw_contact_plane(lines: Sequence[Line], ax: Axes, room: float, *, legend: bool = True) -> None:
    """Runs, each with the look and the name of its line. They share one face; out of contact it is thin and grey."""
    runs = [run for run, _, _ in lines]
    middle, size = view(runs)
    scale, unit = (1e3, "mm") if size < MILLIMETRES else (1.0, "m")
    for run, look, label in lines:
        tip = tip_on_plane(run)
        touching = np.where(run.run["contact"][:, None] > 0, tip, np.nan)
        ax.plot(*(scale * tip.T), color=OFF, lw=0.7, zorder=1.5)
        ax.plot(*(scale * touching.T), label=label, zorder=2, **look)
        draw_reference(ax, run, scale)
    if runs[0].half_sides and not needs_locating(runs):
        outline(ax, runs[0].half_sides, scale)
    limits = scale * (middle[:, None] + 0.6 * size * np.array([-1, 1]))
    ax.set(xlim=limits[0], ylim=limits[1], xlabel=f"along $e_1$, {unit}", ylabel=f"along $e_2$, {unit}")
    ax.set_aspect("equal")
    ax.locator_params(axis="x", nbins=4, steps=[1, 2, 5, 10])
    ax.locator_params(axis="y", nbins=6, steps=[1, 2, 5, 10])
    if legend:
        legend_above(ax, room=room)


def view(runs: Sequence[ForceRun]) -> tuple[Floats, float]:
    """Middle (2,) and size of what is in sight, m: the whole plate, unless the paths are small on it."""
    middle, size = extent(runs)
    half = runs[0].half_sides
    return (middle, max(size, MIN_EXTENT)) if half is None or needs_locating(runs) else (np.zeros(2), 1.9 * max(half))


def needs_locating(runs: Sequence[ForceRun]) -> bool:
    """Whether the paths are so small that the plate around them is out of sight."""
    half = runs[0].half_sides
    return half is not None and extent(runs)[1] < WHOLE_PLATE * 2 * max(half)


def extent(runs: Sequence[ForceRun]) -> tuple[Floats, float]:
    """Middle (2,) and size of what encloses all paths."""
    points = np.concatenate([in_sight(run) for run in runs])
    low, high = points.min(axis=0), points.max(axis=0)
    return (low + high) / 2, float((high - low).max())


def tip_on_plane(run: ForceRun) -> Floats:
    tip = run.on_contact_plane("tip")
    assert tip is not None
    return tip


def in_sight(run: ForceRun) -> Floats:
    """Points that the panel has to show: tip and reference in contact; without any contact, the whole path."""
    tip, reference, on = tip_on_plane(run), run.on_contact_plane("tip_ref"), run.run["contact"] > 0
    return np.concatenate([path[on] for path in (tip, reference) if path is not None]) if on.any() else tip


def draw_reference(ax: Axes, run: ForceRun, scale: float) -> None:
    reference = run.on_contact_plane("tip_ref")
    if reference is None:
        return
    label = "reference" if "reference" not in ax.get_legend_handles_labels()[1] else None
    still = np.ptp(reference, axis=0).max() < MIN_EXTENT
    look: dict[str, Any] = {"marker": "+", "ms": 9, "mew": 1.4, "ls": ""} if still else {"ls": "--", "lw": 1.0}
    ax.plot(*(scale * (reference[-1:] if still else reference).T), color=REFERENCE, zorder=3, label=label, **look)


def outline(ax: Any, half: tuple[float, float], scale: float) -> None:
    from matplotlib.patches import Rectangle

    corner, sides = (-scale * half[0], -scale * half[1]), (2 * scale * half[0], 2 * scale * half[1])
    ax.add_patch(Rectangle(corner, *sides, fc=WALL, ec=BLACK, lw=0.9, alpha=0.12, zorder=0.5))
    ax.add_patch(Rectangle(corner, *sides, fc="none", ec=BLACK, lw=0.9, zorder=1, label="plate"))


def locate(runs: Sequence[ForceRun], ax: Axes) -> None:
    """The whole plate, and where on it the panel beside is."""
    half, (middle, _) = runs[0].half_sides, extent(runs)
    assert half is not None
    outline(ax, half, 1.0)
    ax.plot(*middle, color=TIP, marker="s", ms=4, ls="")
    ax.set(xlim=(-1.12 * half[0], 1.12 * half[0]), ylim=(-1.12 * half[1], 1.12 * half[1]))
    ax.set_aspect("equal", anchor="N")
    ax.axis("off")
    ax.set_title(f"plate\n{2 * half[0]:g} × {2 * half[1]:g} m", fontsize=8)
