"""The functions of MATLAB that are known; every value is an array (states, rows, columns)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..programs import ProgramError, Unread
from .values import MAX_SIZE, Floats, Pages, Structures, as_numbers, check_size, integer, number, stacked, text_in


def _power(base: Floats, exponent: Floats) -> Floats:
    """Element by element; at one state with the bits of Python's `**`, which np.power does not always have."""
    if np.any((base < 0) & (exponent != np.round(exponent))):
        raise Unread("a negative number to a power that is not whole is a complex number, and real ones are read")
    if len(base) > 1 or len(exponent) > 1 or exponent.size > 1:
        return np.power(base, exponent)
    power = exponent.item()
    return base**power if base.size > 1 else np.full((1, 1, 1), np.float64(base.item()) ** power)


def _wrapped(angle: Floats) -> Floats:
    """From 0 to 2 pi, which positive multiples of it keep."""
    rest = np.mod(angle, 2 * np.pi)
    return np.where((rest == 0) & (angle > 0), 2 * np.pi, rest)


def _real(function: Callable[..., Any], least: float, most: float = np.inf) -> Callable[..., Any]:
    """A function that is complex below and above two bounds."""

    def of(x: Floats) -> Any:
        if np.any((x < least) | (x > most)):
            name = function.__name__.replace("arc", "a")
            raise Unread(f"{name} of {x[(x < least) | (x > most)][0]:.3g} is a complex number, and real ones are read")
        return function(x)

    return of


_ARCSINE, _ARCCOSINE = _real(np.arcsin, -1, 1), _real(np.arccos, -1, 1)

ELEMENTWISE: dict[str, Callable[..., Any]] = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "sqrt": _real(np.sqrt, 0),
    "abs": np.abs,
    "exp": np.exp,
    "log": _real(np.log, 0),
    "asin": _ARCSINE,
    "acos": _ARCCOSINE,
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
    "mod": np.mod,
    "floor": np.floor,
    "ceil": np.ceil,
    "fix": np.trunc,
    "round": lambda x: np.copysign(np.floor(np.abs(x) + 0.5), x),
    "rem": np.fmod,
    "sec": lambda x: 1 / np.cos(x),
    "csc": lambda x: 1 / np.sin(x),
    "cot": lambda x: 1 / np.tan(x),
    "sinh": np.sinh,
    "cosh": np.cosh,
    "asind": lambda x: np.rad2deg(_ARCSINE(x)),
    "acosd": lambda x: np.rad2deg(_ARCCOSINE(x)),
    "atand": lambda x: np.rad2deg(np.arctan(x)),
    "atan2d": lambda y, x: np.rad2deg(np.arctan2(y, x)),
    "log10": _real(np.log10, 0),
    "log2": _real(np.log2, 0),
    "wrapToPi": lambda x: np.where(np.abs(x) > np.pi, _wrapped(x + np.pi) - np.pi, x),
    "wrapTo2Pi": lambda x: _wrapped(x),
    "isnan": np.isnan,
    "isinf": np.isinf,
    "isfinite": np.isfinite,
    "plus": np.add,
    "minus": np.subtract,
    "times": np.multiply,
    "rdivide": np.divide,
    "uminus": np.negative,
    **dict.fromkeys(("real", "conj", "double", "full"), np.positive),
    "imag": np.zeros_like,
    "not": np.logical_not,
    "and": np.logical_and,
    "or": np.logical_or,
    "xor": np.logical_xor,
    "logical": lambda x: x != 0,
    "isreal": lambda x: np.ones((1, 1, 1)),
    "isnumeric": lambda x: np.ones((1, 1, 1)),
}
_OF_TWO = ("atan2", "atan2d", "power", "hypot", "mod", "rem", "plus", "minus", "times", "rdivide", "and", "or", "xor")
OPERATORS: dict[str, Callable[..., Any]] = {
    "+": np.add,
    "-": np.subtract,
    ".*": np.multiply,
    "./": np.divide,
    ".^": _power,
    ".\\": lambda left, right: right / left,
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
    """The arguments of a function of which so many are read; MATLAB may take more.

    Raises:
        ProgramError: there are fewer.
        Unread: there are more.
    """
    if len(parts) > count:
        raise Unread(f"{name} is read with {count} argument{'' if count == 1 else 's'}, got {len(parts)}")
    if len(parts) < count:
        raise ProgramError(f"{name} takes {count} argument{'' if count == 1 else 's'}, got {len(parts)}")
    return parts


_VALUES = {"zeros": 0.0, "ones": 1.0, "nan": np.nan, "NaN": np.nan, "inf": np.inf, "Inf": np.inf}


def _filled(name: str, parts: list[Any]) -> Any:
    """zeros(3), zeros(2, 3), zeros([2 3]); a class or 'like' behind the sizes changes nothing."""
    parts = parts[: next((place for place, part in enumerate(parts) if isinstance(part, str)), len(parts))]
    if len(parts) == 1 and isinstance(parts[0], np.ndarray) and parts[0].size > len(parts[0]):
        parts = [parts[0][:, :1, [column]] for column in range(parts[0].shape[2])]
    sizes = [integer(part) for part in parts] or [1]
    if len(sizes) == 3:
        check_size(1, sizes[2])
        return Pages([_filled(name, parts[:2])] * sizes[2])
    if len(sizes) > 3:
        raise Unread(f"{name} of more than three dimensions is not read")
    rows, columns = (sizes * 2)[:2]
    check_size(rows, columns)
    return (np.eye(rows, columns) if name == "eye" else np.full((rows, columns), _VALUES[name]))[None]


def _product_of_vectors(name: str, parts: list[Floats]) -> Floats:
    first, second = counted(name, parts[:2] if len(parts) == 3 else parts, 2)
    flat = [np.swapaxes(one, 1, 2).reshape(len(one), -1) for one in (first, second)]
    if name == "dot":
        return np.asarray(np.sum(flat[0] * flat[1], axis=1)[:, None, None])
    if flat[0].shape[1] != 3 or flat[1].shape[1] != 3:
        raise ProgramError("cross takes two vectors of three numbers")
    product = np.cross(flat[0], flat[1])
    return product[:, :, None] if first.shape[2] == 1 else product[:, None, :]


def _along(name: str, parts: list[Floats]) -> Floats:
    """sum, prod, mean, cumsum and their like, of columns unless the matrix is a row or the dimension is given."""
    array, *given = parts if len(parts) in (2, 3) else counted(name, parts, 1)
    if given and isinstance(given[-1], str):
        if given[-1] != "all":
            raise Unread(f"{name} with {given[-1]!r} is not read")
        array, given = array.reshape(len(array), 1, -1), []
    given = [one for one in given if one.size]  # max(A, [], 2)
    axis = integer(given[0]) if given else 2 if array.shape[1] == 1 else 1
    if axis not in (1, 2):
        raise Unread(f"{name} of a matrix goes along dimension 1 or 2")
    if name in ("cumsum", "cumprod"):
        return np.asarray((np.cumsum if name == "cumsum" else np.cumprod)(array, axis=axis))
    return np.asarray(_ALONG[name](array, axis=axis, keepdims=True))


_ALONG: dict[str, Callable[..., Any]] = {
    "sum": np.sum,
    "prod": np.prod,
    "mean": np.mean,
    "max": np.max,
    "min": np.min,
    "any": np.any,
    "all": np.all,
}


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
    """numel, length, size(A), size(A, dimension), isempty and their like."""
    array, *given = parts
    if isinstance(array, Pages):
        if len(given) != 1 or integer(given[0]) != 3:
            raise Unread("the size of an array of three dimensions is read along the third")
        return number(len(array))
    shape = (1, len(array)) if isinstance(array, (list, str)) else (1, 1)
    shape = array.shape[1:] if isinstance(array, np.ndarray) else shape
    if name == "size" and not given:
        return np.array([[[float(one) for one in shape]]])
    if name == "size":
        if len(given) != 1 or integer(given[0]) not in (1, 2):
            raise Unread("size takes a matrix and the dimension 1 or 2")
        return number(shape[integer(given[0]) - 1])
    counted(name, parts, 1)
    return number(
        {
            "length": max(shape) if min(shape) else 0,
            "numel": shape[0] * shape[1],
            "ndims": 2,
            "isempty": 0 in shape,
            "isscalar": shape == (1, 1),
            "isvector": 1 in shape,
            "isrow": shape[0] == 1,
            "iscolumn": shape[1] == 1,
            "ismatrix": True,
        }[name]
    )


_SIZES = ("numel", "length", "size", "ndims", "isempty", "isscalar", "isvector", "isrow", "iscolumn", "ismatrix")


def _largest(name: str, parts: list[Floats]) -> Floats:
    """max and min of two, or along a matrix."""
    if len(parts) == 2:
        return np.asarray((np.maximum if name == "max" else np.minimum)(*parts))
    return _along(name, parts)


_ORDERS = {"fro": 2.0, "inf": np.inf, "Inf": np.inf}


def _lengths(name: str, parts: list[Floats]) -> Floats:
    """vecnorm(A), vecnorm(A, 2, dimension)."""
    array, *given = parts
    if len(given) > 2 or (given and integer(given[0]) != 2):
        raise Unread(f"{name} is read with the order 2")
    return np.sqrt(_along("sum", [array**2, *given[1:]]))


def _norm(name: str, parts: list[Any]) -> Floats:
    """norm(v), norm(v, p), norm(A, 'fro'): a matrix without an order has its largest singular value."""
    array, *order = parts
    given = order[0] if order else number(2)
    is_of_elements = isinstance(given, str) and given == "fro"
    if isinstance(given, str) and given not in _ORDERS:
        raise Unread(f"norm with {given!r} is not read")
    kind = _ORDERS[given] if isinstance(given, str) else float(given.ravel()[0])
    if 1 in array.shape[1:] or is_of_elements:
        return np.linalg.norm(array.reshape(len(array), -1), kind, axis=1)[:, None, None]
    return np.asarray(np.linalg.norm(array, kind, axis=(1, 2)))[:, None, None]


def _repeated(name: str, parts: list[Any]) -> Floats:
    """repmat(A, n), repmat(A, rows, columns)."""
    array, *sizes = parts
    if len(sizes) == 1 and sizes[0].shape[1:] == (1, 2):
        sizes = [sizes[0][:, :, :1], sizes[0][:, :, 1:]]
    rows, columns = ([integer(one) for one in sizes] * 2)[:2]
    check_size(rows * array.shape[1], columns * array.shape[2])
    return np.tile(array, (1, rows, columns))


def _kron(name: str, parts: list[Floats]) -> Floats:
    first, second = counted(name, parts, 2)
    rows, columns = first.shape[1] * second.shape[1], first.shape[2] * second.shape[2]
    check_size(rows, columns)
    product = first[:, :, None, :, None] * second[:, None, :, None, :]
    return product.reshape(len(product), rows, columns)


def _triangle(name: str, parts: list[Floats]) -> Floats:
    array, *offset = parts
    return (np.triu if name == "triu" else np.tril)(array, integer(offset[0]) if offset else 0)


def _spaced(name: str, parts: list[Floats]) -> Floats:
    first, last, *count = parts
    number_of = integer(count[0]) if count else 100
    check_size(1, number_of)
    return first + (last - first) * (np.arange(number_of) / max(number_of - 1, 1))[None, None]


def _structure(name: str, parts: list[Any]) -> Any:
    """struct('a', 1, 'b', 2); a cell array of several elements makes as many structures."""
    if len(parts) % 2:
        raise ProgramError("struct takes names and values in pairs")
    pairs = [(text_in(key), value) for key, value in zip(parts[::2], parts[1::2], strict=True)]
    counts = {len(value) for _, value in pairs if isinstance(value, list) and len(value) != 1}
    if not counts:
        return {key: value[0] if isinstance(value, list) else value for key, value in pairs}
    count = counts.pop()
    return Structures(
        {key: value[place if len(value) > 1 else 0] if isinstance(value, list) else value for key, value in pairs}
        for place in range(count)
    )


def _is_field(name: str, parts: list[Any]) -> Floats:
    held, key = counted(name, parts, 2)
    held = held[0] if isinstance(held, Structures) and held else held
    return number(isinstance(held, dict) and any(one == key or one.startswith(f"{key}.") for one in held))


def _compared(name: str, parts: list[Any]) -> Floats:
    """strcmp, strcmpi, isequal."""
    first, second = counted(name, parts, 2)
    if isinstance(first, np.ndarray) and isinstance(second, np.ndarray):
        same = first.shape[1:] == second.shape[1:]
        return np.all(first == second, axis=(1, 2))[:, None, None] if same else number(0)
    if name == "strcmpi" and isinstance(first, str) and isinstance(second, str):
        first, second = first.lower(), second.lower()
    return number(isinstance(first, str) and first == second)


def _is_kind(name: str, parts: list[Any]) -> Floats:
    kinds: dict[str, Any] = {"ischar": str, "isstring": str, "iscell": list, "isstruct": (dict, Structures)}
    (value,) = counted(name, parts, 1)
    return number(isinstance(value, kinds[name]) and not (name == "iscell" and isinstance(value, Structures)))


def _in_letters(name: str, parts: list[Any]) -> str:
    text = text_in(*counted(name, parts, 1))
    return text.lower() if name == "lower" else text.upper()


def _is_of_class(name: str, parts: list[Any]) -> Floats:
    value, kind = counted(name, parts, 2)
    return number(isinstance(value, np.ndarray) and isinstance(kind, str) and kind in ("double", "float", "numeric"))


def _elements(name: str, parts: list[Floats]) -> list[Floats]:
    """num2cell of a vector."""
    (array,) = counted(name, parts, 1)
    if 1 not in array.shape[1:]:
        raise Unread(f"{name} of a matrix is not read; a cell array has one row")
    return [one[:, None, None] for one in array.reshape(len(array), -1).T]


def _failed(name: str, parts: list[Any]) -> Any:
    """error(...), and assert(...) of what does not hold."""
    if name == "assert" and np.all(parts[0] != 0):
        return number(1)
    texts = [one for one in parts if isinstance(one, str)]
    raise ProgramError(f"raises the error {texts[-1]!r}" if texts else f"raises an {name}")


def _matrix_of_cells(name: str, parts: list[Any]) -> Floats:
    (cells,) = counted(name, parts, 1)
    if not isinstance(cells, list) or not all(isinstance(one, np.ndarray) for one in cells):
        raise ProgramError(f"{name} takes a cell array of numbers")
    return stacked(cells, 2)


def _flipped(name: str, parts: list[Floats]) -> Floats:
    (array,) = counted(name, parts, 1)
    axis = {"fliplr": 2, "flipud": 1, "flip": 2 if array.shape[1] == 1 else 1}[name]
    return np.flip(array, axis)


def _cell(name: str, parts: list[Floats]) -> list[None]:
    sizes = [integer(part) for part in parts]
    if not sizes or max(sizes) > MAX_SIZE or (len(sizes) > 1 and min(sizes) != 1):
        raise Unread(f"a cell array of {' x '.join(map(str, sizes))} is too large: one row or column is read")
    return [None] * max(sizes)


def _of_one(function: Callable[[Floats], Any]) -> Callable[[str, list[Floats]], Floats]:
    return lambda name, parts: np.asarray(function(*counted(name, parts, 1)), np.float64)


def _constant(value: float) -> Callable[[str, list[Floats]], Floats]:
    def found(name: str, parts: list[Floats]) -> Floats:
        counted(name, parts, 0)
        return number(value)

    return found


_BESIDE_NUMBERS: dict[str, Callable[[str, list[Any]], Any]] = {
    **dict.fromkeys(_SIZES, _size),
    "struct": _structure,
    "isfield": _is_field,
    **dict.fromkeys(("strcmp", "strcmpi", "isequal"), _compared),
    **dict.fromkeys(("ischar", "isstring", "iscell", "isstruct"), _is_kind),
    **dict.fromkeys(("error", "assert"), _failed),
    "cell2mat": _matrix_of_cells,
    "norm": _norm,
    **dict.fromkeys((*_VALUES, "eye"), _filled),
    **dict.fromkeys(("lower", "upper"), _in_letters),
    "isa": _is_of_class,
    "sum": _along,
}
"""They take texts, cell arrays or structures, too."""
_OTHERS: dict[str, Callable[[str, list[Any]], Any]] = {
    "transpose": _of_one(lambda array: np.swapaxes(array, 1, 2)),
    "inv": _of_one(np.linalg.inv),
    "pinv": _of_one(np.linalg.pinv),
    "rank": _of_one(lambda array: np.linalg.matrix_rank(array)[:, None, None]),
    "diag": _diagonal,
    "det": _of_one(lambda array: np.linalg.det(array)[:, None, None]),
    "trace": _of_one(lambda array: np.trace(array, axis1=1, axis2=2)[:, None, None]),
    **dict.fromkeys(("cross", "dot"), _product_of_vectors),
    **dict.fromkeys(("prod", "cumsum", "mean", "any", "all"), _along),
    "vecnorm": _lengths,
    **dict.fromkeys(("max", "min"), _largest),
    "repmat": _repeated,
    "kron": _kron,
    **dict.fromkeys(("triu", "tril"), _triangle),
    "linspace": _spaced,
    **dict.fromkeys(("flip", "fliplr", "flipud"), _flipped),
    "mtimes": lambda name, parts: np.matmul(*counted(name, parts, 2)),
    "ctranspose": _of_one(lambda array: np.swapaxes(array, 1, 2)),
    "expm": _of_one(lambda array: np.stack([_exponential(one) for one in array])),
    "reshape": _reshaped,
    "blkdiag": _blocks,
    "horzcat": lambda name, parts: stacked(parts, 2),
    "vertcat": lambda name, parts: stacked(parts, 1),
    "cell": _cell,
    "num2cell": _elements,
    "cumprod": _along,
    "diff": lambda name, parts: np.diff(counted(name, parts, 1)[0], axis=2 if parts[0].shape[1] == 1 else 1),
    "pi": _constant(np.pi),
    "eps": _constant(float(np.finfo(float).eps)),
    "true": lambda name, parts: _filled("ones", parts) != 0,
    "false": lambda name, parts: _filled("zeros", parts) != 0,
}
_WITHOUT_ARGUMENTS = ("pi", "eps", "true", "false", "eye", *_VALUES, "struct", "error", "vertcat", "horzcat", "blkdiag")
FUNCTIONS = (*ELEMENTWISE, *_OTHERS, *_BESIDE_NUMBERS)


def _exponential(matrix: Any) -> Any:
    """e^A by halving it until its series is short."""
    halvings = max(0, int(np.ceil(np.log2(max(float(np.abs(matrix).sum(axis=0).max()), 1e-300)))) + 5)
    small, term, total = matrix / 2.0**halvings, np.eye(len(matrix)), np.eye(len(matrix))
    for order in range(1, 16):
        term = term @ small / order
        total = total + term
    for _ in range(halvings):
        total = total @ total
    return total


def result_of(name: str, parts: list[Any]) -> Any:
    """What one of FUNCTIONS returns; a cell array is a list.

    Raises:
        ProgramError: the arguments are not what it takes.
    """
    parts = [as_numbers(part) if isinstance(part, np.ndarray) else part for part in parts]
    if any(isinstance(part, Pages) for part in parts) and name != "size":
        raise Unread(f"{name} of an array of three dimensions is not read")
    if not parts and name not in _WITHOUT_ARGUMENTS:
        raise ProgramError(f"{name} takes arguments, got none")
    if name in ("norm", "sum") and not isinstance(parts[0], np.ndarray):
        raise ProgramError(f"{name} takes numbers")
    if name in _BESIDE_NUMBERS:
        return _BESIDE_NUMBERS[name](name, parts)
    if any(not isinstance(part, np.ndarray) for part in parts):
        if any(isinstance(part, str) for part in parts):
            raise Unread(f"{name} of a text is not read")
        raise ProgramError(f"{name} takes numbers")
    if name in ELEMENTWISE:
        return np.asarray(ELEMENTWISE[name](*counted(name, parts, 2 if name in _OF_TWO else 1)))
    return _OTHERS[name](name, parts)
