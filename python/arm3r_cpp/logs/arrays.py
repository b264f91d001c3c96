"""Reads the columns of a log from the arrays of a file of numpy or MATLAB."""

from __future__ import annotations

import tokenize
import zipfile
import zlib
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import IO, Any

import numpy as np

from .._files import regular
from .._native import Floats
from ..errors import UsageError
from .mat_file import MatFile

ENDINGS = (".npy", ".npz", ".mat")
_BROKEN = (
    *(zipfile.BadZipFile, zlib.error, EOFError, KeyError, ValueError, RuntimeError, MemoryError),
    *(SyntaxError, tokenize.TokenError),  # of the head of a .npy, which is a literal of Python
)
_MOST_BYTES = 1 << 30
_MOST_COLUMNS = 200


class Cells(Sequence[list[str]]):
    """The rows of an array, as text."""

    def __init__(self, numbers: Floats) -> None:
        self._numbers = numbers

    def __len__(self) -> int:
        return len(self._numbers)

    def __getitem__(self, row: Any) -> Any:
        return [repr(float(number)) for number in self._numbers[row]]


def read_arrays(file: str) -> tuple[list[str], Floats]:
    """The names of the columns, q1 for the first one of an array q, and their numbers (rows, columns).

    A plain .npy has the columns 1, 2, ...; fields of structures go by their own names.

    Raises:
        UsageError: the file cannot be read, or its arrays have no rows in common.
    """
    try:
        return _read(file)
    except OSError as error:
        why = str(error.strerror or error)
    except _BROKEN as error:
        why = str(error).split("\n")[0][:200] or type(error).__name__
    raise UsageError(f"{file}: this file cannot be read: {why}", code="file.log")


def _read(file: str) -> tuple[list[str], Floats]:
    """
    Raises:
        ValueError: the arrays make no log.
    """
    arrays: dict[str, np.ndarray] = {}
    for name, array in _numeric(_loaded(file)):
        if name in arrays:
            raise ValueError(f"two arrays are named {name!r}")
        arrays[name] = array
    if not arrays:
        raise ValueError("it holds no arrays of numbers")
    shared = [size for array in arrays.values() for size in set(array.shape)]
    rows = max(shared, key=lambda size: (shared.count(size), size))  # what most arrays have, the longest of these
    if len(arrays) == 1:
        rows = next(iter(arrays.values())).shape[0]
    columns = dict(_columns(arrays, rows))
    if not columns or rows == 1:
        raise ValueError("its arrays have no rows in common")
    if len(columns) > _MOST_COLUMNS:
        raise ValueError(f"it has {len(columns)} columns, more than {_MOST_COLUMNS}")
    return list(columns), np.stack(list(columns.values()), axis=1)


def _loaded(file: str) -> Any:
    """An array, or arrays and structures by their names.

    Raises:
        OSError: it cannot be opened.
        Others of `_BROKEN`: it is broken.
    """
    path = regular(Path(file))
    if path.stat().st_size > _MOST_BYTES:
        raise ValueError("it is larger than a gigabyte")
    if file.endswith(".mat"):
        return MatFile(path.read_bytes()).variables
    if file.endswith(".npz"):
        with zipfile.ZipFile(path) as archive:
            if sum(one.file_size for one in archive.infolist()) > _MOST_BYTES:
                raise ValueError("its arrays are larger than a gigabyte")
            return {name.removesuffix(".npy"): _array(archive.open(name)) for name in archive.namelist()}
    array = _array(path.open("rb"))
    return array if array.dtype.names else {"": array}


def _array(stream: IO[bytes]) -> np.ndarray:
    with stream:
        return np.lib.format.read_array(stream, allow_pickle=False)


def _numeric(found: Any, name: str = "") -> Iterator[tuple[str, np.ndarray]]:
    """The arrays of numbers of a file, and of its structures, by their own names."""
    if isinstance(found, Mapping):
        for key, value in found.items():
            yield from _numeric(value, key)
    elif isinstance(found, np.ndarray) and found.dtype.names:
        for key in found.dtype.names:
            yield from _numeric(found[key], key)
    elif isinstance(found, np.ndarray) and found.dtype.kind in "fiu" and 1 <= found.ndim <= 3 and found.size:
        yield name, found.astype(np.float64)


def _columns(arrays: Mapping[str, np.ndarray], rows: int) -> Iterator[tuple[str, Floats]]:
    """q1, q2, ... of an array q with a row for each sample, or a column; J11, ... of one with pages."""
    for name, array in arrays.items():
        if rows not in array.shape:
            continue
        axis = array.shape.index(rows) if array.ndim < 3 or array.shape[0] == rows else array.ndim - 1
        if array.shape[axis] != rows:
            continue
        array = np.moveaxis(array, axis, 0)
        if array.ndim == 1:
            yield name or "1", array
        elif array.ndim == 2 and array.shape[1] == 1:
            yield name or "1", array[:, 0]
        else:
            places = product(*(range(1, size + 1) for size in array.shape[1:]))
            for place, column in zip(places, array.reshape(rows, -1).T, strict=True):
                yield name + "".join(map(str, place)), column
