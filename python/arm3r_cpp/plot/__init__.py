"""Figures and films of runs: `overview`, `lecture`, `force`, `compare`, `measured` and `animate`; `show` opens them.

In comes a finished or partial run, or the table of a sweep. Out goes a matplotlib Figure that pyplot does not know: a
notebook shows it as the value of a cell, `show` opens a window. `figures` holds the public functions, `style` and
`layout` decide how every figure looks, and the other modules draw one kind of figure each. The modules of this room
must not know command lines, and they never run a scenario.
matplotlib and numpy are imported when something is drawn, not before: the names below are loaded when they are used.
`__init__.pyi` has their types. Films and measured rows stand above this room.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from ..core.provided import provided

__all__ = ["animate", "compare", "force", "lecture", "measured", "overview", "show"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}; it has {', '.join(__all__)}")
    if name == "animate":
        return provided("film of a run")
    if name == "measured":
        return provided("figure of measured rows")
    return getattr(import_module(".figures", __name__), name)


def __dir__() -> list[str]:
    return list(__all__)
