"""Evaluates MATLAB functions for many states at once, in numpy."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from difflib import get_close_matches
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...errors import Arm3rError, UsageError
from ..documents import decoded
from ..expressions import (
    All,
    AnonymousFunction,
    Binary,
    Cell,
    Compare,
    Element,
    Field,
    FunctionCall,
    FunctionHandle,
    Group,
    Index,
    Last,
    Logic,
    Matrix,
    Name,
    Node,
    Not,
    Number,
    Part,
    Range,
    Root,
    Text,
    Transpose,
    Unary,
)
from ..programs import Call, Constant, Edit, Given, ProgramError, Unjudged, Unread, line_and_column
from .functions import COMPARISONS, FUNCTIONS, OPERATORS, result_of
from .indexing import Places, flat, part_of, with_element, with_part, without
from .reader import read, read_expression
from .syntax import Assignment, For, Function, If, Kept, Leave, Statement, Switch, Target, Try, While
from .trace import Trace, can_be_traced
from .values import Floats, Pages, Structures, as_numbers, check_size, integer, number, stacked, text_in

_MAX_CALLS, _MAX_DEPTH = 2000, 30
_MAX_STEPS = 20_000  # statements and turns of loops of one evaluation
_MOST_BYTES = 1 << 20  # of a file beside the program's
_MOST_TRACES = 4
_NOTHING = np.zeros((1, 0, 0))


class Divided(Exception):
    """A condition holds at some states and not at others."""


class _Left(Exception):
    """A statement leaves the loop or the function that it stands in."""

    def __init__(self, word: str) -> None:
        super().__init__(word)
        self.word = word


class Handle(NamedTuple):
    """An anonymous function, with the variables of the place where it stands; or a function by its name."""

    names: tuple[str, ...]
    body: Node | None
    variables: dict[str, Any]
    function: str = ""


class Workspace(dict[str, Any]):
    """The variables of a call; those of `kept` stay until the next call: of a function, or "" of all."""

    def __init__(self, function: Function) -> None:
        self.function = function
        self.kept: dict[str, str] = {}


class MatlabProgram:
    """A MATLAB function file. A value is an array (states, rows, columns), a text, a list for a cell array, a dict for
    a structure, `Structures`, `Pages` or a `Handle`.
    """

    of_program: tuple[str, ...] = ("exist", "isempty", "feval", "cellfun", "arrayfun")
    """Functions that look at variables or call functions, each a method."""
    can_trace = True
    """Whether what a statement writes depends on its states alone, and not on others around them."""

    def __init__(
        self,
        text: str,
        file: str,
        function: str | None = None,
        folder: str | None = None,
        beside: dict[str, MatlabProgram | None] | None = None,
        *,
        functions: dict[str, Function] | None = None,
    ) -> None:
        """
        Args:
            folder: where functions in files of their own are looked for; None: nowhere.
            beside: those that are found there by their names, the same for all files of a folder.
            functions: those of the text, where it has been read.
        """
        self.text, self.file, self.folder = text, file, folder
        self.functions = read(text, file) if functions is None else functions
        if function is not None and function not in self.functions:
            raise UsageError(f"{file}: there is no function {function}; it has {', '.join(self.functions)}")
        self.function = function or next(iter(self.functions))
        if not self.functions[self.function].outputs:
            raise UsageError(f"{file}:{self.functions[self.function].line}: {self.function} has no output")
        self._calls = self._steps = self._depth = 0
        self._known: dict[str, Floats] = {}
        self._kept: dict[tuple[str, str], Any] = {}
        self._outside: dict[str, Any] = {}
        self._beside: dict[str, MatlabProgram | None] = {Path(file).stem: self} if beside is None else beside
        self._replaced: tuple[Statement, Node] | None = None
        self._traces: list[tuple[Call, Floats, Trace | None]] = []
        """Of calls at tables, the latest ones; None: it depends on more than its inputs, or fails."""
        self._trace: Trace | None = None

    @property
    def arguments(self) -> list[str]:
        return self.functions[self.function].inputs

    @property
    def optional(self) -> list[str]:
        """The arguments that have a value without being given one: by default, or by a test of `nargin` or `exist`."""
        function = self.functions[self.function]
        values = [one.value for top in function.body for one in top.walk() if one.value]
        text = "\n".join(self.text[value.start : value.end] for value in values)
        fewest = [int(count) - (word == "<") for word, count in re.findall(r"\bnargin\s*(<=?|==)\s*(\d+)", text)]
        tested = re.findall(r"\bexist\s*\(\s*['\"](\w+)['\"]", text)
        left_out = function.inputs[min(fewest) :] if fewest else []
        left_out += [name for name in function.inputs if name in tested or name == "varargin"]
        return list(dict.fromkeys([*function.defaults, *left_out]))

    @property
    def outputs(self) -> list[str]:
        return self.functions[self.function].outputs

    def comments(self) -> str:
        return " ".join(line.split("%", 1)[1] for line in self.text.splitlines() if "%" in line)

    def statements(self) -> list[Statement]:
        every = [statement for function in self.functions.values() for statement in function.body]
        return [inner for statement in every for inner in statement.walk()]

    def nodes(self) -> list[Node]:
        return [Root(one.start, one.end, (one.value,)) for one in self.statements() if one.value]

    @np.errstate(all="ignore")
    def constants(self) -> list[Constant]:
        """The names that are assigned once, and a number."""
        assignments = [one for one in self.statements() if isinstance(one, Assignment)]
        count = Counter(target.name for one in assignments for target in one.targets)
        count.update(one.name for one in self.statements() if isinstance(one, For))
        count.update(name for function in self.functions.values() for name in function.inputs)
        return [
            Constant(one.targets[0].name, float(self._value(one.value, {})[0, 0, 0]), one.value.start, one.value.end)
            for one in assignments
            if one.value and len(one.targets) == 1 and not one.targets[0].way
            if count[one.targets[0].name] == 1 and self._is_number(one.value)
        ]

    def _is_number(self, node: Node) -> bool:
        known = (Number, Unary, Binary, Group)
        return all(isinstance(one, known) and one.word not in ("^", ".^") for one in node.walk())

    # ---- calls from outside ------------------------------------------------------------------------------------------

    def evaluate(self, call: Call, table: Floats, edit: Edit | None = None) -> Floats:
        """A row of numbers for each row of the table, in the shape that the function returns.

        Raises:
            ProgramError: the function failed.
        """
        replaced = self._edited(edit) if edit else None
        self._trace = self._trace_of(call, table) if edit else None
        self._replaced = replaced
        try:
            return self._evaluate(call, table)
        except Divided:
            self._trace = None
            rows = [self._evaluate(call, row[None]) for row in table]
        finally:
            self._replaced = self._trace = None
        if len({row.shape for row in rows}) > 1:
            raise ProgramError("returns arrays of different shapes at different states")
        return np.concatenate(rows)

    def _trace_of(self, call: Call, table: Floats) -> Trace | None:
        """What the statements write without an edit."""
        for known_call, known_table, trace in self._traces:
            if known_call == call and np.array_equal(known_table, table):
                return trace
        found = self._trace = Trace(self.functions[self.function]) if self.can_trace else None
        try:
            if found:
                self._evaluate(call, table)
        except (ProgramError, Divided, ValueError):
            found = None
        if not can_be_traced(one for program in self._programs for one in program.functions.values()):
            found = None
        self._traces = [*self._traces[1 - _MOST_TRACES :], (call, table.copy(), found)]
        return found

    def _evaluate(self, call: Call, table: Floats) -> Floats:
        """
        Raises:
            ProgramError: the function failed.
            Divided: a condition holds at some of the states.
        """
        self._begin()
        self._outside = {}
        for name, value in call.outside.items():
            _put_variable(self._outside, name, _value_given(value))
        for one in self._programs:
            one._kept, one._outside = {}, self._outside
        self._known = {name: table[:, column].reshape(-1, 1, 1) for name, column in call.lifted.items()}
        inputs = [
            _value_given(slot.value)
            if isinstance(slot, Given)
            else table[:, [slot] if isinstance(slot, int) else list(slot)][:, :, None]
            for slot in call.slots
        ]
        with np.errstate(all="ignore"):
            chosen = None if call.output is None else [self.outputs[call.output]]
            outputs = self._run(self.functions[self.function], inputs, asked=len(self.outputs), chosen=chosen)
        if not all(isinstance(one, np.ndarray) for one in outputs):
            raise ProgramError("returns a cell array, a text or a function instead of numbers")
        outputs = [np.broadcast_to(as_numbers(one), (len(table), *one.shape[1:])) for one in outputs]
        if len(outputs) == 1:
            result = outputs[0]
            return result[:, :, 0] if result.shape[2] == 1 else result
        if any(one.shape[1:] != (1, 1) for one in outputs):
            raise ProgramError("returns several outputs that are no scalars")
        return np.stack([one[:, 0, 0] for one in outputs], axis=1)

    def call(self, *arguments: ArrayLike) -> list[Floats]:
        """The outputs at one state, each a matrix. A vector is given as a column. What is persistent stays.

        Raises:
            ProgramError: the function failed.
        """
        self._begin()
        columns = [np.asarray(one, np.float64) for one in arguments]
        inputs = [(one if one.ndim == 2 else one.reshape(-1, 1))[np.newaxis] for one in columns]
        with np.errstate(all="ignore"):
            return [
                as_numbers(one)[0] if isinstance(one, np.ndarray) else one
                for one in self._run(self.functions[self.function], inputs, asked=len(self.outputs))
            ]

    @property
    def _programs(self) -> list[MatlabProgram]:
        """This one, and those in files beside it."""
        return [self, *(one for one in self._beside.values() if one and one is not self)]

    def _begin(self) -> None:
        for one in self._programs:
            one._calls = one._steps = 0

    def _edited(self, edit: Edit) -> tuple[Statement, Node]:
        for statement in self.statements():
            value = statement.value
            if value and value.start <= edit.start and edit.end <= value.end:
                moved = edit._replace(start=edit.start - value.start, end=edit.end - value.start)
                try:
                    return statement, read_expression(moved.apply(self.text[value.start : value.end]))
                except UsageError:
                    break
        raise ProgramError("the edit gives no MATLAB")

    # ---- functions ---------------------------------------------------------------------------------------------------

    def _run(
        self,
        function: Function,
        inputs: list[Any],
        outer: dict[str, Any] | None = None,
        asked: int = 1,
        chosen: list[str] | None = None,
    ) -> list[Any]:
        """
        Args:
            outer: the variables of the place of the call, which a nested function uses.
            asked: how many outputs the function is asked for.
            chosen: those that are needed; by default all that are asked for.
        """
        with self._called(function.line):
            if function.is_nested and isinstance(outer, Workspace):
                return self._run_nested(function, inputs, outer, asked)
            return self._outputs(function, inputs, Workspace(function), asked, chosen)

    def _run_nested(self, function: Function, inputs: list[Any], outer: Workspace, asked: int) -> list[Any]:
        """In the variables of the function around it, but for its own arguments and outputs."""
        own = {*function.inputs, *function.outputs, "nargin", "nargout"}
        before = {name: outer.pop(name) for name in own if name in outer}
        try:
            return self._outputs(function, inputs, outer, asked)
        finally:
            for name in own:
                outer.pop(name, None)
            outer.update(before)

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

    def _outputs(
        self,
        function: Function,
        inputs: list[Any],
        variables: Workspace,
        asked: int,
        chosen: list[str] | None = None,
    ) -> list[Any]:
        names = function.inputs
        if names and names[-1] == "varargin":
            inputs, names = [*inputs[: len(names) - 1], list(inputs[len(names) - 1 :])], names[: len(inputs) + 1]
        if len(inputs) > len(names):
            raise ProgramError(f"{function.name} takes {len(names)} arguments, got {len(inputs)}", function.line)
        variables["nargin"], variables["nargout"] = number(len(inputs)), number(asked)
        for name, given in zip(names, inputs, strict=False):
            _put_variable(variables, name, given)
        for name, default in function.defaults.items():
            if name not in variables:
                _put_variable(variables, name, self._value(default, variables))
        try:
            self._execute_body(function, variables)
        except _Left as left:
            if left.word != "return":
                raise ProgramError(f"`{left.word}` stands outside of a loop", function.line) from None
        finally:
            self._kept.update({(of, name): variables[name] for name, of in variables.kept.items() if name in variables})
        outputs = chosen or function.outputs[:asked]
        for name in outputs:
            if name not in variables and not _fields(variables, name):
                raise ProgramError(f"the output {name} is not assigned", function.line)
        return [variables[name] if name in variables else _fields(variables, name) for name in outputs]

    def _function_beside(self, name: str) -> MatlabProgram | None:
        """The function of this name in a file of its own."""
        if self.folder is None or "." in name:
            return None
        if name not in self._beside:
            self._beside[name] = self._read_beside(Path(self.folder) / f"{name}.m")
        return self._beside[name]

    def _read_beside(self, path: Path) -> MatlabProgram | None:
        if not path.is_file() or path.is_symlink() or path.stat().st_size > _MOST_BYTES:
            return None
        try:
            found = MatlabProgram(decoded(path.read_bytes()), str(path), None, self.folder, self._beside)
        except Arm3rError as error:
            raise Unread(f"needs a file that is not read: {error}") from None
        found._outside = self._outside
        return found

    def _call_beside(self, other: MatlabProgram, inputs: list[Any], asked: int = 1) -> list[Any]:
        with self._called(), np.errstate(all="ignore"):
            if other._depth:
                raise Unread(f"{Path(other.file).name} calls itself through other files, which is not read")
            try:
                return other._run(other.functions[other.function], inputs, asked=asked)
            except ProgramError as error:
                place = f"{Path(other.file).name}{f':{error.line}' if error.line else ''}"
                raise type(error)(f"{error} (in {place})") from None

    # ---- statements --------------------------------------------------------------------------------------------------

    def _execute_body(self, function: Function, variables: dict[str, Any]) -> None:
        if not self._trace or self._depth > 1:
            self._execute(function.body, variables)
        elif self._replaced:
            self._trace.replay(self._replaced[0], self.functions, variables, self._execute)
        else:
            self._trace.record(variables, self._execute)

    def _execute(self, statements: list[Statement], variables: dict[str, Any]) -> None:
        for statement in statements:
            self._count_step(statement)
            match statement:
                case Assignment():
                    self._assign(statement, variables)
                case For():
                    self._loop(statement, variables)
                case While():
                    while self._holds(statement, variables) and self._turn(statement, variables):
                        self._count_step(statement)
                case If(bodies=(body, otherwise)):
                    self._execute(body if self._holds(statement, variables) else otherwise, variables)
                case Switch():
                    self._execute(self._chosen(statement, variables), variables)
                case Try(bodies=(body, otherwise)):
                    self._try(body, otherwise, variables)
                case Leave(word=word):
                    raise _Left(word)
                case Kept():
                    self._keep(statement, variables)

    def _count_step(self, statement: Statement) -> None:
        self._steps += 1
        if self._steps > _MAX_STEPS:
            line, _ = line_and_column(self.text, statement.start)
            raise Unread(f"takes more than {_MAX_STEPS} steps", line)

    def _turn(self, statement: Statement, variables: dict[str, Any]) -> bool:
        """Whether the loop goes on after its body."""
        try:
            self._execute(statement.bodies[0], variables)
        except _Left as left:
            if left.word == "return":
                raise
            return left.word == "continue"
        return True

    def _loop(self, statement: For, variables: dict[str, Any]) -> None:
        for value in self._turns(statement, variables):
            self._count_step(statement)
            variables[statement.name] = value
            if not self._turn(statement, variables):
                break

    def _try(self, body: list[Statement], otherwise: list[Statement], variables: dict[str, Any]) -> None:
        try:
            self._execute(body, variables)
        except (Unread, Unjudged):
            raise
        except ProgramError:
            self._execute(otherwise, variables)

    def _keep(self, statement: Kept, variables: dict[str, Any]) -> None:
        if not isinstance(variables, Workspace):
            raise Unread("persistent variables of an anonymous function are not read")
        for name in statement.names:
            of = "" if statement.is_global else variables.function.name
            variables.kept[name] = of
            if (of, name) in self._kept or not statement.is_global:
                variables[name] = self._kept.get((of, name), _NOTHING)

    def _value_of(self, statement: Statement) -> Node:
        if self._replaced and self._replaced[0] is statement:
            return self._replaced[1]
        assert statement.value
        return statement.value

    def _holds(self, statement: Statement, variables: dict[str, Any]) -> bool:
        """Whether a condition holds: all of its elements, at all states."""
        with self._at(statement):
            return _is_true(self._array(self._value_of(statement), variables))

    def _chosen(self, statement: Switch, variables: dict[str, Any]) -> list[Statement]:
        """The body of the first label that fits, or the last one."""
        with self._at(statement):
            value = self._value(self._value_of(statement), variables)
            for label, body in zip(statement.labels, statement.bodies, strict=False):
                given = self._value(label, variables)
                if any(_fits(value, one) for one in (given if isinstance(given, list) else [given])):
                    return body
        return statement.bodies[-1]

    def _turns(self, statement: Statement, variables: dict[str, Any]) -> Iterator[Floats]:
        """The values of a loop's variable: numbers of a range, or the columns of a matrix."""
        node = self._value_of(statement)
        while isinstance(node, Group):
            (node,) = node.parts
        with self._at(statement):
            if isinstance(node, Range):
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

    def _assign(self, statement: Assignment, variables: dict[str, Any]) -> None:
        value, targets = self._value_of(statement), statement.targets
        with self._at(statement):
            if not targets:
                self._several(value, variables) if isinstance(value, FunctionCall) else self._value(value, variables)
                return
            if self._is_lifted(statement):
                variables[targets[0].name] = self._known[targets[0].name]
                return
            given = [self._value(value, variables)] if len(targets) == 1 else self._several(value, variables, targets)
            if len(given) < len(targets):
                raise ProgramError(f"{len(targets)} outputs are asked for, and {len(given)} are there")
            for target, one in zip(targets, given, strict=False):
                self._put(target, one, value, variables)

    def _is_lifted(self, statement: Assignment) -> bool:
        """Whether a constant is assigned whose value comes from outside."""
        first, *others = statement.targets
        is_known = not others and not first.way and first.name in self._known
        return is_known and statement.value is not None and self._is_number(statement.value)

    def _put(self, target: Target, given: Any, value: Node, variables: dict[str, Any]) -> None:
        if not target.way:
            if target.name:
                _put_variable(variables, target.name, given)
            return
        is_empty = isinstance(value, Matrix) and not value.parts
        held = variables.get(target.name)
        held = _fields(variables, target.name) or None if held is None else held
        _put_variable(variables, target.name, self._with(held, target.way, given, is_empty, variables))

    def _with(self, held: Any, way: Sequence[Node], given: Any, is_empty: bool, variables: dict[str, Any]) -> Any:
        """What is held, with the part at the end of the way replaced, or left out where `[]` is given."""
        step, *rest = way
        if isinstance(step, Field):
            if not isinstance(held, (dict, type(None))):
                raise Unread(f"a field {step.word} is set of what is no single structure, which is not read")
            fields = {**held} if held else {}
            inner = fields.get(step.word)
            return fields | {step.word: self._with(inner, rest, given, is_empty, variables) if rest else given}
        if step.word == "{" or (isinstance(held, (list, dict)) and not isinstance(held, Pages)) or rest:
            return self._with_element(held, step, rest, given, is_empty, variables)
        if len(step.parts) == 3 or isinstance(held, Pages):
            return self._with_page(held, step, given, variables)
        if not isinstance(given, np.ndarray):
            if isinstance(given, dict):
                return self._with_element(held, step, rest, given, is_empty, variables)
            raise Unread("an element of a matrix is set to a number; more is not read")
        mask = self._mask(step.parts, variables)
        if mask is not None:
            return _with_where(held, mask, given)
        array = _NOTHING if held is None else held
        if not isinstance(array, np.ndarray):
            raise ProgramError("an index is assigned of what is not a matrix")
        if len(step.parts) > 2:
            raise Unread("an index of more than three dimensions is not read")
        is_all = [isinstance(part, All) for part in step.parts]
        if len(step.parts) == 2:
            places = []
            for axis, part in enumerate(step.parts):
                size = array.shape[axis + 1] or (given.shape[axis + 1] if is_all[axis] else 0)
                places.append(self._places(part, size, variables))
        else:
            places = [self._places(step.parts[0], array.shape[1] * array.shape[2], variables)]
        return without(array, places, is_all) if is_empty else with_part(array, places, given)

    def _with_element(
        self, held: Any, step: Node, rest: Sequence[Node], given: Any, is_empty: bool, variables: dict[str, Any]
    ) -> Any:
        """A cell array, or an array of structures, with one element set."""
        if isinstance(held, dict):
            held = Structures([held])
        if isinstance(held, np.ndarray) and not held.size:
            held = None
        if held is None and (step.word != "{"):
            held = Structures()
        if not isinstance(held, (list, type(None))):
            raise ProgramError("an element of what is no cell array and no structure is set")
        place = self._place_in_cell(step.parts, len(held or ()), variables)
        if rest:
            inner = held[place] if held and 0 <= place < len(held) else None
            given = self._with(inner, rest, given, is_empty, variables)
        return with_element(held, place, given)

    def _with_page(self, held: Any, step: Node, given: Any, variables: dict[str, Any]) -> Pages:
        """The pages with a part of one of them replaced; they grow as matrices do."""
        if not isinstance(given, np.ndarray):
            raise Unread("a matrix is put into an array of three dimensions; more is not read")
        if len(step.parts) != 3:
            raise Unread("an array of three dimensions is set by three indices")
        pages = Pages([held]) if isinstance(held, np.ndarray) else Pages(held or ())
        place, page = self._page(pages, step.parts, variables)
        if all(isinstance(one, All) for one in step.parts[:2]):
            page = given
        else:
            index = Index(step.start, step.end, step.parts[:2], "(")
            page = self._with(page, [index], given, False, variables)
        check_size(1, place + 1)
        empty = np.zeros((1, *page.shape[1:]))
        return Pages([*pages[:place], *[empty] * (place - len(pages)), page, *pages[place + 1 :]])

    def _mask(self, parts: Sequence[Node], variables: dict[str, Any]) -> Any:
        """An index that says for each element whether it is meant; None where it holds places."""
        if len(parts) != 1 or isinstance(parts[0], (All, Range, Number, Last, Binary)):
            return None
        value = self._value(parts[0], variables)
        return value if isinstance(value, np.ndarray) and value.dtype == bool else None

    def _several(self, node: Node, variables: dict[str, Any], targets: Sequence[Target] = ()) -> list[Any]:
        """All the outputs of a call, or all elements of a cell array."""
        if not isinstance(node, FunctionCall):
            raise Unread("several outputs come from a call")
        if isinstance(node, Element):
            return self._values([node], variables)
        if node.word not in variables:
            if node.word in self.functions:
                inputs = self._values(node.parts, variables)
                return self._run(self.functions[node.word], inputs, variables, len(targets))
            other = None if node.word in FUNCTIONS else self._function_beside(node.word)
            if other:
                return self._call_beside(other, self._values(node.parts, variables), len(targets))
            if node.word == "deal":
                values = self._values(node.parts, variables)
                return values * len(targets) if len(values) == 1 else values
            if node.word == "size" and len(node.parts) == 1:
                sizes = self._array(node, variables)
                return [sizes[:, :, [column]] for column in range(sizes.shape[2])]
        if targets:
            raise Unread(f"several outputs come from functions of this file and its folder, `size` and `deal`, "
                         f"not from {node.word}")  # fmt: skip
        return [self._value(node, variables)]

    # ---- values ------------------------------------------------------------------------------------------------------

    def _array(self, node: Node, variables: dict[str, Any]) -> Floats:
        """The value of a node that is a matrix of numbers."""
        value = self._value(node, variables)
        if isinstance(value, Pages):
            raise Unread("of an array of three dimensions one page at a time is read, such as T(:,:,1)")
        if isinstance(value, str):
            raise Unread(f"the text {self.text[node.start : node.end]!r} is not a number")
        if not isinstance(value, np.ndarray):
            raise ProgramError(f"{self.text[node.start : node.end]!r} is not a number")
        return as_numbers(value)

    def _values(self, parts: Sequence[Node], variables: dict[str, Any]) -> list[Any]:
        """The values of arguments or elements; T{:} gives all that are in T."""
        found = []
        for part in parts:
            is_list = isinstance(part, Element) and isinstance(part.parts[0], (All, Range))
            if is_list and isinstance(variables.get(part.word), list):
                cell = variables[part.word]
                found += [cell[place] for place in self._places(part.parts[0], len(cell), variables)]
            else:
                found.append(self._value(part, variables))
        return found

    def _value(self, node: Node, variables: dict[str, Any]) -> Any:
        match node:
            case Number():
                return number(node.value)
            case Name() | Last():
                return variables[node.word] if node.word in variables else self._call(node, variables)
            case Group():
                return self._value(node.parts[0], variables)
            case Unary():
                inner = self._array(node.parts[0], variables)
                return -inner if node.word == "-" else inner
            case Binary():
                return self._chain(node, variables)
            case Compare() | Logic():
                left = self._array(node.parts[0], variables)
                if (node.word == "&&" and not left.any()) or (node.word == "||" and left.all() and left.size):
                    return left != 0  # the other side is not looked at
                return np.asarray(COMPARISONS[node.word](left, self._array(node.parts[1], variables)))
            case Transpose():
                return np.swapaxes(self._array(node.parts[0], variables), 1, 2)
            case Matrix():
                return self._matrix(node, variables)
            case Range():
                numbers = self._range(node, variables)
                check_size(1, len(numbers))
                return np.array(numbers, float).reshape(1, 1, -1)
            case FunctionCall():
                return self._call(node, variables)
            case Not():
                return self._array(node.parts[0], variables) == 0
            case Text():
                return node.word
            case Cell():
                cells = [one for row in node.parts for one in self._values(row.parts, variables)]
                check_size(1, len(cells))
                return cells
            case Part():
                return self._step(self._value(node.parts[0], variables), node, variables)
            case FunctionHandle():
                return Handle((), None, {}, node.word)
            case AnonymousFunction():
                return Handle(node.names, node.parts[0], dict(variables))
        raise Unread(f"{self.text[node.start : node.end]!r} is not read here")

    def _chain(self, node: Node, variables: dict[str, Any]) -> Floats:
        """a + b - c + ...: from the left, however long it is."""
        chain = [node]
        while isinstance(first := chain[-1].parts[0], Binary):
            chain.append(first)
        value = self._array(chain[-1].parts[0], variables)
        for one in reversed(chain):
            value = self._binary(one.word, value, self._array(one.parts[1], variables))
        return value

    def _matrix(self, node: Node, variables: dict[str, Any]) -> Any:
        rows = [self._values(row.parts, variables) for row in node.parts]
        if any(isinstance(one, str) for row in rows for one in row):
            if not all(isinstance(one, str) for row in rows for one in row):
                raise Unread("a number beside a text in one matrix is not read")
            return "".join(one for row in rows for one in row)
        if any(not isinstance(one, np.ndarray) or isinstance(one, Pages) for row in rows for one in row):
            raise Unread(f"{self.text[node.start : node.end]!r} holds what is not a matrix of numbers")
        return stacked([stacked(row, 2) for row in rows] or [_NOTHING], 1)

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
            return self._step(variables[name], node, variables)
        if not isinstance(node, Element) and name in self.of_program:
            return getattr(self, f"_{name}")(node, variables)
        if not isinstance(node, Element) and (name in self.functions or name in FUNCTIONS):
            return self._result(name, self._values(node.parts, variables), variables)
        if name in self._outside:
            return self._step(self._outside[name], node, variables)
        fields = _fields(variables, name) or _fields(self._outside, name)
        if fields:
            return self._step(fields, node, variables) if isinstance(node, FunctionCall) else fields
        if isinstance(node, Name) and self._function_beside(name) is None:
            remedy = f"write {name} = NUMBER; above, make it an argument, or say it by --set {name}=NUMBER"
            raise Unread(f"{name!r} has no value in this file: {remedy}", name=name)
        return self._result(name, self._values(node.parts, variables), variables)

    def _result(self, name: str, inputs: list[Any], variables: dict[str, Any]) -> Any:
        """The first output of a function of the file, of MATLAB, or of a file beside it."""
        if name in self.functions:
            outputs = self._run(self.functions[name], inputs, variables)
        elif name in FUNCTIONS:
            return result_of(name, inputs)
        elif other := self._function_beside(name):
            outputs = self._call_beside(other, inputs)
        else:
            near = get_close_matches(name, [*self.functions, *FUNCTIONS, *variables], 1, 0.75)
            raise Unread(
                f"{name!r} is not known: no variable, no function of this file or of a file beside it, and none of "
                f"MATLAB that is read; {f'is {near[0]} meant?' if near else 'write it as a function of this file'}"
            )
        if not outputs:
            raise ProgramError(f"{name} has no output")
        return outputs[0]

    def _step(self, held: Any, node: Node, variables: dict[str, Any]) -> Any:
        """What an index or a field takes from a value, or a function returns."""
        parts = node.parts if isinstance(node, FunctionCall) else node.parts[1:]
        word = node.word if isinstance(node, Part) else "{" if isinstance(node, Element) else "("
        shown = self.text[node.start : node.end]
        if isinstance(node, Part) and isinstance(node.step, Field):
            if isinstance(held, Structures) and len(held) == 1:
                held = held[0]
            if not isinstance(held, dict):
                raise ProgramError(f"{shown!r} is a field of what is no structure")
            found = held[word] if word in held else _fields(held, word)
            if found is None or (isinstance(found, dict) and not found):
                raise ProgramError(f"there is no field {word}")
            return found
        if isinstance(held, Handle):
            return self._apply(held, self._values(parts, variables), variables)
        if isinstance(held, Structures) or word == "{":
            return self._element(held, shown, parts, variables)
        if isinstance(held, Pages):
            return self._part(self._page(held, parts, variables)[1], parts[:2], variables)
        if isinstance(held, dict) and len(parts) == 1 and self._places(parts[0], 1, variables) == [0]:
            return held
        if isinstance(held, list):
            return [held[place] for place in self._places(parts[0], len(held), variables) if place < len(held)]
        if not isinstance(held, np.ndarray):
            raise Unread(f"{shown!r} indexes what is not a matrix")
        return self._part(held, parts, variables)

    def _apply(self, handle: Handle, inputs: list[Any], variables: dict[str, Any]) -> Any:
        if handle.body is None:
            return self._result(handle.function, inputs, variables)
        if len(inputs) != len(handle.names):
            raise ProgramError(f"an anonymous function takes {len(handle.names)} arguments, got {len(inputs)}")
        with self._called():
            return self._value(handle.body, {**handle.variables, **dict(zip(handle.names, inputs, strict=True))})

    def _element(self, cell: Any, shown: str, parts: Sequence[Node], variables: dict[str, Any]) -> Any:
        """T{i} of a cell array with one row or one column, L(i) of an array of structures."""
        if not isinstance(cell, list):
            raise ProgramError(f"{shown!r} is an element of what is no cell array")
        place = self._place_in_cell(parts, len(cell), variables)
        if not 0 <= place < len(cell) or cell[place] is None:
            raise ProgramError(f"{shown!r}: there is no element {place + 1}")
        return cell[place]

    def _place_in_cell(self, parts: Sequence[Node], size: int, variables: dict[str, Any]) -> int:
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
        return places[0], pages[places[0]] if places[0] < len(pages) else _NOTHING

    def _places(self, part: Node, size: int, variables: dict[str, Any]) -> Places:
        if isinstance(part, All):
            return list(range(size))
        inside = {**variables, "end": number(size)}
        if isinstance(part, Range):
            return [int(one) - 1 for one in self._range(part, inside)]
        places = self._value(part, inside)
        if not isinstance(places, np.ndarray):
            raise Unread("an index is a number, a range or a comparison")
        if len(places) > 1 and (places != places[:1]).any():
            raise Divided
        if places.dtype == bool:
            return [int(place) for place in np.flatnonzero(places[0].T.ravel())]
        return [round(float(one)) - 1 for one in places[0].T.ravel()]

    def _part(self, array: Floats, parts: Sequence[Node], variables: dict[str, Any]) -> Floats:
        if not parts:
            return array
        rows, columns = array.shape[1:]
        if len(parts) > 2:
            raise Unread("an index of three dimensions is read of what zeros(rows, columns, pages) has made")
        sizes = (rows * columns,) if len(parts) == 1 else (rows, columns)
        places = [self._places(part, size, variables) for part, size in zip(parts, sizes, strict=True)]
        return part_of(array, places, isinstance(parts[0], All))

    # ---- functions that look at variables or call functions ----------------------------------------------------------

    def _exist(self, node: Node, variables: dict[str, Any]) -> Floats:
        name = text_in(self._values(node.parts, variables)[0])
        return number(name in variables or bool(_fields(variables, name)) or name in self.functions)

    def _isempty(self, node: Node, variables: dict[str, Any]) -> Any:
        """A global variable is empty before a value is given to it."""
        kept = variables.kept if isinstance(variables, Workspace) else {}
        match node.parts:
            case (Name(word=name),) if kept.get(name) == "" and name not in variables and name not in self._outside:
                return number(True)
        return self._result(node.word, self._values(node.parts, variables), variables)

    def _feval(self, node: Node, variables: dict[str, Any]) -> Any:
        handle, inputs = self._applied(node, variables)
        return self._apply(handle, inputs, variables)

    def _applied(self, node: Node, variables: dict[str, Any]) -> tuple[Handle, list[Any]]:
        """The first argument, a function, and the others."""
        function, *inputs = self._values(node.parts, variables) or [None]
        handle = Handle((), None, {}, function) if isinstance(function, str) else function
        if not isinstance(handle, Handle):
            raise ProgramError(f"{node.word} takes a function, and what it is applied to")
        return handle, inputs

    def _cellfun(self, node: Node, variables: dict[str, Any]) -> Any:
        """cellfun and arrayfun: a row of results, or with 'UniformOutput', false a cell array."""
        handle, given = self._applied(node, variables)
        is_uniform = True
        if len(given) > 2 and given[-2] == "UniformOutput" and isinstance(given[-1], np.ndarray):
            is_uniform = _is_true(given[-1])
            given = given[:-2]
        if not given or not all(isinstance(one, (list, np.ndarray)) for one in given):
            raise Unread(f"{node.word} is read of matrices and cell arrays, with 'UniformOutput' alone as an option")
        lists = [one if isinstance(one, list) else list(flat(one).T[:, :, None, None]) for one in given]
        found = [self._apply(handle, list(inputs), variables) for inputs in zip(*lists, strict=True)]
        if not is_uniform:
            return found
        if not all(isinstance(one, np.ndarray) and one.shape[1:] == (1, 1) for one in found):
            raise ProgramError(f"{node.word} gives other than single numbers, without 'UniformOutput', false")
        is_column = isinstance(given[0], np.ndarray) and given[0].shape[2] == 1
        return stacked(found, 1 if is_column else 2) if found else _NOTHING

    _arrayfun = _cellfun


def _value_given(given: Any) -> Any:
    """A number, a column for a list, or a structure."""
    if isinstance(given, dict):
        return {name: _value_given(inner) for name, inner in given.items()}
    array = np.asarray(given, np.float64)
    return array.reshape(1, -1, 1) if array.ndim < 2 else array[None]


def _is_true(array: Any) -> bool:
    """Whether all elements are other than zero, and there are some.

    Raises:
        Divided: at some states, and not at others.
    """
    holds = np.logical_and.reduce(array.reshape(len(array), -1) != 0, axis=1) & (array.size > 0)
    if holds.any() != holds.all():
        raise Divided
    return bool(holds.all())


def _fits(value: Any, label: Any) -> bool:
    """Whether a label of `switch` is that of a value."""
    if isinstance(value, np.ndarray) and isinstance(label, np.ndarray):
        return label.size > 0 and _is_true(np.asarray(value == label, float))
    return isinstance(value, str) and isinstance(label, str) and value == label


def _with_where(array: Any, mask: Any, given: Floats) -> Floats:
    """The matrix with a number where a comparison holds, which it may do at some states and not at others."""
    if not isinstance(array, np.ndarray) or mask.shape[1:] != array.shape[1:] or given.shape[1:] != (1, 1):
        raise Unread("a number is put where a comparison of the whole matrix holds; more is not read")
    return np.where(mask, given, array)


def _fields(variables: dict[str, Any], name: str) -> dict[str, Any]:
    """The fields of a structure: p.a2 is a variable of this name."""
    return {key[len(name) + 1 :]: value for key, value in variables.items() if key.startswith(f"{name}.")}


def _put_variable(variables: dict[str, Any], name: str, value: Any) -> None:
    if not isinstance(value, dict):
        variables[name] = value
        return
    for key in [key for key in variables if key == name or key.startswith(f"{name}.")]:
        del variables[key]
    for key, inner in value.items():
        _put_variable(variables, f"{name}.{key}", inner)
