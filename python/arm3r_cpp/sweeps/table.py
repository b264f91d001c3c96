"""The table of a finished sweep, read from its folder."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from .._files import regular
from .._messages import no_column
from ..answers.refusals import Refusal
from ..errors import UsageError
from .axes import SweepAxis
from .folder import LEDGER, count_outcomes, read_manifest, refusals_in, sha256
from .table_io import decode

Found = TypeVar("Found")


class SweepTable:
    """The table of a sweep: `table["peak_force"]` is a column of one number a run, in the order of the runs.

    Columns are float64 in SI units and radians, NaN where a run has no such number; outcomes and words are text.

    Attributes:
        path: the file, table.csv or table.parquet.
        axes: what varied, in order.
        mode: "grid", "list", "random" or "latin_hypercube".
        units: by column; "" for none.
        scenario: the base scenario, as YAML.
        version: of the program that computed the table.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        """Read from a sweep's folder.

        Raises:
            UsageError: there is no finished sweep in it.
        """
        self.folder = Path(folder)
        manifest = read_manifest(self.folder)
        self._kind = manifest["table"]
        self.path = self.folder / f"table.{self._kind}"
        if not self.path.is_file():
            raise UsageError(f"{self.folder}: the sweep is not finished; go on with --resume", code="file")
        self._runs: int = manifest["runs"]
        self.mode: str = manifest["mode"]
        self.units: dict[str, str] = manifest["columns"]
        self.axes = [SweepAxis(**axis) for axis in manifest["axes"]]
        self.scenario: str = manifest["scenario"]
        self.version: str = manifest["version"]

    @cached_property
    def _columns(self) -> dict[str, NDArray[Any]]:
        """The columns by name. Raises UsageError: the table is damaged."""
        try:
            columns = decode(self.path, self._kind)
        except (OSError, ValueError, LookupError, StopIteration):
            columns = {}
        if list(columns) != self.names or {len(column) for column in columns.values()} != {self._runs}:
            raise UsageError(
                f"{self.path}: is not the table of {self._runs} runs; --resume makes it again", code="file"
            )
        return columns

    def __getitem__(self, name: str) -> NDArray[Any]:
        """A column.

        Raises:
            KeyError: there is no such column; the message names the nearest one.
        """
        if name in self.units:
            return self._columns[name]
        raise no_column(name, self.names)

    def __iter__(self) -> Iterator[str]:
        """The columns' names, in order."""
        return iter(self.units)

    def keys(self) -> list[str]:
        """The columns' names, in order: dict(table) is a dict of the columns."""
        return self.names

    def _ipython_key_completions_(self) -> list[str]:
        return self.names

    def __len__(self) -> int:
        """How many runs there are."""
        return len(self["run"])

    def __repr__(self) -> str:
        return f"<SweepTable {self.path}: {len(self)} runs>"

    @property
    def names(self) -> list[str]:
        """The columns' names, in order."""
        return list(self.units)

    @property
    def hash(self) -> str:
        """Of the table's file, "sha256:hex"."""
        return f"sha256:{sha256(self.path.read_bytes())}"

    @property
    def ok(self) -> NDArray[np.bool_]:
        """Which runs reached their end."""
        return self["outcome"] == "ok"

    @property
    def outcomes(self) -> dict[str, int]:
        """How many runs ended in which way, by ledger.jsonl. Raises UsageError: the file is damaged."""
        return self._of_ledger(count_outcomes)

    @property
    def refusals(self) -> list[Refusal]:
        """Why runs are invalid, by ledger.jsonl: each reason with how often it holds, the most frequent first.

        Raises:
            UsageError: the file is damaged.
        """
        return self._of_ledger(refusals_in)

    def _of_ledger(self, read: Callable[[Iterable[Mapping[str, Any]]], Found]) -> Found:
        try:
            with regular(self.folder / LEDGER).open("rb") as ledger:
                return read(map(json.loads, ledger))
        except (OSError, ValueError, RecursionError, KeyError, TypeError) as error:
            raise UsageError(f"{self.folder}: {LEDGER} is damaged; --resume repairs it", code="file") from error
