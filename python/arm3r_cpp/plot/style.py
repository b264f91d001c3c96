"""How every figure looks: one palette, axes with units, legends outside the data, contact shaded, events marked."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..run import Run

BLACK, BLUE, RED, GREEN, AMBER, SKY, PINK = "#222222", "#0072B2", "#D55E00", "#009E73", "#E69F00", "#56B4E9", "#CC79A7"
TRIPLE: tuple[dict[str, Any], ...] = (
    {"color": BLUE, "ls": "-"},
    {"color": RED, "ls": "--"},
    {"color": GREEN, "ls": "-."},
)
LOOKS = tuple(zip((BLUE, RED, GREEN, AMBER, SKY, PINK, BLACK), ("-", "--", "-.", ":", "-", "--", "-."), strict=True))
GREY = "#e4e4e4"
XYZ, JOINTS = "xyz", "123"
DASHES = {"make": ":", "break": (0, (4, 2))}
EVENT_WORDS = {"make": "contact begins", "break": "contact ends"}
MARKED_EVENTS = 4  # where there are more, the shade shows when there is contact
HIDDEN = "_contact"  # a label that no legend shows
FORMATS = ("png", "pdf", "svg")
WIDTH = 6.3  # inches: that of a text; columns of a journal have some 3.4
MARGIN = 0.6  # inches of a figure's width: labels beside its axes

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
    "legend.columnspacing": 0.9,
    "legend.handlelength": 1.7,
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
        ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}".replace("-", "−")))


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
        look: Any = {"color": AMBER, "alpha": 0.15, "lw": 0, "zorder": 0, "label": label or HIDDEN}
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
        for event in run.events:
            label = f"{EVENT_WORDS[event.type]} at {event.t:.4f} s" if labelled else HIDDEN
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
    """All labelled artists above the axes, in as many rows as a width of `room` inches needs."""
    handles, labels = ax.get_legend_handles_labels()
    look = {"loc": "lower left", "bbox_to_anchor": (0, 1), "borderaxespad": 0.1, **look}
    for columns in range(len(handles), 0, -1):
        legend = ax.legend(handles, labels, ncols=columns, **look)
        if legend.get_window_extent().width <= room * ax.figure.dpi:
            return
