"""Judges the columns of a log: entry by entry, against the noise that the log itself shows."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from ...errors import UnjudgedError
from ..comparison import TOLERANCE
from ..doubts import right_elsewhere
from ..explain.hypotheses import FACTORS
from ..finding import Finding
from ..kinds import Kind
from ..verdict import Verdict
from .candidate import judged
from .case import at_random
from .meanings import best_meaning
from .noise import FEWEST_ROWS
from .reading import JUDGED, Log

_STILL = 1e-3  # rad or m: less is no motion
_MOST_SPIKES = 0.05  # of the rows
_TOGETHER = 4  # rows: fewer may lie beside each other by chance


def judge_log(log: Log, kind: Kind, truth: Any, *, noise: float | None = None) -> Verdict:
    """The verdict on the entries that a log has.

    Args:
        noise: of the numbers, relative to an entry's scale; None: what follows none of the terms that such a formula
            has is noise.

    Raises:
        UnjudgedError: the rows are too few, or do not tell what is right.
    """
    best = best_meaning(log, kind, truth, noise)
    spikes = sorted(best.spikes)
    if 0 < len(spikes) <= _MOST_SPIKES * len(log.lines) and not _are_together(spikes, best.case.log, kind, truth):
        without = judged(best.case.log.without(spikes), kind, truth, noise)
        if not without.undecided:
            best = without
    verdict, log = best.verdict, best.case.log
    if len(next(iter(log.columns.values()))) < FEWEST_ROWS:
        raise UnjudgedError(
            f"{log.file}: cannot be judged: {FEWEST_ROWS} rows or more are needed, at poses that differ in every joint"
        )
    if best.undecided and (best.is_unrelated or not verdict.findings):
        why = list(best.undecided.values())[-1]
        names = [name for name, other in best.undecided.items() if other == why][:3]
        raise UnjudgedError(f"{log.file}: cannot be judged: {', '.join(names)} {why}")
    verdict.warnings += [f"{name} {why}" for name, why in best.undecided.items()]
    _require_columns(log, kind, truth, verdict)
    if verdict.ok:
        _require_motion(log, kind, truth)
    _explain_by_factor(verdict, log, kind, truth, noise)
    _compare_with_other_convention(verdict, log, kind, truth, noise)
    verdict.warnings += log.notes()
    others = {one.name: [name for name in log.columns if re.fullmatch(one.columns, name)] for one in JUDGED}
    verdict.not_judged = {
        ", ".join(names): one
        for one, names in others.items()
        if names and one != kind.name and names[0].rstrip("0123456789") not in kind.inputs
    }
    return verdict


def _are_together(rows: list[int], log: Log, kind: Kind, truth: Any) -> bool:
    """Whether these rows are all that a range of one state, or of time, has: then they follow it, and are no spikes."""
    if len(rows) < _TOGETHER:
        return False
    states = log.states(truth.joints)
    columns = np.column_stack([np.arange(len(log.lines)), *(states[name] for name in kind.inputs)])
    columns = columns[:, np.ptp(columns, axis=0) > 0]
    inside = (columns >= columns[rows].min(axis=0)) & (columns <= columns[rows].max(axis=0))
    return bool((inside.sum(axis=0) == len(rows)).any())


def _explain_by_factor(verdict: Verdict, log: Log, kind: Kind, truth: Any, noise: float | None) -> None:
    """Say it where one factor makes all entries right."""
    names = [name for name in log.columns if re.fullmatch(kind.columns, name)]
    for factor, words in FACTORS.items() if len(verdict.findings) > 1 else ():
        if not judged(log.times(1 / factor, names), kind, truth, noise).doubt:
            verdict.findings = [Finding(one.entry, f"the result {words}.") for one in verdict.findings]
            verdict.unexplained = []
            return


def _compare_with_other_convention(verdict: Verdict, log: Log, kind: Kind, truth: Any, noise: float | None) -> None:
    """Say that a log is right in the convention that the scenario does not state."""
    other = None if verdict.ok else truth.in_other_convention()
    if other is not None and not judged(log, kind, other, noise).doubt:
        verdict.alternatives.append(right_elsewhere(other, truth))


def _require_columns(log: Log, kind: Kind, truth: Any, verdict: Verdict) -> None:
    """What is right without the columns of its rates is right at rest, and says so.

    Raises:
        UnjudgedError: it is wrong without them.
    """
    missing = [name for name in ("qd", "qdd", "tau") if name in kind.inputs and log.vector(name, truth.joints) is None]
    if missing and not verdict.ok:
        raise UnjudgedError(
            f"{log.file}: cannot be judged: {kind.words} depends on {' and '.join(missing)}, and the log has no "
            f"columns {', '.join(f'{name}1..' for name in missing)}; add them{log.hint()}"
        )
    if missing:
        verdict.found.append(f"with {' and '.join(missing)} = 0, as the log has no columns of them")


def _require_motion(log: Log, kind: Kind, truth: Any) -> None:
    """
    Raises:
        UnjudgedError: a joint on which the entries depend stands still in all rows.
    """
    states = log.states(truth.joints)
    still = [joint for joint in range(truth.joints) if np.ptp(states["q"][:, joint]) < _STILL]
    idle = [f"q{joint + 1}" for joint in still if _depends(kind, truth, joint)]
    if kind.is_product and not states["qd"].any():
        idle = [f"qd{joint + 1}" for joint in range(truth.joints)]
    if idle:
        is_one = len(idle) == 1
        raise UnjudgedError(
            f"{log.file}: cannot be judged: {', '.join(idle)} {'stays' if is_one else 'stay'} the same in all rows, "
            f"and {kind.words} depends on {'it' if is_one else 'them'}; log rows in which every joint moves"
        )


def _depends(kind: Kind, truth: Any, joint: int) -> bool:
    """Whether what is due changes with a joint."""
    first, second = at_random(truth, kind), at_random(truth, kind, turned=joint)
    return bool(np.abs(first - second).max() > TOLERANCE * np.abs(first).max())
