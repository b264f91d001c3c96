"""Reads a measurement: columns over time, named as those of a run; others are left out, and named."""

from __future__ import annotations

import csv
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .._files import regular
from .._messages import place, warn_user
from .._native import Floats, column_places
from ..errors import ScenarioWarning, UsageError

TIMES = ("t", "time")
MAX_NAMED = 8  # columns that a warning names
_UNIT = re.compile(r"\s*[\[(](.*)[\])]\s*$")
_DEGREES = re.compile(r"deg|°", re.IGNORECASE)
_SI = ("", "s", "rad", "rad/s", "rad/s^2", "N m", "Nm", "m", "m/s", "N", "-", "1")


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
    """A measurement from a CSV file, or from a map of columns.

    Raises:
        UsageError: the file cannot be read, has no column of time, no column of a run, or a cell that is no number.
    """
    if isinstance(source, Mapping):
        return _chosen("measured", list(source), [np.asarray(column, np.float64) for column in source.values()])
    path = Path(source)
    try:
        text = regular(path).read_text(encoding="utf-8-sig", errors="replace")
    except OSError as error:
        raise _unreadable(path, f"cannot be read: {error.strerror or error}") from error
    names, rows = _table(path, text)
    if not any(_is_time(name) for name in names):
        raise _unreadable(place(path, 1), f"a column `t` or `time`, in s, is needed, got {', '.join(names)[:80]!r}")
    data = np.array(rows, np.float64).reshape(-1, len(names))
    return _chosen(os.fspath(path), names, list(data.T))


def _unreadable(where: object, why: str) -> UsageError:
    return UsageError(f"{where}: {why}", code="file.measured")


def _table(path: Path, text: str) -> tuple[list[str], list[list[float]]]:
    """The names and the rows of a CSV file, parted by comma, semicolon or tab."""
    lines = text.splitlines()
    head = lines[0] if lines else ""
    separator = max(";\t,", key=head.count)
    names = [name.strip() for name in next(csv.reader([head], delimiter=separator), [])]
    rows = []
    for number, cells in enumerate(csv.reader(lines[1:], delimiter=separator), 2):
        if not cells or not any(cell.strip() for cell in cells):
            continue
        if len(cells) != len(names):
            raise _unreadable(place(path, number), f"{len(names)} cells are needed, got {len(cells)}")
        rows.append([_number(cell, comma=separator != ",") for cell in cells])
        for name, cell, value in zip(names, cells, rows[-1], strict=True):
            if np.isnan(value) and cell.strip().lower() not in ("", "nan") and (_is_time(name) or _column(name)):
                raise _unreadable(place(path, number), f"{name}: a number is needed, got {cell.strip()[:40]!r}")
    return names, rows


def _number(cell: str, *, comma: bool) -> float:
    """NaN where it is none; comma: it may stand for the point."""
    try:
        return float(cell.strip().replace(",", ".") if comma else cell)
    except ValueError:
        return float("nan")


def _is_time(name: str) -> bool:
    return _bare(name).lower() in TIMES


def _column(name: str) -> str:
    """The column of a run that a name stands for; "" where it is none."""
    bare = _bare(name)
    return bare if bare in column_places() and bare != "t" else ""


def _bare(name: str) -> str:
    """A name without its unit in brackets, where that is SI's."""
    unit = _UNIT.search(name)
    return name[: unit.start()].strip() if unit and unit[1].strip() in _SI else name


def _chosen(name: str, names: Sequence[str], data: Sequence[Floats]) -> Measurement:
    """The columns that a run could have; the others are named in a warning.

    Raises:
        UsageError: there is none, a name stands there twice, or time does not increase.
    """
    times = [column for given, column in zip(names, data, strict=True) if _is_time(given)]
    columns = {_column(given): column for given, column in zip(names, data, strict=True) if _column(given)}
    if len(times) != 1 or len(columns) != sum(bool(_column(given)) for given in names):
        raise _unreadable(name, "each column is needed once, and one of them is `t` or `time`, in s")
    if not columns:
        hint = "angles are drawn in rad" if any(map(_DEGREES.search, names)) else "`arm3r columns` lists them"
        raise _unreadable(name, f"no column has a name that a run has, such as q1 or tau2; {hint}")
    (t,) = times
    if len(t) < 2 or not np.isfinite(t).all() or (np.diff(t) < 0).any():
        raise _unreadable(name, "two rows or more are needed, in which time is a number that does not decrease")
    if others := [given for given in names if not _is_time(given) and not _column(given)]:
        warn_user(f"{name}: {_left_out(others)}", ScenarioWarning)
    return Measurement(Path(name).name, t, columns)


def _left_out(names: Sequence[str]) -> str:
    shown = ", ".join(names[:MAX_NAMED]) + (f" and {len(names) - MAX_NAMED} more" if len(names) > MAX_NAMED else "")
    degrees = "; angles are drawn in rad, not in degrees" if any(map(_DEGREES.search, names)) else ""
    return f"not drawn, as no column of a run is called so: {shown}{degrees}"
