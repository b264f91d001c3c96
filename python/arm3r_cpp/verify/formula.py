"""The user's formula: a program, and what it is given."""

from __future__ import annotations

import ast
import inspect
import os
import re
import textwrap
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from .._files import regular
from .._native import Floats
from ..errors import UnjudgedError, UnreadError, UsageError
from ..user_functions.c_symbol import text_of
from ..user_functions.documents import MATLAB, code_of
from ..user_functions.expressions import Node
from ..user_functions.matlab.program import MatlabProgram
from ..user_functions.matlab.script import SymbolicScript, program_of
from ..user_functions.octave.installation import installed
from ..user_functions.octave.process import OctaveProcess
from ..user_functions.octave.source import constants_of, headers_of
from ..user_functions.programs import Call, Constant, Edit, Given, ProgramError, calls_in, numbers_of
from ..user_functions.python_functions import needed_by, objects_of
from ..user_functions.python_in_memory import PythonInMemory
from ..user_functions.python_nodes import PythonText
from ..user_functions.python_process import PythonProcess
from ..user_functions.python_program import _numbers, value_of
from ..user_functions.sympy_expressions import function_of, is_expression
from .kinds import KINDS, Kind, kind_of_name, kinds_of_outputs
from .names import TIME, quantities_of, slot_of, slots_of
from .samples import Samples, columns


class Program(Protocol):
    """Evaluates the user's function, (rows, columns) to (rows, ...)."""

    def evaluate(self, call: Call, table: Floats, edit: Edit | None = None) -> Floats: ...


class CallableProgram:
    """A function without a text."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function

    def evaluate(self, call: Call, table: Floats, edit: Edit | None = None) -> Floats:
        results = []
        for row in table:
            values = [
                value_of(slot.value)
                if isinstance(slot, Given)
                else float(row[slot])
                if isinstance(slot, int)
                else row[list(slot)][:, None]
                if call.as_columns
                else row[list(slot)]
                for slot in call.slots
            ]
            try:
                results.append(_numbers(self.function(*values), call.output))
            except ProgramError:
                raise
            except Exception as error:
                raise ProgramError(f"raises {type(error).__name__}: {error}") from None
        return np.array(results)


@dataclass
class Formula:
    """A user's function, with what its text tells about it."""

    file: str
    name: str
    program: Program
    arguments: list[str]
    constants: dict[str, Constant] = field(default_factory=dict)
    defaults: dict[str, float] = field(default_factory=dict)
    nodes: list[Node] = field(default_factory=list)
    default_nodes: list[Node] = field(default_factory=list)
    """The numbers in `defaults`, and those of other functions of the text, where they stand."""
    text: str | None = None
    language: str = "python"
    comments: str = ""
    outputs: list[str] = field(default_factory=list)
    """The names of several outputs in their order, where they have names."""
    optional: list[str] = field(default_factory=list)
    """The arguments that have a default."""
    global_numbers: dict[str, float] = field(default_factory=dict)
    """Numbers outside of the text that a function in memory uses."""
    output: int | None = None
    """Which of several results is meant, from 0; None: there is one."""
    engine: str = ""
    """Which program evaluates it in the place of this package, and what this package does not read; or which variable
    of a script it is."""
    as_columns: bool = False
    """Whether vectors are given with two axes, (n, 1)."""
    beside: list[str] = field(default_factory=list)
    """Other functions of the file that are named as formulas, where no function and no kind was asked for."""
    given: dict[str, Any] = field(default_factory=dict)
    """Values of arguments and of names outside of the text, as the user says them; a structure holds others."""

    @property
    def outside(self) -> dict[str, Any]:
        """Values of names that are no arguments."""
        return {name: value for name, value in self.given.items() if name not in self.arguments}

    def edited(self, edit: Edit) -> Formula | None:
        """The formula of a file with an edit of its text."""
        program = self.program
        if self.text is None or not isinstance(program, (MatlabProgram, PythonInMemory, PythonProcess)):
            return None
        if isinstance(program, PythonInMemory) and program.has_surroundings:
            return None
        sandbox = type(program) if isinstance(program, PythonProcess) else PythonProcess
        edited = from_text(
            edit.apply(self.text), self.file, self.name, sandbox=sandbox, folder=getattr(program, "folder", None)
        )
        return replace(
            edited,
            output=self.output,
            as_columns=self.as_columns,
            given=self.given,
            arguments=self.arguments,
            optional=self.optional,
        )

    @property
    def order(self) -> list[int] | None:
        """The places of outputs 1 to n among several outputs whose names end with these numbers."""
        digits = numbers_of(self.outputs)
        if self.output is not None or len(digits) < 2 or sorted(digits) != [str(n + 1) for n in range(len(digits))]:
            return None
        if self.language == "python" and numbers_of(self.arguments)[: len(digits)] != digits:
            return None  # a Python function returns by position, unless its arguments have the same order
        return [digits.index(str(n + 1)) for n in range(len(digits))]

    @property
    def output_words(self) -> str:
        """Which of several results is judged; "" of one."""
        if self.output is None:
            return ""
        return f"its output {self.outputs[self.output] if self.language == 'matlab' else self.output + 1}"

    def numbers(self) -> dict[str, float]:
        """The numbers that the text gives to names."""
        assigned = {name: one.value for name, one in self.constants.items()}
        return {**self.defaults, **self.global_numbers, **assigned}

    def parameters(self, kind: Kind, joints: int) -> dict[str, str]:
        """The parameters of the arm among arguments and constants, by the names of the formula."""
        known = quantities_of([name for name in self.arguments if not _is_state(name, kind)])
        names = [*self._given(kind, known), *self.constants, *self.global_numbers]
        names = [name for name in names if name not in self.given]
        return quantities_of([name for name in names if not _is_state(name, kind) and name != "self"])

    def _given(self, kind: Kind, parameters: Iterable[str]) -> list[str]:
        """The arguments up to the first one that may be left out and is neither a state nor a parameter."""
        left_out = [
            name in self.optional and name not in (*parameters, *self.given) and not _is_state(name, kind)
            for name in self.arguments
        ]
        return self.arguments[: left_out.index(True)] if any(left_out) else self.arguments

    def bind(self, kind: Kind, joints: int, parameters: dict[str, str], known: list[str]) -> Call:
        """How the function is called; `known` are the quantities that stand in the table behind the joint vectors."""
        first = 4 * joints
        if self.language == "c":
            return Call(tuple(columns(vector, joints) for vector in kind.inputs), {})
        if self.arguments == ["*"]:
            return Call(tuple(c for vector in kind.inputs for c in columns(vector, joints)), {}, self.output)
        slots: list[Any] = []
        arguments = self._given(kind, parameters)
        for vector, joint in slots_of(arguments, kind, joints, [*parameters, *self.given], self.text or ""):
            if vector == TIME:
                slots.append(Given(0.0))
            elif vector in self.given:
                slots.append(Given(self.given[vector]))
            elif joint == -1:
                slots.append(first + known.index(parameters[vector]))
            else:
                place = columns(vector, joints)
                slots.append(place if joint is None else place[joint])
        lifted = {name: first + known.index(quantity) for name, quantity in parameters.items() if name not in arguments}
        return Call(tuple(slots), lifted, self.output, self.outside, self.as_columns)

    def values(self, call: Call, samples: Samples, known: list[str], edit: Edit | None = None) -> Floats:
        """What the formula returns, a row for each arm and state, outputs in their order."""
        values = self.program.evaluate(call, samples.table(known), edit)
        return values[:, self.order] if self.order and values.ndim == 2 else values

    def calls(self, call: Call, samples: Samples, known: list[str]) -> int:
        """How many functions an evaluation calls, where the formula runs."""
        table = samples.table(known)
        if isinstance(self.program, PythonProcess):
            return self.program.calls(call, table)
        return calls_in(lambda: self.program.evaluate(call, table))


def _is_state(name: str, kind: Kind) -> bool:
    slot = slot_of(name)
    return slot is not None and slot[0] in kind.inputs


def from_callable(function: Any) -> Formula:
    """A function in memory, or sympy expressions."""
    if is_expression(function):
        of_symbols, names = function_of(function)
        return Formula("expression", "expression", CallableProgram(of_symbols), names)
    if not callable(function):
        raise UsageError(f"a function, a file or sympy expressions are needed, got {type(function).__name__}")
    name = getattr(function, "__name__", type(function).__name__)
    optional: list[str] = []
    try:
        given = inspect.signature(function).parameters.values()
        optional = [one.name for one in given if one.default is not one.empty]
        several = any(one.kind is one.VAR_POSITIONAL for one in given)
        arguments = ["*"] if several else [one.name for one in given if one.kind is not one.KEYWORD_ONLY]
    except (TypeError, ValueError):
        arguments = ["q"]
    formula = Formula(name, name, CallableProgram(function), arguments, optional=optional)
    try:
        text = textwrap.dedent(inspect.getsource(function))
        source = PythonText(text, name)
        if name in source.functions and not getattr(source.functions[name].node, "decorator_list", None):
            _with_text(formula, function, source)
    except (OSError, TypeError, UsageError):
        pass  # without a text there is no repair
    return formula


def _with_text(formula: Formula, function: Any, source: PythonText) -> None:
    formula.text, formula.nodes, formula.comments = source.text, source.nodes(), source.comments(formula.name)
    formula.constants = {one.name: one for one in source.constants()}
    formula.defaults, formula.default_nodes = source.arguments(formula.name)[1], source.numbers_of_arguments()
    formula.outputs = source.returned_names(formula.name)
    closure = inspect.getclosurevars(function)
    outside = {**closure.globals, **closure.nonlocals}
    formula.global_numbers = {name: float(value) for name, value in outside.items() if type(value) in (int, float)}
    namespace = {**getattr(function, "__globals__", {}), **outside}
    formula.program = PythonInMemory(source.text, formula.name, "<formula>", namespace)


def from_file(
    path: str | os.PathLike[str], *, kind: str | None = None, sandbox: Any = None, is_alone: bool = False
) -> Formula:
    """A function of a file: `file.py:function`, `file.m`, `file.m:function`, in notebooks and live scripts, too.

    Args:
        kind: that of the function which is looked for where none is named.
        is_alone: whether a MATLAB function may not call those in files beside it.

    Raises:
        UsageError: the file cannot be read, or has no such function.
    """
    file, function = split_name(os.fspath(path))
    if file.endswith((".so", ".dylib", ".dll")):
        return _from_library(file, function)
    if file.endswith((".c", ".h", ".cpp", ".cc", ".hpp")):
        library = f"{Path(file).stem}.so"
        raise UnjudgedError(
            f"{file}: cannot be judged as text: compile it, cc -shared -fPIC -O2 {file} -o {library} -lm, "
            f"and name the function, {library}:{function or 'FUNCTION'}"
        )
    text = _code_in(file)
    folder = None if is_alone else os.path.dirname(os.path.abspath(file))
    return from_text(text, file, function, kind=kind, sandbox=sandbox, folder=folder)


def _code_in(file: str) -> str:
    try:
        return code_of(file, regular(Path(file)).read_bytes())
    except UsageError:
        raise
    except (OSError, ValueError) as error:
        raise UsageError(f"{file}: this file cannot be read: {getattr(error, 'strerror', None) or error}") from None


def by_octave(path: str | os.PathLike[str], refusal: UnreadError) -> Formula | None:
    """A function of a MATLAB file that this package does not read, evaluated by GNU Octave; None where it is none.

    Its text is not edited, as no part of it is understood but its constants.

    Raises:
        UnreadError: there is no Octave.
    """
    file, function = split_name(os.fspath(path))
    if not file.endswith(MATLAB):
        return None
    text = _code_in(file)
    headers = headers_of(text)
    name = function or next(iter(headers), "")
    if name not in headers or not headers[name].outputs:
        return None
    if refusal.name and re.search(rf"^\s*global\b[^;\n%]*\b{refusal.name}\b", text, re.M):
        return None  # for Octave it is empty, and no error
    if (octave := installed()) is None:
        remedy = "GNU Octave, where it is installed, evaluates such a file"
        raise UnreadError(f"{refusal}; {remedy}", line=refusal.line, reason=refusal.reason)
    place = f"line {refusal.line}: " if refusal.line else ""
    header = headers[name]
    return Formula(
        file,
        name,
        OctaveProcess(text, name, file, octave),
        header.inputs,
        {one.name: one for one in constants_of(text)},
        text=text,
        language="matlab",
        outputs=header.outputs if len(header.outputs) > 1 else [],
        optional=[one for one in header.inputs if one == "varargin"],
        engine=f"evaluated by {octave.name} ({place}{re.split('[:;] ', refusal.reason)[0]})",
    )


def _from_library(file: str, function: str | None) -> Formula:
    """A C function; its arguments are the vectors of its kind, and then the output."""
    if function is None:
        raise UsageError(f"{file}: name the function of this library: {file}:FUNCTION")
    if not os.path.isfile(file):
        raise UsageError(f"{file}: this file cannot be read: there is none")
    program = PythonProcess(text_of(os.path.abspath(file), function), function, file)
    return Formula(file, function, program, [], language="c")


def from_text(
    text: str,
    file: str,
    function: str | None,
    *,
    kind: str | None = None,
    sandbox: Any = None,
    folder: str | None = None,
) -> Formula:
    """A function of a text.

    Args:
        kind: that of the function which is looked for where none is named.
        folder: where a MATLAB function finds those in files of their own; None: nowhere.

    Raises:
        UsageError: the text cannot be read, or has no such function.
        UnjudgedError: it takes no argument by its position.
    """
    if file.endswith(MATLAB):
        return _of_matlab(program_of(text, file, function, folder, lambda names: _likely_variable(names, kind)))
    source = PythonText(text, file)
    name = _with_object(source, file, function or likely_function(source, file, kind))
    program = (sandbox or PythonInMemory)(text, name, file)
    if name in source.functions:
        arguments, defaults = source.arguments(name)
        optional = source.optional(name)
        if not arguments and (keywords := source.keywords(name)):
            raise UnjudgedError(
                f"{file}:{source.line(name)}: cannot be judged: {name} takes {keywords[0]} by keyword alone; "
                "leave out the `*` of its arguments"
            )
    else:
        arguments, optional, defaults = *_arguments_of(program, file, name, source), {}
    return Formula(
        file,
        name,
        program,
        arguments,
        {one.name: one for one in source.constants()},
        defaults,
        source.nodes(),
        source.numbers_of_arguments(),
        text,
        "python",
        source.comments(name),
        source.returned_names(name),
        optional,
        beside=[] if function or kind else _formulas_beside(source, name),
    )


def _likely_variable(names: list[str], kind: str | None) -> str:
    """The last variable of a script that is named as a formula is, of this kind if one is given; else the last one."""
    named = [name for name in names if kind_of_name(name) and kind in (None, kind_of_name(name))]
    return (named or names)[-1]


def _of_matlab(program: MatlabProgram) -> Formula:
    return Formula(
        program.file,
        program.function,
        program,
        ["*"] if program.arguments == ["varargin"] else program.arguments,
        {one.name: one for one in program.constants()},
        {},
        program.nodes(),
        [],
        program.text,
        "matlab",
        program.comments(),
        program.outputs if len(program.outputs) > 1 else [],
        program.optional,
        engine=f"its variable {program.function}" if isinstance(program, SymbolicScript) else "",
    )


def _arguments_of(program: Any, file: str, name: str, source: PythonText) -> tuple[list[str], list[str]]:
    """The arguments of what a text makes a function of, and those that may be left out; none where the text fails.

    Raises:
        UsageError: it makes no function of this name.
    """
    if name not in source.assigned:
        raise UsageError(f"{file}: there is no function {name}; it has {', '.join(source.functions) or 'none'}")
    try:
        return program.arguments()
    except ProgramError as error:
        if str(error).startswith("there is no function"):
            raise UsageError(
                f"{file}:{source.line(name)}: {name} is neither a function nor an expression of sympy: write one, "
                f"def {kind_of_name(name) or name}(q): ..."
            ) from None
        return ["*"], []


def _with_object(source: PythonText, file: str, name: str) -> str:
    """A method by the name of an object that the text makes, where its class needs numbers.

    Raises:
        UnjudgedError: the class needs them, and the text makes no object.
    """
    of_class, _, method = name.partition(".")
    if name not in source.functions or not (needed := needed_by(source.tree, of_class)):
        return name
    if objects := objects_of(source.tree, of_class):
        return f"{objects[0]}.{method}" if method else objects[0]
    lower = of_class.lower()
    raise UnjudgedError(
        f"{file}: {of_class} takes {', '.join(needed)}: make one in the file, {lower} = {of_class}(...), and name "
        f"{lower}{method and '.'}{method}"
    )


def split_name(path: str) -> tuple[str, str | None]:
    """The file and the function in FILE:FUNCTION, or FILE:OBJECT.METHOD."""
    file, colon, function = path.rpartition(":")
    is_name = function.isidentifier() or (
        file.endswith((".py", ".ipynb")) and all(one.isidentifier() for one in function.split("."))
    )
    return (file, function) if colon and is_name and not os.path.exists(path) else (path, None)


def likely_function(source: PythonText, file: str, kind: str | None = None) -> str:
    """The function named like its kind, or like the file, or the last one.

    Methods are looked at where no function has such a name; then names that are no functions until the text is run.
    """
    plain = [name for name, one in source.functions.items() if not one.is_method]
    methods = [name for name, one in source.functions.items() if one.is_method and one.names]
    made = [name for name, is_made in source.assigned.items() if is_made]
    formulas = [name for name in source.assigned if kind_of_name(name)]
    for names in (plain, methods, made, formulas):
        of_kinds = {name: kind_of_name(name) for name in names}
        for chosen in (
            [name for name in names if kind and of_kinds[name] == kind],
            [name for name in names if name == Path(file).stem],
            [name for name in names if of_kinds[name]],
        ):
            if len({source.functions[name].node if name in source.functions else name for name in chosen}) == 1:
                return chosen[-1]  # a method by the name of an object, where there is one
    several = [name for name in (*plain, *methods) if kind_of_name(name)]
    if names := several or plain or made:
        return names[-1]
    if resting := [name for name in source.functions if kind_of_name(name)]:
        word = kind_of_name(resting[-1])
        raise UsageError(
            f"{file}: {resting[-1]} takes no joint angles: write a function that sets them and calls it, "
            f"def {word}(q): ..."
        )
    hint = f"; name one of its methods: {file}:{methods[0]}" if methods else ""
    raise UsageError(f"{file}: there is no function in this file{hint}")


def _formulas_beside(source: PythonText, name: str) -> list[str]:
    """The other functions named as formulas are, but for those that this one calls, by others too."""
    called, new = set[str](), [name]
    while new:
        function = source.functions.get(new.pop())
        names = {node.id for node in ast.walk(function.node) if isinstance(node, ast.Name)} if function else set()
        new += names & source.functions.keys() - called
        called |= names
    plain = [one for one, function in source.functions.items() if not function.is_method]
    return [one for one in plain if one != name and one not in called and kind_of_name(one)]


def kind_of(formula: Formula) -> Kind | None:
    """The kind of formula, from its names; None where they do not tell it."""
    outputs = formula.outputs
    if isinstance(formula.program, MatlabProgram):
        outputs = formula.program.outputs
    elif isinstance(formula.program, OctaveProcess):
        outputs = formula.program.header.outputs
    for name in (formula.name, Path(formula.file).stem):
        if kind := kind_of_name(name):
            return KINDS[kind]
    if outputs and (kind := kinds_of_outputs(outputs)[0]):
        return KINDS[kind]
    if outputs and outputs[0].rstrip("123") in ("t", "tau", "Tau", "torque", "g", "G"):
        return _torque_of({slot[0] for name in formula.arguments if (slot := slot_of(name))})
    return None


def _torque_of(vectors: set[str]) -> Kind | None:
    """The kind of torque that depends on these joint vectors; None where it may be one of several."""
    if "qdd" in vectors:
        return KINDS["inverse"]
    return KINDS["gravity"] if "qd" not in vectors else None
