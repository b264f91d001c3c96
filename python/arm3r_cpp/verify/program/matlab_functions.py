"""The functions of MATLAB that are known; every value is an array (states, rows, columns)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .nodes import ProgramError, Unread

Floats = NDArray[np.float64]
MAX_SIZE = 12
"""Rows or columns of a matrix."""


def _power(base: Floats, exponent: Floats) -> Floats:
    """Element by element; at one state with the bits of Python's `**`, which np.power does not always have."""
    if len(base) > 1 or len(exponent) > 1 or exponent.size > 1:
        return np.power(base, exponent)
    power = exponent.item()
    return base**power if base.size > 1 else np.full((1, 1, 1), np.float64(base.item()) ** power)


ELEMENTWISE: dict[str, Callable[..., Any]] = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "sqrt": np.sqrt,
    "abs": np.abs,
    "exp": np.exp,
    "log": np.log,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "atan2": np.arctan2,
    "sign": np.sign,
    "tanh": np.tanh,
    "deg2rad": np.deg2rad,
    "rad2deg": np.rad2deg,
    "sind": lambda x: np.sin(np.deg2rad(x)),
    "power": _power,
    "cosd": lambda x: np.cos(np.deg2rad(x)),
    "tand": lambda x: np.tan(np.deg2rad(x)),
    "hypot": np.hypot,
    "max": np.maximum,
    "min": np.minimum,
    "mod": np.mod,
    "floor": np.floor,
}
_OF_TWO = ("atan2", "power", "hypot", "max", "min", "mod")
OPERATORS: dict[str, Callable[..., Any]] = {
    "+": np.add,
    "-": np.subtract,
    ".*": np.multiply,
    "./": np.divide,
    ".^": _power,
}
COMPARISONS: dict[str, Callable[..., Any]] = {
    "==": np.equal,
    "~=": np.not_equal,
    "<": np.less,
    "<=": np.less_equal,
    ">": np.greater,
    ">=": np.greater_equal,
    **dict.fromkeys(("&&", "&"), np.logical_and),
    **dict.fromkeys(("||", "|"), np.logical_or),
}


def counted(name: str, parts: list[Any], count: int) -> list[Any]:
    """The arguments of a function that takes so many."""
    if len(parts) != count:
        raise ProgramError(f"{name} takes {count} argument{'s' if count > 1 else ''}, got {len(parts)}")
    return parts


def check_size(rows: int, columns: int) -> None:
    if not (0 <= rows <= MAX_SIZE and 0 <= columns <= MAX_SIZE):
        raise Unread(f"a matrix of {rows} x {columns} is too large")


def number(value: float) -> Floats:
    return np.array([[[float(value)]]])


def integer(value: Floats) -> int:
    """The value of a scalar that is the same whole number in every state."""
    if value.shape[1:] != (1, 1) or not np.isfinite(value).all() or np.any(value != np.round(value[0])):
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


class Pages(list[Any]):
    """An array of three dimensions: a matrix for each place along the third."""


def _filled(name: str, parts: list[Floats]) -> Any:
    sizes = [integer(part) for part in parts] or [1]
    if len(sizes) == 3:
        check_size(1, sizes[2])
        return Pages([_filled(name, parts[:2])] * sizes[2])
    if len(sizes) > 3:
        raise Unread(f"{name} of more than three dimensions is not read")
    rows, columns = (sizes * 2)[:2]
    check_size(rows, columns)
    return (np.eye(rows, columns) if name == "eye" else np.full((rows, columns), float(name == "ones")))[None]


def _product_of_vectors(name: str, parts: list[Floats]) -> Floats:
    first, second = counted(name, parts, 2)
    flat = [np.swapaxes(one, 1, 2).reshape(len(one), -1) for one in (first, second)]
    if name == "dot":
        return np.asarray(np.sum(flat[0] * flat[1], axis=1)[:, None, None])
    if flat[0].shape[1] != 3 or flat[1].shape[1] != 3:
        raise ProgramError("cross takes two vectors of three numbers")
    product = np.cross(flat[0], flat[1])
    return product[:, :, None] if first.shape[2] == 1 else product[:, None, :]


def _along(name: str, parts: list[Floats]) -> Floats:
    """sum, prod and cumsum, of columns unless the matrix is a row or the dimension is given."""
    array, *given = parts if len(parts) == 2 else counted(name, parts, 1)
    axis = integer(given[0]) if given else 2 if array.shape[1] == 1 else 1
    if axis not in (1, 2):
        raise Unread(f"{name} of a matrix goes along dimension 1 or 2")
    if name == "cumsum":
        return array.cumsum(axis=axis)
    return np.asarray((np.sum if name == "sum" else np.prod)(array, axis=axis, keepdims=True))


def _reshaped(name: str, parts: list[Floats]) -> Floats:
    """reshape(A, rows, columns), reshape(A, [rows, columns]), column by column; one size may be []."""
    array, *sizes = parts
    if len(sizes) == 1 and sizes[0].shape[1:] == (1, 2):
        sizes = [sizes[0][:, :, :1], sizes[0][:, :, 1:]]
    if len(sizes) != 2:
        raise ProgramError("reshape takes a matrix, and its new rows and columns")
    count = array.shape[1] * array.shape[2]
    rows, columns = (integer(one) if one.size else -1 for one in sizes)
    if 0 in (rows, columns) and count:
        raise ProgramError(f"{count} numbers do not fill {max(rows, 0)} x {max(columns, 0)}")
    rows, columns = (count // max(columns, 1) if rows < 0 else rows, count // max(rows, 1) if columns < 0 else columns)
    check_size(rows, columns)
    if rows * columns != count:
        raise ProgramError(f"{count} numbers do not fill {rows} x {columns}")
    return np.swapaxes(np.swapaxes(array, 1, 2).reshape(len(array), columns, rows), 1, 2)


def _diagonal(name: str, parts: list[Floats]) -> Floats:
    (array,) = counted(name, parts, 1)
    if 1 not in array.shape[1:]:
        return np.diagonal(array, axis1=1, axis2=2)[:, :, None]
    diagonal = array.reshape(len(array), -1)
    return np.asarray(diagonal[:, :, None] * np.eye(diagonal.shape[1]))


def _blocks(name: str, parts: list[Floats]) -> Floats:
    """The matrices along the diagonal of a larger one."""
    width = sum(part.shape[2] for part in parts)
    rows, left = [], 0
    for part in parts:
        right = width - left - part.shape[2]
        rows.append(np.pad(part, ((0, 0), (0, 0), (left, right))))
        left += part.shape[2]
    return stacked(rows, 1)


def _size(name: str, parts: list[Any]) -> Floats:
    """numel, length, and size(A, dimension)."""
    array, *given = parts
    if isinstance(array, Pages):
        if len(given) != 1 or integer(given[0]) != 3:
            raise Unread("the size of an array of three dimensions is read along the third")
        return number(len(array))
    shape = (1, len(array)) if isinstance(array, list) else array.shape[1:]
    if name == "size":
        if len(given) != 1 or integer(given[0]) not in (1, 2):
            raise Unread("size takes a matrix and the dimension 1 or 2")
        return number(shape[integer(given[0]) - 1])
    counted(name, parts, 1)
    return number(max(shape) if name == "length" else shape[0] * shape[1])


def _cell(name: str, parts: list[Floats]) -> list[None]:
    sizes = [integer(part) for part in parts]
    if not sizes or max(sizes) > MAX_SIZE or (len(sizes) > 1 and min(sizes) != 1):
        raise Unread(f"a cell array of {' x '.join(map(str, sizes))} is too large: one row or column is read")
    return [None] * max(sizes)


def _of_one(function: Callable[[Floats], Any]) -> Callable[[str, list[Floats]], Floats]:
    return lambda name, parts: np.asarray(function(*counted(name, parts, 1)), np.float64)


_OTHERS: dict[str, Callable[[str, list[Any]], Any]] = {
    "transpose": _of_one(lambda array: np.swapaxes(array, 1, 2)),
    "inv": _of_one(np.linalg.inv),
    **dict.fromkeys(("eye", "zeros", "ones"), _filled),
    "diag": _diagonal,
    "det": _of_one(lambda array: np.linalg.det(array)[:, None, None]),
    "trace": _of_one(lambda array: np.trace(array, axis1=1, axis2=2)[:, None, None]),
    **dict.fromkeys(("cross", "dot"), _product_of_vectors),
    "norm": _of_one(lambda array: np.sqrt(np.sum(array**2, axis=(1, 2)))[:, None, None]),
    **dict.fromkeys(("sum", "prod", "cumsum"), _along),
    "double": _of_one(lambda array: array),
    "reshape": _reshaped,
    "blkdiag": _blocks,
    "horzcat": lambda name, parts: stacked(parts, 2),
    "vertcat": lambda name, parts: stacked(parts, 1),
    **dict.fromkeys(("numel", "length", "size"), _size),
    "cell": _cell,
    "pi": lambda name, parts: number(np.pi),
    "true": lambda name, parts: number(1),
    "false": lambda name, parts: number(0),
}
FUNCTIONS = (*ELEMENTWISE, *_OTHERS)


def result_of(name: str, parts: list[Any]) -> Any:
    """What one of FUNCTIONS returns; a cell array is a list.

    Raises:
        ProgramError: the arguments are not what it takes.
    """
    if any(isinstance(part, Pages) for part in parts) and name != "size":
        raise Unread(f"{name} of an array of three dimensions is not read")
    if name in ELEMENTWISE:
        return ELEMENTWISE[name](*counted(name, parts, 2 if name in _OF_TWO else 1))
    if any(not isinstance(part, np.ndarray) for part in parts) and name not in ("numel", "length", "size"):
        raise ProgramError(f"{name} takes numbers")
    return _OTHERS[name](name, parts)
