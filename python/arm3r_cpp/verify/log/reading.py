"""Logs of the numbers of a formula, in named columns."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Collection, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ..._messages import place, shown
from ..._native import Floats
from ...errors import UsageError
from ...logs.arrays import ENDINGS as ARRAYS
from ...logs.names import Column, columns_of
from ...logs.table import MOST_SHOWN, Table, read_table
from ..kinds import KINDS, Kind
from ..names import quantities_of

ENDINGS = (".csv", ".tsv", ".txt", ".dat", ".log", *ARRAYS)
JUDGED = sorted((kind for kind in KINDS.values() if kind.columns), key=lambda kind: kind.is_logged_anyway)
"""The kinds that have columns; those that logs hold beside others come last."""
LARGEST = 1e12  # of a number
_STATES = re.compile(r"(q|qd|qdd|tau)\d")
_NOT_TYPED = frozenset(',"$`\\!')  # in a name on a command line
_UNITS_OF_STATES = {"q": "rad", "qd": "rad/s", "qdd": "rad/s^2", "tau": "N m"}


class Log(NamedTuple):
    """The columns of a log by their names."""

    file: str
    columns: dict[str, Floats]
    left_out: list[int]
    """The lines with a cell that is no finite number."""
    meant: list[Column]
    """The columns that the file calls otherwise, or gives in other units."""
    says_unit_of_angles: bool
    others: list[str]
    """The columns that are not known."""
    lines: list[int]
    """Of the rows."""
    spikes: Sequence[int] = ()
    """The lines that are left out for lying far from all others."""
    with_unit: frozenset[str] = frozenset()
    """The columns whose unit the file says."""
    of_unknown_units: Sequence[Column] = ()
    """The columns that are not known because their unit is not."""

    def vector(self, name: str, joints: int) -> Floats | None:
        """name1, name2, ...: (rows, joints); None where a column is missing."""
        names = [f"{name}{joint + 1}" for joint in range(joints)]
        return np.stack([self.columns[one] for one in names], axis=1) if set(names) <= set(self.columns) else None

    def states(self, joints: int) -> dict[str, Floats]:
        """The joint vectors; what is not in the log is zero.

        Raises:
            UsageError: the log has no q.
        """
        q = self.vector("q", joints)
        if q is None:
            needed = ", ".join(f"q{joint + 1}" for joint in range(joints))
            raise UsageError(f"{self.file}: a log has the columns {needed}{self.hint()}")
        found = {"q": q}
        for name in ("qd", "qdd", "tau"):
            values = self.vector(name, joints)
            found[name] = np.zeros_like(q) if values is None else values
        return found

    @property
    def may_be_degrees(self) -> bool:
        """Whether angles of no unit exceed a turn of radians."""
        angles = [values for name, values in self.columns.items() if re.fullmatch(r"q\d", name)]
        return not self.says_unit_of_angles and bool(angles) and float(np.abs(angles).max()) > 2 * math.pi

    def in_radians(self, revolute: Sequence[bool]) -> Log:
        """The log, the angles of these joints and their rates taken for degrees where the file says no unit."""
        angles = {f"{name}{joint + 1}" for name in ("q", "qd", "qdd") for joint, turns in enumerate(revolute) if turns}
        angles -= self.with_unit
        return self._replace(
            columns={n: one * (math.pi / 180 if n in angles else 1) for n, one in self.columns.items()}
        )

    def but_for(self, names: Collection[str]) -> Log:
        """The log without some of its columns."""
        return self._replace(columns={name: one for name, one in self.columns.items() if name not in names})

    def times(self, factor: float, names: Collection[str]) -> Log:
        """The log with some of its columns multiplied by a factor."""
        return self._replace(
            columns={name: factor * one if name in names else one for name, one in self.columns.items()}
        )

    def later(self, rows: int, names: Collection[str]) -> Log:
        """The log with some of its columns moved so many rows up, beside what stood above them; down where negative."""
        size, lag = len(self.lines), abs(rows)
        late, others = (slice(lag, None), slice(size - lag)) if rows > 0 else (slice(size - lag), slice(lag, None))
        moved = {name: one[late if name in names else others] for name, one in self.columns.items()}
        return self._replace(columns=moved, lines=self.lines[others])

    def without(self, spikes: Sequence[int]) -> Log:
        """The log without some of its rows, which lie far from all others."""
        kept = np.delete(np.arange(len(self.lines)), spikes)
        return self._replace(
            columns={name: one[kept] for name, one in self.columns.items()},
            lines=[self.lines[row] for row in kept],
            spikes=[self.lines[row] for row in spikes],
        )

    def notes(self) -> list[str]:
        """What was taken for what, and left out."""
        found = []
        if self.meant:
            found.append("read as " + ", ".join(f"{one.name}: {one.given}" for one in self.meant))
        word = "row" if self.file.endswith(ARRAYS) else "line"
        for lines, what in (
            (self.left_out, "with NaN or infinity"),
            (self.spikes, "far from all others, as spikes are,"),
        ):
            if lines:
                shown_ones = ", ".join(map(str, lines[:5])) + (", ..." if len(lines) > 5 else "")
                found.append(f"{len(lines)} row{'s' * (len(lines) > 1)} {what} left out: {word} {shown_ones}")
        return found

    def entries(self, kind: Kind) -> dict[tuple[int, ...], Floats]:
        """The columns of a kind of formula, by their places from 0."""
        found = {}
        for name, values in self.columns.items():
            match = re.fullmatch(kind.columns, name) if kind.columns else None
            if match:
                found[tuple("xyz".index(one) if one in "xyz" else int(one) - 1 for one in match.groups())] = values
        return found

    def kind(self) -> Kind:
        """The kind of formula whose entries the log has.

        Raises:
            UsageError: it has none.
        """
        for kind in JUDGED:
            if self.entries(kind):
                return kind
        *others, last = (kind.columns_words for kind in JUDGED)
        raise UsageError(f"{self.file}: no column is judged; name them {', '.join(others)} or {last}{self.hint()}")

    def judged(self, kind: Kind) -> dict[tuple[int, ...], Floats]:
        """The entries of a kind of formula.

        Raises:
            UsageError: the log has none.
        """
        if not kind.columns:
            raise UsageError(f"{self.file}: {kind.a_words} is judged as a function, and not by a log")
        found = self.entries(kind)
        if not found:
            raise UsageError(
                f"{self.file}: no column is that of {kind.a_words}; name them {kind.columns_words}{self.hint()}"
            )
        return found

    def hint(self) -> str:
        """What to say of the columns that are not known, where some are missing."""
        names = shown(", ".join(self.others)[:200])
        return self._hint_of_units() + (f"; --columns NAME=q1,... says which they are: {names}" if names else "")

    def _hint_of_units(self) -> str:
        if not self.of_unknown_units:
            return ""
        first, *more = (one.given for one in self.of_unknown_units)
        nor = f", nor is that of {', '.join(more)}" if more else ""
        pairs = [f"{one.given}={one.but_for_unit}{_in_si(one.but_for_unit)}" for one in self.of_unknown_units]
        said = ",".join(one for one in pairs if not set(one) & _NOT_TYPED) or "NAME=tau1 [1 N m],..."
        return shown(
            f'; {first}: its unit is not known{nor}; --columns "{said}" says what it is, its size in place of 1'
        )


def _in_si(name: str) -> str:
    """The unit that a column of this name has, as a number of it: [1 rad/s]."""
    state = _STATES.fullmatch(name)
    kinds = (kind.unit for kind in JUDGED if re.fullmatch(kind.columns, name))
    unit = _UNITS_OF_STATES[state[1]] if state else next(kinds, "")
    return f" [1 {unit}]" if unit else ""


def is_known(name: str) -> bool:
    """Whether a log's column of this name is judged, or says at which state or of which arm a row is."""
    return bool(_STATES.fullmatch(name)) or is_entry(name) or bool(quantities_of([name]))


def is_entry(name: str) -> bool:
    """Whether a log's column of this name is an entry of some kind of formula: h1 is no height."""
    return any(re.fullmatch(kind.columns, name) for kind in JUDGED)


def read_log(path: str | os.PathLike[str], called: Mapping[str, str] | None = None, joints: Sequence[str] = ()) -> Log:
    """The numbers of a file with named columns. Rows with NaN or infinity are left out.

    Args:
        called: what a column is, q1 or J12, perhaps with a unit in brackets, by its name in the file.
        joints: what the arm's joints are called, from the base to the tip.

    Raises:
        UsageError: the file cannot be read, or a row of it holds what is no number.
    """
    table = read_table(path)
    named = columns_of(table.names, is_known, called=called, joints=joints)
    known = [(index, column) for index, column in enumerate(named) if is_known(column.name)]
    of_unknown_units = [column for column in named if is_known(column.but_for_unit)]
    names = [column.name for _, column in known]
    if len(names) != len(set(names)):
        twice = next(name for name in names if names.count(name) > 1)
        raise UsageError(f"{table.file}:1: two columns are named {twice!r}")
    if not table.rows:
        raise UsageError(f"{table.file}: the log has no rows")
    columns = {column.name: column.factor * table.column(index) for index, column in known}
    _hold_size(table, known, columns)
    finite = np.all([np.isfinite(one) for one in columns.values()] or [np.ones(len(table.rows), bool)], axis=0)
    if not finite.any():
        raise UsageError(f"{table.file}: the log has no rows of finite numbers")
    return Log(
        table.file,
        {name: values[finite] for name, values in columns.items()},
        [line for line, one in zip(table.lines, finite, strict=True) if not one],
        [column for _, column in known if column.given != column.name],
        any(column.has_unit for _, column in known if column.name == "q1"),
        [
            column.given
            for column in named
            if not is_known(column.name) and column.name != "t" and column not in of_unknown_units
        ],
        [line for line, one in zip(table.lines, finite, strict=True) if one],
        with_unit=frozenset(column.name for _, column in known if column.has_unit),
        of_unknown_units=of_unknown_units,
    )


def _hold_size(table: Table, known: Sequence[tuple[int, Column]], columns: Mapping[str, Floats]) -> None:
    """
    Raises:
        UsageError: a number is larger than any measured quantity.
    """
    for index, column in known:
        values = np.abs(columns[column.name])
        for row in np.flatnonzero((values > LARGEST) & np.isfinite(values))[:1]:
            where, got = place(table.file, table.lines[row]), table.rows[row][index][:MOST_SHOWN]
            raise UsageError(f"{where}: {column.given} is at most {LARGEST:g} either way, got {got!r}")
