"""The names of columns, and names that stand for three of them."""

from __future__ import annotations

from collections.abc import Container, Iterable

from .. import _native
from .._messages import did_you_mean
from ..errors import UsageError


def triples(name: str) -> list[list[str]]:
    """The columns that a name could stand for, such as "q" for q1, q2, q3, whether they exist or not."""
    return [[name + joint + end for end in ends] for ends in ("123", "xyz") for joint in ("", "_")]


def three_of(name: str, columns: Container[str]) -> list[str]:
    """The columns that a name stands for, such as "q" for q1, q2, q3; else none."""
    return next((parts for parts in triples(name) if all(part in columns for part in parts)), [])


def columns_of(name: str, columns: Container[str]) -> list[str]:
    """The one column or the three that a name stands for, among these; else none."""
    return [name] if name in columns else three_of(name, columns)


def completions(columns: Iterable[str]) -> list[str]:
    """The columns, and the names that stand for three of them: what the Tab key offers."""
    names = list(columns)
    shorter = {name[:-1].removesuffix("_") for name in names}
    return [*names, *sorted(name for name in shorter if three_of(name, names))]


def columns_asked_for(names: object) -> list[str]:
    """Names of columns in the order of a log, with t; each given name is a column, or stands for three.

    Raises:
        TypeError: no list of names.
        UsageError: some run has no such column; the message names the nearest one.
    """
    if isinstance(names, str) or not isinstance(names, Iterable):
        raise TypeError(f'columns: a list of names is needed, such as ["q1", "force"], got {names!r}')
    places = _native.column_places()
    asked = {"t"}
    for i, name in enumerate(names):
        if not isinstance(name, str):
            raise TypeError(f"columns[{i}]: a column's name is needed, got {name!r}")
        found = columns_of(name, places)
        if not found:
            hint = did_you_mean(name, places) or "`arm3r columns` lists them"
            raise UsageError(f"columns[{i}]: there is no column {name!r}; {hint}", code="usage")
        asked.update(found)
    return sorted(asked, key=places.__getitem__)


def metrics_asked_for(names: object) -> list[str]:
    """Names of summaries in the order of a batch's table, with the outcome; None: all.

    Raises:
        TypeError: no list of names.
        UsageError: there is no such metric; the message names the nearest one.
    """
    known = list(_native.summary_columns())
    if names is None:
        return known
    if isinstance(names, str) or not isinstance(names, Iterable):
        raise TypeError(f'metrics: a list of names is needed, such as ["peak_force", "impulse"], got {names!r}')
    asked = {"outcome"}
    for i, name in enumerate(names):
        if not isinstance(name, str):
            raise TypeError(f"metrics[{i}]: a metric's name is needed, got {name!r}")
        if name not in known:
            hint = did_you_mean(name, known) or f"there are {', '.join(known)}"
            raise UsageError(f"metrics[{i}]: there is no metric {name!r}; {hint}", code="usage")
        asked.add(name)
    return sorted(asked, key=known.index)
