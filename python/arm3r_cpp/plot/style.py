"""How every figure looks: one palette, axes with units, legends outside the data, contact shaded, events marked."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import pairwise
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..run import Run

BLACK, BLUE, RED, GREEN, AMBER, SKY, PINK = "#222222", "#0072B2", "#D55E00", "#009E73", "#E69F00", "#56B4E9", "#CC79A7"
TRIPLE: tuple[dict[str, Any], ...] = (
    {"color": BLUE, "ls": "-"},
    {"color": RED, "ls": "--"},
    {"color": GREEN, "ls": "-."},
)
LOOKS = tuple(zip((BLUE, RED, GREEN, AMBER, SKY, PINK, BLACK), ("-", "--", "-.", ":", "-", "--", "-."), strict=True))
XYZ, JOINTS = "xyz", "123"
DASHES = {"make": ":", "break": (0, (4, 2))}
LABELLED_EVENTS = 4
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
    "svg.hashsalt": "arm3r",
}


@contextmanager
def style() -> Iterator[None]:
    import matplotlib

    with matplotlib.rc_context(RC):
        yield


def panels(run: Run, heights: Sequence[float]) -> tuple[Figure, list[Axes]]:
    """Panels over one time axis, of the given heights in inches."""
    import matplotlib.pyplot as plt

    figure, grid = plt.subplots(
        len(heights), sharex=True, squeeze=False, figsize=(WIDTH, sum(heights) + 0.35 * len(heights) + 0.3),
        height_ratios=heights, layout="constrained",
    )  # fmt: skip
    axes = list(grid[:, 0])
    axes[-1].set_xlabel("t, s")
    axes[-1].set_xlim(run.t[0], max(run.t[-1], run.t[0] + 1e-9))
    return figure, axes


def draw(ax: Axes, run: Run, names: Sequence[str], labels: Sequence[str], **style: Any) -> None:
    for name, label, look in zip(names, labels, TRIPLE, strict=True):
        ax.plot(run.t, run[name], label=label, **{**look, **style})


def finish(ax: Axes, run: Run, quantity: str, *, legend: bool = True) -> None:
    """Label with quantity and unit, shade contact, mark events, and put the legend above the axes."""
    ax.set_ylabel(quantity)
    if ax.get_yscale() == "linear":
        widen_if_flat(ax)
    handles, labels = ax.get_legend_handles_labels()
    if handles and legend:
        ax.legend(handles, labels, loc="lower left", bbox_to_anchor=(0, 1), borderaxespad=0.1, ncols=len(handles))
    mark_contact(ax, run)


def widen_if_flat(ax: Axes) -> None:
    """Keep rounding noise on a constant line from filling the panel."""
    low, high = ax.get_ylim()
    if high - low < 1e-6 * max(1, abs(low)):
        middle = (low + high) / 2
        ax.set_ylim(middle - 1, middle + 1)


def contact_spans(run: Run) -> list[tuple[float, float]]:
    """Intervals of contact, s, from the events; an open one ends with the run."""
    times = [*((e.type, e.t) for e in run.events), ("break", float(run.t[-1]))]
    return [(start, end) for (kind, start), (_, end) in pairwise(times) if kind == "make"]


def mark_contact(ax: Axes, run: Run) -> None:
    for start, end in contact_spans(run):
        ax.axvspan(start, end, color=AMBER, alpha=0.15, lw=0, zorder=0, label="contact")
    for event in run.events:
        label = f"{event.type} at {event.t:.4f} s"
        ax.axvline(event.t, color=BLACK, lw=0.8, ls=DASHES[event.type], zorder=1, label=label)


def event_legend(figure: Figure, run: Run) -> None:
    """Contact and its first events, in a line of their own above everything."""
    if run.events:
        marks = [*figure.axes[0].patches[:1], *figure.axes[0].lines[-len(run.events) :][:LABELLED_EVENTS]]
        figure.legend(handles=marks, loc="outside upper left", ncols=len(marks))


def shade_contact(ax: Axes, run: Run, *, label: str | None = None) -> None:
    """As one artist, however often contact is made."""
    if spans := contact_spans(run):
        bars = [(start, end - start) for start, end in spans]
        look: Any = {"color": AMBER, "alpha": 0.15, "lw": 0, "zorder": 0, "label": label}
        ax.broken_barh(bars, (0, 1), transform=ax.get_xaxis_transform(), **look)


def legend_above(ax: Axes, *, room: float, **look: Any) -> None:
    """All labelled artists above the axes, in as many rows as a width of `room` inches needs."""
    handles, labels = ax.get_legend_handles_labels()
    look = {"loc": "lower left", "bbox_to_anchor": (0, 1), "borderaxespad": 0.1, **look}
    for columns in range(len(handles), 0, -1):
        legend = ax.legend(handles, labels, ncols=columns, **look)
        if legend.get_window_extent().width <= room * ax.figure.dpi:
            return
