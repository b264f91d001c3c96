"""Why entries are wrong: one mistake of the whole, edits of the text, or the terms that they read."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from ..._native import Floats
from ...user_functions.expressions import FunctionCall, Index, Name, Node
from ...user_functions.programs import Edit, ProgramError, line_and_column
from ..comparison import Comparison, Solved, scales
from ..finding import Finding
from ..formula import Formula
from ..kinds import SPATIAL
from ..names import slot_of
from ..verdict import Verdict
from .budget import Budget
from .edits import Editor
from .hypotheses import Hypothesis, hypotheses
from .reader import Reading, read_entries
from .repair import Progress, Repair, cover, influential, tried, wrong_entries
from .terms import difference_words

_MOST_OTHERS = 3  # edits that are named beside one
_NEAR = 2000  # characters between edits that may write the same
_MOST_JOINTS_READ, _MOST_ENTRIES_READ = 4, 3
"""Terms of more entries of more joints are too many to read, and take seconds; edits that mend them say all."""
_MOST_STATES_READ = 3000
"""That a script of symbols computes for each state: for more, its terms would take minutes."""
_FARTHER = 1.01
_MOST_PARTS = 3000
"""Of a statement that is edited: what programs write in one is read back, and not mended."""


def explain(
    verdict: Verdict, case: Comparison, wrong: frozenset[int], progress: Progress | None, budget: Budget
) -> None:
    whole = _hypotheses(case)
    causes = [one.cause for one in whole]
    repairs = repairs_of(case, wrong, progress, budget=budget)
    chosen = cover(repairs, wrong)
    if len(chosen) > 1 and not _hold_together(case, chosen, wrong):
        chosen = chosen[:1]
    left = wrong - frozenset(place for one in chosen for place in one.mended)
    if whole and (left or (whole[0].is_of_result and len(chosen) > 1)):  # one sentence says more than these edits
        chosen, left = [], frozenset()
    has_long_terms = case.truth.joints > _MOST_JOINTS_READ and len(wrong) > _MOST_ENTRIES_READ
    is_too_slow = getattr(case.formula.program, "states", 1) > _MOST_STATES_READ
    reads: dict[int, Reading] = {}
    if not is_too_slow and not (has_long_terms and chosen and not left):
        reads, is_too_slow = read_entries(case, wrong, budget.reading)
    if is_too_slow:
        verdict.warnings.append("its terms take too long to be read")
    joint = None
    if left and len(chosen) == 1 and (more := _after(case, chosen[0].edit, left, progress, budget)):
        joint, chosen = chosen[0].edit, [*chosen, *more]
    for place in sorted(wrong):
        found = reads.get(place)
        finding = Finding(case.entry(place), "", found.reads if found else None, found.due if found else None)
        repair = next((one for one in chosen if place in one.mended), None)
        if repair:
            put_edit(finding, case, repair.edit)
        finding.cause = _cause(case, place, finding, causes, repair, joint)
        verdict.findings.append(finding)
        if not (repair or causes or (found and found.reads)):
            verdict.unexplained.append(case.entry(place))
        if found and found.note and found.note not in verdict.warnings:
            verdict.warnings.append(found.note)
    if not causes and any(one.old is None for one in verdict.findings):
        verdict.warnings += _unsearched(case, budget)
    if "tau" in case.kind.inputs and verdict.unexplained:
        _read_torque(verdict, case)
    verdict.warnings += _not_continued(case.formula)
    verdict.alternatives += causes[1:]
    for repair in chosen:
        verdict.alternatives += _other_edits(case, repairs, repair)


def _not_continued(formula: Formula) -> list[str]:
    """The lines that begin with a sign and are statements of their own, which nothing uses."""
    text, found = formula.text or "", []
    signed = [one for one in formula.nodes if one.start == one.parts[0].start and text[one.start] in "+-"]
    for node in signed:
        end = max((one.end for one in formula.nodes if one.end <= node.start), default=len(text))
        if re.fullmatch(r"[ \t;]*([#%][^\n]*)?\n\s*", text[end : node.start]):
            line, last = (line_and_column(text, place)[0] for place in (node.start, end))
            found.append(
                f"line {line} begins with a sign and is a statement of its own, which nothing uses: "
                f"it does not go on with line {last}"
            )
    return found


def _unsearched(case: Comparison, budget: Budget) -> list[str]:
    """Why there may be an edit that was not tried."""
    found = []
    if budget.is_over():
        found.append("the search for an edit that mends it was ended: there are too many, or they are too slow")
    if long := len(case.formula.nodes) - len(_short(case.formula)):
        what = "a statement" if long == 1 else f"{long} statements"
        found.append(f"{what} of more than {_MOST_PARTS} parts: no edit of that was tried")
    return found


def _short(formula: Formula) -> list[Node]:
    """The statements that are edited."""
    return [one for one in formula.nodes if sum(1 for _ in one.walk()) <= _MOST_PARTS]


def _read_torque(verdict: Verdict, case: Comparison) -> None:
    """Say what the formula reads when it is solved for the torque, in the entries in which this differs."""
    solved = Solved.of(case)
    values, due = solved.values(solved.second), solved.due(solved.second)
    wrong = wrong_entries(values, due, scales(due), 1e-8)
    readings, _ = read_entries(solved, wrong, Budget.of_reading(case.formula.program))
    words = [
        f"t{place + 1} {difference_words(found.reads, found.due)}"
        for place, found in sorted(readings.items())
        if found.reads and found.due
    ]
    if not words:
        return
    if len(words) < len(wrong):
        verdict.warnings.append(f"solved for the torque, {'; '.join(words)}")
        return
    for finding in verdict.findings:
        if finding.entry in verdict.unexplained:
            finding.cause = (
                f"{case.kind.entry_name(finding.entry)} is wrong: solved for the torque, {'; '.join(words)}."
            )
    verdict.unexplained = []


def _hypotheses(case: Comparison) -> list[Hypothesis]:
    """The mistakes of the formula as a whole that explain it at all samples, the simplest ones first."""
    found = []
    fitting, fresh = case.second, case.fresh
    values, check = case.values(fitting), case.values(fresh)

    def list_at(samples: Any) -> Iterator[Hypothesis]:
        states = {vector: samples.tiled(vector) for vector in samples.states}

        def truth(here: dict[str, Floats], changes: dict[str, Any]) -> Floats:
            return case.due(samples, changes, here)

        for words, other in case.truth.variants(case.kind):
            yield Hypothesis(words, partial(replace(case, truth=other).due, samples))
        is_spatial = case.rows[:3] == SPATIAL and not case.frame
        yield from hypotheses(
            case.kind,
            truth,
            states,
            case.truth.revolute,
            (lambda: case.pose(samples)) if is_spatial else None,
            case.given(samples),
            in_degrees=case.degrees,
        )

    for one, other in zip(list_at(fitting), list_at(fresh), strict=True):
        try:
            expected = one.values()
            if not case.wrong(values, fitting, expected) and not case.wrong(check, fresh, other.values()):
                found.append(one)
        except (ProgramError, ValueError, ArithmeticError):
            continue
    found.sort(key=lambda one: one.weight)
    return [one for place, one in enumerate(found) if one.cause not in (other.cause for other in found[:place])]


def repairs_of(
    case: Comparison,
    wrong: frozenset[int],
    progress: Progress | None,
    statements: Sequence[Node] = (),
    budget: Budget | None = None,
) -> list[Repair]:
    """The edits of the text that make wrong entries right, confirmed at fresh states and arms.

    Args:
        statements: those that are edited; by default the ones that wrong entries depend on.
        budget: how long edits are tried; by default all of them.
    """
    formula = case.formula
    if not formula.text or not formula.nodes:
        return []
    angles = [name for name in formula.arguments if (slot := slot_of(name)) and slot[0] == "q" and slot[1] is not None]
    angles = sorted(angles) or _indexed_angles(formula, case.truth.joints)
    editor = Editor(formula.text, formula.nodes, formula.language, angles, list(case.parameters), formula.outputs)
    due = {everywhere: case.due(case.second if everywhere else case.first) for everywhere in (False, True)}

    def evaluate(edit: Edit, everywhere: bool) -> Floats:
        return case.values(case.second, edit) if everywhere else case.first_values(edit)

    def as_it_is(everywhere: bool) -> Floats:
        return case.values(case.second if everywhere else case.first)

    def wrong_at(everywhere: bool) -> Callable[[Floats], frozenset[int]]:
        return lambda values: case.wrong(values, case.second if everywhere else case.first, due[everywhere])

    statements = statements or influential(_short(formula), formula.text, evaluate, as_it_is, wrong)

    def evaluate_in_order(edit: Edit, everywhere: bool) -> Floats:
        if everywhere and formula.order and (edited := formula.edited(edit)) and edited.order != formula.order:
            raise ProgramError("the edit takes away the names that tell the order of the outputs")
        return evaluate(edit, everywhere)

    edits = [one for one in editor.all(statements) if not _takes_own_number(case, one)]
    found = tried(edits, evaluate_in_order, wrong_at(False), wrong_at(True), wrong, progress, budget)

    def spoils(one: Repair) -> bool:
        left = wrong - one.mended
        try:
            return bool(left) and _spoils(evaluate(one.edit, True), as_it_is(True), due[True], left)
        except ProgramError:  # the formula fails as it is
            return False

    return [one for one in found[:60] if _is_confirmed(case, one, wrong) and not spoils(one)]


def _spoils(values: Floats, before: Floats, due: Floats, left: frozenset[int]) -> bool:
    """Whether an edit takes an entry that stays wrong farther from what is due: then it mends the others by chance."""
    places = sorted(left)
    after, now = (np.abs(one - due).reshape(len(due), -1)[:, places].max(axis=0) for one in (values, before))
    return bool((after > _FARTHER * now).any())


def _takes_own_number(case: Comparison, edit: Edit) -> bool:
    """Whether it puts another number for the arm's own, where the text gives that to a name or into a list."""
    text = case.formula.text or ""
    try:
        old = float(text[edit.start : edit.end])
        float(edit.new)
    except ValueError:
        return False
    is_own = any(math.isclose(old, abs(own), rel_tol=1e-9) for own in case.truth.values_of_quantities.values())
    if not is_own or old in (0.0, 0.5, 1.0, 2.0):
        return False
    before = text[text.rfind("\n", 0, edit.start) + 1 : edit.start].rstrip()
    after = re.compile(r"[ \t]*([,;\])}]|[#%\n]|$)").match(text, edit.end)
    return before[-1:] in tuple("=[({,;") and after is not None


def _hold_together(case: Comparison, chosen: list[Repair], wrong: frozenset[int]) -> bool:
    """Whether several edits at once mend what each of them mends alone."""
    formula: Formula | None = case.formula
    for one in sorted(chosen, key=lambda one: one.edit.start, reverse=True):
        formula = formula.edited(one.edit) if formula else None
    if formula is None:
        return False
    other = replace(case, formula=formula, edited={})
    left = wrong - frozenset(place for one in chosen for place in one.mended)
    try:
        return all(other.wrong(other.values(samples), samples) <= left for samples in (other.second, other.fresh))
    except ProgramError:
        return False


def _after(
    case: Comparison, edit: Edit, left: frozenset[int], progress: Progress | None, budget: Budget
) -> list[Repair]:
    """The edit that mends more entries in the text with a first edit, moved to its place in the text without it."""
    formula = case.formula.edited(edit)
    if formula is None:
        return []
    other = replace(case, formula=formula, edited={})
    other.shape = case.shape
    found = [one for one in repairs_of(other, left, progress, budget=budget) if not _overlap(one.edit, edit)]
    shift = len(edit.new) - (edit.end - edit.start)
    moved = [
        one.edit.start - shift if one.edit.start >= edit.start + len(edit.new) else one.edit.start for one in found
    ]
    return [one._replace(edit=one.edit._replace(start=start, end=start + one.edit.end - one.edit.start))
            for one, start in zip(found[:1], moved, strict=False)]  # fmt: skip


def _overlap(later: Edit, first: Edit) -> bool:
    return later.start < first.start + len(first.new) and first.start < later.end


def _is_confirmed(case: Comparison, repair: Repair, wrong: frozenset[int]) -> bool:
    try:
        return case.wrong(case.values(case.fresh, repair.edit), case.fresh) <= wrong - repair.mended
    except ProgramError:
        return False


def _indexed_angles(formula: Formula, joints: int) -> list[str]:
    """q[0], q[1], ... where the formula takes a vector, or the names that it gives to its elements."""
    text = formula.text or ""
    every = [node for top in formula.nodes for node in top.walk()]
    names = [name for name in formula.arguments if (slot := slot_of(name)) and slot[0] == "q"]
    used = {node.word for node in every if isinstance(node, Name)}
    plain = {
        name.rstrip("0123456789") for name in used if (slot := slot_of(name)) and slot[0] == "q" and slot[1] is not None
    }
    given = [f"{stem}{joint + 1}" for stem in sorted(plain) for joint in range(joints)]
    if given:
        return [name for name in given if re.search(rf"\b{name}\b", text)]  # a lost angle still has its name
    bases = [node.parts[0] for node in every if isinstance(node, Index) and node.parts]
    indexed = {text[base.start : base.end] for base in bases}
    called = {node.word for node in every if isinstance(node, FunctionCall)}
    return [
        f"{name}({joint + 1})" if formula.language == "matlab" else f"{name}[{joint}]"
        for name in names
        if name in indexed | called
        for joint in range(joints)
    ]


def put_edit(finding: Finding, case: Comparison, edit: Edit) -> None:
    text = case.formula.text or ""
    finding.line, finding.column = line_and_column(text, edit.start)
    finding.old, finding.new = text[edit.start : edit.end], edit.new
    if not finding.old:  # an insertion is shown with the character before it
        start = max(edit.start - 1, 0)
        finding.line, finding.column = line_and_column(text, start)
        finding.old, finding.new = text[start : edit.end], text[start : edit.start] + edit.new


def _cause(
    case: Comparison, place: int, finding: Finding, causes: list[str], repair: Repair | None, first: Edit | None
) -> str:
    if causes:
        words = causes[0] if causes[0][1:2].isdigit() or causes[0][1:2] == " " else causes[0][0].upper() + causes[0][1:]
        return words if words.endswith("?") else f"{words}."
    name = case.kind.entry_name(case.entry(place))
    if repair and finding.old is not None:
        stands = f"should be `{finding.new}`" if finding.new else "should not be here"
        others = f"; this line spoils {len(repair.mended)} entries" if len(repair.mended) > 1 else ""
        if first and first != repair.edit:
            line, _ = line_and_column(case.formula.text or "", first.start)
            others += f", together with the mistake in line {line}"
        return f"{name}: in line {finding.line} `{finding.old}` {stands}{others}."
    if finding.reads is not None:
        return f"{name} {difference_words(finding.reads, finding.due)}." if finding.due else f"{name} is wrong."
    values, q = case.values(case.second), case.second.tiled("q")
    row = int(np.argmax(np.isnan(values.reshape(len(values), -1)[:, place])))
    if np.isnan(values.reshape(len(values), -1)[row, place]):
        return f"{name} is NaN, which is no number, at q = [{', '.join(f'{angle:.6g}' for angle in q[row])}]."
    return f"{name} is wrong, and neither its terms nor a single edit explain it."


def _other_edits(case: Comparison, repairs: list[Repair], shown: Repair) -> list[str]:
    """A few edits that do the same, each once: one that only writes another with more brackets or signs is none."""
    text, different = case.formula.text or "", [shown.edit]
    for one in repairs:
        if one.mended == shown.mended and not any(_is_same(one.edit, other, text) for other in different):
            different.append(one.edit)
        if len(different) > _MOST_OTHERS:
            break
    said = []
    for edit in different[1:]:
        line, _ = line_and_column(text, edit.start)
        said.append(f"in line {line} `{text[edit.start : edit.end]}` as `{edit.new}` would be right, too")
    return said


def _is_same(one: Edit, other: Edit, text: str) -> bool:
    """Whether two edits write the same, or change a sign of the same product."""
    first, last = min(one.start, other.start), max(one.end, other.end)
    if last - first > _NEAR:
        return False
    meet = one.start <= other.end and other.start <= one.end
    if meet and _is_of_sign(one, text) and _is_of_sign(other, text):
        return True
    around = slice(text.rfind("\n", 0, first) + 1, last)
    moved = (edit._replace(start=edit.start - around.start, end=edit.end - around.start) for edit in (one, other))
    first_text, second_text = (_plain(edit.apply(text[around])) for edit in moved)
    return first_text == second_text


def _is_of_sign(edit: Edit, text: str) -> bool:
    """Whether it changes nothing but a sign."""
    return re.sub(r"[-+\s()]", "", edit.new) == re.sub(r"[-+\s()]", "", text[edit.start : edit.end])


def _plain(text: str) -> str:
    """A text without blanks and brackets, and with one sign where several meet."""
    bare = re.sub(r"[\s()]", "", text)
    while (fewer := re.sub(r"\+\+|--", "+", re.sub(r"\+-|-\+", "-", bare))) != bare:
        bare = fewer
    return re.sub(r"(?<=[=,;:*/\[{])\+", "", bare)
