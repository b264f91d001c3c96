"""How every figure looks: one palette, axes with units, legends outside the data, contact shaded, events marked.

The colours and what they mean are those of films and of the live page (web/page/src/app/colours.js), too.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from math import pi
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..core.run import Run
    from ..core.scenario import Scenario

BLACK, BLUE, RED, GREEN, AMBER, SKY, PINK = "#222222", "#0072B2", "#D55E00", "#009E73", "#E69F00", "#56B4E9", "#CC79A7"
ARM, TIP, WALL = "#8A94A3", BLUE, AMBER
ON_WALL, ON_TIP = RED, PINK  # forces; the pressing force is the normal part of that on the wall
REFERENCE, MEASURED, ESTIMATED = BLACK, SKY, BLUE
TRIPLE: tuple[dict[str, Any], ...] = (
    {"color": BLUE, "ls": "-"},
    {"color": RED, "ls": "--"},
    {"color": GREEN, "ls": "-."},
)
LOOKS = tuple(zip((BLUE, RED, GREEN, AMBER, SKY, PINK, BLACK), ("-", "--", "-.", ":", "-", "--", "-."), strict=True))
GREY = "#e4e4e4"
XYZ, JOINTS = "xyz", "123"
TENTH, NEARLY = 0.1, 1e-9  # degrees: an angle that was given in degrees is a multiple of the first within the second
DASHES = {"make": ":", "break": (0, (4, 2))}
EVENT_WORDS = {"make": "begins", "break": "ends"}
MARKED_EVENTS = 4  # where there are more, the shade shows when there is contact
HIDDEN = "_contact"  # a label that no legend shows
FORMATS = ("png", "pdf", "svg")
WIDTH = 6.3  # inches: that of a text; columns of a journal have some 3.4
NARROW = 5.0  # inches: narrower figures have one panel a row, and smaller letters in their legends
SMALL = 7  # points: the smallest letters that journals take
MARGIN = 0.6  # inches of a figure's width: labels beside its axes
POINTS = 72  # in an inch

RC: Any = {
    "font.size": 9,
    "axes.labelsize": 9,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.formatter.useoffset": False,
    "axes.formatter.limits": (-4, 5),
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "legend.borderpad": 0.2,
    "legend.columnspacing": 0.9,
    "legend.handlelength": 1.7,
    "legend.labelspacing": 0.2,
    "lines.linewidth": 1.4,
    "agg.path.chunksize": 20000,
    "savefig.dpi": 200,
    "pdf.fonttype": 42,
    "ps.fonttype": 42,
    "svg.hashsalt": "arm3r",
}


@contextmanager
def style() -> Iterator[None]:
    import matplotlib

    with matplotlib.rc_context(RC):
        yield


def finish(ax: Axes, run: Run, quantity: str, room: float, *, legend: bool = True) -> None:
    """Label with quantity and unit, shade contact, mark events, and put the legend above the axes.

    room: what the legend may be wide, inches.
    """
    ax.set_ylabel(quantity)
    if ax.get_yscale() == "linear":
        widen_if_flat(ax)
        plain_ticks(ax)
    shade_contact(ax, run)
    mark_events(ax, run)
    if legend and ax.get_legend_handles_labels()[0]:
        legend_above(ax, room=room)


def widen_if_flat(ax: Axes) -> None:
    """Keep rounding noise on a constant line from filling the panel."""
    low, high = ax.get_ylim()
    if high - low < 1e-6 * max(1, abs(low)):
        ax.set_ylim((low + high) / 2 - 1, (low + high) / 2 + 1)


def plain_ticks(ax: Axes) -> None:
    """Write very small and very large numbers in full: a common power of ten would stand in the legend."""
    from matplotlib.ticker import FuncFormatter

    largest = max(map(abs, ax.get_ylim()))
    if not 1e-3 < largest < 1e5:
        ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: in_full(value)))


def in_full(value: float) -> str:
    """A number for a tick; of a very small or very large one, with its power of ten."""
    digits, _, power = f"{value:g}".replace("-", "−", 1 if value < 0 else 0).partition("e")
    return rf"{digits}$\cdot$10$^{{{int(power)}}}$" if power else digits


def contact_spans(run: Run) -> list[tuple[float, float]]:
    """Intervals of contact, s, from the events; one that began before the first row begins with it, and an open one
    ends with the run."""
    times = [*((e.type, e.t) for e in run.events), ("break", float(run.t[-1]))]
    if times[0][0] == "break" and "contact" in run and run["contact"][0] > 0:
        times.insert(0, ("make", float(run.t[0])))
    return [(start, end) for (kind, start), (_, end) in pairwise(times) if kind == "make"]


def shade_contact(ax: Axes, run: Run, *, label: str | None = None) -> None:
    """As one artist, however often contact is made."""
    if spans := contact_spans(run):
        bars = [(start, end - start) for start, end in spans]
        look: Any = {"color": WALL, "alpha": 0.15, "lw": 0, "zorder": 0, "label": label or HIDDEN}
        ax.broken_barh(bars, (0, 1), transform=ax.get_xaxis_transform(), **look)


def grey_out(ax: Axes, run: Run, *, room: float | None = None) -> None:
    """Cover what lies beyond the time up to which a run can be trusted; `room`: the legend is to say so, and its width.

    A run that does not know this time, or is right to its end, stays as it is.
    """
    start, end = float(run.t[0]), float(run.t[-1])
    if not run.trust or run.trust.to_the_end or run.trust.horizon >= end:
        return
    look: Any = {"facecolor": GREY, "edgecolor": "none", "alpha": 0.8, "zorder": 4}
    label = f"angles off by more than {run.trust.error:g} rad"
    ax.axvspan(max(run.trust.horizon, start), end, label=HIDDEN if room is None else label, **look)
    if room is not None:
        legend_above(ax, room=room)


def mark_events(ax: Axes, run: Run, *, labelled: bool = False) -> None:
    """A line where contact begins or ends, unless there are too many; `labelled`: the legend is to say when."""
    if len(run.events) <= MARKED_EVENTS:
        for k, event in enumerate(run.events):
            what = "contact " if event.type == "make" or k == 0 else ""
            label = f"{what}{EVENT_WORDS[event.type]} at {event.t:.4f} s" if labelled else HIDDEN
            ax.axvline(event.t, color=BLACK, lw=0.8, ls=DASHES[event.type], zorder=1, label=label)


def explain_contact(ax: Axes, run: Run, *, room: float) -> None:
    """Let the legend of axes say when contact begins and ends; where that is too often, how often."""
    spans = contact_spans(run)
    if not spans:
        return
    if not 0 < len(run.events) <= MARKED_EVENTS:
        often = f", {len(spans)} times" if run.events else ""
        next(part for part in ax.collections if part.get_label() == HIDDEN).set_label(f"contact{often}")
    mark_events(ax, run, labelled=True)
    legend_above(ax, room=room)


def legend_above(ax: Axes, *, room: float, **look: Any) -> None:
    """All labelled artists above the axes, in rows that a width of `room` inches holds, one entry after the other."""
    handles, labels = ax.get_legend_handles_labels()
    look = {"loc": "lower left", "bbox_to_anchor": (0, 1), "borderaxespad": 0.1, **look}
    if ax.figure.bbox.width < NARROW * ax.figure.dpi:
        look["fontsize"] = SMALL
    legend = ax.legend(handles, labels, ncols=len(handles), **look)
    break_into_rows(legend, room * ax.figure.dpi)


def break_into_rows(legend: Any, room: float) -> None:
    """Matplotlib has columns, each as wide as its widest entry; in rows as full as they get, a legend is lower.

    room: pixels. An entry without a line or a marker takes the place of its words only.
    """
    from matplotlib.offsetbox import HPacker, VPacker

    renderer, letter = legend.figure.canvas.get_renderer(), legend.prop.get_size()
    entries = [entry for column in legend._legend_handle_box.get_children() for entry in column.get_children()]
    signs = [is_seen(handle) for handle in legend.legend_handles]
    entries = [entry if sign else entry.get_children()[1] for entry, sign in zip(entries, signs, strict=True)]
    gap = legend.columnspacing * letter
    pixels = gap * legend.figure.dpi / POINTS
    rows: list[list[Any]] = []
    left = 0.0
    for entry in entries:
        width = entry.get_window_extent(renderer).width + pixels
        if not rows or width - pixels > left:
            rows.append([])
            left = room
        rows[-1].append(entry)
        left -= width
    lines: list[Any] = [HPacker(pad=0, sep=gap, align="baseline", children=row) for row in rows]
    packed = VPacker(pad=0, sep=legend.labelspacing * letter, align="left", children=lines)
    packed.set_figure(legend.figure)
    legend._legend_box._children[-1] = legend._legend_handle_box = packed


def is_seen(handle: Any) -> bool:
    """Whether an artist of a legend draws a line, a marker or an area."""
    from matplotlib.lines import Line2D

    return not isinstance(handle, Line2D) or handle.get_linestyle() != "None" or handle.get_marker() != "None"


# ---- angles ---------------------------------------------------------------------------------------------------------


class Unit(NamedTuple):
    """In which a quantity is drawn: its values in SI units times a factor; and that of small values."""

    name: str
    factor: float
    small_name: str
    small_factor: float


RADIANS = Unit("rad", 1.0, "mrad", 1e3)
DEGREES = Unit("deg", 180 / pi, "deg", 180 / pi)


def angle_unit(scenario: Scenario | None, degrees: bool | None = None) -> Unit:
    """Of a figure; `degrees` None: degrees where the scenario gives an angle of its start or its reference in them.

    A run keeps its scenario in radians: a multiple of a tenth of a degree was given in degrees.
    """
    if degrees is None:
        degrees = scenario is not None and speaks_degrees(scenario)
    return DEGREES if degrees else RADIANS


def speaks_degrees(scenario: Scenario) -> bool:
    given = [scenario[key] for key in ("initial.q", "reference.q") if key in scenario]
    angles = [DEGREES.factor * angle for three in given if three is not None for angle in three]
    return any(angle and abs(angle - TENTH * round(angle / TENTH)) < NEARLY for angle in angles)
