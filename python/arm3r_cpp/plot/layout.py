"""Panels over one time axis, and other panels in rows below."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from .._messages import did_you_mean
from ..errors import UsageError
from .style import MARGIN, NARROW, SMALL, WIDTH, legend_above

if TYPE_CHECKING:
    from .run_figure import RunFigure

BESIDE = 0.28  # of a panel's width: what stands beside it
GAP, LABELS = 0.14, 0.42  # inches of height: above a panel and its legend, and for the labels of a time axis
PAD, RIGHT = 0.06, 0.2  # inches of width: between texts, and to the right of panels: half of a label
PAGE = 9.0  # inches: no figure gets higher by itself
LEAST = 0.5  # of their heights: panels do not get lower
TRIES = 4  # a legend or a label that is changed moves the others


class Panel(NamedTuple):
    height: float
    """inches"""
    draw: Callable[[Any, float], None]
    """Draws into axes; the number is the width that its legend may have, inches."""
    beside: Callable[[Any], None] | None = None
    """Draws what explains the panel into small axes to the right of it."""
    is_table: bool = False
    """Whether its height is that of its lines."""


class Size(NamedTuple):
    """Of a figure, inches."""

    width: float = WIDTH
    height: float | None = None
    """None: what the panels need, at most a page."""
    foot: float = 0.0
    """What is free below the panels."""


Named = Mapping[str, Sequence[Panel]]
"""Panels by the names that users choose them by; none where the run lacks what they show."""


class Chosen(NamedTuple):
    """Panels by where they stand in a figure."""

    over_time: list[Panel]
    below: list[Panel]
    last: list[Panel]


def chosen(panels: Named, names: Sequence[str], *, below: Sequence[str], last: Sequence[str] = ()) -> Chosen:
    """The panels of these names, in this order; `below` and `last` name those that are not over time.

    Raises:
        UsageError: there is no panel of a name, or the run has nothing for it.
    """
    there = [name for name, found in panels.items() if found]
    for name in names:
        if name not in there:
            why = "the run has nothing to show there" if name in panels else "there is no such panel"
            hint = "" if name in panels else did_you_mean(name, there)
            message = f"panels: {name}: {why}; {hint + ' ' if hint else ''}this figure can have {', '.join(there)}"
            raise UsageError(message, code="usage")
    groups = Chosen([], [], [])
    for name in names:
        (groups.below if name in below else groups.last if name in last else groups.over_time).extend(panels[name])
    return groups


def lay_out(
    over_time: Sequence[Panel], below: Sequence[Panel], last: Sequence[Panel] = (), *,
    size: Size, start: float, end: float,
) -> RunFigure:  # fmt: skip
    """start, end: of the time axis, s. Panels below stand two a row where the figure is wide enough, the last ones
    alone.

    Raises:
        UsageError: the height is too small for the panels.
    """
    from .run_figure import RunFigure

    figure = RunFigure(figsize=(size.width, PAGE))
    step = 2 if size.width >= NARROW else 1
    rows = [*draw_over_time(figure, over_time, size.width, start, end)]
    rows += [draw_row(figure, below[i : i + step], size.width) for i in range(0, len(below), step)]
    rows += [draw_row(figure, [panel], size.width) for panel in last]
    place(figure, rows, size)
    for _ in range(TRIES):
        if not narrow_legends(figure, rows) | break_labels(figure, rows):
            break
        place(figure, rows, size)
    return figure


class Row(NamedTuple):
    """Panels side by side, with their axes."""

    panels: Sequence[Panel]
    axes: Sequence[Any]
    beside: Sequence[Any]
    """Axes of what stands to the right of a panel; None: nothing does."""
    group: int
    """Rows of one group have one left margin."""
    labels: float
    """inches: for the labels of the horizontal axis"""

    def above(self) -> float:
        """inches: what stands above the panels"""
        return GAP + max(map(legend_height, self.axes))

    @property
    def height(self) -> float:
        return max(panel.height for panel in self.panels)


def draw_over_time(figure: Any, panels: Sequence[Panel], width: float, start: float, end: float) -> list[Row]:
    rows: list[Row] = []
    for panel in panels:
        ax = figure.add_axes((0.1, 0.1, 0.8, 0.8), label=f"{len(rows)}", sharex=rows[0].axes[0] if rows else None)
        ax.tick_params(labelbottom=panel is panels[-1])
        panel.draw(ax, width - MARGIN)
        rows.append(Row([panel], [ax], [None], 0, LABELS if panel is panels[-1] else 0.0))
    if rows:
        rows[-1].axes[0].set(xlabel="t, s", xlim=(start, max(end, start + 1e-9)))
    return rows


def draw_row(figure: Any, panels: Sequence[Panel], width: float) -> Row:
    """Panels side by side, of one width."""
    axes, beside = [], []
    for panel in panels:
        ax = figure.add_axes((0.1, 0.1, 0.8, 0.8), label=f"{len(figure.axes)}")
        panel.draw(ax, width * shares(panels)[0] - MARGIN)
        axes.append(ax)
        beside.append(figure.add_axes((0.1, 0.1, 0.8, 0.8), label=f"{len(figure.axes)}") if panel.beside else None)
        if panel.beside:
            panel.beside(beside[-1])
    return Row(panels, axes, beside, len(figure.axes), 0.0 if panels[0].is_table else LABELS)


def shares(panels: Sequence[Panel]) -> tuple[float, float]:
    """Of a row's width: that of a panel, and that of what stands beside one."""
    whole = sum(1.0 + BESIDE * bool(panel.beside) for panel in panels)
    return 1.0 / whole, BESIDE / whole


# ---- places ---------------------------------------------------------------------------------------------------------


def place(figure: RunFigure, rows: Sequence[Row], size: Size) -> None:
    """Put all axes where they belong, one row below the other, with room for legends and labels."""
    above = [row.above() for row in rows]
    heights = fitted(rows, size, size.foot + sum(above) + sum(row.labels for row in rows))
    total = size.foot + sum(above) + sum(row.labels for row in rows) + sum(heights)
    figure.set_size_inches(size.width, total)
    for margin_is_known in (False, True):  # the labels of the vertical axes depend on the heights
        top = total
        for row, height, legends in zip(rows, heights, above, strict=True):
            top -= legends + height
            same = [other.axes[0] for other in rows if other.group == row.group]
            place_row(figure, row, (top, height), same if margin_is_known else [])
            top -= row.labels


def place_row(figure: RunFigure, row: Row, vertical: tuple[float, float], same: Sequence[Any]) -> None:
    """vertical: foot and height, inches. same: axes that share the left margin; none: it is not known yet."""
    width = figure.get_figwidth()
    share, share_beside = shares(row.panels)
    left = 0.0
    for panel, ax, beside in zip(row.panels, row.axes, row.beside, strict=True):
        ticks, label = (0.4, 0.2) if not same else widths(same if ax in same else [ax])
        margin = PAD if panel.is_table else ticks + label + 2 * PAD
        inner = share * width - margin - (0.0 if panel.is_table else RIGHT)
        ax.set_position(in_figure(figure, left + margin, inner, vertical))
        if ax.get_aspect() == "auto":  # else the axes are narrower than their place
            ax.yaxis.set_label_coords(-(ticks + PAD) / inner, 0.5)
        left += share * width
        if beside is not None:
            beside.set_position(in_figure(figure, left, share_beside * width, vertical))
            left += share_beside * width


def in_figure(
    figure: RunFigure, left: float, width: float, vertical: tuple[float, float]
) -> tuple[float, float, float, float]:
    """Left, foot, width and height in shares of the figure, from inches."""
    across, up = figure.get_size_inches()
    return left / across, vertical[0] / up, width / across, vertical[1] / up


def widths(axes: Sequence[Any]) -> tuple[float, float]:
    """Of the tick labels and of the labels of vertical axes, inches: the largest ones."""
    dpi = axes[0].figure.dpi
    labels = max(ax.yaxis.label.get_window_extent().width if ax.get_ylabel() else 0.0 for ax in axes)
    return max(map(tick_width, axes)) / dpi, labels / dpi


def tick_width(ax: Any) -> float:
    """Of the tick labels of the vertical axis, pixels."""
    ax.yaxis.label.set_visible(False)
    box = ax.yaxis.get_tightbbox()
    ax.yaxis.label.set_visible(True)
    return max(0.0, ax.bbox.x0 - box.x0) if box else 0.0


def fitted(rows: Sequence[Row], size: Size, taken: float) -> list[float]:
    """Heights of the panels of each row, inches: all but tables lower or higher by one factor.

    taken: the height of all that is no panel, inches.

    Raises:
        UsageError: so low a figure is not readable.
    """
    are_tables = [row.panels[0].is_table for row in rows]
    still = taken + sum(row.height for row, is_table in zip(rows, are_tables, strict=True) if is_table)
    free = sum(row.height for row, is_table in zip(rows, are_tables, strict=True) if not is_table)
    wanted = min(still + free, PAGE) if size.height is None else size.height
    scale = (wanted - still) / free if free else 1.0
    if scale < LEAST and size.height is not None:
        message = f"height: {size.height:g} inches are too few, {still + LEAST * free:.1f} are needed"
        raise UsageError(f"{message}; give more, or choose fewer panels", code="usage")
    scale = max(scale, LEAST)
    return [row.height * (1.0 if is_table else scale) for row, is_table in zip(rows, are_tables, strict=True)]


def legend_height(ax: Any) -> float:
    """Of the legend above axes, inches; 0: there is none."""
    legend = ax.get_legend()
    return legend.get_window_extent().height / ax.figure.dpi if legend else 0.0


def narrow_legends(figure: RunFigure, rows: Sequence[Row]) -> bool:
    """Give more rows to legends that leave the figure; whether there was one."""
    end = figure.bbox.x1 - PAD * figure.dpi
    wide = [ax for row in rows for ax in row.axes if ax.get_legend() and legend_end(ax) > end]
    for ax in wide:
        look = {"handlelength": ax.get_legend().handlelength}
        legend_above(ax, room=(end - ax.bbox.x0) / figure.dpi, **look)
    return bool(wide)


def legend_end(ax: Any) -> float:
    """The right end of a legend, pixels."""
    return float(ax.get_legend().get_window_extent().x1)


def break_labels(figure: RunFigure, rows: Sequence[Row]) -> bool:
    """Put the unit into a line of its own where labels of panels run into each other; whether there were such.

    Labels of two lines get smaller letters.
    """
    labels = [(row.axes[0].yaxis.label, row.axes[0].bbox.height) for row in rows if row.axes[0].get_ylabel()]
    if not labels:
        return False
    boxes = [label.get_window_extent() for label, _ in labels]
    above = [figure.bbox.y1, *(box.y0 - 2 for box in boxes[:-1])]
    long = [
        label
        for (label, height), box, limit, lower in zip(labels, boxes, above, [*boxes[1:], None], strict=True)
        if (box.y1 > limit or (lower is not None and lower.y1 > box.y0 - 2)) and box.height > height
    ]
    for label in long:
        if "\n" in label.get_text():
            label.set_fontsize(SMALL)
        label.set_text(",\n".join(label.get_text().rsplit(", ", 1)))
    return bool(long)
