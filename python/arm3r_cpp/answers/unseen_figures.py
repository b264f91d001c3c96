"""Figures that a script made and never looked at: said once, when it ends.

pyplot does not know the figures of this package, so `plt.show()` shows none of them and says nothing.
"""

from __future__ import annotations

import atexit
import sys
from itertools import count

_numbers = count(1)
_figures: set[int] = set()
_is_silent = False


def made() -> int:
    """A figure has been made: its number."""
    if not _figures:
        atexit.unregister(_say)
        atexit.register(_say)
    number = next(_numbers)
    _figures.add(number)
    return number


def seen(number: int) -> None:
    """A figure is drawn: saved, in a window, in a notebook, or as pixels."""
    _figures.discard(number)


def silence() -> None:
    """Say nothing in this process: a command says itself what became of its figures."""
    global _is_silent
    _is_silent = True


def _say() -> None:
    failed = hasattr(sys, "last_value") or hasattr(sys, "last_exc")
    if not _figures or _is_silent or failed or hasattr(sys, "ps1") or {"pytest", "IPython"} & set(sys.modules):
        return
    count = "a figure was" if len(_figures) == 1 else f"{len(_figures)} figures were"
    how = "arm3r.plot.show(figure) opens a window, figure.savefig(path) writes a file"
    print(f"arm3r: {count} made and neither shown nor saved; plt.show() does not know it: {how}", file=sys.stderr)
