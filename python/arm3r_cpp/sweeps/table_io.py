"""Tables as bytes: CSV, or Parquet where pyarrow is installed; the same numbers give the same bytes."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ..errors import UsageError

ROWS_AT_A_TIME = 2000
ROWS_OF_A_GROUP = 100_000  # at least, in Parquet: each group of rows takes memory and time of its own


def encode(columns: Mapping[str, NDArray[Any]], kind: str, go_on: Callable[[], Any]) -> bytes:
    """Rows of a table, without CSV's line of names. NaN becomes an empty cell, or null.

    go_on: called now and then; what it raises comes out.
    """
    if kind == "csv":
        return b"".join(_lines(list(columns.values()), go_on))
    arrow = pyarrow()
    out = io.BytesIO()
    table = arrow.table({name: arrow.array(column, from_pandas=True) for name, column in columns.items()})
    arrow.parquet.write_table(table, out)
    return out.getvalue()


def merge(pieces: Iterable[bytes], names: Sequence[str], kind: str, out: BinaryIO) -> None:
    """One table of its pieces, in their order; never more than one of them, or one group of rows, in memory."""
    if kind == "csv":
        out.write(f"{','.join(names)}\n".encode())
        for piece in pieces:
            out.write(piece)
        return
    writer = None
    for table in _groups(pieces):
        writer = writer or pyarrow().parquet.ParquetWriter(out, table.schema)
        writer.write_table(table)
    if writer:
        writer.close()


def _groups(pieces: Iterable[bytes]) -> Iterator[Any]:
    """The tables of Parquet's pieces, as many at a time as make a group of rows."""
    arrow = pyarrow()
    tables: list[Any] = []
    for piece in pieces:
        tables.append(arrow.parquet.read_table(io.BytesIO(piece)))
        if sum(table.num_rows for table in tables) >= ROWS_OF_A_GROUP:
            yield arrow.concat_tables(tables)
            tables = []
    if tables:
        yield arrow.concat_tables(tables)


def decode(path: Path, kind: str) -> dict[str, NDArray[Any]]:
    """The columns of a table, by name: float64, NaN where there is nothing; or text."""
    if kind == "parquet":
        table = pyarrow().parquet.read_table(path)
        return {name: column.to_numpy() for name, column in zip(table.column_names, table.columns, strict=True)}
    with path.open(newline="") as file:
        rows = csv.reader(file)
        names = next(rows)
        pieces = list(_pieces(rows))
    return {name: _column([piece[i] for piece in pieces]) for i, name in enumerate(names)}


def pyarrow() -> Any:
    """pyarrow with its Parquet part. UsageError: it is not installed."""
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError as error:
        raise UsageError("Parquet needs pyarrow: pip install 'arm3r_cpp[parquet]'", code="extra") from error
    return pyarrow


def _lines(columns: Sequence[NDArray[Any]], go_on: Callable[[], Any]) -> Iterator[bytes]:
    for first in range(0, len(columns[0]), ROWS_AT_A_TIME):
        go_on()
        cells = (_cells(column[first : first + ROWS_AT_A_TIME]) for column in columns)
        yield "".join(f"{','.join(row)}\n" for row in zip(*cells, strict=True)).encode()


def _cells(column: NDArray[Any]) -> list[str]:
    if column.dtype.kind == "f":
        return ["" if math.isnan(value) else repr(value).removesuffix(".0") for value in column.tolist()]
    return [_quoted(str(value)) for value in column.tolist()]


def _quoted(text: str) -> str:
    return '"' + text.replace('"', '""') + '"' if re.search('[,"\r\n]', text) else text


def _pieces(rows: Iterator[list[str]]) -> Iterator[list[NDArray[Any]]]:
    """The columns of some rows at a time: text takes more room than the numbers that it says."""
    while some := list(islice(rows, ROWS_AT_A_TIME)):
        yield [_numbers(cells) for cells in zip(*some, strict=True)]


def _numbers(cells: Sequence[str]) -> NDArray[Any]:
    try:
        return np.array([float(cell) if cell else math.nan for cell in cells])
    except ValueError:
        return np.array(cells)


def _column(pieces: Sequence[NDArray[Any]]) -> NDArray[Any]:
    return np.concatenate(pieces) if pieces else np.empty(0)
