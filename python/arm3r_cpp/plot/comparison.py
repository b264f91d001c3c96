"""Several runs that press on one wall, over each other: force, errors, torques, the tip's path, a table of metrics."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..errors import UsageError
from .contact_plane import draw_contact_plane, locate, needs_locating
from .force_figure import heights, since_contact, transient
from .layout import PAD, Named, Panel, Size, chosen, lay_out
from .run_panels import greyed_out
from .style import BLACK, JOINTS, LOOKS, NARROW, REFERENCE, contact_spans, legend_above, plain_ticks, widen_if_flat

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .._native import Floats
    from .force_run import ForceRun
    from .run_figure import RunFigure

MAX_RUNS = len(LOOKS) - 1  # the last look is black: that of references
LINE, LABELS = 0.17, 1.35  # inches: a line of the table, and its first column
MIN_COLUMN, MAX_COLUMN = 0.62, 1.1  # inches: its other columns
LETTER = 0.058  # inches: in its head
MISSING = "–"
FEW = 3  # runs: the table has one part where the figure is as wide as a column
NARROW_WITHOUT = (
    ("torques", "contact"),
    ("torques", "contact", "first_contact", "face"),
)  # to fit a page: few runs, many
MAX_LETTERS, NARROW_LETTERS = 30, 18  # of a name in a legend; in a narrow figure two stand in a row
ROUNDING = 1e-9  # SI units: a smaller number is none
SAME = ("wall.normal", "wall.size", "wall.rotation")  # what runs need to share for one face


class Row(NamedTuple):
    """Of the table: a metric of the summary."""

    metric: str
    label: str
    scale: float = 1.0


ROWS = (
    Row("peak_force", "peak force, N"),
    Row("first_contact_peak", "first contact peak, N"),
    Row("overshoot", "overshoot, N"),
    Row("force_error_rms", "force error rms, N"),
    Row("settling_time", "settling time, s"),
    Row("tip_path_error_rms", "path error rms, mm", 1e3),
    Row("tip_path_error_max", "path error max, mm", 1e3),
    Row("contact_time", "contact, s"),
    Row("contacts", "contacts"),
    Row("saturation_share", "saturated, %", 1e2),
)


def compare_figure(runs: Sequence[ForceRun], names: Sequence[str] | None, size: Size) -> RunFigure:
    """
    Raises:
        UsageError: too few or too many runs, or walls that differ; a name of no panel, or too low a figure.
    """
    check(runs)
    panels = panels_of(runs, size.width)
    left_out = NARROW_WITHOUT[len(runs) > FEW] if size.width < NARROW else ()
    wanted = names or [name for name, found in panels.items() if found and name not in left_out]
    over_time, below, last = chosen(panels, wanted, below=("first_contact", "face"), last=("table",))
    start, end = min(run.run.t[0] for run in runs), max(run.run.t[-1] for run in runs)
    first_wrong = min((run.run for run in runs), key=lambda run: run.trust.horizon if run.trust else np.inf)
    return lay_out(greyed_out(first_wrong, over_time), below, last, size=size, start=start, end=end)


def panels_of(runs: Sequence[ForceRun], width: float) -> Named:
    """All panels by the names that users choose them by; none where no run has the columns."""

    def over_time(draw: Callable[..., None], has: Callable[[ForceRun], bool]) -> list[Panel]:
        return [Panel(0.9, partial(draw, runs))] if any(map(has, runs)) else []

    return {
        "force": [Panel(1.6, partial(draw_force, runs))],
        "force_error": over_time(draw_force_error, lambda run: run.reference is not None),
        "path_error": over_time(draw_path_error, lambda run: bool(run.path_error)),
        "joint_error": over_time(draw_joint_error, lambda run: bool(run.joint_error)),
        "torques": [Panel(0.75, partial(draw_torque, runs, joint)) for joint in JOINTS],
        "contact": [Panel(0.1 * len(runs), partial(draw_contact, runs))],
        "first_contact": transient_panel(runs),
        "face": face_panel(runs),
        "table": tables(runs, width),
    }


def check(runs: Sequence[ForceRun]) -> None:
    if not 2 <= len(runs) <= MAX_RUNS:
        raise UsageError(f"--compare: 2 to {MAX_RUNS} runs fit into one figure, got {len(runs)}", code="usage")
    for run in runs:
        run.check()
    first = runs[0]
    for run in runs[1:]:
        for key in SAME:
            if first.scenario and run.scenario and wall(first, key) != wall(run, key):
                raise UsageError(
                    f"{run.name}: {key} is {wall(run, key)}, that of {first.name} is {wall(first, key)}: paths on one "
                    f"face need one wall; compare runs of the same wall",
                    code="usage",
                )


def wall(run: ForceRun, key: str) -> Any:
    return run.scenario[key] if run.scenario and key in run.scenario else None


def looks(runs: Sequence[ForceRun]) -> Iterable[tuple[ForceRun, dict[str, Any]]]:
    """Thinner ones on top, so that lines that agree are all seen."""
    looks = enumerate(zip(runs, LOOKS, strict=False))
    return [(run, {"color": colour, "ls": dashes, "lw": 2.0 - 0.2 * i}) for i, (run, (colour, dashes)) in looks]


# ---- over time ------------------------------------------------------------------------------------------------------


def draw_force(runs: Sequence[ForceRun], ax: Axes, room: float) -> None:
    draw_forces(runs, ax)
    ax.set_ylabel("pressing force, N")
    legend_above(ax, room=room, handlelength=2.6)


def draw_forces(runs: Sequence[ForceRun], ax: Axes, zeros: Sequence[float] | None = None) -> None:
    """Those of the runs, and the references: one that all share in black.

    zeros: where the time of each run is counted from, s; None: t = 0.
    """
    zeros = zeros or [0.0] * len(runs)
    letters = NARROW_LETTERS if ax.figure.bbox.width < NARROW * ax.figure.dpi else MAX_LETTERS
    pairs = list(zip(runs, zeros, strict=True))
    wanted = [(run.run.t - zero, run.reference) for run, zero in pairs if run.reference is not None]
    shared = len(wanted) > 0 and all(alike(wanted[0], other) for other in wanted[1:])
    for (run, look), zero in zip(looks(runs), zeros, strict=True):
        t, force = run.force_line
        ax.plot(t - zero, force, label=shortened(run.name, letters), **look)
        if run.reference is not None and not shared:
            ax.plot(run.run.t - zero, run.reference, color=look["color"], ls=(0, (1, 2)), lw=1.0)
    if shared:
        longest = max(wanted, key=lambda line: line[0][-1])
        ax.plot(*longest, color=REFERENCE, ls="--", lw=1.0, zorder=2.6, label="reference")
    elif wanted:
        ax.plot([], [], color=REFERENCE, ls=(0, (1, 2)), lw=1.0, label="references")


def alike(one: tuple[Floats, Floats], other: tuple[Floats, Floats]) -> bool:
    """Whether two lines are one where both have values."""
    start, end = max(one[0][0], other[0][0]), min(one[0][-1], other[0][-1])
    t = one[0][(one[0] >= start) & (one[0] <= end)]
    return bool(np.allclose(np.interp(t, *one), np.interp(t, *other), rtol=1e-6, atol=1e-6))


def draw_force_error(runs: Sequence[ForceRun], ax: Axes, _: float) -> None:
    overlay(ax, runs, lambda run: run.error, "force error,\nN")


def draw_path_error(runs: Sequence[ForceRun], ax: Axes, _: float) -> None:
    """As the table's numbers have it: of all three directions, without the normal one while force is controlled."""
    overlay(ax, runs, lambda run: size(run.path_error, 1e3), "path error,\nmm")


def draw_joint_error(runs: Sequence[ForceRun], ax: Axes, _: float) -> None:
    unit = runs[0].angle
    overlay(ax, runs, lambda run: size(run.joint_error, unit.small_factor), f"joint error,\n{unit.small_name}")


def draw_torque(runs: Sequence[ForceRun], joint: str, ax: Axes, _: float) -> None:
    overlay(ax, runs, lambda run: run.run[f"tau{joint}"], rf"$\tau_{joint}$, N m")


def overlay(ax: Axes, runs: Sequence[ForceRun], values: Callable[[ForceRun], Floats | None], quantity: str) -> None:
    for run, look in looks(runs):
        if (line := values(run)) is not None:
            ax.plot(run.run.t, line, **look)
    widen_if_flat(ax)
    plain_ticks(ax)
    ax.set_ylabel(quantity)


def size(error: Mapping[str, Floats], factor: float) -> Floats | None:
    """Of an error of several parts, times a factor of its unit."""
    return factor * np.linalg.norm(list(error.values()), axis=0) if error else None


def draw_contact(runs: Sequence[ForceRun], ax: Axes, _: float) -> None:
    """A bar a run, the first one on top."""
    for i, (run, look) in enumerate(looks(runs)):
        ax.broken_barh(
            [(start, end - start) for start, end in contact_spans(run.run)], (-i - 0.4, 0.8), fc=look["color"]
        )
    ax.set_ylim(0.5 - len(runs), 0.5)
    ax.set_yticks([(1 - len(runs)) / 2], ["contact"], fontsize=8)
    ax.tick_params(axis="y", length=0)


# ---- below ----------------------------------------------------------------------------------------------------------


def transient_panel(runs: Sequence[ForceRun]) -> list[Panel]:
    """Each run is counted from its own first contact."""
    windows = [np.array(window) - begin_of_contact(run) for run in runs if (window := transient(run))]
    if not windows:
        return []
    window = min(start for start, _ in windows), max(end for _, end in windows)
    return [Panel(1.9, partial(draw_transient, runs, window))]


def begin_of_contact(run: ForceRun) -> float:
    """When the first contact begins, s; 0: there is none."""
    spans = contact_spans(run.run)
    return spans[0][0] if spans else 0.0


def draw_transient(runs: Sequence[ForceRun], window: tuple[float, float], ax: Axes, _: float) -> None:
    """window: time since the first contact, s."""
    zeros = [begin_of_contact(run) for run in runs]
    draw_forces(runs, ax, zeros)
    for (run, look), zero in zip(looks(runs), zeros, strict=True):
        peak = run.first_peak or run.peak
        if peak and window[0] <= peak.t - zero <= window[1]:
            ax.plot(peak.t - zero, peak.force, color=look["color"], ls="", marker=7, ms=6, clip_on=False, zorder=5)
    since_contact(ax, window)
    own = [(run, (window[0] + zero, window[1] + zero)) for run, zero in zip(runs, zeros, strict=True)]
    ax.set(ylabel="pressing force, N", ylim=heights(own))


def face_panel(runs: Sequence[ForceRun]) -> list[Panel]:
    lines = [(run, look, run.name) for run, look in looks(runs) if run.on_contact_plane("tip") is not None]
    drawn = [run for run, _, _ in lines]
    if not lines:
        return []
    beside = partial(locate, drawn) if needs_locating(drawn) else None
    return [Panel(1.9, partial(draw_contact_plane, lines, legend=False), beside=beside)]


# ---- table ----------------------------------------------------------------------------------------------------------


def tables(runs: Sequence[ForceRun], width: float) -> list[Panel]:
    """A column a run, a row a metric that some run has; one table under the other where the width needs it."""
    rows = [row for row in ROWS if any(cell(run, row) != MISSING for run in runs)]
    fitting = max(1, int((width - LABELS) / MIN_COLUMN))
    columns = list(looks(runs))
    parts = [columns[i : i + fitting] for i in range(0, len(columns), fitting)]
    height = LINE * (len(rows) + 3)
    return [Panel(height, partial(draw_table, part, rows, width), is_table=True) for part in parts]


def draw_table(columns: Sequence[Any], rows: Sequence[Row], width: float, ax: Axes, _: float) -> None:
    """width: inches, of the figure. Units of the axes: inches, and lines of the table."""
    each = min((width - LABELS - 0.1) / len(columns), MAX_COLUMN)
    ax.axis("off")
    ax.set(xlim=(0, width - PAD), ylim=(len(rows) + 0.5, -2.5))
    ax.plot([0, LABELS + each * len(columns)], [0, 0], color=BLACK, lw=0.8)
    for i, row in enumerate(rows):
        ax.text(0, i + 0.6, row.label, va="center", fontsize=8)
    for k, (run, look) in enumerate(columns):
        right = LABELS + each * (k + 1)
        ax.plot([right - 0.35, right], [-0.4, -0.4], **{**look, "lw": 1.8})
        ax.text(right, -0.75, head(run.name, int((each - 0.1) / LETTER)), ha="right", va="bottom", fontsize=7)
        for i, row in enumerate(rows):
            ax.text(right, i + 0.6, cell(run, row), ha="right", va="center", fontsize=8)


def head(name: str, most: int) -> str:
    """A name in up to two lines of so many letters, broken after a sign where it has one."""
    breaks = [i for i in range(1, min(most, len(name) - 1) + 1) if name[i - 1] in "_-. "] or [most]
    lines = [name] if len(name) <= most else [name[: breaks[-1]], name[breaks[-1] :]]
    return "\n".join(shortened(line, most) for line in lines)


def shortened(text: str, most: int) -> str:
    """Without its middle, if it has more letters."""
    return text if len(text) <= most else f"{text[: most // 2]}…{text[len(text) + 1 - (most + 1) // 2 :]}"


def cell(run: ForceRun, row: Row) -> str:
    value = run.metric(row.metric)
    if value is None:
        return "never" if run.settling and row.metric == "settling_time" else MISSING
    value = row.scale * value if abs(value) > ROUNDING else 0
    is_count = row.metric == "contacts"
    return f"{value:#.3g}".rstrip(".") if 1e-3 <= abs(value) < 1e3 and not is_count else f"{value:.3g}"
