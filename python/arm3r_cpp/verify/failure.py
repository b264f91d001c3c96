"""A formula that returns nothing that could be compared: why, and which edit mends it."""

from __future__ import annotations

import contextlib
import math
import re
from itertools import product
from typing import Any

import numpy as np

from ..errors import UnjudgedError, UnreadError
from ..user_functions.expressions import FunctionCall, Index, Name, Number
from ..user_functions.programs import ProcessEnded, ProgramError, Unread, line_and_column
from .comparison import OtherShape
from .explain.budget import Budget
from .explain.causes import put_edit, repairs_of
from .explain.repair import Progress
from .finding import Finding
from .formula import Formula
from .kinds import Kind
from .meaning import ways
from .names import slot_of
from .verdict import Verdict

MENDING_EDITS = 3000


def failed(error: ProgramError, formula: Formula, kind: Kind, truth: Any, progress: Progress | None) -> Verdict:
    """The verdict on a formula that raises, or returns no numbers.

    Raises:
        UnreadError: it holds what is not read, which no edit mends.
        UnjudgedError: it is a formula of an arm with more or fewer joints.
    """
    finding = Finding(None, f"the formula fails: {error}", line=error.line)
    verdict = Verdict(False, kind.name, truth.convention, float("inf"), [finding], file=formula.file, text=formula.text)
    verdict.found = list(filter(None, (formula.engine, formula.output_words)))
    if not isinstance(error, ProcessEnded) and not (isinstance(error, Unread) and not error.name):
        _mend_failure(verdict, formula, kind, truth, progress)
    if isinstance(error, Unread) and not _is_renamed(finding, error.name):
        place = f"{formula.file}:{error.line}" if error.line else formula.file
        words = f"{place}: cannot be judged: {error}"
        raise UnreadError(words, line=error.line, reason=str(error), name=error.name) from None
    if finding.old is None and (words := _of_other_arm(error, formula, kind, truth.joints)):
        raise UnjudgedError(
            f"{formula.file}: cannot be judged: {words}; "
            "--urdf, --dh, --arm name the arm that it is of, --tip where a chain ends"
        )
    return verdict


def _of_other_arm(error: ProgramError, formula: Formula, kind: Kind, joints: int) -> str:
    """What tells that a formula is of an arm with more or fewer joints; "" where nothing does."""
    elements, where = _elements(formula), f"where the arm has {joints} joint{'s' * (joints != 1)}"
    if beyond := next((read for read, place in elements if place >= joints), ""):
        return f"it reads {beyond}, {where}"
    taken = _taken_apart(formula)
    if re.search(r"values to unpack \(expected \d+", str(error)) and taken.get(error.line, joints) != joints:
        return f"line {error.line} takes {taken[error.line]} elements from a joint vector, {where}"
    has_angles = any(
        slot[0] == "q" for name in formula.arguments if (slot := slot_of(name))
    )  # and no state in one vector
    reads_last = joints in taken.values() or joints - 1 in (place for _, place in elements)
    if not isinstance(error, OtherShape) or not has_angles or reads_last:
        return ""
    returned = f"it returns {'x'.join(map(str, error.shape))} numbers, as {kind.a_words}"
    other = kind.joints_of(error.shape)
    if other not in (0, joints):
        return f"{returned} of {other} joint{'s' * (other != 1)}, {where}"
    return f"{returned} in a plane, where the arm moves in space" if kind.is_planar(error.shape, joints) else ""


def _elements(formula: Formula) -> list[tuple[str, int]]:
    """The elements of joint vectors that a formula reads by their places, "q(3)", with these from 0."""
    text = formula.text or ""
    slots = {name: slot for name in formula.arguments if (slot := slot_of(name))}
    found = [(name, slot[1]) for name, slot in slots.items() if slot[1] is not None]
    first = 1 if formula.language == "matlab" else 0
    for node in (part for top in formula.nodes for part in top.walk()):
        match node:
            case (
                FunctionCall(word=name, parts=(Number() as index,)) | Index(parts=(Name(word=name), Number() as index))
            ) if name in slots and slots[name][1] is None and math.isfinite(index.value):
                found.append((text[node.start : node.end], int(index.value) - first))
    return found


def _taken_apart(formula: Formula) -> dict[int | None, int]:
    """The lines of Python that give the elements of a joint vector to names, and to how many: `q1, q2 = q`."""
    found: dict[int | None, int] = {}
    for line, text in enumerate((formula.text or "").splitlines(), start=1):
        apart = re.fullmatch(r"\s*[(\[]?((?:\w+\s*,\s*)+\w*)[)\]]?\s*=\s*(\w+)(\.\w+\(\))*\s*(#.*)?", text)
        if apart and formula.language == "python" and apart[2] in formula.arguments and slot_of(apart[2]):
            found[line] = len([name for name in apart[1].split(",") if name.strip()])
    return found


def _is_renamed(finding: Finding, name: str) -> bool:
    """Whether the edit that mends a failure puts another name for this one."""
    return finding.old == name and str(finding.new).isidentifier()


def _mend_failure(verdict: Verdict, formula: Formula, kind: Kind, truth: Any, progress: Progress | None) -> None:
    """The edit that makes a formula right which raises, or returns no numbers: in the line that fails, or another."""
    budget = Budget(formula.program, MENDING_EDITS)
    with contextlib.suppress(ProcessEnded):
        _mend_in_time(verdict, formula, kind, truth, progress, budget)


def _mend_in_time(
    verdict: Verdict, formula: Formula, kind: Kind, truth: Any, progress: Progress | None, budget: Budget
) -> None:
    line, text = verdict.findings[0].line, formula.text or ""
    failing = [one for one in formula.nodes if line_and_column(text, one.start)[0] == line]
    for statements, case in product(
        [failing, formula.nodes] if failing else [formula.nodes], ways(formula, kind, truth)
    ):
        wrong = frozenset(range(int(np.prod(case.due(case.first).shape[1:]))))
        if budget.is_over():
            return
        for repair in repairs_of(case, wrong, progress, statements, budget):
            if repair.mended == wrong:
                verdict.convention = case.convention
                put_edit(verdict.findings[0], case, repair.edit)
                return
