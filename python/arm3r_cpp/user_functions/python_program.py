"""Runs a function of a Python text: many states in one call, with lifted constants, and with an edit of the text."""

from __future__ import annotations

import ast
import builtins
import contextlib
import inspect
import io
import sys
import traceback
import warnings
from collections.abc import Iterator, Mapping
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .programs import Call, Edit, Given, ProgramError, Unread
from .sympy_expressions import function_of, is_expression

Floats = NDArray[np.float64]
LIFTED = "__arm3r_lifted__"
_MODULE = "__formula__"
_BARRED = "a formula reads no files but its folder's, writes none, opens no sockets and starts no processes"
_APART = 'put what only a run of the file needs under `if __name__ == "__main__":`'
_NUMBER = (ast.Constant, ast.UnaryOp, ast.BinOp)
_ARITHMETIC = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.UAdd, ast.USub)  # no power or shift: they can be endless


def number_in(node: ast.AST) -> float | None:
    """The value of an expression of numbers only, such as 9.81/6."""
    allowed = (ast.Expression, *_NUMBER, *_ARITHMETIC)
    if not all(isinstance(inner, allowed) for inner in ast.walk(node)):
        return None
    if not all(type(inner.value) in (int, float) for inner in ast.walk(node) if isinstance(inner, ast.Constant)):
        return None
    try:
        return float(eval(compile(ast.fix_missing_locations(ast.Expression(node)), "", "eval"), {"__builtins__": {}}))  # type: ignore[arg-type]
    except (ArithmeticError, TypeError, ValueError):
        return None


def pairs(statement: ast.AST) -> list[tuple[ast.Name, ast.expr]]:
    """The names that a statement assigns, and what: `a = 1`, `a: float = 1`, `a, b = 1, 2`, `a = b = 1`."""
    if isinstance(statement, ast.AnnAssign):
        given: list[tuple[ast.expr, ast.expr]] = [(statement.target, statement.value)] if statement.value else []
    elif isinstance(statement, ast.Assign):
        given = [(target, statement.value) for target in statement.targets]
    else:
        return []
    found: list[tuple[ast.Name, ast.expr]] = []
    for target, value in given:
        if isinstance(target, ast.Name):
            found.append((target, value))
        elif isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple) and len(target.elts) == len(value.elts):
            found += [
                (one, other) for one, other in zip(target.elts, value.elts, strict=True) if isinstance(one, ast.Name)
            ]
    return found


class Structure(dict[str, Any]):
    """Values by names, as p["l1"] and as p.l1."""

    def __getattr__(self, name: str) -> Any:
        if name not in self:
            raise AttributeError(f"there is no field {name}")
        return self[name]


def value_of(given: Any, make_array: bool = True) -> Any:
    """What a function gets for a number, nested lists of numbers, or a structure of these."""
    if isinstance(given, dict):
        return Structure({name: value_of(inner, make_array) for name, inner in given.items()})
    return np.array(given, np.float64) if isinstance(given, list) and make_array else given


def callable_of(namespace: Mapping[str, Any], name: str) -> Any:
    """What `f`, `robot.jacobian`, `Robot.jacobian`, an expression of sympy or a class to be called stand for; or None.

    A method of a class is that of an object which its name makes, and the call of a class is that of such an object.
    """
    first, *attributes = name.split(".")
    found = namespace.get(first)
    for attribute in attributes:
        is_of_class = isinstance(found, type) and isinstance(
            inspect.getattr_static(found, attribute, None), (staticmethod, classmethod)
        )
        found = getattr(found() if isinstance(found, type) and not is_of_class else found, attribute, None)
    if isinstance(found, type):
        found = found()
    if is_expression(found):
        found, _ = function_of(found)
    return found if callable(found) else None


class PythonProgram:
    """A function of a Python text, which this process executes."""

    def __init__(
        self,
        text: str,
        function: str,
        file: str = "<formula>",
        namespace: dict[str, Any] | None = None,
        make_array: bool = True,
    ) -> None:
        self.text, self.function, self.file = text, function, file
        self.given = namespace
        self.make_array = make_array
        self.names: set[str] = set()
        self.namespace: dict[str, Any] = {}
        self._function: Any = None
        self._body: list[tuple[int, int, Any]] = []
        self._spans: list[tuple[int, int, str]] = []
        self._lifted_text = text
        self._offsets = [0]
        for line in text.split("\n"):
            self._offsets.append(self._offsets[-1] + len(line) + 1)

    def offset(self, line: int, column: int) -> int:
        """Of a place as `ast` gives it: its columns count bytes of UTF-8."""
        start = self._offsets[line - 1]
        row = self.text[start : self._offsets[line] - 1]
        return start + (column if row.isascii() else len(row.encode()[:column].decode(errors="ignore")))

    def load(self, lifted: dict[str, int]) -> None:
        """Compile the text, with some constants lifted: their numbers become look-ups."""
        try:
            tree = ast.parse(self.text)
            self._spans = self._lifted_spans(tree, set(lifted)) if lifted else []
            self._lifted_text = self.text
            for start, end, code in reversed(self._spans):
                self._lifted_text = f"{self._lifted_text[:start]}{code}{self._lifted_text[end:]}"
            self.names = set(lifted)
            spans = [self._span(node) for node in tree.body]
            self._body = [(start, end, self._compiled(start, end, None)) for start, end in spans]
        except (SyntaxError, ValueError, RecursionError) as error:
            raise ProgramError(
                f"is not Python: {getattr(error, 'msg', error)}", getattr(error, "lineno", None)
            ) from None

    def _lifted_spans(self, tree: ast.Module, names: set[str]) -> list[tuple[int, int, str]]:
        """Where the numbers of lifted constants stand, and what is to stand there."""
        found: dict[tuple[int, int], list[str]] = {}
        for statement in ast.walk(tree):
            for target, value in pairs(statement):
                if number_in(value) is not None:
                    start = self.offset(value.lineno, value.col_offset)
                    end = self.offset(value.end_lineno or 0, value.end_col_offset or 0)
                    found.setdefault((start, end), []).append(target.id)
        return [
            (*span, self._look_up(span, assigned, names))
            for span, assigned in sorted(found.items())
            if names & set(assigned)
        ]

    def _look_up(self, span: tuple[int, int], assigned: list[str], names: set[str]) -> str:
        """The code for a number; `a2 = a3 = 1` goes on as `a2 = a3 = 1; a2 = ...; a3 = ...`."""
        if len(assigned) == 1:
            return f"{LIFTED}[{assigned[0]!r}]"
        each = (f"; {name} = {LIFTED}[{name!r}]" for name in assigned if name in names)
        return self.text[slice(*span)] + "".join(each)

    def _moved(self, place: int) -> int:
        """A place of the text in the text with lifted constants."""
        return place + sum(len(code) - (end - start) for start, end, code in self._spans if end <= place)

    def _span(self, node: ast.stmt) -> tuple[int, int]:
        first = min([node.lineno, *(one.lineno for one in getattr(node, "decorator_list", []))])
        return self.offset(first, 0), self.offset(node.end_lineno or node.lineno, node.end_col_offset or 0)

    def _compiled(self, start: int, end: int, edit: Edit | None) -> Any:
        """The code of a statement, in its own line of the file."""
        first, last = self._moved(start), self._moved(end)
        segment = self._lifted_text[first:last]
        if edit:
            place = edit._replace(start=self._moved(edit.start) - first, end=self._moved(edit.end) - first)
            return compile(place.apply(segment), self.file, "exec", dont_inherit=True)
        lines = "\n" * self.text.count("\n", 0, start)
        return compile(lines + segment, self.file, "exec", dont_inherit=True)

    def _run_body(
        self, values: dict[str, float], outside: Mapping[str, Any], replaced: tuple[int, Any] | None = None
    ) -> None:
        if self.given is None:
            self.namespace = _new_module(self.file)
        else:
            self.namespace = dict(self.given)
            self.namespace.update({name: value for name, value in values.items() if name in self.given})
        self.namespace.update({name: value_of(value, self.make_array) for name, value in outside.items()})
        self.namespace[LIFTED] = values
        for number, (_, _, code) in enumerate(self._body):
            exec(replaced[1] if replaced and replaced[0] == number else code, self.namespace)
        self._function = callable_of(self.namespace, self.function)
        if self._function is None:
            raise ProgramError(f"there is no function {self.function}")

    def arguments(self) -> tuple[list[str], list[str]]:
        """The names of the arguments of what the text makes a function of, and those that have a default.

        Raises:
            ProgramError: the text failed, or the name stands for no function.
        """
        self.load({})
        with self._described(), contextlib.redirect_stdout(io.StringIO()):
            self._run_body({}, {})
            first = self.namespace.get(self.function)
            if is_expression(first):
                return function_of(first)[1], []
            given = inspect.signature(self._function).parameters.values()
            names = [one.name for one in given if one.kind in (one.POSITIONAL_ONLY, one.POSITIONAL_OR_KEYWORD)]
            return names, [one.name for one in given if one.name in names and one.default is not one.empty]

    def evaluate(self, call: Call, table: Floats, edit: Edit | None = None) -> Floats:
        """A row of numbers for each row of the table, in the shape that the function returns.

        Raises:
            ProgramError: the function failed.
        """
        if not self._body or self.names != set(call.lifted):
            self.load(call.lifted)
        replaced = self._edited(edit) if edit else None
        results, before = [], None
        with self._described(), contextlib.redirect_stdout(io.StringIO()), np.errstate(all="ignore"):
            for row in table:
                values = {name: float(row[column]) for name, column in call.lifted.items()}
                if values != before:
                    self._run_body(values, call.outside, replaced)
                    before = values
                given = (self._argument(slot, row, call.as_columns) for slot in call.slots)
                results.append(_numbers(self._function(*given), call.output))
        if len({result.shape for result in results}) > 1:
            raise ProgramError("returns arrays of different shapes at different states")
        return np.array(results)

    @contextlib.contextmanager
    def _described(self) -> Iterator[None]:
        """Whatever a user's program raises becomes an error that says it, SystemExit, too."""
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                yield
        except (ProgramError, KeyboardInterrupt):
            raise
        except ModuleNotFoundError as error:
            if sys.modules.get((error.name or "").partition(".")[0], error) is None:  # it is hidden from this file
                raise ProgramError(*self._describe(error)) from None
            raise Unread(f"imports {error.name}, which is not installed here", self._line(error)) from None
        except PermissionError as error:
            raise Unread(f"does what is barred: {_first_line(error)}; {_BARRED}; {_APART}", self._line(error)) from None
        except BaseException as error:
            if isinstance(error, EOFError) and str(error) == "EOF when reading a line":
                raise Unread(f"asks for input, and gets none here; {_APART}", self._line(error)) from None
            if isinstance(error, MemoryError) and not str(error):  # of the interpreter's own
                raise ProgramError("needs too much memory") from None
            raise ProgramError(*self._describe(error)) from None

    def _argument(self, slot: Any, row: Floats, as_column: bool) -> Any:
        if isinstance(slot, Given):
            return value_of(slot.value, self.make_array)
        if isinstance(slot, int):
            return float(row[slot])
        values = row[list(slot)][:, None] if as_column else row[list(slot)]
        return values if self.make_array else values.tolist()

    def _edited(self, edit: Edit) -> tuple[int, Any]:
        """The statement of the text that an edit changes, and its code."""
        if any(start < edit.end and edit.start < end for start, end, _ in self._spans):
            raise ProgramError("the edit is one of a lifted constant")
        for number, (start, end, _) in enumerate(self._body):
            if start <= edit.start and edit.end <= end:
                try:
                    with warnings.catch_warnings():
                        warnings.simplefilter("ignore")
                        return number, self._compiled(start, end, edit)
                except (SyntaxError, ValueError, RecursionError):
                    break
        raise ProgramError("the edit gives no Python")

    def _describe(self, error: BaseException) -> tuple[str, int | None]:
        message = _first_line(error)
        return f"raises {type(error).__name__}{f': {message}' if message else ''}", self._line(error)

    def _line(self, error: BaseException) -> int | None:
        lines = [
            line for frame, line in traceback.walk_tb(error.__traceback__) if frame.f_code.co_filename == self.file
        ]
        return lines[-1] if lines else None


def _first_line(error: BaseException) -> str:
    return str(error).split("\n")[0][:200]


def _new_module(file: str) -> dict[str, Any]:
    """The names of a module that is found by its name: `dataclass` looks for that of a class, to read annotations."""
    module = sys.modules[_MODULE] = ModuleType(_MODULE)
    module.__dict__.update({"__file__": file, "__builtins__": builtins})
    return module.__dict__


def _has_results(result: Any) -> bool:
    """Whether a function returns several results: a tuple, a dict, or a list that is no matrix row by row."""
    if not isinstance(result, list):
        return isinstance(result, (tuple, dict))
    try:
        return np.ndim(result) > 2
    except ValueError:
        return True


def _numbers(result: Any, output: int | None) -> Floats:
    """An array of real numbers, of one of several results where an output is given.

    Raises:
        Unread: it is a function, which another call would have to evaluate.
        ProgramError: the result is none.
    """
    if callable(result) and not hasattr(result, "__array__"):
        made = getattr(result, "__name__", type(result).__name__)
        raise Unread(f"returns a function, {made}: name an object that the file makes of it, FILE:OBJECT")
    if output is not None:
        if not _has_results(result) or output >= len(result):
            raise ProgramError(f"returns no output {output + 1}")
        result = (list(result.values()) if isinstance(result, dict) else result)[output]
    kind = type(result).__name__
    if result is None:
        raise ProgramError("returns None instead of numbers")
    if hasattr(result, "tolist") and kind.endswith("Matrix"):  # sympy's
        result = result.tolist()
    if isinstance(result, dict):
        result = list(result.values())
    try:
        array = np.asarray(result)
        if array.dtype == object:
            array = np.array([float(value) for value in array.ravel()]).reshape(array.shape)
        if np.iscomplexobj(array):
            raise ProgramError("returns complex numbers")
        if array.dtype.kind not in "fiub":
            raise ProgramError(f"returns {kind} instead of numbers")
        return array.astype(np.float64)
    except (TypeError, ValueError):
        try:
            return np.concatenate([np.atleast_1d(np.asarray(part, np.float64)).ravel() for part in result])
        except Exception:
            raise ProgramError(f"returns {kind} that is not an array of numbers") from None
