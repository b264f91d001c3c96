"""Judges a function that a student hands in: its values beside the right ones."""

from __future__ import annotations

import builtins
import re
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from .._native import Floats
from ..core.scenario import Scenario
from ..errors import BudgetError, ControllerError, UnjudgedError, UsageError
from ..user_functions.programs import Call, ProgramError, Unjudged, Unread
from ..user_functions.python_process import PythonProcess
from ..verify.comparison import scales
from ..verify.finding import Finding
from ..verify.formula import Formula, from_file
from ..verify.judge import judge
from ..verify.kinds import KINDS
from ..verify.names import quantities_of, slot_of
from ..verify.samples import VECTORS, Samples
from ..verify.truth.three_r import ThreeR
from .mark import RIGHT, UNCLEAR, WORDS, WRONG, Mark, one_line, word_of
from .task import FunctionTask, Mistake

THRESHOLD = 1e-6  # of an entry's scale
_AN_EXPRESSION = re.compile(r"`[^`]*[A-Za-z_)\]] *[-+*/] *[^`]+` as `")
_NOT_READ = "is not read"  # a refusal of the MATLAB reader: the file may still be right


class OwnWork(PythonProcess):
    """The process of a file that may not import this package."""

    forbid_own_package = True


def judge_function(task: FunctionTask, path: Path, *, forbid_own_package: bool = False) -> Mark:
    """The mark of a file."""
    program = None
    try:
        formula = formula_of(task, path, OwnWork if forbid_own_package else PythonProcess)
        program = formula.program
        states = task.samples()
        values, again = _values(task, formula, states), _values(task, formula, states)
        mark = _mark(task, values, again, states)
        return _in_the_loop(task, formula, mark) if task.loop and mark.word != UNCLEAR else mark
    except (Unread, UnjudgedError) as error:
        return replace(_failed(error, path), word=UNCLEAR)
    except Unjudged as error:
        return Mark(UNCLEAR, str(error).split(":")[0], message=one_line(str(error), 400))
    except (UsageError, ProgramError) as error:
        return _failed(error, path)
    except BudgetError as error:
        return Mark(UNCLEAR, "takes too long in the loop", message=one_line(str(error), 400))
    finally:
        if isinstance(program, PythonProcess):
            program.close()


def _mark(task: FunctionTask, values: Floats, again: Floats, states: dict[str, Floats]) -> Mark:
    """The mark for the values of a function, and for those of a second call."""
    if not np.array_equal(values, again, equal_nan=True):
        return Mark(WRONG, "gives different numbers when it is called again with the same ones")
    if not np.isfinite(values).all():
        return Mark(WRONG, "returns NaN or infinity instead of numbers")
    return _compared(task, values, states)


def _in_the_loop(task: FunctionTask, formula: Formula, mark: Mark) -> Mark:
    """The mark with what the function does in a loop. That of wrong values stays, and the loop shows their effect."""

    def function(**inputs: Any) -> Floats:
        values = _values(task, formula, {name: np.asarray(value, float)[None] for name, value in inputs.items()})
        if not np.isfinite(values).all():
            raise ProgramError("returns NaN or infinity in the loop")
        return values[0]

    assert task.loop
    try:
        word, off = task.loop.judged(function)
    except ControllerError as error:
        if isinstance(error.__cause__, (Unjudged, Unread)):
            return Mark(UNCLEAR, f"{str(error.__cause__).split(':')[0]} in the loop")
        if mark.word == RIGHT:
            return Mark(WRONG, "right at single states, and fails in the loop", message=one_line(str(error), 400))
        return mark
    if mark.word == RIGHT and word != RIGHT:
        return Mark(word, "right at single states, and not in the loop", message=one_line(off, 400))
    return replace(mark, message=one_line(off, 400)) if off else mark


def formula_of(task: FunctionTask, path: Path, sandbox: type[PythonProcess]) -> Formula:
    """The function of the task's name; where a file has none, the one that `arm3r verify` would take.

    Raises:
        UsageError: the file cannot be read.
    """
    try:
        return from_file(f"{path}:{task.function}", sandbox=sandbox, is_alone=True)
    except UsageError:
        return from_file(path, sandbox=sandbox, is_alone=True)


def reading(task: FunctionTask, path: Path) -> str:
    """What `arm3r verify` says of the file: the wrong terms, and their lines.

    Empty where the task is no formula of the arm, or the file is right in the other convention.
    """
    if not task.kind:
        return ""
    formula = formula_of(task, path, PythonProcess)
    verdict = judge(formula, KINDS[task.kind], ThreeR(Scenario(task.scenario)))
    if verdict.ok:
        return ""
    text = str(verdict).replace(str(path), path.name)
    return without_negated_constants(text) if any(map(negates_a_constant, verdict.findings)) else text


def negates_a_constant(finding: Finding) -> bool:
    """Whether a finding would turn the sign of a number or of a name: a negative stiffness or mass explains values, and
    is no cause."""
    old, new = (finding.old or "").strip("() "), (finding.new or "").strip("() ")
    if old.isidentifier():
        return new == f"-{old}"
    try:
        return float(new) == -float(old) < 0
    except ValueError:
        return False


def without_negated_constants(text: str) -> str:
    """A verdict's first line, and of the edits that would do as well those of an expression."""
    head, *lines = text.splitlines()
    edits = [line.strip() for line in lines if "also possible" in line and _AN_EXPRESSION.search(line)]
    return "\n".join([head, *(f"  {line.removeprefix('also possible: ')}" for line in edits)])


def _failed(error: UsageError | ProgramError, path: Path) -> Mark:
    """The mark of a file that cannot be read, or whose function fails."""
    message = str(error).replace(str(path), path.name)
    is_text = isinstance(error, UsageError)
    is_unclear = is_text and _NOT_READ in message and path.suffix == ".m"
    line = getattr(error, "line", None)
    text = f"line {line}: {message}" if line else message
    reason = _reason_of_text(message, path) if is_text else _reason_of_run(message, line, path)
    return Mark(UNCLEAR if is_unclear else WRONG, one_line(reason), message=one_line(text, 400))


def _reason_of_text(message: str, path: Path) -> str:
    """What is wrong with the text, in words that are the same with every version of Python."""
    found = re.fullmatch(rf"(?:{re.escape(path.name)})?(?::(\d+))?(?::\d+)?:? ?(.*)", message, re.S)
    line, words = found.groups() if found else (None, message)
    return re.split(r"[:;] ", words)[0] + (f" in line {line}" if line else "")


def _reason_of_run(message: str, line: int | None, path: Path) -> str:
    """What went wrong, without the words of an exception: they may differ each time."""
    where = f" in line {line}" if line else ""
    if path.suffix == ".m" and line:
        return f"cannot be evaluated{where}"
    reason = message.split(":")[0]
    raised = re.fullmatch(r"raises (.*)", reason, re.S)
    if raised and not hasattr(builtins, raised[1]):
        reason = "raises an error of a kind that Python does not know"
    return reason + where


# ---- values ---------------------------------------------------------------------------------------------------------


def _values(task: FunctionTask, formula: Formula, states: dict[str, Floats]) -> Floats:
    """What the function returns, (N, entries)."""
    values = _by_name(task, formula, states) if task.kind else _by_position(task, formula, states)
    flat = values.reshape(len(values), -1)
    if flat.shape[1] != len(task.entries):
        raise ProgramError(f"returns {flat.shape[1]} numbers; it should return {len(task.entries)}")
    return flat


@cache
def _truth(scenario: str) -> ThreeR:
    return ThreeR(Scenario(scenario))


def _by_name(task: FunctionTask, formula: Formula, states: dict[str, Floats]) -> Floats:
    """Joint angles, rates and the arm's numbers, each as the argument of its name."""
    kind, truth = KINDS[task.kind], _truth(task.scenario)
    names = [name for name in formula.arguments if not ((slot := slot_of(name)) and slot[0] in kind.inputs)]
    own = truth.values_of_quantities
    parameters = {name: what for name, what in quantities_of(names).items() if what in own}
    known = sorted(set(parameters.values()))
    count = len(states["q"])
    samples = Samples({name: states.get(name, np.zeros((count, 3))) for name in VECTORS}, [own])
    raw = formula.values(formula.bind(kind, truth.joints, parameters, known), samples, known)
    try:
        values = kind.standard_form(raw, truth.joints, samples.tiled("qd"))
    except UsageError as error:
        raise ProgramError(str(error)) from None
    return values[:, :3] if values.ndim > 2 else values


def _by_position(task: FunctionTask, formula: Formula, states: dict[str, Floats]) -> Floats:
    """The inputs in their order: each as one argument, or number by number."""
    sizes = [one.size for one in task.inputs]
    ends = np.cumsum(sizes)
    together = tuple(
        int(end) - 1 if size == 1 else tuple(range(end - size, end)) for end, size in zip(ends, sizes, strict=True)
    )
    given: dict[int, tuple[Any, ...]] = {len(together): together, int(ends[-1]): tuple(range(ends[-1]))}
    slots = given.get(len(formula.arguments))
    if slots is None:
        count = len(formula.arguments)
        raise ProgramError(f"takes {count} argument{'' if count == 1 else 's'}; it should be {task.signature}")
    table = np.concatenate([states[one.name].reshape(-1, one.size) for one in task.inputs], axis=1)
    return formula.program.evaluate(Call(slots, {}), table)


# ---- comparison -----------------------------------------------------------------------------------------------------


def _compared(task: FunctionTask, values: Floats, states: dict[str, Floats]) -> Mark:
    right = task.right(**states).reshape(len(values), -1)
    scale = scales(right)
    words = [word_of(float(error), THRESHOLD) for error in _errors(values, right, scale)]
    names = {word: [name for name, one in zip(task.entries, words, strict=True) if one == word] for word in WORDS}
    if not names[WRONG]:
        unclear = ", ".join(names[UNCLEAR])
        return Mark(UNCLEAR, f"differs a little in {unclear}: a rounded number?") if unclear else Mark(RIGHT)
    return Mark(WRONG, _found(names), _cause(task, values, states, scale))


def _found(names: dict[str, list[str]]) -> str:
    """What is right and what is not."""
    if not names[RIGHT] and not names[UNCLEAR]:
        return "every entry is wrong"
    return f"wrong in {', '.join(names[WRONG])}, right in the others"


def _cause(task: FunctionTask, values: Floats, states: dict[str, Floats], scale: Floats) -> str:
    """The sentence of the known mistake with which a function would return the same."""
    reversed_signs = Mistake("every sign is reversed", lambda **states: -task.right(**states))
    for mistake in (*task.mistakes, reversed_signs):
        wrong = mistake.values(**states).reshape(len(values), -1)
        if (_errors(values, wrong, scale) <= THRESHOLD).all():
            return mistake.sentence
    return ""


def _errors(values: Floats, due: Floats, scale: Floats) -> Floats:
    """The largest error of each entry, relative to its scale."""
    result: Floats = np.abs(values - due).max(axis=0) / scale
    return result
