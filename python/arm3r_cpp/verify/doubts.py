"""What a verdict cannot say for certain: what follows a length, whose convention is meant, numbers as they stand."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .comparison import Comparison
from .explain.budget import Budget
from .explain.reader import read_entries
from .meaning import is_right_as_it_stands, wrong_count
from .truth.three_r import FOLLOWING_WORDS
from .verdict import Verdict

_MOST_ALTERNATIVES = 3


def look_at_others(verdict: Verdict, case: Comparison, verdicts: Sequence[tuple[Verdict, Comparison]]) -> None:
    """Say that a formula is right for the numbers in its text, or as wrong or right in the other convention."""
    if not verdict.findings:
        return
    other = next((one.convention for _, one in verdicts if one.convention != case.convention), "")
    if is_right_as_it_stands(case):
        _excuse(verdict, case)
    elif other:
        verdict.alternatives.append(f"in the convention {other} as many entries would be wrong")
    else:
        _compare_with_other_convention(verdict, case)


def leave_open(verdict: Verdict, case: Comparison, verdicts: Sequence[tuple[Verdict, Comparison]]) -> None:
    """Where the formula does not tell what follows a length, no terms of an entry are said to be due without an if."""
    due = {case.follows: _due_terms(verdict)}
    for one, meaning in verdicts:
        if meaning.convention == case.convention and one.complexity == verdict.complexity:
            due.setdefault(meaning.follows, _due_terms(one))
    open_entries = {entry for entry in due[case.follows] if len({terms.get(entry) for terms in due.values()}) > 1}
    for finding in verdict.findings:
        if finding.entry and tuple(finding.entry) in open_entries:
            name = case.kind.entry_name(finding.entry)
            if finding.cause.startswith(f"{name} "):
                finding.cause = f"{name} reads {finding.reads}."
            finding.due = None
    for follows, terms in due.items() if open_entries else ():
        words = ", ".join(
            f"{case.kind.entry_name(entry)} = {terms[entry]}" for entry in sorted(open_entries & set(terms))
        )
        if words:
            verdict.warnings.append(
                f"the formula does not tell what follows a length: if {FOLLOWING_WORDS[follows]}, it should be {words}"
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
    entries = ", ".join(case.kind.entry_name(one.entry) for one in verdict.findings if one.entry)
    verdict.findings, verdict.unexplained, verdict.alternatives = [], [], []
    verdict.warnings = [f"right for the numbers in the text; with others of {names} it would differ in {entries}"]


def _has_other_names(verdict: Verdict, case: Comparison) -> bool:
    """Whether the wrong entries read what is due with other names in it: a3 for a2, and no bare number for either."""
    wrong = case.wrong(case.values(case.second), case.second)
    readings, _ = read_entries(case, wrong, Budget.of_reading(case.formula.program))
    return set(readings) == wrong and all(one.has_due_units for one in readings.values())


def _compare_with_other_convention(verdict: Verdict, case: Comparison) -> None:
    """Say that a formula is right in the convention that the scenario does not state."""
    other = case.truth.in_other_convention()
    if other is not None and wrong_count(case.formula, case.kind, other) == 0:
        verdict.alternatives.append(right_elsewhere(other, case.truth))


def right_elsewhere(other: Any, truth: Any) -> str:
    return f"it is right in the convention {other.convention}; the scenario states {truth.convention}"


def few(alternatives: Sequence[str]) -> list[str]:
    """Those that are said: each once, those of another convention first."""
    return sorted(dict.fromkeys(alternatives), key=lambda one: " the convention " not in one)[:_MOST_ALTERNATIVES]
