"""The names of columns, and names that stand for three of them."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator

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
    places = _native.column_places()
    asked = {"t"}
    for i, name in _each_name(names, "column", '["q1", "force"]'):
        found = columns_of(name, places)
        if not found:
            raise _no_such("column", i, name, places, "`arm3r columns` lists them")
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
    asked = {"outcome"}
    for i, name in _each_name(names, "metric", '["peak_force", "impulse"]'):
        if name not in known:
            raise _no_such("metric", i, name, known, f"there are {', '.join(known)}")
        asked.add(name)
    return sorted(asked, key=known.index)


def _each_name(names: object, kind: str, example: str) -> Iterator[tuple[int, str]]:
    """The names in the argument `kind`s, with their places. TypeError: it is no list of names."""
    if isinstance(names, str) or not isinstance(names, Iterable):
        raise TypeError(f"{kind}s: a list of names is needed, such as {example}, got {names!r}")
    for i, name in enumerate(names):
        if not isinstance(name, str):
            raise TypeError(f"{kind}s[{i}]: a {kind}'s name is needed, got {name!r}")
        yield i, name


def _no_such(kind: str, place: int, name: str, known: Iterable[str], list_of_all: str) -> UsageError:
    hint = did_you_mean(name, known) or list_of_all
    return UsageError(f"{kind}s[{place}]: there is no {kind} {name!r}; {hint}", code="usage")
