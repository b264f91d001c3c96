"""A verdict in words, and as a table for notebooks."""

from __future__ import annotations

import html
from itertools import groupby

import numpy as np

from .._messages import shown
from .explain.terms import difference_words
from .finding import Finding, Judgement
from .kinds import KINDS

_MOST_NAMES = 4
"""Of entries that one sentence is about."""


def report(verdict: Judgement) -> str:
    """What `arm3r verify` prints of a formula: a line for the whole, then each finding; what explains several first."""
    lines, told = [f"{verdict.file}: {_head(verdict)}"], set[str]()
    blocks = [list(same) for _, same in groupby(sorted(verdict.findings, key=_edit_of), key=_edit_of)]
    for same in sorted(blocks, key=lambda one: (one[0].entry is not None, not _is_of_several(one))):
        lines += [f"  {line}" for line in _block(verdict, same, told)]
    lines += [f"  also possible: {words}" for words in verdict.alternatives]
    lines += [f"  note: {words}" for words in verdict.warnings]
    if others := [f"{name} (--kind {kind})" for name, kind in verdict.not_judged.items()]:
        lines.append(f"  note: not judged here: {', '.join(others)}")
    lines += [f"  {_covered(verdict, name)}" for name in verdict.coverage]
    return "\n".join(map(shown, lines))


def _is_of_several(findings: list[Finding]) -> bool:
    """Whether one sentence, and no edit, explains several entries."""
    return len(findings) > 1 and findings[0].old is None


def _head(verdict: Judgement) -> str:
    kind = KINDS[verdict.kind].words
    parts = [kind, *verdict.found]
    if verdict.ok:
        return f"{', '.join(parts)}: right"
    count = int(np.prod(verdict.shape)) if verdict.shape else 0
    wrong = len({tuple(one.entry) for one in verdict.findings if one.entry})
    if wrong and count:
        size = (
            f"by up to {verdict.residual:.3g} {_unit(verdict)}".rstrip()
            if np.isfinite(verdict.residual)
            else "some NaN"
        )
        parts.append(f"{wrong} of {count} entries wrong, {size}")
    return ", ".join(parts)


def _unit(verdict: Judgement) -> str:
    """Of the residual: m, and of an angular row none; m/s, and of an angular row 1/s."""
    unit = KINDS[verdict.kind].unit
    return unit.removeprefix("m").replace("/", "1/") if verdict.is_angular else unit


def _covered(verdict: Judgement, name: str) -> str:
    """The joints that a test moves, the entries that it tests, and how many planted mistakes it would catch."""
    test = verdict.coverage[name]
    count = int(np.prod(verdict.shape)) if verdict.shape else 0
    *others, last = map(str, test["joints"] or [""])
    joints = f"joints {', '.join(others)} and {last}" if others else f"joint {last}" if last else "no joint"
    verb = ("move" if KINDS[verdict.kind].is_derivative else "turn") + ("" if others else "s")
    text = f"{name}: {joints} {verb}, {len(test['entries'])} of {count} entries tested"
    return text + (f", {test['seen']} of {test['planted']} typical mistakes would show" if "planted" in test else "")


def _edit_of(finding: Finding) -> tuple[int, int, str, str]:
    if finding.old is None:
        return (10**9, 0, finding.cause, "")
    return (finding.line or 0, finding.column or 0, finding.old, finding.new or "")


def _block(verdict: Judgement, findings: list[Finding], told: set[str]) -> list[str]:
    """What entries read that have one explanation, and the explanation, where it is not among those `told` before."""
    first, read = findings[0], _readings(verdict, findings)
    if _is_about_entry(verdict, first):
        lines = read if first.reads is not None else [*read, _cause(verdict, findings)]
    elif first.cause in told:
        lines = [f"  {line}" for line in read]
    else:
        told.add(first.cause)
        same = [one for one in verdict.findings if one.cause == first.cause]
        lines = [_cause(verdict, same), *(f"  {line}" for line in read)]
    lines += [f"  {line}" for line in _place(verdict, first)]
    lines += [f"  {name} cannot see it{f': {why}' if why else ''}" for name, why in _unseen(findings).items()]
    return lines


def _readings(verdict: Judgement, findings: list[Finding]) -> list[str]:
    """ "t2 reads m3 g C2, should be -m3 g C2"."""
    found = []
    for one in findings:
        if one.entry and one.reads is not None:
            said = difference_words(one.reads, one.due) if one.due is not None else f"reads {one.reads}"
            found.append(f"{KINDS[verdict.kind].entry_name(one.entry)} {said}")
    return found


def _is_about_entry(verdict: Judgement, finding: Finding) -> bool:
    """Whether the sentence is about its entry alone."""
    if not finding.entry:
        return False
    name = KINDS[verdict.kind].entry_name(finding.entry)
    return finding.cause.startswith((f"{name} ", f"{name}: "))


def _cause(verdict: Judgement, findings: list[Finding]) -> str:
    """The sentence, after the entries that it is about."""
    first, name_of = findings[0], KINDS[verdict.kind].entry_name
    entries = [one.entry for one in findings if one.entry]
    names = ", ".join(map(name_of, entries)) if len(entries) <= _MOST_NAMES else f"{len(entries)} entries"
    if not names or first.cause.startswith(f"{names} "):
        return first.cause
    return f"{names}: {_lower(first.cause.removeprefix(f'{name_of(entries[0])}: '))}"


def _unseen(findings: list[Finding]) -> dict[str, str]:
    """The tests that see a mistake in none of its entries, and why."""
    found = {}
    for name in findings[0].seen_by:
        if not any(one.seen_by.get(name) for one in findings):
            found[name] = next(filter(None, (one.unseen_because.get(name) for one in findings)), "")
    return found


def _lower(text: str) -> str:
    return text[:1].lower() + text[1:] if text[1:2].islower() or text[1:2] == " " else text


def _place(verdict: Judgement, finding: Finding) -> list[str]:
    """The line of the source, with carets below what is to be replaced."""
    if finding.line is None or verdict.text is None or finding.old is None:
        return [f"line {finding.line}"] if finding.line else []
    source = verdict.text.split("\n")[finding.line - 1].replace("\t", " ").rstrip("\r")
    head = f"line {finding.line}:  "
    before = source[: (finding.column or 1) - 1]
    blanks = " " * len(shown(before.lstrip()))
    width = max(len(shown(finding.old.split("\n")[0])), 1)
    due = f"should be {finding.new}" if finding.new else "should not be here"
    return [f"{head}{source.strip()}", f"{' ' * len(head)}{blanks}{'^' * width}  {due}"]


def table(verdict: Judgement) -> str:
    """The entries in a table: green where they are right, red where they are wrong, with what they read."""
    shape = verdict.shape or [0]
    rows, columns = (shape[0], shape[1]) if len(shape) > 1 else (shape[0], 1)
    found = {tuple(one.entry): one for one in verdict.findings if one.entry}
    cells = []
    for row in range(1, rows + 1):
        line = ""
        for column in range(1, columns + 1):
            one = found.get((row, column) if len(shape) > 1 else (row,))
            colour = "#f8d0d0" if one else "#d0f0d0"
            text = "right" if one is None else _cell(one)
            line += f'<td style="background:{colour};color:#000;padding:0.4em;text-align:left">{text}</td>'
        cells.append(f"<tr>{line}</tr>")
    head, whole = html.escape(shown(_head(verdict))), html.escape(report(verdict))
    return f"<p>{head}</p><table>{''.join(cells)}</table><pre>{whole}</pre>"


def _cell(finding: Finding) -> str:
    if finding.reads is not None:
        return f"<u>{html.escape(shown(finding.reads))}</u><br>should be: {html.escape(shown(finding.due or ''))}"
    if finding.old is not None:
        return f"<u>{html.escape(shown(finding.old))}</u><br>should be: {html.escape(shown(finding.new or ''))}"
    return "wrong"
