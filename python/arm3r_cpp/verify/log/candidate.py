"""The verdict on a log by the arm, frame and convention in which fewest entries are wrong."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ..._native import Floats
from ...errors import UsageError
from ..comparison import TOLERANCE, scales
from ..explain.regression import SIGNIFICANT, Fit
from ..finding import Finding
from ..kinds import Kind
from ..names import SHORT
from ..verdict import Verdict
from .case import Candidate, Case, Place, due_of, entry_of, entry_words, left_of, rms, spread_by_states, typical
from .excuses import Excuse, excuse_of, not_noise
from .noise import inflation
from .reading import Log

_LARGER = 4.0  # than the noise of the other entries: then an entry holds what is no such sum
_OF_TYPICAL = 1e-4  # of an entry's size at any states: torques that cancel leave rounding of that


def judged(log: Log, kind: Kind, truth: Any, noise: float | None) -> Candidate:
    """The verdict by that arm, frame and convention in which fewest entries are wrong; a draw goes to the own."""
    case = Case.of(log, kind, truth, noise)
    best: Candidate | None = None
    count = max(place[0] + 1 for place in case.entries)
    for one in (truth, *truth.open_to(kind)):
        for rows in one.rows_of(kind, 6 if count > 3 else count):
            for convention in (one.convention, *(other for other in one.conventions if other != one.convention)):
                found = _candidate(replace(case, truth=one, rows=rows), convention)
                if best is None or found.doubt < best.doubt:
                    best = found
                    best.verdict.found += one.assumed(kind, rows, list(case.given))
        assert best is not None
        if not best.doubt:
            break
    assert best is not None
    return best


def _candidate(case: Case, convention: str) -> Candidate:
    """The verdict by one arm, in one convention."""
    log, kind = case.log, case.kind
    due = due_of(case, convention, case.states)
    missing = [place for place in case.entries if len(place) != due.ndim - 1 or any(np.array(place) >= due.shape[1:])]
    if missing:
        raise UsageError(f"{log.file}: {kind.a_words} has no entry {[one + 1 for one in missing[0]]}{log.hint()}")
    verdict = Verdict(True, kind.name, convention, 0.0, file=log.file, shape=list(due.shape[1:]))
    verdict.found = [f"convention {convention}"] if convention else []
    found = Candidate(case, verdict)
    rights = {place: entry_of(due, place) for place in case.entries}
    left, scale = left_of(case, due), _scale_of_entries(case, due)
    sizes = {place: case.fitted[place].noise if place in case.fitted else rms(one) for place, one in left.items()}
    off = {place: one for place, one in sorted(left.items()) if not _is_within(case, one, scale[place])}
    excuses = {} if case.noise is not None else _excuses(case, convention, due, off, left, sizes, scale)
    found.undecided = {entry_words(kind, place): one.doubt for place, one in excuses.items() if one.doubt}
    quiet = {place: one.rest for place, one in excuses.items() if one.is_noise and not one.doubt}
    wrong = [place for place in off if place not in excuses]
    wrong += not_noise(case, found, quiet, scale)
    words = [one.words for place, one in excuses.items() if one.words and place not in wrong]
    verdict.warnings += words
    found.is_excused = bool(words)

    level = float(np.median([size / scale[place] for place, size in sizes.items()]))
    same = float(np.median(list(sizes.values())))
    for place in sorted(wrong):
        size = max(scale[place] * level, same) if case.noise is None else scale[place] * case.noise
        verdict.findings.append(_finding(kind, place, case.fitted.get(place), rights[place], left[place], size))
    verdict.residual = float(max(np.abs(left[place]).max() for place in wrong or left))
    verdict.unexplained = [one.entry for one in verdict.findings if one.reads is None and one.entry]
    if not case.fitted:
        level = max((rms(one) / scale[place] for place, one in quiet.items() if place not in wrong), default=0.0)
    if level > TOLERANCE:
        verdict.warnings.append(f"noise of {level:.1e} of the entries' scale; what is smaller cannot be judged")
    verdict.ok = not verdict.findings
    return found


def _scale_of_entries(case: Case, due: Floats) -> dict[Place, float]:
    """What an entry is compared with: its size in these rows, but not less than rounding at any states."""
    flat = scales(due.reshape(len(due), -1)).reshape(due.shape[1:])
    flat = np.maximum(flat, _OF_TYPICAL * np.abs(typical(case)).max())
    return {place: float(flat[place]) for place in case.entries}


def _is_within(case: Case, left: Floats, scale: float) -> bool:
    """Whether what is left of an entry is rounding, or the noise that the caller has stated."""
    return bool(np.abs(left).max() <= max((case.noise or 0.0) * SIGNIFICANT, TOLERANCE) * scale)


def _excuses(
    case: Case,
    convention: str,
    due: Floats,
    off: dict[Place, Floats],
    left: dict[Place, Floats],
    sizes: dict[Place, float],
    scale: dict[Place, float],
) -> dict[Place, Excuse]:
    """What may explain an entry that is off, where anything does, other than a mistake."""
    by_states = spread_by_states(case, convention, due)
    rights = {place: entry_of(due, place) for place in off}
    is_exact = any(size <= TOLERANCE * scale[at] < np.ptp(entry_of(due, at)) for at, size in sizes.items())
    is_exact = is_exact and max(np.abs(one).max() for one in left.values()) > 2 * case.step
    found = {at: excuse_of(case, at, one, rights[at], by_states[at], is_exact=is_exact) for at, one in off.items()}
    return {place: excuse for place, excuse in found.items() if excuse is not None}


def _finding(kind: Kind, place: Place, fitted: Fit | None, right: Floats, left: Floats, noise: float) -> Finding:
    """The finding on an entry that is wrong."""
    entry = [one + 1 for one in place]
    name = kind.entry_name(entry)
    off = f"{name} is wrong, by up to {np.abs(left).max():.2g} {kind.unit}"
    if fitted is None:
        return Finding(entry, f"{off}; its terms cannot be read from these rows.")
    due = fitted.inverse @ right
    due += fitted.inverse @ (right - fitted.matrix @ due)
    if fitted.noise > _LARGER * noise and fitted.noise > TOLERANCE * np.abs(right).max():
        return Finding(entry, f"{off}, and it is no sum of sines and cosines of first order.")
    coloured = inflation(fitted.left)
    fitted = replace(fitted, deviations=fitted.deviations * coloured)
    due[np.abs(due) < 1e-9 * np.abs(due).max(initial=1e-9)] = 0.0
    due = np.where(np.abs(due - np.round(due * 24) / 24) < 1e-9, np.round(due * 24) / 24, due)
    read, right_words = fitted.read(due), fitted.words(due, due, SHORT)
    if (read == due).all() or _is_off(fitted, read, right):
        return Finding(entry, f"{off}; these rows do not tell by which term.", None, right_words)
    reads = fitted.words(read, due, SHORT)
    return Finding(entry, f"{name} reads {reads}; it should be {right_words}.", reads, right_words)


def _is_off(fitted: Fit, coefficients: Floats, right: Floats) -> bool:
    """Whether coefficients do not give the values of the fit, up to the noise."""
    error, values = fitted.matrix @ (coefficients - fitted.values), fitted.matrix @ fitted.values
    return bool(np.abs(error).max() > 3 * max(fitted.noise, 1e-12 * max(np.abs(right).max(), np.abs(values).max())))
