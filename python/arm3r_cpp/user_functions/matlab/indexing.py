"""Takes and sets parts of MATLAB's arrays; places count from 0, and an array is (states, rows, columns)."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..programs import ProgramError, Unread
from .values import MAX_SIZE, Floats, check_size

Places = list[int]


def check_places(places: Places, size: int) -> None:
    """
    Raises:
        ProgramError: one of them lies outside.
    """
    if any(not 0 <= place < size for place in places):
        raise ProgramError(f"index {max(places, default=0) + 1} is out of range: there are {size} elements")


def flat(array: Floats) -> Floats:
    """The elements column by column."""
    return np.swapaxes(array, 1, 2).reshape(len(array), array.shape[1] * array.shape[2])


def part_of(array: Floats, places: list[Places], is_all: bool) -> Floats:
    """A(i) or A(i, j); is_all: whether the only index is a colon, which gives a column."""
    rows, columns = array.shape[1:]
    if len(places) == 1:
        elements = flat(array)
        check_places(places[0], elements.shape[1])
        chosen = elements[:, places[0]]
        return chosen[:, None, :] if rows == 1 and not is_all else chosen[:, :, None]
    check_places(places[0], rows)
    check_places(places[1], columns)
    return array[:, places[0]][:, :, places[1]]


def with_part(array: Floats | None, places: list[Places], given: Floats) -> Floats:
    """The array with elements replaced; it grows as far as needed, with zeros.

    Raises:
        ProgramError: a place is out of range.
    """
    array = np.zeros((1, 0, 0)) if array is None else array
    sizes = [*array.shape[1:]]
    if len(places) == 1 and min(sizes) > 1:
        return _with_flat_part(array, places[0], given)
    if len(places) == 1:
        is_row = sizes[0] == 1 or not array.size
        places = [[0], places[0]] if is_row else [places[0], [0]]
    shape = [max(size, 1 + max(one, default=0)) for size, one in zip(sizes, places, strict=True)]
    if max(shape) > MAX_SIZE or min(min(one, default=0) for one in places) < 0:
        raise ProgramError("an index is out of range")
    result = np.zeros((max(len(array), len(given)), *shape))
    result[:, : sizes[0], : sizes[1]] = array
    if 1 in given.shape[1:] and given.size == len(given) * len(places[0]) * len(places[1]):
        given = given.reshape(len(given), len(places[0]), len(places[1]))
    result[np.ix_(range(len(result)), *places)] = given
    return result


def _with_flat_part(array: Floats, places: Places, given: Floats) -> Floats:
    """A(:) = ..., A(5) = ... of a matrix: its elements count column by column."""
    count, rows, columns = array.shape
    check_places(places, rows * columns)
    elements = np.repeat(flat(array), max(len(given) // count, 1), axis=0)
    elements[:, places] = flat(given)
    return np.swapaxes(elements.reshape(len(elements), columns, rows), 1, 2)


def without(array: Floats, places: list[Places], is_all: list[bool]) -> Floats:
    """A(i, :) = []: the array without rows, columns, or elements of a vector.

    Raises:
        Unread: neither whole rows nor whole columns.
    """
    if len(places) == 1 and 1 in array.shape[1:]:
        axis, gone = (2 if array.shape[1] == 1 else 1), places[0]
    elif len(places) == 2 and any(is_all):
        axis = 2 if is_all[0] else 1
        gone = places[axis - 1]
    else:
        raise Unread("whole rows or columns of a matrix are left out")
    check_places(gone, array.shape[axis])
    return np.delete(array, gone, axis=axis)


def with_element(held: list[Any] | None, place: int, given: Any) -> list[Any]:
    """A cell array or an array of structures with an element replaced or appended."""
    check_size(1, place + 1)
    if place < 0:
        raise ProgramError("an index is out of range")
    result = [*(held or ()), *[None] * (place + 1 - len(held or ()))]
    result[place] = given
    return type(held)(result) if held is not None else result
