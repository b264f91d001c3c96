"""Tries the edits of a program's text: which of them make entries right."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ..._native import Floats
from ...user_functions.expressions import Node
from ...user_functions.programs import Edit, ProgramError
from .budget import Budget

Evaluate = Callable[[Edit, bool], Floats]
"""The formula with an edit at the first samples, or with True at all of them: (rows, entries)."""
Progress = Callable[[int, int], None]


class Repair(NamedTuple):
    edit: Edit
    mended: frozenset[int]
    """The entries that are right with the edit and were wrong without."""


def wrong_entries(values: Floats, due: Floats, scale: Floats, tolerance: float) -> frozenset[int]:
    """The entries that differ somewhere; what is no number differs."""
    difference = np.abs(values - due)
    return frozenset(int(entry) for entry in np.flatnonzero(~(difference <= tolerance * scale).all(axis=0)))


def tried(
    edits: Sequence[Edit],
    evaluate: Evaluate,
    wrong_first: Callable[[Floats], frozenset[int]],
    wrong_all: Callable[[Floats], frozenset[int]],
    wrong: frozenset[int],
    progress: Progress | None = None,
    budget: Budget | None = None,
) -> list[Repair]:
    """The edits that make some wrong entries right and no right one wrong, the best ones first.

    They are tried in the order of their ranks, up to the first rank with one that mends everything, as long as the
    budget lasts.
    """
    found: list[Repair] = []
    enough = 100
    for number, edit in enumerate(edits):
        if edit.rank > enough or (budget and budget.is_over()):
            break
        if budget:
            budget.spend()
        if progress and number % 10 == 0:
            progress(number, len(edits))
        left = _left(evaluate, edit, False, wrong_first)
        if left is None or not left < wrong:
            continue
        left = _left(evaluate, edit, True, wrong_all)
        if left is not None and left < wrong:
            found.append(Repair(edit, frozenset(wrong - left)))
            enough = edit.rank if not left else enough
    return sorted(found, key=lambda one: (-len(one.mended), one.edit.rank, len(one.edit.new)))


def influential(
    nodes: Sequence[Node], text: str, evaluate: Evaluate, values: Callable[[bool], Floats], wrong: frozenset[int]
) -> list[Node]:
    """The statements that change a wrong entry when their values change; at the first samples, or at others.

    Args:
        values: of the formula as it is, at the first samples or with True at all of them.
    """
    unchanged = [values(False), values(True)]
    return [
        node
        for node in nodes
        if not all(
            _is_idle(node.parts[0], text, evaluate, unchanged, everywhere, wrong) for everywhere in (False, True)
        )
    ]


def _is_idle(
    inner: Node, text: str, evaluate: Evaluate, unchanged: list[Floats], everywhere: bool, wrong: frozenset[int]
) -> bool:
    """Whether the wrong entries stay as they are when the value is another."""
    rows, places, own = len(unchanged[everywhere]), sorted(wrong), text[inner.start : inner.end]
    flat = unchanged[everywhere].reshape(rows, -1)[:, places]
    if not np.isfinite(flat).all() or not np.abs(flat).max() > 0:
        return False
    try:
        for change in (f"1.3*({own})", f"1.3+({own})"):
            changed = evaluate(Edit(inner.start, inner.end, change), everywhere)
            if not np.array_equal(changed.reshape(rows, -1)[:, places], flat):
                return False
    except (ProgramError, ValueError, IndexError):
        return False
    return True


def _left(
    evaluate: Evaluate, edit: Edit, everywhere: bool, wrong: Callable[[Floats], frozenset[int]]
) -> frozenset[int] | None:
    """The entries that are wrong with an edit; None where it fails, or leaves nothing but zeros that are not due."""
    try:
        values = evaluate(edit, everywhere)
        found = wrong(values)
    except (ProgramError, ValueError):
        return None
    return found if values.any() or not found else None


def cover(repairs: Sequence[Repair], wrong: frozenset[int]) -> list[Repair]:
    """Few edits that mend as many entries as possible together: each time the one that mends most of what is left."""
    chosen: list[Repair] = []
    left = set(wrong)
    while left:
        best = max(repairs, key=lambda one: len(one.mended & left), default=None)
        if best is None or not best.mended & left:
            break
        if not any(best.edit.start < one.edit.end and one.edit.start < best.edit.end for one in chosen):
            chosen.append(best)
        left -= best.mended
    return chosen
