"""Panels over one time axis, and other panels in rows below."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from .style import MARGIN, legend_above

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TWO_PANELS = 5.0  # inches: narrower figures have one panel a row
BESIDE = 0.28  # of a panel's width: what stands beside it
GAP, LEGEND, LABELS = 0.12, 0.28, 0.45  # inches of height: between panels, above one, and below the last of a part


class Panel(NamedTuple):
    height: float
    """inches"""
    draw: Callable[[Any, float], None]
    """Draws into axes; the number is the width that its legend may have, inches."""
    legend: bool = True
    """Whether it has one."""
    beside: Callable[[Any], None] | None = None
    """Draws what explains the panel into small axes to the right of it."""

    @property
    def space(self) -> float:
        """inches"""
        return self.height + GAP + (LEGEND if self.legend else 0)


def lay_out(
    over_time: Sequence[Panel],
    below: Sequence[Panel],
    last: Sequence[Panel] = (),
    *,
    width: float,
    start: float,
    end: float,
) -> Figure:
    """width: inches. start, end: of the time axis, s. Panels below stand two a row where the figure is wide enough, the
    last ones alone."""
    import matplotlib.pyplot as plt

    step = 2 if width >= TWO_PANELS else 1
    rows = [below[i : i + step] for i in range(0, len(below), step)]
    rows += [[panel] for panel in last]
    heights = [LABELS + sum(p.space for p in over_time), *(LABELS + max(p.space for p in row) for row in rows)]
    figure = plt.figure(figsize=(width, sum(heights)), layout="constrained")
    parts = figure.subfigures(len(heights), 1, height_ratios=heights, squeeze=False)[:, 0]
    axes = parts[0].subplots(len(over_time), 1, sharex=True, squeeze=False, height_ratios=[p.height for p in over_time])
    for panel, ax in zip(over_time, axes[:, 0], strict=True):
        panel.draw(ax, width - MARGIN)
    axes[-1, 0].set(xlabel="t, s", xlim=(start, max(end, start + 1e-9)))
    parts[0].align_ylabels()
    for part, row in zip(parts[1:], rows, strict=True):
        draw_row(part, row, width)
    narrow_legends(figure)
    return figure


def draw_row(part: Any, row: Sequence[Panel], width: float) -> None:
    """Panels side by side, of one width."""
    shares = [share for panel in row for share in ([1.0, BESIDE] if panel.beside else [1.0])]
    axes = iter(part.subplots(1, len(shares), squeeze=False, width_ratios=shares)[0])
    for panel in row:
        panel.draw(next(axes), width / sum(shares) - MARGIN)
        if panel.beside:
            panel.beside(next(axes))


def narrow_legends(figure: Figure) -> None:
    """Labels beside axes have their widths when all is laid out: legends that then leave the figure get more rows."""
    figure.draw_without_rendering()
    for ax in figure.axes:
        if (legend := ax.get_legend()) and legend.get_window_extent().x1 > figure.bbox.x1:
            legend_above(ax, room=(figure.bbox.x1 - ax.bbox.x0) / figure.dpi, handlelength=legend.handlelength)
