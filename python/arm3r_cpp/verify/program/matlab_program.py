"""Evaluates functions that `matlab_reader` has read, for many states at once, in numpy."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import UsageError
from .matlab_reader import Function, Statement, read, read_expression
from .nodes import Call, Constant, Edit, Node, ProgramError, line_and_column

Floats = NDArray[np.float64]
_MAX_CALLS = 2000
_MAX_SIZE = 12  # rows or columns of a matrix


def _power(base: Floats, exponent: Floats) -> Floats:
    """Element by element; at one state with the bits of Python's `**`, which np.power does not always have."""
    if len(base) > 1 or len(exponent) > 1 or exponent.size > 1:
        return np.power(base, exponent)
    power = exponent.item()
    return base**power if base.size > 1 else np.full((1, 1, 1), np.float64(base.item()) ** power)


_ELEMENTWISE: dict[str, Callable[..., Any]] = {
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
}
_OPERATORS: dict[str, Callable[..., Any]] = {
    "+": np.add,
    "-": np.subtract,
    ".*": np.multiply,
    "./": np.divide,
    ".^": _power,
}
_OTHERS = ("transpose", "inv", "eye", "zeros", "ones", "diag", "det", "cross", "dot", "norm", "sum", "double")
FUNCTIONS = (*_ELEMENTWISE, *_OTHERS, "pi")


class MatlabProgram:
    """A MATLAB function file; every value is an array (states, rows, columns)."""

    def __init__(self, text: str, file: str, function: str | None = None) -> None:
        self.text, self.file = text, file
        self.functions = read(text, file)
        if function is not None and function not in self.functions:
            raise UsageError(f"{file}: there is no function {function}; it has {', '.join(self.functions)}")
        self.function = function or next(iter(self.functions))
        if not self.functions[self.function].outputs:
            raise UsageError(f"{file}:{self.functions[self.function].line}: {self.function} has no output")
        self._calls = 0
        self._known: dict[str, Floats] = {}
        self._replaced: tuple[Statement, Node] | None = None

    @property
    def arguments(self) -> list[str]:
        return self.functions[self.function].inputs

    @property
    def outputs(self) -> list[str]:
        return self.functions[self.function].outputs

    def comments(self) -> str:
        return " ".join(line.split("%", 1)[1] for line in self.text.splitlines() if "%" in line)

    def statements(self) -> list[Statement]:
        return [statement for function in self.functions.values() for statement in function.body]

    def nodes(self) -> list[Node]:
        return [Node("assign", one.start, one.end, (one.value,)) for one in self.statements()]

    def constants(self) -> list[Constant]:
        """The names that are assigned once, and a number."""
        count = Counter(name for one in self.statements() for name, _ in one.targets)
        count.update(name for function in self.functions.values() for name in function.inputs)
        found = []
        for one in self.statements():
            (name, index), value = one.targets[0], one.value
            if len(one.targets) == 1 and index is None and count[name] == 1 and self._is_number(value):
                number = float(self._value(value, {})[0, 0, 0])
                found.append(Constant(name, number, value.start, value.end))
        return found

    def _is_number(self, node: Node) -> bool:
        kinds = ("number", "unary", "binary", "group")
        return all(one.kind in kinds and one.word not in ("^", ".^") for one in node.walk())

    def evaluate(self, call: Call, table: Floats, edit: Edit | None = None) -> Floats:
        """A row of numbers for each row of the table, in the shape that the function returns.

        Raises:
            ProgramError: the function failed.
        """
        self._calls = 0
        self._replaced = self._edited(edit) if edit else None
        self._known = {name: table[:, column].reshape(-1, 1, 1) for name, column in call.lifted.items()}
        inputs = [table[:, [slot] if isinstance(slot, int) else list(slot)][:, :, None] for slot in call.slots]
        with np.errstate(all="ignore"):
            try:
                outputs = self._run(self.functions[self.function], inputs)
            finally:
                self._replaced = None
        outputs = [np.broadcast_to(one, (len(table), *one.shape[1:])) for one in outputs]
        if len(outputs) == 1:
            result = outputs[0]
            return result[:, :, 0] if result.shape[2] == 1 else result
        if any(one.shape[1:] != (1, 1) for one in outputs):
            raise ProgramError("returns several outputs that are no scalars")
        return np.stack([one[:, 0, 0] for one in outputs], axis=1)

    def call(self, *arguments: ArrayLike) -> list[Floats]:
        """The outputs at one state, each a matrix. A vector is given as a column.

        Raises:
            ProgramError: the function failed.
        """
        self._calls = 0
        columns = [np.asarray(one, np.float64) for one in arguments]
        inputs = [(one if one.ndim == 2 else one.reshape(-1, 1))[np.newaxis] for one in columns]
        with np.errstate(all="ignore"):
            return [one[0] for one in self._run(self.functions[self.function], inputs)]

    def _edited(self, edit: Edit) -> tuple[Statement, Node]:
        for statement in self.statements():
            value = statement.value
            if value.start <= edit.start and edit.end <= value.end:
                moved = edit._replace(start=edit.start - value.start, end=edit.end - value.start)
                try:
                    return statement, read_expression(moved.apply(self.text[value.start : value.end]))
                except UsageError:
                    break
        raise ProgramError("the edit gives no MATLAB")

    def _run(self, function: Function, inputs: list[Floats]) -> list[Floats]:
        self._calls += 1
        if self._calls > _MAX_CALLS:
            raise ProgramError(f"calls functions more than {_MAX_CALLS} times", function.line)
        if len(inputs) > len(function.inputs):
            raise ProgramError(
                f"{function.name} takes {len(function.inputs)} arguments, got {len(inputs)}", function.line
            )
        variables = dict(zip(function.inputs, inputs, strict=False))
        for statement in function.body:
            self._assign(statement, variables)
        for name in function.outputs:
            if name not in variables:
                raise ProgramError(f"the output {name} is not assigned", function.line)
        return [variables[name] for name in function.outputs]

    def _assign(self, statement: Statement, variables: dict[str, Floats]) -> None:
        value = statement.value
        if self._replaced and self._replaced[0] is statement:
            value = self._replaced[1]
        try:
            is_one = len(statement.targets) == 1
            values = [self._value(value, variables)] if is_one else self._several(value, variables)
            for (name, index), given in zip(statement.targets, values, strict=False):
                if index is not None:
                    variables[name] = self._put(variables.get(name), index, given, variables)
                elif name in self._known and self._is_number(statement.value):
                    variables[name] = self._known[name]
                else:
                    variables[name] = given
        except ProgramError as error:
            raise ProgramError(str(error), error.line or line_and_column(self.text, statement.start)[0]) from None
        except (ValueError, IndexError, np.linalg.LinAlgError, RecursionError) as error:
            raise ProgramError(str(error).split("\n")[0], line_and_column(self.text, statement.start)[0]) from None

    def _several(self, node: Node, variables: dict[str, Floats]) -> list[Floats]:
        if node.kind == "call" and node.word in self.functions:
            return self._run(self.functions[node.word], [self._value(part, variables) for part in node.parts])
        raise ProgramError("several outputs come only from a local function")

    def _value(self, node: Node, variables: dict[str, Floats]) -> Floats:
        if node.kind == "number":
            return np.full((1, 1, 1), float(node.word.lower().replace("d", "e")))
        if node.kind == "name":
            return variables[node.word] if node.word in variables else self._call(node, variables)
        if node.kind == "group":
            return self._value(node.parts[0], variables)
        if node.kind == "unary":
            inner = self._value(node.parts[0], variables)
            return -inner if node.word == "-" else inner
        if node.kind == "binary":
            return self._binary(node.word, *(self._value(part, variables) for part in node.parts))
        if node.kind == "transpose":
            return np.swapaxes(self._value(node.parts[0], variables), 1, 2)
        if node.kind == "matrix":
            return self._matrix(node, variables)
        if node.kind == "call":
            return self._call(node, variables)
        raise ProgramError(f"{self.text[node.start : node.end]!r} is not read here")

    def _binary(self, word: str, left: Floats, right: Floats) -> Floats:
        is_scalar = left.shape[1:] == (1, 1) or right.shape[1:] == (1, 1)
        if word == "*" and not is_scalar:
            return np.matmul(left, right)
        if word == "/" and right.shape[1:] != (1, 1):
            return np.matmul(left, np.linalg.inv(right))
        if word == "^" and left.shape[1:] != (1, 1):
            raise ProgramError("a power of a matrix is not read; write .^ for that of its elements")
        return _OPERATORS[word if word in _OPERATORS else f".{word}"](left, right)

    def _matrix(self, node: Node, variables: dict[str, Floats]) -> Floats:
        rows = [[self._value(part, variables) for part in row.parts] for row in node.parts]
        count = max((len(one) for row in rows for one in row), default=1)
        width = max((sum(one.shape[2] for one in row) for row in rows), default=0)
        height = sum(row[0].shape[1] for row in rows if row)
        _check_size(height, width)
        wide = [np.concatenate([np.broadcast_to(one, (count, *one.shape[1:])) for one in row], axis=2) for row in rows]
        if not wide:
            return np.zeros((1, 0, 0))
        return np.concatenate(wide, axis=1)

    def _call(self, node: Node, variables: dict[str, Floats]) -> Floats:
        name = node.word
        if name in variables:
            return self._index(variables[name], node.parts, variables)
        parts = [self._value(part, variables) for part in node.parts]
        if name in self.functions:
            outputs = self._run(self.functions[name], parts)
            if not outputs:
                raise ProgramError(f"{name} has no output")
            return outputs[0]
        if name in _ELEMENTWISE:
            return _ELEMENTWISE[name](*_counted(name, parts, 2 if name in ("atan2", "power", "hypot") else 1))
        if name == "pi":
            return np.full((1, 1, 1), np.pi)
        if name in _OTHERS:
            return _other(name, parts)
        raise ProgramError(f"{name!r} is not known: no variable, no local function and none of {', '.join(FUNCTIONS)}")

    def _places(self, part: Node, size: int, variables: dict[str, Floats]) -> list[int]:
        if part.kind == "all":
            return list(range(size))
        if part.kind == "range":
            first, last = (int(self._value(one, variables)[0, 0, 0]) for one in part.parts)
            return list(range(first - 1, last))
        return [round(float(one)) - 1 for one in self._value(part, variables)[0].ravel()]

    def _index(self, array: Floats, parts: tuple[Node, ...], variables: dict[str, Floats]) -> Floats:
        rows, columns = array.shape[1:]
        if len(parts) == 1:
            flat = np.swapaxes(array, 1, 2).reshape(len(array), rows * columns)
            places = self._places(parts[0], flat.shape[1], variables)
            _check_places(places, flat.shape[1])
            chosen = flat[:, places]
            return chosen[:, None, :] if rows == 1 else chosen[:, :, None]
        first, second = (self._places(part, size, variables) for part, size in zip(parts, (rows, columns), strict=True))
        _check_places(first, rows)
        _check_places(second, columns)
        return array[:, first][:, :, second]

    def _put(self, array: Floats | None, index: Node, given: Floats, variables: dict[str, Floats]) -> Floats:
        array = np.zeros((1, 0, 0)) if array is None else array
        sizes = [*array.shape[1:]]
        if len(index.parts) == 1:
            is_row = sizes[0] == 1
            places = [self._places(index.parts[0], max(sizes), variables)]
            places = [[0], places[0]] if is_row or not array.size else [places[0], [0]]
        else:
            places = [self._places(part, size, variables) for part, size in zip(index.parts, sizes, strict=True)]
        shape = [max(size, 1 + max(one, default=0)) for size, one in zip(sizes, places, strict=True)]
        if max(shape) > _MAX_SIZE or min(min(one, default=0) for one in places) < 0:
            raise ProgramError("an index is out of range")
        result = np.zeros((max(len(array), len(given)), *shape))
        result[:, : sizes[0], : sizes[1]] = array
        result[np.ix_(range(len(result)), *places)] = given
        return result


def _check_places(places: list[int], size: int) -> None:
    if any(not 0 <= place < size for place in places):
        raise ProgramError(f"index {max(places, default=0) + 1} is out of range: there are {size} elements")


def _counted(name: str, parts: list[Floats], count: int) -> list[Floats]:
    if len(parts) != count:
        raise ProgramError(f"{name} takes {count} argument{'s' if count > 1 else ''}, got {len(parts)}")
    return parts


def _check_size(rows: int, columns: int) -> None:
    if not (0 <= rows <= _MAX_SIZE and 0 <= columns <= _MAX_SIZE):
        raise ProgramError(f"a matrix of {rows} x {columns} is too large")


def _other(name: str, parts: list[Floats]) -> Floats:
    """The functions of matrices."""
    if name in ("eye", "zeros", "ones"):
        sizes = [int(part[0, 0, 0]) for part in parts] or [1]
        rows, columns = (sizes * 2)[:2]
        _check_size(rows, columns)
        matrix = np.eye(rows, columns) if name == "eye" else np.full((rows, columns), float(name == "ones"))
        return matrix[None]
    if name in ("cross", "dot"):
        first, second = _counted(name, parts, 2)
        flat = [np.swapaxes(one, 1, 2).reshape(len(one), -1) for one in (first, second)]
        if name == "dot":
            return np.sum(flat[0] * flat[1], axis=1)[:, None, None]
        if flat[0].shape[1] != 3 or flat[1].shape[1] != 3:
            raise ProgramError("cross takes two vectors of three numbers")
        product = np.cross(flat[0], flat[1])
        return product[:, :, None] if first.shape[2] == 1 else product[:, None, :]
    (array,) = _counted(name, parts, 1)
    if name == "transpose":
        return np.swapaxes(array, 1, 2)
    if name == "inv":
        return np.asarray(np.linalg.inv(array), np.float64)
    if name == "det":
        return np.asarray(np.linalg.det(array), np.float64)[:, None, None]
    if name == "norm":
        return np.sqrt(np.sum(array**2, axis=(1, 2)))[:, None, None]
    if name == "sum":
        return array.sum(axis=2 if array.shape[1] == 1 else 1, keepdims=True)
    if name == "diag":
        if 1 in array.shape[1:]:
            diagonal = array.reshape(len(array), -1)
            return diagonal[:, :, None] * np.eye(diagonal.shape[1])
        return np.diagonal(array, axis1=1, axis2=2)[:, :, None]
    return array
