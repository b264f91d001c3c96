"""Evaluates functions that `matlab_reader` has read, for many states at once, in numpy."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import UsageError
from .matlab_functions import (
    COMPARISONS,
    FUNCTIONS,
    MAX_SIZE,
    OPERATORS,
    Pages,
    check_size,
    integer,
    number,
    result_of,
    stacked,
)
from .matlab_reader import Function, Statement, read, read_expression
from .nodes import Call, Constant, Edit, Node, ProgramError, Unjudged, Unread, line_and_column

Floats = NDArray[np.float64]
_MAX_CALLS, _MAX_DEPTH = 2000, 30
_MAX_STEPS = 20_000  # statements and turns of loops of one evaluation


class _Divided(Exception):
    """A condition holds at some states and not at others."""


class Handle(NamedTuple):
    """An anonymous function, with the variables of the place where it stands."""

    names: tuple[str, ...]
    body: Node
    variables: dict[str, Any]


class MatlabProgram:
    """A MATLAB function file; a value is an array (states, rows, columns), a list for a cell array, a dict for a
    structure, or a `Handle`.
    """

    def __init__(self, text: str, file: str, function: str | None = None) -> None:
        self.text, self.file = text, file
        self.functions = read(text, file)
        if function is not None and function not in self.functions:
            raise UsageError(f"{file}: there is no function {function}; it has {', '.join(self.functions)}")
        self.function = function or next(iter(self.functions))
        if not self.functions[self.function].outputs:
            raise UsageError(f"{file}:{self.functions[self.function].line}: {self.function} has no output")
        self._calls = self._steps = self._depth = 0
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
        every = [statement for function in self.functions.values() for statement in function.body]
        return [inner for statement in every for inner in statement.walk()]

    def nodes(self) -> list[Node]:
        return [Node("assign", one.start, one.end, (one.value,)) for one in self.statements()]

    @np.errstate(all="ignore")
    def constants(self) -> list[Constant]:
        """The names that are assigned once, and a number."""
        count = Counter(name for one in self.statements() for name, _ in one.targets)
        count.update(name for function in self.functions.values() for name in function.inputs)
        found = []
        for one in self.statements():
            (name, index), value = one.targets[0] if one.targets else ("", None), one.value
            if (
                one.body is None
                and len(one.targets) == 1
                and index is None
                and count[name] == 1
                and self._is_number(value)
            ):
                found.append(Constant(name, float(self._value(value, {})[0, 0, 0]), value.start, value.end))
        return found

    def _is_number(self, node: Node) -> bool:
        kinds = ("number", "unary", "binary", "group")
        return all(one.kind in kinds and one.word not in ("^", ".^") for one in node.walk())

    def evaluate(self, call: Call, table: Floats, edit: Edit | None = None) -> Floats:
        """A row of numbers for each row of the table, in the shape that the function returns.

        Raises:
            ProgramError: the function failed.
        """
        self._replaced = self._edited(edit) if edit else None
        try:
            return self._evaluate(call, table)
        except _Divided:
            rows = [self._evaluate(call, row[None]) for row in table]
        finally:
            self._replaced = None
        if len({row.shape for row in rows}) > 1:
            raise ProgramError("returns arrays of different shapes at different states")
        return np.concatenate(rows)

    def _evaluate(self, call: Call, table: Floats) -> Floats:
        """
        Raises:
            ProgramError: the function failed.
            _Divided: a condition holds at some of the states.
        """
        self._calls = self._steps = 0
        self._known = {name: table[:, column].reshape(-1, 1, 1) for name, column in call.lifted.items()}
        inputs = [table[:, [slot] if isinstance(slot, int) else list(slot)][:, :, None] for slot in call.slots]
        with np.errstate(all="ignore"):
            outputs = self._run(self.functions[self.function], inputs)
        if not all(isinstance(one, np.ndarray) for one in outputs):
            raise ProgramError("returns a cell array or a function instead of numbers")
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
        self._calls = self._steps = 0
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

    def _run(self, function: Function, inputs: list[Any]) -> list[Any]:
        with self._called(function.line):
            return self._outputs(function, inputs)

    @contextmanager
    def _called(self, line: int | None = None) -> Iterator[None]:
        """A call of a function: how many there may be, and how many inside each other."""
        self._calls += 1
        if self._calls > _MAX_CALLS:
            raise Unread(f"calls functions more than {_MAX_CALLS} times", line)
        if self._depth >= _MAX_DEPTH:
            raise Unread(f"calls functions more than {_MAX_DEPTH} deep")
        self._depth += 1
        try:
            yield
        finally:
            self._depth -= 1

    def _outputs(self, function: Function, inputs: list[Any]) -> list[Any]:
        if len(inputs) > len(function.inputs):
            raise ProgramError(
                f"{function.name} takes {len(function.inputs)} arguments, got {len(inputs)}", function.line
            )
        variables: dict[str, Any] = {"nargin": number(len(inputs))}
        for name, given in zip(function.inputs, inputs, strict=False):
            _put_variable(variables, name, given)
        self._execute(function.body, variables)
        for name in function.outputs:
            if name not in variables and not _fields(variables, name):
                raise ProgramError(f"the output {name} is not assigned", function.line)
        return [variables[name] if name in variables else _fields(variables, name) for name in function.outputs]

    def _execute(self, statements: list[Statement], variables: dict[str, Any]) -> None:
        for statement in statements:
            self._steps += 1
            if self._steps > _MAX_STEPS:
                line, _ = line_and_column(self.text, statement.start)
                raise Unread(f"takes more than {_MAX_STEPS} steps", line)
            if statement.body is None:
                self._assign(statement, variables)
                continue
            if not statement.targets:
                chosen = statement.body if self._holds(statement, variables) else statement.otherwise
                self._execute(chosen, variables)
                continue
            for value in self._turns(statement, variables):
                self._steps += 1
                variables[statement.targets[0][0]] = value
                self._execute(statement.body, variables)

    def _value_of(self, statement: Statement) -> Node:
        return self._replaced[1] if self._replaced and self._replaced[0] is statement else statement.value

    def _holds(self, statement: Statement, variables: dict[str, Any]) -> bool:
        """Whether a condition holds: all of its elements, at all states."""
        with self._at(statement):
            array = self._array(self._value_of(statement), variables)
        holds = np.logical_and.reduce(array.reshape(len(array), -1) != 0, axis=1) & (array.size > 0)
        if holds.any() != holds.all():
            raise _Divided
        return bool(holds.all())

    def _turns(self, statement: Statement, variables: dict[str, Any]) -> Iterator[Floats]:
        """The values of a loop's variable: numbers of a range, or the columns of a matrix."""
        node = self._value_of(statement)
        while node.kind == "group":
            (node,) = node.parts
        with self._at(statement):
            if node.kind == "range":
                return (number(one) for one in self._range(node, variables))
            matrix = self._array(node, variables)
            return (matrix[:, :, [column]] for column in range(matrix.shape[2]))

    @contextmanager
    def _at(self, statement: Statement) -> Iterator[None]:
        """Errors of the program get the statement's line."""
        try:
            yield
        except ProgramError as error:
            error.line = error.line or line_and_column(self.text, statement.start)[0]
            raise
        except RecursionError:
            raise Unjudged("is nested too deeply", line_and_column(self.text, statement.start)[0]) from None
        except (ValueError, IndexError, ArithmeticError, np.linalg.LinAlgError) as error:
            raise ProgramError(str(error).split("\n")[0], line_and_column(self.text, statement.start)[0]) from None

    def _assign(self, statement: Statement, variables: dict[str, Any]) -> None:
        value = self._value_of(statement)
        with self._at(statement):
            is_one = len(statement.targets) == 1
            values = [self._value(value, variables)] if is_one else self._several(value, variables)
            for (name, index), given in zip(statement.targets, values, strict=False):
                if index is not None:
                    variables[name] = self._put(variables.get(name), index, given, variables)
                elif name in self._known and self._is_number(statement.value):
                    variables[name] = self._known[name]
                else:
                    _put_variable(variables, name, given)

    def _several(self, node: Node, variables: dict[str, Any]) -> list[Any]:
        if node.kind == "call" and node.word in self.functions:
            return self._run(self.functions[node.word], [self._value(part, variables) for part in node.parts])
        raise Unread("several outputs come only from a local function")

    def _array(self, node: Node, variables: dict[str, Any]) -> Floats:
        """The value of a node that is a matrix of numbers."""
        value = self._value(node, variables)
        if isinstance(value, Pages):
            raise Unread("of an array of three dimensions one page at a time is read, such as T(:,:,1)")
        if not isinstance(value, np.ndarray):
            raise ProgramError(f"{self.text[node.start : node.end]!r} is no number")
        return value

    def _value(self, node: Node, variables: dict[str, Any]) -> Any:
        if node.kind == "number":
            return number(float(node.word.lower().replace("d", "e")))
        if node.kind in ("name", "last"):
            if node.word in variables:
                return variables[node.word]
            return _fields(variables, node.word) or self._call(node, variables)
        if node.kind == "group":
            return self._value(node.parts[0], variables)
        if node.kind == "unary":
            inner = self._array(node.parts[0], variables)
            return -inner if node.word == "-" else inner
        if node.kind in ("compare", "logic"):
            left = self._array(node.parts[0], variables)
            if (node.word == "&&" and not left.any()) or (node.word == "||" and left.all()):
                return left  # the other side is not looked at
            return np.asarray(COMPARISONS[node.word](left, self._array(node.parts[1], variables)), np.float64)
        if node.kind == "binary":
            return self._binary(node.word, *(self._array(part, variables) for part in node.parts))
        if node.kind == "transpose":
            return np.swapaxes(self._array(node.parts[0], variables), 1, 2)
        if node.kind == "matrix":
            return stacked([self._row(row, variables) for row in node.parts] or [np.zeros((1, 0, 0))], 1)
        if node.kind == "range":
            numbers = self._range(node, variables)
            check_size(1, len(numbers))
            return np.array(numbers, float).reshape(1, 1, -1)
        if node.kind == "call":
            return self._call(node, variables)
        return self._other_value(node, variables)

    def _other_value(self, node: Node, variables: dict[str, Any]) -> Any:
        """Cell arrays, parts of their elements, anonymous functions, and what does not hold."""
        if node.kind == "not":
            return np.asarray(self._array(node.parts[0], variables) == 0, np.float64)
        if node.kind == "cell":
            check_size(1, sum(len(row.parts) for row in node.parts))
            return [self._value(part, variables) for row in node.parts for part in row.parts]
        if node.kind == "part":
            return self._index(self._array(node.parts[0], variables), node.parts[1:], variables)
        if node.kind == "handle":
            names = node.info if isinstance(node.info, tuple) else ()
            return Handle(names, node.parts[0], dict(variables))
        raise Unread(f"{self.text[node.start : node.end]!r} is not read here")

    def _row(self, row: Node, variables: dict[str, Any]) -> Floats:
        return stacked([self._array(part, variables) for part in row.parts], 2)

    def _range(self, node: Node, variables: dict[str, Any]) -> list[float]:
        """The numbers of first:last or first:step:last."""
        first, *step, last = (self._array(part, variables) for part in node.parts)
        start, change, end = integer(first), integer(step[0]) if step else 1, integer(last)
        if change == 0 or abs(end - start) > _MAX_STEPS:
            raise Unread(f"a range has at most {_MAX_STEPS} numbers")
        return [float(one) for one in range(start, end + (1 if change > 0 else -1), change)]

    def _binary(self, word: str, left: Floats, right: Floats) -> Floats:
        is_scalar = left.shape[1:] == (1, 1) or right.shape[1:] == (1, 1)
        if word == "*" and not is_scalar:
            return np.matmul(left, right)
        if word == "/" and right.shape[1:] != (1, 1):
            return np.matmul(left, np.linalg.inv(right))
        if word == "\\":
            return right / left if left.shape[1:] == (1, 1) else np.matmul(np.linalg.inv(left), right)
        if word == "^" and left.shape[1:] != (1, 1):
            if right.shape[1:] != (1, 1) or np.any(right != np.round(right[0])):
                raise Unread("a power of a matrix is read to a whole number, the same at every state")
            return np.linalg.matrix_power(left, integer(right))
        if word == "^" and right.shape[1:] != (1, 1):
            raise Unread("a matrix as an exponent is not read; write .^ for its elements")
        return np.asarray(OPERATORS[word if word in OPERATORS else f".{word}"](left, right))

    def _call(self, node: Node, variables: dict[str, Any]) -> Any:
        name = node.word
        if name in variables:
            held = variables[name]
            if isinstance(held, Handle):
                return self._apply(held, [self._value(part, variables) for part in node.parts])
            if node.info == "element":
                return self._element(held, node, variables)
            if isinstance(held, Pages):
                return self._index(self._page(held, node.parts, variables)[1], node.parts[:2], variables)
            if isinstance(held, list):
                raise ProgramError(f"an element of the cell array {name} is taken by {name}{{...}}")
            return self._index(held, node.parts, variables)
        parts = [self._value(part, variables) for part in node.parts]
        if name in self.functions:
            outputs = self._run(self.functions[name], parts)
            if not outputs:
                raise ProgramError(f"{name} has no output")
            return outputs[0]
        if name in FUNCTIONS and node.info is None:
            return result_of(name, parts)
        if node.kind == "name":
            remedy = f"write {name} = NUMBER; above, or make it an argument"
            raise Unread(f"{name!r} has no value in this file: {remedy}", name=name)
        raise Unread(f"{name!r} is not known: no variable, no local function and none of {', '.join(FUNCTIONS)}")

    def _apply(self, handle: Handle, inputs: list[Any]) -> Any:
        if len(inputs) != len(handle.names):
            raise ProgramError(f"an anonymous function takes {len(handle.names)} arguments, got {len(inputs)}")
        with self._called():
            return self._value(handle.body, {**handle.variables, **dict(zip(handle.names, inputs, strict=True))})

    def _element(self, cell: Any, node: Node, variables: dict[str, Any]) -> Any:
        """T{i} of a cell array with one row or one column."""
        if not isinstance(cell, list):
            raise ProgramError(f"{node.word} is no cell array")
        place = self._place_in_cell(node.parts, len(cell), variables)
        if not 0 <= place < len(cell) or cell[place] is None:
            raise ProgramError(f"the cell array {node.word} has no element {place + 1}")
        return cell[place]

    def _place_in_cell(self, parts: tuple[Node, ...], size: int, variables: dict[str, Any]) -> int:
        places = [self._places(part, size, variables) for part in parts]
        if not 1 <= len(places) <= 2 or any(len(one) != 1 for one in places):
            raise Unread("one element of a cell array is taken at a time")
        if len(places) == 2 and 0 not in (places[0][0], places[1][0]):
            raise Unread("cell arrays of one row or one column are read")
        return max(one[0] for one in places)

    def _page(self, pages: Pages, parts: Sequence[Node], variables: dict[str, Any]) -> tuple[int, Floats]:
        """The place along the third dimension, and the matrix there; an empty one behind the last."""
        if len(parts) != 3:
            raise Unread("an array of three dimensions is read by three indices")
        places = self._places(parts[2], len(pages), variables)
        if len(places) != 1:
            raise Unread("one page of an array of three dimensions is taken at a time")
        if places[0] < 0:
            raise ProgramError("an index is out of range")
        return places[0], pages[places[0]] if places[0] < len(pages) else np.zeros((1, 0, 0))

    def _places(self, part: Node, size: int, variables: dict[str, Any]) -> list[int]:
        if part.kind == "all":
            return list(range(size))
        inside = {**variables, "end": number(size)}
        if _is_mask(part):
            holds = np.swapaxes(self._array(part, inside), 1, 2).reshape(-1, size if size else 1) != 0
            if (holds != holds[0]).any():
                raise _Divided
            return [int(place) for place in np.flatnonzero(holds[0])]
        if part.kind == "range":
            return [int(one) - 1 for one in self._range(part, inside)]
        return [round(float(one)) - 1 for one in self._array(part, inside)[0].ravel()]

    def _index(self, array: Floats, parts: tuple[Node, ...], variables: dict[str, Any]) -> Floats:
        rows, columns = array.shape[1:]
        if len(parts) > 2:
            raise Unread("an index of three dimensions is read of what zeros(rows, columns, pages) has made")
        if len(parts) == 1:
            flat = np.swapaxes(array, 1, 2).reshape(len(array), rows * columns)
            places = self._places(parts[0], flat.shape[1], variables)
            _check_places(places, flat.shape[1])
            chosen = flat[:, places]
            return chosen[:, None, :] if rows == 1 and parts[0].kind != "all" else chosen[:, :, None]
        first, second = (self._places(part, size, variables) for part, size in zip(parts, (rows, columns), strict=True))
        _check_places(first, rows)
        _check_places(second, columns)
        return array[:, first][:, :, second]

    def _put(self, array: Any, index: Node, given: Any, variables: dict[str, Any]) -> Any:
        if len(index.parts) == 3 and not isinstance(given, np.ndarray):
            raise Unread("a matrix is put into an array of three dimensions; more is not read")
        if len(index.parts) == 3 and (array is None or isinstance(array, (Pages, np.ndarray))):
            pages = Pages([array]) if isinstance(array, np.ndarray) else Pages(array or ())
            return self._put_page(pages, index, given, variables)
        if isinstance(array, Pages):
            raise Unread("an array of three dimensions is set by three indices")
        if index.word == "{" or isinstance(array, list):
            return self._put_element(array, index, given, variables)
        if not isinstance(given, np.ndarray):
            raise Unread("an element of a matrix is set to a number; more is not read")
        if len(index.parts) == 1 and _is_mask(index.parts[0]):
            return self._put_where(array, index.parts[0], given, variables)
        array = np.zeros((1, 0, 0)) if array is None else array
        sizes = [*array.shape[1:]]
        if len(index.parts) == 1:
            is_row = sizes[0] == 1
            places = [self._places(index.parts[0], max(sizes), variables)]
            places = [[0], places[0]] if is_row or not array.size else [places[0], [0]]
        else:
            places = [self._places(part, size, variables) for part, size in zip(index.parts, sizes, strict=True)]
        shape = [max(size, 1 + max(one, default=0)) for size, one in zip(sizes, places, strict=True)]
        if max(shape) > MAX_SIZE or min(min(one, default=0) for one in places) < 0:
            raise ProgramError("an index is out of range")
        result = np.zeros((max(len(array), len(given)), *shape))
        result[:, : sizes[0], : sizes[1]] = array
        result[np.ix_(range(len(result)), *places)] = given
        return result

    def _put_page(self, pages: Pages, index: Node, given: Any, variables: dict[str, Any]) -> Pages:
        """The pages with a part of one of them replaced; they grow as matrices do."""
        place, page = self._page(pages, index.parts, variables)
        whole = [one.kind == "all" for one in index.parts[:2]]
        page = given if all(whole) else self._put(page, replace(index, parts=index.parts[:2]), given, variables)
        check_size(1, place + 1)
        empty = np.zeros((1, *page.shape[1:]))
        return Pages([*pages[:place], *[empty] * (place - len(pages)), page, *pages[place + 1 :]])

    def _put_where(self, array: Any, mask: Node, given: Any, variables: dict[str, Any]) -> Floats:
        """The matrix with a number where a comparison holds, which it may do at some states and not at others."""
        here = self._array(mask, variables)
        if not isinstance(array, np.ndarray) or here.shape[1:] != array.shape[1:] or given.shape[1:] != (1, 1):
            raise Unread("a number is put where a comparison of the whole matrix holds; more is not read")
        return np.where(here != 0, given, array)

    def _put_element(self, cell: Any, index: Node, given: Any, variables: dict[str, Any]) -> list[Any]:
        """The cell array with an element replaced or appended."""
        if index.word != "{" or not isinstance(cell, (list, type(None))):
            raise ProgramError("an element of a cell array is set by T{i} = ...")
        place = self._place_in_cell(index.parts, len(cell or ()), variables)
        if not 0 <= place < MAX_SIZE:
            raise ProgramError("an index is out of range")
        result = [*(cell or ()), *[None] * (place + 1 - len(cell or ()))]
        result[place] = given
        return result


def _is_mask(node: Node) -> bool:
    """Whether an index is a comparison: it chooses the elements for which it holds."""
    while node.kind == "group":
        (node,) = node.parts
    return node.kind in ("compare", "logic", "not")


def _fields(variables: dict[str, Any], name: str) -> dict[str, Any]:
    """The fields of a structure: p.a2 is a variable of this name."""
    return {key[len(name) + 1 :]: value for key, value in variables.items() if key.startswith(f"{name}.")}


def _put_variable(variables: dict[str, Any], name: str, value: Any) -> None:
    if isinstance(value, dict):
        variables.update({f"{name}.{key}": inner for key, inner in value.items()})
    else:
        variables[name] = value


def _check_places(places: list[int], size: int) -> None:
    if any(not 0 <= place < size for place in places):
        raise ProgramError(f"index {max(places, default=0) + 1} is out of range: there are {size} elements")
