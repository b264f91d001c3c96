"""Reads a measurement: columns over time, named as those of a run; others are left out, and named."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .._messages import place, warn_user
from .._native import Floats, column_places
from ..errors import ScenarioWarning, UsageError
from ..logs.names import Column, columns_of
from ..logs.table import read_table

MAX_NAMED = 8  # columns that a warning names


class Measurement(NamedTuple):
    """What was measured, SI units and radians; NaN where a cell is empty."""

    name: str
    t: Floats
    columns: dict[str, Floats]
    """Those that a run could have, without t."""


def is_measurement(path: Path) -> bool:
    """Whether a file is read as a measurement: a CSV file without the summary that lies beside that of a run."""
    return path.suffix == ".csv" and not path.with_suffix(".json").exists()


def measurement(source: str | os.PathLike[str] | Mapping[str, Any]) -> Measurement:
    """A measurement from a text file of named columns, or from a map of columns.

    Raises:
        UsageError: the file cannot be read, has no column of time, no column of a run, or a cell that is no number.
    """
    if isinstance(source, Mapping):
        columns = columns_of(list(source), _is_drawn)
        return _chosen("measured", columns, [np.asarray(column, np.float64) for column in source.values()])
    table = read_table(source)
    columns = columns_of(table.names, _is_drawn)
    if not any(column.name == "t" for column in columns):
        got = ", ".join(table.names)[:80]
        raise _unreadable(place(table.file, 1), f"a column `t` or `time`, in s, is needed, got {got!r}")
    numbers = [
        table.column(index) if column.name == "t" or _is_drawn(column.name) else np.empty(0)
        for index, column in enumerate(columns)
    ]
    return _chosen(table.file, columns, numbers)


def _unreadable(where: object, why: str) -> UsageError:
    return UsageError(f"{where}: {why}", code="file.measured")


def _is_drawn(name: str) -> bool:
    """Whether a run has a column of this name, beside time."""
    return name in column_places() and name != "t"


def _chosen(name: str, named: Sequence[Column], data: Sequence[Floats]) -> Measurement:
    """The columns that a run could have; the others are named in a warning.

    Raises:
        UsageError: there is none, a name stands there twice, or time does not increase.
    """
    times = [column.factor * numbers for column, numbers in zip(named, data, strict=True) if column.name == "t"]
    drawn = [(column, numbers) for column, numbers in zip(named, data, strict=True) if _is_drawn(column.name)]
    columns = {column.name: column.factor * numbers for column, numbers in drawn}
    if len(times) != 1 or len(columns) != len(drawn):
        raise _unreadable(name, "each column is needed once, and one of them is `t` or `time`, in s")
    if not columns:
        raise _unreadable(name, "no column has a name that a run has, such as q1 or tau2; `arm3r columns` lists them")
    (t,) = times
    if len(t) < 2 or not np.isfinite(t).all() or (np.diff(t) < 0).any():
        raise _unreadable(name, "two rows or more are needed, in which time is a number that does not decrease")
    if others := [column.given for column in named if column.name != "t" and not _is_drawn(column.name)]:
        shown = ", ".join(others[:MAX_NAMED]) + (f" and {len(others) - MAX_NAMED} more" if others[MAX_NAMED:] else "")
        warn_user(f"{name}: not drawn, as no column of a run is called so: {shown}", ScenarioWarning)
    return Measurement(Path(name).name, t, columns)
