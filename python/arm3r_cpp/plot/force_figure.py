"""Panels of a run under control: force, tracking, torques, observer, and the tip's path on the wall's face."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from .contact_plane import draw_contact_plane, extent, locate, needs_locating
from .force_run import SETTLED, ForceRun, Peak
from .layout import Panel
from .style import (
    BLACK,
    BLUE,
    ESTIMATED,
    GREEN,
    JOINTS,
    MEASURED,
    ON_WALL,
    RED,
    REFERENCE,
    TIP,
    TRIPLE,
    contact_spans,
    finish,
    legend_above,
    plain_ticks,
    shade_contact,
    widen_if_flat,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TRANSIENT = 0.3  # of the run: a first contact that settles in less gets a panel of its own
FEW_ROWS = 60  # in that panel: they are marked
LIMITS_IN_SIGHT = 3.0  # times the largest torque: limits beyond stand in the legend and are not drawn
LEAST_PATH = 1e-4  # m: a path on the face that is shorter looks like a point
LEAST_ERROR = 1e-9  # m: a smaller one is rounding
FULL: dict[str, Any] = {"color": BLACK}
HOLLOW: dict[str, Any] = {"color": BLACK, "mfc": "white"}


# ---- force ----------------------------------------------------------------------------------------------------------


def draw_force(run: ForceRun, ax: Axes, room: float) -> None:
    draw_forces(ax, run)
    shade_contact(ax, run.run, label="contact")
    strip(ax, run, "force_phase", GREEN, "force controlled")
    mark_settling(ax, run)
    mark_peaks(ax, run)
    ax.set_ylabel("pressing force, N")
    widen_if_flat(ax)
    plain_ticks(ax)
    legend_above(ax, room=room)


def draw_forces(ax: Axes, run: ForceRun, **look: Any) -> None:
    t, measured = run.run.t, run.column("force_measured")
    differs = measured is not None and np.abs(measured - run.force).max() > 1e-6 * np.abs(run.force).max()
    if run.reference is not None:
        ax.plot(t, run.reference, color=REFERENCE, ls="--", lw=1.1, zorder=2.6, label="reference")
    ax.plot(*run.force_line, color=ON_WALL, zorder=2.5, label="true" if differs else "force")
    if look and look["marker"]:
        ax.plot(t, run.force, color=ON_WALL, ls="", zorder=2.5, **look)
    if measured is not None and differs:
        ax.plot(t, measured, color=MEASURED, lw=0.8, label="measured")
    if run.estimate is not None:
        ax.plot(t, run.estimate, color=ESTIMATED, ls="-.", lw=1.1, label="estimated")


def mark_peaks(ax: Axes, run: ForceRun, window: tuple[float, float] = (-math.inf, math.inf)) -> None:
    """The largest force, and that of the first contact where it is another, if they lie in a window of time."""
    largest, first = run.peak, run.first_peak
    marks: list[tuple[Peak | None, str, dict[str, Any]]]
    if largest and first and largest.t == first.t:
        marks = [(largest, "peak {} (first contact)", FULL)]
    else:
        marks = [(largest, "peak {}", FULL), (first, "first contact's peak {}", HOLLOW)]
    for peak, text, look in marks:
        if peak and window[0] <= peak.t <= window[1]:
            mark_peak(ax, run, peak, text, look)


def mark_peak(ax: Axes, run: ForceRun, peak: Peak, text: str, look: dict[str, Any]) -> None:
    """Where rows do not show it, a dotted line leads up to it."""
    label = text.format(f"{peak.force:.4g} N, t {'=' if peak.exact or peak.seen else '≈'} {peak.t:.4f} s")
    if not peak.seen:
        ax.vlines(peak.t, np.interp(peak.t, *run.force_line), peak.force, color=BLACK, ls=":", lw=1.0)
    ax.plot(peak.t, peak.force, ls="", marker=7, ms=7, clip_on=False, zorder=5, label=label, **look)


def mark_settling(ax: Axes, run: ForceRun) -> None:
    settling = run.settling
    if settling is None or run.reference is None:
        return
    if settling.duration == 0:
        ax.plot([], [], ls="", label=f"always within ±{100 * SETTLED:g} %")
        return
    label = f"±{100 * SETTLED:g} %, never settles"
    if settling.duration is not None:
        label = f"±{100 * SETTLED:g} %, settles in {settling.duration:.3g} s"
        ax.axvline(settling.start + settling.duration, color=GREEN, ls=(0, (4, 2)), lw=1.1, zorder=2)
    low, high = (1 - SETTLED) * run.reference, (1 + SETTLED) * run.reference
    here = (run.run["contact"] > 0).tolist()
    ax.fill_between(run.run.t, low, high, where=here, color=GREEN, alpha=0.3, lw=0, zorder=1, label=label)


def transient(run: ForceRun) -> tuple[float, float] | None:
    """When the first contact is shown by itself, s; None: the whole run shows it well."""
    spans = contact_spans(run.run)
    if not spans:
        return None
    start, end = spans[0]
    settling, peak = run.settling, run.peak
    if settling and settling.duration == 0:
        return None
    if settling and settling.duration:
        length = 1.5 * settling.duration
    elif peak and peak.t > start:
        length = min(5 * (peak.t - start), 1.5 * (end - start))
    else:
        return None
    length = min(length, run.run.t[-1] - start)
    if length >= TRANSIENT * (run.run.t[-1] - run.run.t[0]):
        return None
    return max(start - 0.15 * length, float(run.run.t[0])), start + length


def draw_transient(run: ForceRun, ax: Axes, room: float, *, legend: bool = False) -> None:
    window = transient(run)
    assert window is not None
    shown = (run.run.t >= window[0]) & (run.run.t <= window[1])
    draw_forces(ax, run, marker="." if shown.sum() < FEW_ROWS else "", ms=4)
    mark_settling(ax, run)
    mark_peaks(ax, run, window)
    shade_contact(ax, run.run)
    since_contact(ax, window, contact_spans(run.run)[0][0])
    ax.set(ylabel="force, N" if legend else "pressing force, N", ylim=heights([(run, window)]))
    if legend:
        legend_above(ax, room=room)


def since_contact(ax: Axes, window: tuple[float, float], start: float = 0.0) -> None:
    """The time axis counted from the first contact, which is at `start`."""
    from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator

    scale, unit = (1e3, "ms") if window[1] - window[0] < 1 else (1.0, "s")
    ticks = MaxNLocator(5, steps=[1, 2, 5, 10]).tick_values(*(scale * (t - start) for t in window))
    ax.set(xlim=window, xlabel=f"time since the first contact, {unit}")
    ax.xaxis.set_major_locator(FixedLocator([start + tick / scale for tick in ticks]))
    ax.xaxis.set_major_formatter(FuncFormatter(lambda t, _: f"{round(scale * (t - start), 6) + 0.0:g}"))


def heights(windows: Sequence[tuple[ForceRun, tuple[float, float]]]) -> tuple[float, float]:
    """From below to above all forces of runs, each in a window of its time."""
    values: list[float] = []
    for run, window in windows:
        t, force = run.force_line
        values += force[(t >= window[0]) & (t <= window[1])].tolist()
        shown = (run.run.t >= window[0]) & (run.run.t <= window[1])
        for line in (run.reference, run.column("force_measured")):
            values += [] if line is None else line[shown].tolist()
        if run.peak and window[0] <= run.peak.t <= window[1]:
            values.append(run.peak.force)
    margin = 0.06 * (max(values) - min(values)) or 1.0
    return min(values) - margin, max(values) + margin


# ---- the other panels -----------------------------------------------------------------------------------------------


def draw_path_error(run: ForceRun, ax: Axes, room: float) -> None:
    for (axis, error), look in zip(run.path_error.items(), TRIPLE, strict=False):
        ax.plot(run.run.t, 1e3 * error, label=f"along ${axis}$", **look)
    largest = run.metric("tip_path_error_max")
    if largest is not None:
        ax.plot([], [], ls="", label=f"largest {1e3 * largest if largest > LEAST_ERROR else 0:.4g} mm")
    finish(ax, run.run, "path error, mm", room)


def draw_joint_error(run: ForceRun, ax: Axes, room: float) -> None:
    for (joint, error), look in zip(run.joint_error.items(), TRIPLE, strict=True):
        ax.plot(run.run.t, run.angle.small_factor * error, label=f"${joint}$", **look)
    finish(ax, run.run, f"joint error, {run.angle.small_name}", room)


def draw_torques(run: ForceRun, ax: Axes, room: float) -> None:
    for i, look in zip(JOINTS, TRIPLE, strict=True):
        ax.plot(run.run.t, run.run[f"tau{i}"], label=rf"$\tau_{i}$", **look)
    draw_bounds(ax, run.torque_limit, "limit", largest=float(np.abs(run.run["tau"]).max()))
    strip(ax, run, "saturated", RED, "at a limit")
    finish(ax, run.run, "torque, N m", room)


def draw_residuals(run: ForceRun, ax: Axes, room: float) -> None:
    for i, look in zip(JOINTS, TRIPLE, strict=True):
        ax.plot(run.run.t, run.run[f"residual{i}"], label=f"$r_{i}$", **look)
    if run.threshold:
        draw_bounds(ax, run.threshold, "threshold", largest=float(np.abs(run.run["residual"]).max()))
    strip(ax, run, "collision", RED, "collision")
    finish(ax, run.run, "residual, N m", room)


def draw_bounds(ax: Axes, bounds: Sequence[float], what: str, *, largest: float) -> None:
    """Lines at plus and minus each joint's bound, in its colour; one for all in black. The legend names those too far
    away to be drawn."""
    if all(math.isinf(bound) for bound in bounds):
        return
    alike = len(set(bounds)) == 1
    numbers = f"±{bounds[0]:.4g}" if alike else ", ".join("none" if math.isinf(b) else f"±{b:.4g}" for b in bounds)
    drawn = [bound <= LIMITS_IN_SIGHT * largest for bound in bounds]
    for i, bound in enumerate(bounds):
        if drawn[i]:
            for level in (bound, -bound):
                ax.axhline(level, color=BLACK if alike else TRIPLE[i]["color"], ls=(0, (1, 1.5)), lw=1.2)
    look: Any = {"color": BLACK, "ls": (0, (1, 1.5)), "lw": 1.2} if any(drawn) else {"ls": ""}
    ax.plot([], [], label=f"{what} {numbers}" + ("" if any(drawn) else ", far outside"), **look)


def draw_stiffness(run: ForceRun, ax: Axes, room: float) -> None:
    """Where it is identifiable."""
    estimate = run.run["stiffness_estimate"]
    known = run.column("identifiable")
    if known is not None:
        estimate = np.where(known > 0, estimate, np.nan)
    has_estimate = not np.all(np.isnan(estimate))
    ax.plot(run.run.t, estimate, color=BLUE, label="estimated" if has_estimate else "never identifiable")
    if run.scenario and "wall.contact.stiffness" in run.scenario:
        ax.axhline(run.scenario["wall.contact.stiffness"], color=BLACK, ls="--", lw=1.1, label="the wall's")
    finish(ax, run.run, "stiffness, N/m", room)


def draw_tank(run: ForceRun, ax: Axes, room: float) -> None:
    ax.plot(run.run.t, run.run["tank_energy"], color=BLUE, label="in the tank")
    ax.set_ylim(bottom=min(0.0, ax.get_ylim()[0]))
    finish(ax, run.run, "energy, J", room)


def strip(ax: Axes, run: ForceRun, flag: str, colour: str, label: str) -> None:
    """A band along the panel's foot where a flag is 1."""
    on = run.column(flag)
    if on is not None and np.any(on > 0):
        ax.fill_between(
            run.run.t, 0, 0.035, where=(on > 0).tolist(), step="post", transform=ax.get_xaxis_transform(),
            color=colour, lw=0, zorder=3, label=label,
        )  # fmt: skip


def face_panel(run: ForceRun) -> list[Panel]:
    """The tip's path; none where the plane is not known."""
    if run.on_contact_plane("tip") is None:
        return []
    runs = [(run, {"color": TIP, "ls": "-"}, "tip in contact")]
    beside: Callable[[Any], None] | None = partial(locate, [run]) if needs_locating([run]) else None
    return [Panel(1.9, partial(draw_contact_plane, runs), beside=beside)]


def face_shows_something(run: ForceRun) -> bool:
    """Whether the tip moves on the face, so that its path is more than a point."""
    return extent([run])[1] >= LEAST_PATH
