"""Logs: CSV files with named columns."""

from __future__ import annotations

import csv
import math
import os
import re
from typing import NamedTuple

import numpy as np

from .._native import Floats
from ..errors import UsageError
from .kinds import KINDS, Kind

_ENTRIES = {
    "jacobian": r"J_?(\d)_?(\d)", "gravity": r"(?:g|tau_g)_?(\d)", "mass": r"M_?(\d)_?(\d)", "coriolis": r"h_?(\d)",
    "kinematics": r"(?:p_?|tip_)([123xyz])", "inverse": r"tau_?(\d)", "forward": r"qdd_?(\d)",
}  # fmt: skip
_MOST_ROWS = 1_000_000
LARGEST = 1e12  # of a number


class Log(NamedTuple):
    """The columns of a log by their names."""

    file: str
    columns: dict[str, Floats]
    left_out: list[int]
    """The lines with a cell that is no finite number."""

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
            raise UsageError(
                f"{self.file}: a log has the columns {', '.join(f'q{joint + 1}' for joint in range(joints))}"
            )
        found = {"q": q}
        for name in ("qd", "qdd", "tau"):
            values = self.vector(name, joints)
            found[name] = np.zeros_like(q) if values is None else values
        return found

    def entries(self, kind: Kind) -> dict[tuple[int, ...], Floats]:
        """The columns of a kind of formula, by their places from 0."""
        found = {}
        for name, values in self.columns.items():
            match = re.fullmatch(_ENTRIES.get(kind.name, "-"), name)
            if match:
                found[tuple("xyz".index(one) if one in "xyz" else int(one) - 1 for one in match.groups())] = values
        return found

    def kind(self) -> Kind:
        """The kind of formula whose entries the log has.

        Raises:
            UsageError: it has none.
        """
        for name in _ENTRIES:
            if self.entries(KINDS[name]) and not (name == "forward" and self.entries(KINDS["inverse"])):
                return KINDS[name]
        raise UsageError(
            f"{self.file}: no column is judged; name them J11.., g1.., M11.., h1.., p1.., tau1.. or qdd1.."
        )


def read_log(path: str | os.PathLike[str]) -> Log:
    """The numbers of a CSV file with one line of names. Rows with NaN or infinity are left out.

    Raises:
        UsageError: the file cannot be read, or a row of it holds what is no number.
    """
    file = os.fspath(path)
    try:
        with open(file, encoding="utf-8", newline="") as stream:
            reader = csv.reader(stream)
            names = [name.strip() for name in next(reader, [])]
            rows: list[list[float]] = []
            left_out: list[int] = []
            for number, row in enumerate(reader, start=2):
                if len(row) != len(names) or number > _MOST_ROWS:
                    raise UsageError(f"{file}:{number}: a row has {len(names)} numbers, got {len(row)}")
                numbers = _numbers(f"{file}:{number}", names, row)
                if all(map(math.isfinite, numbers)):
                    rows.append(numbers)
                else:
                    left_out.append(number)
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise UsageError(f"{file}: this file cannot be read: {getattr(error, 'strerror', None) or error}") from None
    if not rows:
        raise UsageError(f"{file}: the log has no rows{' of finite numbers' if left_out else ''}")
    if len(names) != len(set(names)):
        twice = next(name for name in names if names.count(name) > 1)
        raise UsageError(f"{file}:1: two columns are named {twice!r}")
    return Log(file, dict(zip(names, np.array(rows).T, strict=True)), left_out)


def _numbers(place: str, names: list[str], row: list[str]) -> list[float]:
    """The numbers of a row; NaN and infinity are some.

    Raises:
        UsageError: a cell holds no number, or one that no measured quantity has.
    """
    found = []
    for name, cell in zip(names, row, strict=True):
        try:
            found.append(float(cell))
        except ValueError:
            raise UsageError(f"{place}: {name} is a number, got {cell[:80]!r}") from None
        if LARGEST < abs(found[-1]) < math.inf:
            raise UsageError(f"{place}: {name} is at most {LARGEST:g} either way, got {cell[:80]!r}")
    return found
