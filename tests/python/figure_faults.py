"""What a referee would send back: words that are cut off, labels that touch, a legend that hides data."""

from __future__ import annotations

from itertools import combinations, pairwise
from typing import Any

import matplotlib.text
from matplotlib.figure import Figure


def crowded(figure: Figure) -> list[str]:
    """The faults of a figure in words; none: []."""
    figure.draw_without_rendering()
    faults = []
    for ax in (ax for ax in figure.axes if ax.axison):
        for axis in (ax.xaxis, ax.yaxis):
            if axis.get_offset_text().get_text():
                faults.append(f"a power of ten over {ax.get_ylabel()}")
            boxes = [label.get_window_extent() for label in tick_labels(axis)]
            faults += [
                f"ticks of {ax.get_ylabel()}, {axis.axis_name}" for one, other in pairwise(boxes) if one.overlaps(other)
            ]
    inside = figure.bbox.padded(2)
    ticks = {label for ax in figure.axes for axis in (ax.xaxis, ax.yaxis) for label in axis.get_ticklabels()}
    shown = {*figure.findobj(matplotlib.text.Text)} - ticks
    shown |= {label for ax in figure.axes if ax.axison for axis in (ax.xaxis, ax.yaxis) for label in tick_labels(axis)}
    for text in shown:
        box = text.get_window_extent()
        if (
            text.get_visible()
            and text.get_text()
            and not (inside.contains(box.x0, box.y0) and inside.contains(box.x1, box.y1))
        ):
            faults.append(f"cut off: {text.get_text()}")
    legends = [ax.get_legend() for ax in figure.axes if ax.get_legend()]
    for box, ax in ((found.get_window_extent().padded(-2), ax) for found in legends for ax in figure.axes):
        if box.overlaps(ax.get_window_extent()):
            faults.append(f"a legend over {ax.get_ylabel()}")
    names = [ax.yaxis.label for ax in figure.axes if ax.axison] + [ax.xaxis.label for ax in figure.axes if ax.axison]
    for one, other in combinations([name for name in names if name.get_text()], 2):
        if one.get_window_extent().overlaps(other.get_window_extent()):
            faults.append(f"{one.get_text()} over {other.get_text()}")
    return faults


def tick_labels(axis: Any) -> list[Any]:
    """Those in sight, in order."""
    low, high = sorted(axis.get_view_interval())
    ticks = sorted(
        (tick for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high), key=lambda tick: tick.get_loc()
    )
    return [tick.label1 for tick in ticks if tick.label1.get_visible() and tick.label1.get_text()]
