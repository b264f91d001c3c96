"""Judges the columns of a log: entry by entry, against the noise that the log itself shows."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._native import Floats
from ..errors import UnjudgedError, UsageError
from .comparison import TOLERANCE, scales
from .explain.regression import SIGNIFICANT, Fit, columns_of, design, fits
from .finding import Finding
from .kinds import Kind, entry_name
from .log import Log
from .names import SHORT, quantities_of
from .verdict import Verdict

FEWEST_ROWS = 8
_LARGER = 4.0  # than the noise of the other entries: then an entry holds what is no such sum


def judge_log(log: Log, kind: Kind, truth: Any, *, noise: float | None = None) -> Verdict:
    """The verdict on the entries that a log has.

    Args:
        noise: of the numbers, relative to an entry's scale; None: as large as a fit shows it to be.
    """
    verdict = _judged(log, kind, truth, noise)
    if len(next(iter(log.columns.values()))) < FEWEST_ROWS:
        raise UnjudgedError(
            f"{log.file}: cannot be judged: {FEWEST_ROWS} rows or more are needed, at poses that differ in every joint"
        )
    if not verdict.ok and log.may_be_degrees:
        other = _judged(log.in_radians(), kind, truth, noise)
        if len(other.findings) < len(verdict.findings):
            verdict = other
            verdict.found.append("angles in degrees")
    verdict.warnings += log.notes()
    return verdict


def _judged(log: Log, kind: Kind, truth: Any, noise: float | None) -> Verdict:
    """The verdict in the convention in which fewer entries are wrong; a draw goes to that of the arm."""
    states = log.states(truth.joints)
    entries = log.entries(kind)
    parameters = {
        name: quantity
        for name, quantity in quantities_of(log.columns).items()
        if quantity in truth.values_of_quantities and not name.startswith("J")
    }
    given = {quantity: log.columns[name] for name, quantity in parameters.items()}
    fitted = _fits(kind, truth, states, given, entries)
    best: tuple[int, Verdict] | None = None
    for convention in (truth.convention, *(one for one in truth.conventions if one != truth.convention)):
        due = _due(truth, kind, convention, states, given)
        verdict = _verdict(log, kind, convention, fitted, entries, due, noise)
        count = len(verdict.findings)
        if best is None or count < best[0]:
            best = count, verdict
    assert best
    return best[1]


def _due(truth: Any, kind: Kind, convention: str, states: dict[str, Floats], given: dict[str, Floats]) -> Floats:
    """What is right in each row, with the quantities that stand in it."""
    rows = len(states["q"])
    if not given:
        return truth.values(kind.name, convention, states, {})
    names = list(given)
    arms, which = np.unique(np.stack([given[name] for name in names], axis=1), axis=0, return_inverse=True)
    found: Floats | None = None
    for number, arm in enumerate(arms):
        here = np.flatnonzero(which.ravel() == number)
        part = truth.values(
            kind.name,
            convention,
            {name: one[here] for name, one in states.items()},
            dict(zip(names, map(float, arm), strict=True)),
        )
        found = np.zeros((rows, *part.shape[1:])) if found is None else found
        found[here] = part
    assert found is not None
    return found


def _verdict(
    log: Log,
    kind: Kind,
    convention: str,
    every_fit: dict[tuple[int, ...], Fit],
    entries: dict[tuple[int, ...], Floats],
    due: Floats,
    noise: float | None,
) -> Verdict:
    verdict = Verdict(True, kind.name, convention, 0.0, file=log.file, shape=list(due.shape[1:]))
    verdict.found = [f"convention {convention}"] if convention else []
    missing = [place for place in entries if len(place) != due.ndim - 1 or any(np.array(place) >= due.shape[1:])]
    if missing:
        raise UsageError(f"{log.file}: a {kind.words} has no entry {[one + 1 for one in missing[0]]}")
    flat = scales(due.reshape(len(due), -1)).reshape(due.shape[1:])
    level = float(np.median([one.noise / flat[place] for place, one in every_fit.items()])) if every_fit else 0.0
    for place, values in sorted(entries.items()):
        right = np.array([row[place] for row in due])
        difference, scale = np.abs(values - right), float(flat[place])
        verdict.residual = max(verdict.residual, float(difference.max()))
        fitted = every_fit.get(place)
        limit = max(noise or 0.0, TOLERANCE) * scale * (SIGNIFICANT if noise else 1.0)
        if difference.max() <= limit:
            continue
        finding = _finding(kind, place, fitted, right, level * scale if noise is None else noise * scale)
        if finding:
            verdict.findings.append(finding)
            if finding.reads is None:
                verdict.unexplained.append([one + 1 for one in place])
    if level > TOLERANCE:
        verdict.warnings.append(f"noise of {level:.1e} of the entries' scale; what is smaller cannot be judged")
    verdict.ok = not verdict.findings
    return verdict


def _fits(
    kind: Kind,
    truth: Any,
    states: dict[str, Floats],
    given: dict[str, Floats],
    entries: dict[tuple[int, ...], Floats],
) -> dict[tuple[int, ...], Fit]:
    if kind.name in ("coriolis", "inverse", "forward"):
        return {}
    own = truth.values_of_quantities
    varied = [name for name in given if len(np.unique(given[name])) > 1]
    constant = {name: np.full(len(states["q"]), own[name]) for name in own} | given
    columns = columns_of(kind.name, truth.groups, truth.revolute, list(constant) if varied else [])
    if len(columns) > 1000:
        return {}
    matrix = design(columns, states["q"], constant)
    return fits(columns, matrix, entries)


def _finding(kind: Kind, place: tuple[int, ...], fitted: Fit | None, right: Floats, noise: float) -> Finding | None:
    """The finding on an entry that differs; None where the noise explains it."""
    entry = [one + 1 for one in place]
    name = entry_name(kind, entry)
    if fitted is None:
        return Finding(entry, f"{name} is wrong; its terms cannot be read from these rows.")
    due = fitted.inverse @ right
    due += fitted.inverse @ (right - fitted.matrix @ due)
    if fitted.noise > _LARGER * noise and fitted.noise > TOLERANCE * np.abs(right).max():
        return Finding(entry, f"{name} is wrong, and it is no sum of sines and cosines of first order.")
    if fitted.differs(due).max() <= SIGNIFICANT:
        return None
    due[np.abs(due) < 1e-9 * np.abs(due).max(initial=1e-9)] = 0.0
    due = np.where(np.abs(due - np.round(due * 24) / 24) < 1e-9, np.round(due * 24) / 24, due)
    read, right_words = fitted.read(due), fitted.words(due, due, SHORT)
    if _is_off(fitted, read, right):
        return Finding(entry, f"{name} is wrong, with terms that are smaller than the noise.", None, right_words)
    reads = fitted.words(read, due, SHORT)
    return Finding(entry, f"{name} reads {reads}; {right_words} is due.", reads, right_words)


def _is_off(fitted: Fit, coefficients: Floats, right: Floats) -> bool:
    """Whether coefficients do not give the values of the fit, up to the noise."""
    error, values = fitted.matrix @ (coefficients - fitted.values), fitted.matrix @ fitted.values
    return bool(np.abs(error).max() > 3 * max(fitted.noise, 1e-12 * max(np.abs(right).max(), np.abs(values).max())))
