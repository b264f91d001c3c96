"""Values of MATLAB programs: arrays (states, rows, columns) of numbers or of what holds, texts, lists for cell arrays,
and dicts for structures."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..programs import ProgramError, Unread

Floats = NDArray[np.float64]
MAX_SIZE = 100
"""Rows or columns of a matrix."""


class Pages(list[Any]):
    """An array of three dimensions: a matrix for each place along the third."""


class Structures(list[Any]):
    """An array of structures, in one row: a dictionary for each."""


def check_size(rows: int, columns: int) -> None:
    if not (0 <= rows <= MAX_SIZE and 0 <= columns <= MAX_SIZE):
        raise Unread(f"a matrix of {rows} x {columns} is too large")


def number(value: float) -> Floats:
    return np.array([[[float(value)]]])


def integer(value: Any) -> int:
    """The value of a scalar that is the same whole number in every state."""
    if (
        not isinstance(value, np.ndarray)
        or value.shape[1:] != (1, 1)
        or not np.isfinite(value).all()
        or np.any(value != np.round(value[0]))
    ):
        raise ProgramError("a whole number is needed here, the same at every state")
    return int(value[0, 0, 0])


def stacked(parts: list[Floats], axis: int) -> Floats:
    """Matrices beside each other (axis 2) or below each other (axis 1)."""
    parts = [one for one in parts if one.size] or parts[:1]
    count = max((len(one) for one in parts), default=1)
    sizes = [sum(one.shape[1] for one in parts), max((one.shape[2] for one in parts), default=0)]
    if axis == 2:
        sizes = [max((one.shape[1] for one in parts), default=0), sum(one.shape[2] for one in parts)]
    check_size(*sizes)
    whole = [one if len(one) == count else np.broadcast_to(one, (count, *one.shape[1:])) for one in parts]
    return np.concatenate(whole, axis=axis)


def as_numbers(array: Any) -> Floats:
    """What comparisons give, as zeros and ones."""
    return array.astype(np.float64) if array.dtype == bool else np.asarray(array)


def text_in(value: Any) -> str:
    """
    Raises:
        Unread: it is not text.
    """
    if not isinstance(value, str):
        raise Unread("a text is needed here; what stands here is none, or is not read")
    return value
