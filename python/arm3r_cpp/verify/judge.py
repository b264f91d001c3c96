"""Judges a formula: finds how it is meant, which entries are wrong, and why."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from .._native import Floats
from ..errors import UnjudgedError
from ..user_functions.nodes import Edit, Node, ProcessEnded, ProgramError, Unjudged, Unread, line_and_column
from .comparison import TOLERANCE, Comparison, Solved, scales
from .coverage import seen_by_tests
from .explain.budget import Budget
from .explain.edits import Editor
from .explain.hypotheses import Hypothesis, hypotheses
from .explain.reader import read_entries
from .explain.repair import Repair, cover, influential, tried, wrong_entries
from .explain.terms import difference_words
from .formula import Formula
from .kinds import SPATIAL, Kind, entry_name
from .meaning import as_called, assumed, doubted, is_right_as_it_stands, meant, ways, wrong_count
from .names import slot_of
from .truth.three_r import FOLLOWING_WORDS
from .verdict import Finding, Verdict

Progress = Callable[[int, int], None]
_MOST_PARTS = 3000
"""Of a statement that is edited: what programs write in one is read back, and not mended."""
MENDING_EDITS = 3000  # of a formula that fails
_MOST_ALTERNATIVES = 3
REPAIR_EDITS = 10_000  # of all that a formula may mean
_LARGEST_OF_A_STEP, _LARGEST_STEP = 1e-3, 0.1  # of the scale; rad: what is taken for the step of differences
_FINER, _FINEST, _ROUNDING = 1000.0, 1e-13, 1e-5  # a step that is smaller, and one that leaves rounding of the scale
_NUMERICAL = 1e-6  # of the scale: a difference below it that has no structure comes from rounding


@np.errstate(all="ignore")
def judge(
    formula: Formula,
    kind: Kind,
    truth: Any,
    *,
    seen_by: Sequence[Any] = (),
    progress: Progress | None = None,
) -> Verdict:
    """The verdict on a formula of a known kind.

    Raises:
        UnjudgedError: it holds what is not read, is too slow, needs too much memory, or breaks the connection to its
            judge.
    """
    kind = truth.allowing(kind)
    try:
        formula = as_called(formula, kind, truth)
        truth = assumed(formula, kind, truth)
        cases = meant(formula, kind, truth)
        values = cases[0].values(cases[0].second)
        if not np.array_equal(values, cases[0].values(cases[0].second), equal_nan=True):
            raise ProgramError("gives different numbers when it is called again with the same ones")
        if not np.isfinite(values).any():
            raise ProgramError("returns NaN or infinity instead of numbers")
        budget = Budget(formula.program, REPAIR_EDITS)
        verdicts = _verdicts(cases, progress, budget)
        verdict, case = min(verdicts, key=lambda one: _complexity(one[0]))
        if strict := _with_unused_numbers(verdict, case, progress, budget):
            verdicts, (verdict, case) = [strict], strict
    except Unjudged as error:
        raise UnjudgedError(f"{formula.file}: cannot be judged: it {error}") from None
    except ProgramError as error:
        verdict = _failed(Verdict(True, kind.name, truth.convention, 0.0, file=formula.file, text=formula.text), error)
        if not isinstance(error, ProcessEnded) and not (isinstance(error, Unread) and not error.name):
            _mend_failure(verdict, formula, kind, truth, progress)
        if isinstance(error, Unread) and not _is_renamed(verdict.findings[0], error.name):
            place = f"{formula.file}:{error.line}" if error.line else formula.file
            raise UnjudgedError(f"{place}: cannot be judged: {error}") from None
        return verdict
    _leave_open(verdict, case, verdicts)
    if verdict.findings and is_right_as_it_stands(case):
        _excuse(verdict, case)
    elif other := next((one.convention for _, one in verdicts if one.convention != case.convention), ""):
        verdict.alternatives.append(f"in the convention {other} as many entries would be wrong")
    elif verdict.findings:
        _compare_with_other_convention(verdict, formula, kind, truth)
    _judge_constants(verdict, case)
    verdict.alternatives = _few(verdict.alternatives)
    verdict.ok = not verdict.findings
    seen_by_tests(verdict, case, seen_by)
    return verdict


def _verdicts(
    cases: Sequence[Comparison], progress: Progress | None, budget: Budget
) -> list[tuple[Verdict, Comparison]]:
    """The verdicts on a formula that may be meant in several ways, up to one with one cause of everything."""
    verdicts: list[tuple[Verdict, Comparison]] = []
    for number, case in enumerate(cases):
        if verdicts and (_complexity(verdicts[-1][0]) <= (0, 0, 1) or budget.is_over()):
            break
        share = budget.share(len(cases) - number)  # edits that were tried once cost nothing again
        verdicts.append((_verdict(case, progress, share), case))
    return verdicts


def _with_unused_numbers(
    loose: Verdict, case: Comparison, progress: Progress | None, budget: Budget
) -> tuple[Verdict, Comparison] | None:
    """The verdict with others of the numbers that a formula does not use, if one edit puts them in.

    Args:
        loose: the verdict with these numbers as they stand, of a formula that is right, or that edits mend.
    """
    if any(one.old is None for one in loose.findings):
        return None
    entries = [one.entry for one in loose.findings]
    for strict in doubted(case.formula, case.kind, case.truth, case):
        verdict = _verdict(strict, progress, budget)
        more = [one for one in verdict.findings if one.entry not in entries]
        edits = {(one.line, one.column, one.old, one.new) for one in more}
        if len(edits) == 1 and more[0].old is not None and not verdict.unexplained:
            return verdict, strict
    return None


def _leave_open(verdict: Verdict, case: Comparison, verdicts: Sequence[tuple[Verdict, Comparison]]) -> None:
    """Where the formula does not tell what follows a length, no terms of an entry are said to be due without an if."""
    due = {case.follows: _due_terms(verdict)}
    for one, meaning in verdicts:
        if meaning.convention == case.convention and _complexity(one) == _complexity(verdict):
            due.setdefault(meaning.follows, _due_terms(one))
    open_entries = {entry for entry in due[case.follows] if len({terms.get(entry) for terms in due.values()}) > 1}
    for finding in verdict.findings:
        if finding.entry and tuple(finding.entry) in open_entries:
            name = entry_name(case.kind, finding.entry)
            if finding.cause.startswith(f"{name} "):
                finding.cause = f"{name} reads {finding.reads}."
            finding.due = None
    for follows, terms in due.items() if open_entries else ():
        words = ", ".join(
            f"{entry_name(case.kind, entry)} = {terms[entry]}" for entry in sorted(open_entries & set(terms))
        )
        if words:
            verdict.warnings.append(
                f"the formula does not tell what follows a length: if {FOLLOWING_WORDS[follows]}, due is {words}"
            )


def _due_terms(verdict: Verdict) -> dict[tuple[int, ...], str]:
    """What is due, in terms, in the entries that no edit mends."""
    return {
        tuple(one.entry): one.due
        for one in verdict.findings
        if one.entry and one.due is not None and one.reads is not None and one.old is None
    }


def _excuse(verdict: Verdict, case: Comparison) -> None:
    """What is right with the numbers in the text is wrong only if edits or terms explain why others spoil it."""
    names = ", ".join(sorted({*case.parameters}))
    if all(one.old is not None for one in verdict.findings) or _has_other_names(verdict, case):
        verdict.warnings.append(f"right for the numbers in the text; others of {names} show the mistake")
        return
    entries = ", ".join(entry_name(case.kind, one.entry) for one in verdict.findings if one.entry)
    verdict.findings, verdict.unexplained, verdict.alternatives = [], [], []
    verdict.warnings = [f"right for the numbers in the text; with others of {names} it would differ in {entries}"]


def _has_other_names(verdict: Verdict, case: Comparison) -> bool:
    """Whether the wrong entries read what is due with other names in it: a3 for a2, and no bare number for either."""
    wrong = case.wrong(case.values(case.second), case.second)
    readings = read_entries(case, wrong)
    return set(readings) == wrong and all(one.has_due_units for one in readings.values())


def _few(alternatives: Sequence[str]) -> list[str]:
    """Those that are said: each once, those of another convention first."""
    return sorted(dict.fromkeys(alternatives), key=lambda one: " the convention " not in one)[:_MOST_ALTERNATIVES]


def _compare_with_other_convention(verdict: Verdict, formula: Formula, kind: Kind, truth: Any) -> None:
    """Say that a formula is right in the convention that the scenario does not state."""
    other = truth.in_other_convention()
    if other is not None and wrong_count(formula, kind, other) == 0:
        verdict.alternatives.append(
            f"it is right in the convention {other.convention}; the scenario states {truth.convention}"
        )


def _without_cause(verdict: Verdict) -> int:
    """The findings that neither an edit nor a mistake of the whole explains."""
    words = (" reads ", " has ", " explain it")
    return sum(one.old is None and any(word in one.cause for word in words) for one in verdict.findings)


def _complexity(verdict: Verdict) -> tuple[int, int, int]:
    """Of verdicts on a formula that may be meant in several ways, the simplest explanation is the likeliest."""
    edits = {(one.line, one.column, one.new) for one in verdict.findings}
    return len(verdict.unexplained), _without_cause(verdict), len(edits)


def _verdict(case: Comparison, progress: Progress | None, budget: Budget) -> Verdict:
    """The verdict on a formula that is meant in one way; edits are tried as long as a budget lasts."""
    formula = case.formula
    verdict = Verdict(True, case.kind.name, case.convention, 0.0, file=formula.file, text=formula.text)
    values, due = case.values(case.second), case.due(case.second)
    case.shape = due.shape[1:]
    verdict.shape, verdict.found = list(case.shape), _found(case)
    wrong = case.wrong(values, case.second, due)
    own_due, own_values = _own(case)
    verdict.residual = _largest(own_values - own_due)
    wrong = _only_structured(verdict, case, values, due, wrong)
    if case.convention != case.truth.convention:
        verdict.warnings.append(f"the convention {case.convention} is not that of the arm, {case.truth.convention}")
    if case.kind.name == "coriolis" and not wrong:
        _note_skewness(verdict, case)
    if wrong:
        is_rounding = verdict.residual <= TOLERANCE * _largest(own_due)
        verdict.residual = _largest(values - due) if is_rounding else verdict.residual
        _explain(verdict, case, wrong, progress, budget)
    return verdict


def _note_skewness(verdict: Verdict, case: Comparison) -> None:
    """Whether dM/dt - 2C is skew, where the formula returns a matrix."""
    samples, step = case.second, 1e-6
    matrix = case.formula.values(case.call, samples, case.known)
    if matrix.shape[1:] != (case.truth.joints,) * 2:
        return
    at = [
        case.due_of("mass", samples, {"q": samples.tiled("q") + sign * step * samples.tiled("qd")}) for sign in (1, -1)
    ]
    change = (at[0] - at[1]) / (2 * step) - 2 * matrix
    if np.abs(change + np.swapaxes(change, 1, 2)).max() > 1e-6 * (1 + np.abs(matrix).max()):
        verdict.warnings.append("dM/dt - 2C is not skew; the product C qd is right, and the matrix is not unique")


def _largest(difference: Floats) -> float:
    return float(np.max(np.abs(difference))) if np.isfinite(difference).all() else float("inf")


def _failed(verdict: Verdict, error: ProgramError) -> Verdict:
    finding = Finding(None, f"the formula fails: {error}", line=error.line)
    verdict.ok, verdict.residual, verdict.findings = False, float("inf"), [finding]
    return verdict


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
        for repair in _repairs(case, wrong, progress, statements, budget):
            if repair.mended == wrong:
                verdict.convention = case.convention
                _put_edit(verdict.findings[0], case, repair.edit)
                return


def _own(case: Comparison) -> tuple[Floats, Floats]:
    """What is due and what the formula returns for the arm itself, with the constants as they stand in the text."""
    samples = case.second
    numbers = case.formula.numbers()
    written = {case.parameters[name]: value for name, value in numbers.items() if name in case.parameters}
    here = type(samples)(samples.states, [{**case.own, **written}])
    return case.due(type(samples)(samples.states, [case.own])), case.values(here)


def _found(case: Comparison) -> list[str]:
    """What was found out rather than asked for."""
    formula, found = case.formula, []
    states = [name for name in formula.arguments if slot_of(name) and name not in case.parameters]
    if [slot_of(name) for name in states] != sorted((slot_of(name) for name in states), key=str):
        found.append(f"arguments in the order {', '.join(states)}")
    if formula.order and formula.order != sorted(formula.order):
        found.append(f"outputs in the order {', '.join(formula.outputs)}")
    if formula.output is not None:
        found.append(f"its output {formula.output + 1}")
    if formula.as_columns:
        found.append("with vectors as columns")
    if formula.given:
        found.append(f"with {', '.join(sorted(formula.given))} as it is given")
    if case.degrees:
        found.append("angles in degrees")
    if case.convention:
        found.append(f"convention {case.convention}")
    return found + case.truth.assumed(case.kind, case.rows, case.known)


def _only_structured(
    verdict: Verdict, case: Comparison, values: Floats, due: Floats, wrong: frozenset[int]
) -> frozenset[int]:
    """Without the entries that are right but for rounding, or for the step of differences: these get a warning."""
    flat, right = values.reshape(len(values), -1), due.reshape(len(due), -1)
    relative = np.abs(flat - right).max(axis=0) / scales(right)
    numerical = {place for place in wrong if relative[place] < _NUMERICAL}
    step = ""
    if wrong and numerical != wrong and relative.max() < _LARGEST_OF_A_STEP:
        step = _step_of_differences(case, flat, right)
        numerical = set(wrong) if step else numerical
    if wrong and numerical == wrong:
        verdict.warnings.append(
            f"differences of up to {relative.max():.1e} of the entries' scale: these are numerical{step}"
        )
        return frozenset()
    return wrong


def _step_of_differences(case: Comparison, values: Floats, due: Floats) -> str:
    """The small number of the text that is the step of finite differences, in words; "" where none is.

    The errors shrink with it, and where it is tiny rounding is all that is left: a small term would just be gone.
    """
    text, scale = case.formula.text or "", scales(due)

    def off(node: Node, step: float) -> Floats:
        other = case.values(case.second, Edit(node.start, node.end, repr(step)))
        return np.asarray(np.abs(other.reshape(len(other), -1) - due).max(axis=0))

    for node in (inner for top in case.formula.nodes for inner in top.walk() if inner.kind == "number"):
        number = float(node.word.lower().replace("d", "e"))
        if not 0 < number < _LARGEST_STEP:
            continue
        try:
            left, rounded = off(node, number / _FINER), off(node, _FINEST)
        except (ProgramError, ValueError):
            continue
        error = np.abs(values - due).max(axis=0)
        shrinks = (left <= error / (0.7 * _FINER) + _NUMERICAL * scale).all() and (left < _NUMERICAL * scale).any()
        if shrinks and (rounded > _ROUNDING * scale).any():
            line, _ = line_and_column(text, node.start)
            return f", of differences with the step {node.word} in line {line}"
    return ""


# ---- why ------------------------------------------------------------------------------------------------------------


def _explain(
    verdict: Verdict, case: Comparison, wrong: frozenset[int], progress: Progress | None, budget: Budget
) -> None:
    whole = _hypotheses(case)
    causes = [one.cause for one in whole]
    repairs = _repairs(case, wrong, progress, budget=budget)
    reads = read_entries(case, wrong)
    chosen = cover(repairs, wrong)
    if len(chosen) > 1 and not _hold_together(case, chosen, wrong):
        chosen = chosen[:1]
    left = wrong - frozenset(place for one in chosen for place in one.mended)
    if whole and (left or (whole[0].is_of_result and len(chosen) > 1)):  # one sentence says more than these edits
        chosen, left = [], frozenset()
    joint = None
    if left and len(chosen) == 1 and (more := _after(case, chosen[0].edit, left, progress, budget)):
        joint, chosen = chosen[0].edit, [*chosen, *more]
    for place in sorted(wrong):
        found = reads.get(place)
        finding = Finding(case.entry(place), "", found.reads if found else None, found.due if found else None)
        repair = next((one for one in chosen if place in one.mended), None)
        if repair:
            _put_edit(finding, case, repair.edit)
        finding.cause = _cause(case, place, finding, causes, repair, joint)
        verdict.findings.append(finding)
        if not (repair or causes or (found and found.reads)):
            verdict.unexplained.append(case.entry(place))
        if found and found.note and found.note not in verdict.warnings:
            verdict.warnings.append(found.note)
    if budget.is_over() and verdict.unexplained:
        verdict.warnings.append(
            "the search for an edit that mends it was ended: there are too many, or they are too slow"
        )
    if case.kind.name == "forward" and verdict.unexplained:
        _read_torque(verdict, case)
    verdict.alternatives += causes[1:]
    for repair in chosen:
        verdict.alternatives += _other_edits(case, repairs, repair)


def _read_torque(verdict: Verdict, case: Comparison) -> None:
    """Say what the formula reads when it is solved for the torque, in the entries in which this differs."""
    solved = Solved.of(case)
    values, due = solved.values(solved.second), solved.due(solved.second)
    wrong = wrong_entries(values, due, scales(due), 1e-8)
    readings = read_entries(solved, wrong)
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
                f"{entry_name(case.kind, finding.entry)} is wrong: solved for the torque, {'; '.join(words)}."
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
        is_spatial = case.rows[:3] == SPATIAL
        yield from hypotheses(
            case.kind.name,
            truth,
            states,
            case.truth.joints,
            (lambda: case.truth.pose(case.convention, states["q"])) if is_spatial else None,
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
    return sorted(found, key=lambda one: one.weight)


def _repairs(
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

    short = [one for one in formula.nodes if sum(1 for _ in one.walk()) <= _MOST_PARTS]
    statements = statements or influential(short, formula.text, evaluate, as_it_is, wrong)

    def evaluate_in_order(edit: Edit, everywhere: bool) -> Floats:
        if everywhere and formula.order and (edited := formula.edited(edit)) and edited.order != formula.order:
            raise ProgramError("the edit takes away the names that tell the order of the outputs")
        return evaluate(edit, everywhere)

    found = tried(editor.all(statements), evaluate_in_order, wrong_at(False), wrong_at(True), wrong, progress, budget)
    return [one for one in found[:60] if _is_confirmed(case, one, wrong)]


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
    found = [one for one in _repairs(other, left, progress, budget=budget) if not _overlap(one.edit, edit)]
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
    used = {node.word for node in every if node.kind == "name"}
    plain = {
        name.rstrip("0123456789") for name in used if (slot := slot_of(name)) and slot[0] == "q" and slot[1] is not None
    }
    given = [f"{stem}{joint + 1}" for stem in sorted(plain) for joint in range(joints)]
    if given:
        return [name for name in given if re.search(rf"\b{name}\b", text)]  # a lost angle still has its name
    indexed = {text[node.parts[0].start : node.parts[0].end] for node in every if node.kind == "index" and node.parts}
    called = {node.word for node in every if node.kind == "call"}
    return [
        f"{name}({joint + 1})" if formula.language == "matlab" else f"{name}[{joint}]"
        for name in names
        if name in indexed | called
        for joint in range(joints)
    ]


def _put_edit(finding: Finding, case: Comparison, edit: Edit) -> None:
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
    name = entry_name(case.kind, case.entry(place))
    if repair and finding.old is not None:
        stands = f"stands where `{finding.new}` is due" if finding.new else "is too much"
        others = f"; this line spoils {len(repair.mended)} entries" if len(repair.mended) > 1 else ""
        if first and first != repair.edit:
            line, _ = line_and_column(case.formula.text or "", first.start)
            others += f", together with the mistake in line {line}"
        return f"{name}: in line {finding.line} `{finding.old}` {stands}{others}."
    if finding.reads is not None:
        return f"{name} {difference_words(finding.reads, finding.due)}." if finding.due else f"{name} is wrong."
    return f"{name} is wrong, and neither its terms nor a single edit explain it."


def _other_edits(case: Comparison, repairs: list[Repair], shown: Repair) -> list[str]:
    same = [one for one in repairs if one is not shown and one.mended == shown.mended]
    text, said = case.formula.text or "", []
    for one in same[:3]:
        line, _ = line_and_column(text, one.edit.start)
        old = text[one.edit.start : one.edit.end]
        said.append(f"in line {line} `{old}` as `{one.edit.new}` would be right, too")
    return said


def _judge_constants(verdict: Verdict, case: Comparison) -> None:
    """The numbers that the text gives to the arm's quantities, against the arm's own."""
    for name, constant in case.formula.constants.items():
        quantity = case.parameters.get(name)
        own = case.truth.values_of_quantities.get(quantity) if quantity else None
        if own is None or abs(constant.value - own) <= 1e-9 * max(abs(own), 1e-3):
            continue
        places = _depending(case, str(quantity), constant.value)
        text = case.formula.text or ""
        line, column = line_and_column(text, constant.start)
        old = text[constant.start : constant.end]
        words = "millimetres? " if own and abs(constant.value / own - 1000) < 1e-6 else ""
        arm = "the lecture's arm" if case.truth.is_default else "the arm"
        for place in places:
            verdict.findings.append(
                Finding(
                    case.entry(place),
                    f"{name} is {constant.value:.10g} in line {line}; {words}{arm} has {own:.10g}.",
                    None,
                    None,
                    line,
                    column,
                    old,
                    f"{own:.12g}",
                )
            )


def _depending(case: Comparison, quantity: str, value: float) -> list[int]:
    """The entries that another value of a quantity changes."""
    samples = type(case.second)(case.second.states, [case.own])
    right = case.due(samples)
    changed = case.due(samples, {quantity: np.full(len(right), value)})
    flat, other = (one.reshape(len(one), -1) for one in (right, changed))
    return [int(place) for place in np.flatnonzero(np.abs(flat - other).max(axis=0) > 1e-12 * np.abs(flat).max())]
