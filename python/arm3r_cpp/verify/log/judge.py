"""Judges the columns of a log: entry by entry, against the noise that the log itself shows."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..._native import Floats
from ...errors import UnjudgedError, UsageError
from ..comparison import TOLERANCE, scales
from ..explain.regression import SIGNIFICANT, Fit, columns_of, design, fits
from ..finding import Finding
from ..kinds import Kind
from ..names import SHORT, quantities_of
from ..verdict import Verdict
from .noise import FEWEST_ROWS, features_of, follows, friction_of, inflation, quantum
from .reading import Log

_LARGER = 4.0  # than the noise of the other entries: then an entry holds what is no such sum
_NO_NOISE = 0.1  # of the largest entry: no measurement is meant to be as bad


@dataclass
class _Case:
    """A log in one unit of angles: what depends on no convention."""

    log: Log
    kind: Kind
    truth: Any
    noise: float | None
    entries: dict[tuple[int, ...], Floats]
    states: dict[str, Floats]
    given: dict[str, Floats]
    """The quantities of the arm that stand in the rows."""
    fitted: dict[tuple[int, ...], Fit]
    features: Floats
    step: float
    """Of the measured numbers."""


@dataclass
class _Candidate:
    verdict: Verdict
    undecided: list[str] = field(default_factory=list)
    """The entries that are far off, by what follows nothing."""

    @property
    def doubt(self) -> int:
        return len(self.verdict.findings) + len(self.undecided)


def judge_log(log: Log, kind: Kind, truth: Any, *, noise: float | None = None) -> Verdict:
    """The verdict on the entries that a log has.

    Args:
        noise: of the numbers, relative to an entry's scale; None: what follows none of the terms that such a formula
            has is noise.

    Raises:
        UnjudgedError: the rows are too few, or what they hold has nothing to do with what is due.
    """
    best = _judged(log, kind, truth, noise)
    if best.doubt and log.may_be_degrees:
        other = _judged(log.in_radians(), kind, truth, noise)
        if other.doubt < best.doubt:
            best = other
            best.verdict.found.append("angles in degrees")
    verdict = best.verdict
    if len(next(iter(log.columns.values()))) < FEWEST_ROWS:
        raise UnjudgedError(
            f"{log.file}: cannot be judged: {FEWEST_ROWS} rows or more are needed, at poses that differ in every joint"
        )
    if best.undecided:
        raise UnjudgedError(
            f"{log.file}: cannot be judged: {', '.join(best.undecided[:3])} is off by up to {verdict.residual:.2g} and "
            f"follows no term of a {kind.words}; is this the arm, and are q1, q2, ... its angles?"
        )
    verdict.warnings += log.notes()
    return verdict


def _judged(log: Log, kind: Kind, truth: Any, noise: float | None) -> _Candidate:
    """The verdict in the convention in which fewer entries are wrong; a draw goes to that of the arm."""
    states, entries = log.states(truth.joints), log.judged(kind)
    given = {
        quantity: log.columns[name]
        for name, quantity in quantities_of(log.columns).items()
        if quantity in truth.values_of_quantities and not name.startswith("J")
    }
    case = _Case(
        log=log,
        kind=kind,
        truth=truth,
        noise=noise,
        entries=entries,
        states=states,
        given=given,
        fitted=_fits(kind, truth, states, given, entries),
        features=features_of(kind, truth.groups, truth.revolute, states),
        step=max(quantum(values) for values in entries.values()),
    )
    conventions = (truth.convention, *(one for one in truth.conventions if one != truth.convention))
    return min((_candidate(case, convention) for convention in conventions), key=lambda one: one.doubt)


def _due(truth: Any, kind: Kind, convention: str, states: dict[str, Floats], given: dict[str, Floats]) -> Floats:
    """What is right in each row, with the quantities that stand in it."""
    rows = len(states["q"])
    if not given:
        return truth.values(kind, convention, states, {})
    names = list(given)
    arms, which = np.unique(np.stack([given[name] for name in names], axis=1), axis=0, return_inverse=True)
    found: Floats | None = None
    for number, arm in enumerate(arms):
        here = np.flatnonzero(which.ravel() == number)
        part = truth.values(
            kind,
            convention,
            {name: one[here] for name, one in states.items()},
            dict(zip(names, map(float, arm), strict=True)),
        )
        found = np.zeros((rows, *part.shape[1:])) if found is None else found
        found[here] = part
    assert found is not None
    return found


def _candidate(case: _Case, convention: str) -> _Candidate:
    log, kind, noise = case.log, case.kind, case.noise
    due = _due(case.truth, kind, convention, case.states, case.given)
    missing = [place for place in case.entries if len(place) != due.ndim - 1 or any(np.array(place) >= due.shape[1:])]
    if missing:
        raise UsageError(f"{log.file}: a {kind.words} has no entry {[one + 1 for one in missing[0]]}")
    verdict = Verdict(True, kind.name, convention, 0.0, file=log.file, shape=list(due.shape[1:]))
    verdict.found = [f"convention {convention}"] if convention else []
    found = _Candidate(verdict)
    flat = scales(due.reshape(len(due), -1)).reshape(due.shape[1:])
    rights = {place: np.array([row[place] for row in due]) for place in case.entries}
    left = {place: values - rights[place] for place, values in case.entries.items()}
    sizes = {place: case.fitted[place].noise if place in case.fitted else _rms(one) for place, one in left.items()}
    level = float(np.median([size / flat[place] for place, size in sizes.items()]))
    is_exact = any(size <= TOLERANCE * flat[place] < np.ptp(rights[place]) for place, size in sizes.items())
    verdict.residual = float(max(np.abs(one).max() for one in left.values()))
    for place, one in sorted(left.items()):
        if np.abs(one).max() <= max((noise or 0.0) * SIGNIFICANT, TOLERANCE) * flat[place]:
            continue
        if noise is None and not is_exact and (words := _excuse(case, place, one)) is not None:
            verdict.warnings += [words] if words else []
            if not words and _rms(one) > _NO_NOISE * flat.max():
                found.undecided.append(kind.entry_name([index + 1 for index in place]))
            continue
        size = float(flat[place]) * (level if noise is None else noise)
        verdict.findings.append(_finding(kind, place, case.fitted.get(place), rights[place], size))
    verdict.unexplained = [one.entry for one in verdict.findings if one.reads is None and one.entry]
    if level > TOLERANCE:
        verdict.warnings.append(f"noise of {level:.1e} of the entries' scale; what is smaller cannot be judged")
    verdict.ok = not verdict.findings
    return found


def _excuse(case: _Case, place: tuple[int, ...], left: Floats) -> str | None:
    """Why what is left of an entry is no mistake: "" for noise, else what is to be said; None: it is one."""
    rates = case.log.vector("qd", case.truth.joints) if case.kind.has_friction else None
    columns = np.zeros((len(left), 0)) if rates is None else friction_of(rates[:, place[0]])
    if not follows(left, columns, case.step):
        return None if follows(left, case.features, case.step) else ""
    by_friction = columns @ np.linalg.lstsq(columns, left, rcond=None)[0]
    if follows(left - by_friction, case.features, case.step):
        return None
    return (
        f"t{place[0] + 1} leaves up to {np.abs(by_friction).max():.2g} N m that follow the rate of joint "
        f"{place[0] + 1}, as friction does: a mistake that looks like friction cannot be judged"
    )


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _fits(
    kind: Kind,
    truth: Any,
    states: dict[str, Floats],
    given: dict[str, Floats],
    entries: dict[tuple[int, ...], Floats],
) -> dict[tuple[int, ...], Fit]:
    if "qd" in kind.inputs:
        return {}
    own = truth.values_of_quantities
    varied = [name for name in given if len(np.unique(given[name])) > 1]
    constant = {name: np.full(len(states["q"]), own[name]) for name in own} | given
    columns = columns_of(truth.groups, truth.revolute, kind.order, kind.monomials, list(constant) if varied else [])
    if len(columns) > 1000:
        return {}
    matrix = design(columns, states["q"], constant)
    return fits(columns, matrix, entries)


def _finding(kind: Kind, place: tuple[int, ...], fitted: Fit | None, right: Floats, noise: float) -> Finding:
    """The finding on an entry that is wrong."""
    entry = [one + 1 for one in place]
    name = kind.entry_name(entry)
    if fitted is None:
        return Finding(entry, f"{name} is wrong; its terms cannot be read from these rows.")
    due = fitted.inverse @ right
    due += fitted.inverse @ (right - fitted.matrix @ due)
    if fitted.noise > _LARGER * noise and fitted.noise > TOLERANCE * np.abs(right).max():
        return Finding(entry, f"{name} is wrong, and it is no sum of sines and cosines of first order.")
    coloured = inflation(fitted.left)
    fitted = replace(fitted, deviations=fitted.deviations * coloured)
    due[np.abs(due) < 1e-9 * np.abs(due).max(initial=1e-9)] = 0.0
    due = np.where(np.abs(due - np.round(due * 24) / 24) < 1e-9, np.round(due * 24) / 24, due)
    read, right_words = fitted.read(due), fitted.words(due, due, SHORT)
    if (read == due).all() or _is_off(fitted, read, right):
        return Finding(entry, f"{name} is wrong, with terms that are smaller than the noise.", None, right_words)
    reads = fitted.words(read, due, SHORT)
    return Finding(entry, f"{name} reads {reads}; it should be {right_words}.", reads, right_words)


def _is_off(fitted: Fit, coefficients: Floats, right: Floats) -> bool:
    """Whether coefficients do not give the values of the fit, up to the noise."""
    error, values = fitted.matrix @ (coefficients - fitted.values), fitted.matrix @ fitted.values
    return bool(np.abs(error).max() > 3 * max(fitted.noise, 1e-12 * max(np.abs(right).max(), np.abs(values).max())))
