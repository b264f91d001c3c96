"""The rows of the runs of a batch."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .._messages import no_column
from .._native import Floats, column_places
from ..errors import ColumnError
from .names import columns_of, completions, three_of


class BatchRows:
    """Columns over time of many runs: `batch.rows["q1"]` is an array of the batch's shape and, last, of the rows.

    `rows["q"]` and `rows["tip"]` are three columns at once, (..., rows, 3). Columns are read-only float64 in SI units
    and radians, views of one block of memory; each run's have the bits of its own log. NaN stands after the last row of
    a run, and where a run does not have a column.

    Attributes:
        shape: of the batch.
        columns: their names, in order; the first is t.
    """

    def __init__(self, columns: Sequence[str], block: Floats, shape: tuple[int, ...]) -> None:
        """`Scenario.batch` makes them. block: (runs, columns, rows)."""
        self.columns = list(columns)
        self.shape = shape
        self._block = block
        block.flags.writeable = False

    def __reduce__(self) -> tuple[object, ...]:
        return BatchRows, (self.columns, self._block, self.shape)

    def __getitem__(self, name: str) -> Floats:
        """A column, (..., rows), s, rad, ...; or three at once, such as "q" or "tip", as a new (..., rows, 3).

        Raises:
            ColumnError: there is no such column; the message names the nearest one.
            TypeError: it is not a name.
        """
        if not isinstance(name, str):
            raise TypeError(f"a column's name is needed, such as rows['q1'], got {name!r}; runs are rows['q1'][0]")
        if name in self.columns:
            column = self._block[:, self.columns.index(name)]
            return column.reshape(*self.shape, column.shape[-1]) if self.shape else column[0]
        if parts := three_of(name, self.columns):
            return np.stack([self[part] for part in parts], axis=-1)
        if columns_of(name, column_places()):
            message = f"this batch was not asked for {name!r}: add it to columns"
            raise ColumnError(f"{message}; there are {', '.join(self)}", code="usage")
        raise no_column(name, self.columns)

    def __contains__(self, name: object) -> bool:
        """Whether rows[name] is there."""
        return name in self.columns or (isinstance(name, str) and bool(three_of(name, self.columns)))

    def __iter__(self) -> Iterator[str]:
        """The columns' names, in order."""
        return iter(self.columns)

    def keys(self) -> list[str]:
        """The columns' names, in order: dict(rows) is a dict of the columns."""
        return list(self.columns)

    def _ipython_key_completions_(self) -> list[str]:
        return completions(self.columns)

    def __repr__(self) -> str:
        runs, _, rows = self._block.shape
        return f"<BatchRows of {runs} runs: {', '.join(self.columns)}; at most {rows} rows each>"

    @property
    def t(self) -> Floats:
        """Time: (..., rows), s."""
        return self["t"]

    @cached_property
    def counts(self) -> NDArray[np.intp]:
        """How many rows each run has: in the shape of the batch; 0 of one that was not begun."""
        counts = np.count_nonzero(~np.isnan(self.t), axis=-1)
        return np.asarray(counts, np.intp)

    @property
    def nbytes(self) -> int:
        """How much memory they take: 8 bytes for each run, column and row."""
        return self._block.nbytes
