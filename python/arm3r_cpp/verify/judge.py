"""Judges a formula, in steps: what each decides, the next one takes for granted.

How the formula is called and which arm it means; all that it may mean, by which fewest entries are wrong; in each
meaning which entries are wrong, and why; the meaning with the simplest explanation; what stays open in it; the numbers
of the text against the arm's; what tests would have seen.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from .._native import Floats
from ..errors import UnjudgedError
from ..user_functions.programs import ProgramError, Unjudged
from .comparison import TOLERANCE, Comparison
from .coverage import seen_by_tests
from .doubts import few, leave_open, look_at_others
from .explain.budget import SECONDS_AN_EDIT, Budget, affordable
from .explain.causes import explain
from .explain.constants import judge_constants
from .explain.differences import only_structured
from .explain.repair import Progress
from .failure import failed
from .finding import Finding
from .formula import Formula
from .kinds import KINDS, Kind, kinds_of_outputs
from .meaning import ANGULAR_FIRST, as_called, assumed, doubted, meant
from .names import line_of_own_torque, reference_of, slot_of, vectors_of
from .verdict import Verdict

REPAIR_EDITS = 10_000  # of all that a formula may mean


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
    kind = truth.allowing(kind).taking(vectors_of(formula.arguments))
    try:
        if not kind.is_of_arm:
            formula = _with_references(formula, truth)
        formula = as_called(formula, kind, truth)
        truth = assumed(formula, kind, truth)
        cases = meant(formula, kind, truth)
        _require_numbers(cases[0])
        edits = affordable(REPAIR_EDITS, cases[0].calls())
        reading = Budget.of_reading(formula.program)
        budget = Budget(formula.program, edits, SECONDS_AN_EDIT * REPAIR_EDITS, reading=reading)
        verdicts = _explained(cases, budget, progress)
    except Unjudged as error:
        raise UnjudgedError(f"{formula.file}: cannot be judged: it {error}") from None
    except ProgramError as error:
        verdict = failed(error, formula, kind, truth, progress)
        verdict.not_judged = _not_judged(formula, kind)
        return verdict
    verdict, case = min(verdicts, key=lambda one: one[0].complexity)
    if verdict.findings and _is_left_alone(kind) and (line := line_of_own_torque(formula.text or "")):
        raise UnjudgedError(
            f"{formula.file}:{line}: cannot be judged: it sets a torque, and is not that of an arm without one; "
            "make the torque an argument, f(t, x, tau)"
        )
    leave_open(verdict, case, verdicts)
    look_at_others(verdict, case, verdicts)
    judge_constants(verdict, case)
    verdict.alternatives = few(verdict.alternatives)
    verdict.ok = not verdict.findings
    verdict.not_judged = _not_judged(formula, kind)
    seen_by_tests(verdict, case, seen_by)
    return verdict


def _with_references(formula: Formula, truth: Any) -> Formula:
    """A law whose arguments such as q_des have what the scenario's reference is."""
    stated = truth.references()
    found = {name: stated[what] for name in formula.arguments if (what := reference_of(name)) in stated}
    return replace(formula, given={**found, **formula.given})


def _require_numbers(case: Comparison) -> None:
    """
    Raises:
        ProgramError: the formula returns other numbers each time, or none.
    """
    values = case.values(case.second)
    if not np.array_equal(values, case.values(case.second), equal_nan=True):
        raise ProgramError("gives different numbers when it is called again with the same ones")
    if not np.isfinite(values).any():
        raise ProgramError("returns NaN or infinity instead of numbers")


def _explained(
    cases: Sequence[Comparison], budget: Budget, progress: Progress | None
) -> list[tuple[Verdict, Comparison]]:
    """The verdict in each meaning; with others of the numbers that the formula does not use, where these tell more."""
    verdicts = _verdicts(cases, progress, budget)
    simplest = min(verdicts, key=lambda one: one[0].complexity)
    strict = _with_unused_numbers(*simplest, progress, budget)
    return [strict] if strict else verdicts


def _verdicts(
    cases: Sequence[Comparison], progress: Progress | None, budget: Budget
) -> list[tuple[Verdict, Comparison]]:
    """The verdicts on a formula that may be meant in several ways, up to one with one cause of everything."""
    verdicts: list[tuple[Verdict, Comparison]] = []
    for number, case in enumerate(cases):
        if verdicts and (verdicts[-1][0].complexity <= (0, 0, 1) or budget.is_over()):
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


def _verdict(case: Comparison, progress: Progress | None, budget: Budget) -> Verdict:
    """The verdict on a formula that is meant in one way; edits are tried as long as a budget lasts."""
    formula = case.formula
    verdict = Verdict(True, case.kind.name, case.convention, 0.0, file=formula.file, text=formula.text)
    values, due = case.values(case.second), case.due(case.second)
    case.shape = due.shape[1:]
    if unnamed := [
        str(place) for place, name in enumerate(formula.outputs, 1) if not name and formula.output != place - 1
    ]:
        verdict.warnings.append(f"not judged here: output {', '.join(unnamed)}, which no name tells")
    if formula.beside:
        verdict.warnings.append(f"not judged here: {', '.join(formula.beside)} ({formula.file}:{formula.beside[0]})")
    verdict.shape, verdict.found = list(case.shape), _found(case)
    wrong = case.wrong(values, case.second, due)
    own_due, own_values = _own(case)
    verdict.residual = _largest(own_values - own_due)
    wrong = only_structured(verdict, case, values, due, wrong)
    if case.convention != case.truth.convention:
        verdict.warnings.append(f"the convention {case.convention} is not that of the arm, {case.truth.convention}")
    _note_rotation(verdict, case)
    if case.kind.is_product and not wrong:
        _note_skewness(verdict, case)
    if wrong:
        is_rounding = verdict.residual <= TOLERANCE * _largest(own_due)
        verdict.residual = _largest(values - due) if is_rounding else verdict.residual
        worst = np.abs(values - due if is_rounding else own_values - own_due).reshape(-1, *case.shape).max(axis=0)
        verdict.is_angular = case.shape[0] == 6 and case.kind.is_derivative and int(worst.max(axis=1).argmax()) > 2
        explain(verdict, case, wrong, progress, budget)
        if case.rows == ANGULAR_FIRST:
            words = "the angular rows stand above the linear ones; the linear rows should be first."
            verdict.findings.insert(0, Finding(None, words))
    return verdict


def _not_judged(formula: Formula, kind: Kind) -> dict[str, str]:
    """The other kinds of formula that a function returns, by the names of its outputs."""
    if formula.output is None:
        return {}
    kinds = zip(formula.outputs, kinds_of_outputs(formula.outputs), strict=True)
    return {name: other for name, other in kinds if other not in (None, kind.name)}


def _note_rotation(verdict: Verdict, case: Comparison) -> None:
    """Whether a transform has another rotation than the tip's frame, where the formula returns one."""
    if "4x4" not in case.kind.shapes:
        return
    raw = case.formula.values(case.call, case.second, case.known)
    if raw.shape[1:] != (4, 4):
        return
    rotation = case.truth.rotation(case.convention, case.second.tiled("q"))
    if np.abs(raw[:, :3, :3] - rotation).max() > TOLERANCE:
        verdict.warnings.append("its rotation is not that of the tip's frame, and is not judged")


def _note_skewness(verdict: Verdict, case: Comparison) -> None:
    """Whether dM/dt - 2C is skew, where the formula returns a matrix."""
    samples, step = case.second, 1e-6
    matrix = case.formula.values(case.call, samples, case.known)
    if matrix.shape[1:] != (case.truth.joints,) * 2:
        return
    steps = (sign * step * samples.tiled("qd") for sign in (1, -1))
    at = [case.due_of(KINDS["mass"], samples, {"q": samples.tiled("q") + one}) for one in steps]
    change = (at[0] - at[1]) / (2 * step) - 2 * matrix
    if np.abs(change + np.swapaxes(change, 1, 2)).max() > 1e-6 * (1 + np.abs(matrix).max()):
        verdict.warnings.append("dM/dt - 2C is not skew; the product C qd is right, and the matrix is not unique")


def _largest(difference: Floats) -> float:
    return float(np.max(np.abs(difference))) if np.isfinite(difference).all() else float("inf")


def _own(case: Comparison) -> tuple[Floats, Floats]:
    """What is due and what the formula returns for the arm itself, with the constants as they stand in the text."""
    samples = case.second
    numbers = case.formula.numbers()
    written = {case.parameters[name]: value for name, value in numbers.items() if name in case.parameters}
    here = type(samples)(samples.states, [{**case.own, **written}])
    return case.due(type(samples)(samples.states, [case.own])), case.values(here)


def _is_left_alone(kind: Kind) -> bool:
    """Whether the arm of a formula has no torque, though its kind has one."""
    return "tau" in KINDS[kind.name].inputs and "tau" not in kind.inputs


def _found(case: Comparison) -> list[str]:
    """What was found out rather than asked for."""
    formula, found = case.formula, [case.frame.words] if case.frame else []
    states = [name for name in formula.arguments if slot_of(name) and name not in case.parameters]
    if [slot_of(name) for name in states] != sorted((slot_of(name) for name in states), key=str):
        found.append(f"arguments in the order {', '.join(states)}")
    if formula.order and formula.order != sorted(formula.order):
        found.append(f"outputs in the order {', '.join(formula.outputs)}")
    found += [formula.output_words] if formula.output_words else []
    if formula.as_columns:
        found.append("with vectors as columns")
    if formula.given:
        found.append(f"with {', '.join(sorted(formula.given))} as given")
    if _is_left_alone(case.kind):
        found.append("without a torque")
    if case.degrees:
        found.append("angles in degrees")
    if formula.engine:
        found.insert(0, formula.engine)
    if case.convention:
        found.append(f"convention {case.convention}")
    return found + case.truth.assumed(case.kind, case.rows, case.known)
