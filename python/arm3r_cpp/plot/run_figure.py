"""The matplotlib Figure that this package returns: outside pyplot, shown by a notebook, saved with its origin."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from matplotlib import rcParams
from matplotlib.backend_bases import FigureManagerBase
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from ..answers import unseen_figures
from ..core.run import Run
from ..core.scenario import Scenario
from ..errors import UsageError
from .style import style

STAMP: Any = {"fontsize": 6, "color": "#666666"}
STAMP_LETTER, STAMP_LINE = 0.046, 0.11  # inches: the mean width of a letter of the stamp, and the height of a line


class Origin(NamedTuple):
    """What identifies the numbers of a figure."""

    scenario: str
    """The scenario's name."""
    convention: str
    """Of the joint angles; "" where the summary holds no scenario."""
    hash: str
    """Over all columns of the run."""
    version: str
    """Of the program that computed them."""

    def __str__(self) -> str:
        return f"scenario {self.scenario}, convention {self.convention or 'unknown'}, hash {self.hash}"


def origin_of(run: Run) -> Origin:
    summary = run.summary
    text = summary.get("scenario")
    convention = Scenario(text)["arm.convention"] if text else ""
    return Origin(summary["name"], convention, summary.get("hash", "none"), summary.get("version", "unknown"))


class RunFigure(Figure):
    """A matplotlib Figure that pyplot does not know: it leaves the user's own `plt.plot` and `plt.show` alone.

    A notebook shows it as the value of a cell; `arm3r.plot.show` opens a window. A saved file names the scenario, the
    convention of the joint angles and the hash of the run.
    """

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        FigureCanvasAgg(self)
        self.origins: list[Origin] = []
        self._number = unseen_figures.made()

    def draw(self, renderer: Any) -> None:
        """As matplotlib's own: drawing the figure counts as seeing it."""
        unseen_figures.seen(self._number)
        super().draw(renderer)

    def savefig(self, fname: str | os.PathLike[str] | Any, **options: Any) -> None:
        """As matplotlib's own, with the origin in the file, fonts that journals take, and no date."""
        kind = options.get("format") or _suffix(fname) or rcParams["savefig.format"]
        if own := _metadata(self.origins, kind.lower()):
            options["metadata"] = {**own, **(options.get("metadata") or {})}
        with style():
            super().savefig(fname, **options)

    def _repr_png_(self) -> bytes:
        """The picture that a notebook shows where matplotlib has not registered one of its own."""
        picture = io.BytesIO()
        self.savefig(picture, format="png", dpi="figure")
        return picture.getvalue()

    def set_origin(self, origins: Iterable[Origin], *, stamp: bool = False) -> None:
        """Remember what the figure shows; `stamp`: write it at the figure's foot, too."""
        self.origins = list(origins)
        if stamp:
            lines = stamp_lines(self.origins, self.get_figwidth())
            share = stamp_height(self.origins, self.get_figwidth()) / self.get_figheight()
            engine: Any = self.get_layout_engine()
            if engine:  # else the foot is free
                engine.set(rect=(0, share, 1, 1 - share))
            self.text(0.99, 0.02 / self.get_figheight(), "\n".join(lines), ha="right", va="bottom", **STAMP)


def stamp_lines(origins: Iterable[Origin], width: float) -> list[str]:
    """One line for each origin, broken where a figure of this width, inches, is narrow."""
    letters = int(width / STAMP_LETTER)
    return [line for origin in origins for line in _broken(str(origin), letters)]


def stamp_height(origins: Iterable[Origin], width: float) -> float:
    """inches"""
    return STAMP_LINE * len(stamp_lines(origins, width)) + 0.05


def _suffix(fname: Any) -> str:
    return os.path.splitext(fname)[1][1:] if isinstance(fname, (str, os.PathLike)) else ""


def _metadata(origins: list[Origin], kind: str) -> dict[str, Any]:
    """In the words of the format: PNG's text chunks, PDF's information dictionary, SVG's Dublin Core."""
    title = ", ".join(origin.scenario for origin in origins)
    text = "; ".join(map(str, origins))
    creator = f"arm3r {', '.join(sorted({origin.version for origin in origins}))}".strip()
    words: dict[str, dict[str, Any]] = {
        "png": {"Title": title, "Description": text, "Source": creator},
        "pdf": {"Title": title, "Subject": text, "Creator": creator, "CreationDate": None},
        "svg": {"Title": title, "Description": text, "Creator": creator, "Date": None},
    }
    return words.get(kind, {})


def _broken(text: str, letters: int) -> list[str]:
    """A text in lines of so many letters, broken after commas where that is possible."""
    lines = [""]
    for part in text.split(", "):
        joined = f"{lines[-1]}, {part}" if lines[-1] else part
        lines = [*lines[:-1], joined] if len(joined) <= letters or not lines[-1] else [*lines, part]
    return lines


# ---- windows --------------------------------------------------------------------------------------------------------


def has_notebook() -> bool:
    """Whether a notebook runs this code; a shell of IPython in a terminal is none."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    return hasattr(shell, "kernel")


def open_windows(figures: Sequence[Figure]) -> None:
    """Lend figures to pyplot until their windows are closed."""
    import matplotlib.pyplot as plt

    for figure in figures:
        plt.figure(FigureClass=lambda *_, made=figure, **__: made)  # type: ignore[arg-type]
        manager: Any = type(figure.canvas.manager)
        if manager.show is FigureManagerBase.show:
            plt.close(figure)
            message = f"show: matplotlib's backend here is {plt.get_backend()}, which has no windows"
            raise UsageError(f"{message}; save the figure instead: figure.savefig('figure.png')", code="usage")
    plt.show()
    if not plt.isinteractive():
        for figure in figures:
            plt.close(figure)
            FigureCanvasAgg(figure)
