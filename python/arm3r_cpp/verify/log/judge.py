"""Judges the columns of a log: entry by entry, against the noise that the log itself shows."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..._native import Floats
from ...errors import UnjudgedError, UsageError
from ..comparison import TOLERANCE, scales
from ..doubts import right_elsewhere
from ..explain.regression import SIGNIFICANT, Fit, columns_of, design, fits
from ..finding import Finding
from ..kinds import Kind
from ..names import SHORT, quantities_of
from ..verdict import Verdict
from .noise import FEWEST_ROWS, features_of, follows, friction_of, inflation, noise_of, quantum, spikes_of
from .reading import Log, is_entry

_LARGER = 4.0  # than the noise of the other entries: then an entry holds what is no such sum
_OF_STATES = 2.0  # times what the noise of the states makes of an entry: nothing smaller is told from it
_OF_TYPICAL = 1e-4  # of an entry's size at any states: torques that cancel leave rounding of that
_STILL = 1e-3  # rad or m: less is no motion
_MOST_SPIKES = 0.05  # of the rows
_TOGETHER = 4  # rows: fewer may lie beside each other by chance
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
    undecided: dict[str, float] = field(default_factory=dict)
    """The entries that are far off, by what follows nothing, and how far."""
    spikes: set[int] = field(default_factory=set)
    """The rows of these entries that lie far from all others."""

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
    best, log = _in_units(log, kind, truth, noise)
    spikes = sorted(best.spikes)
    if 0 < len(spikes) <= _MOST_SPIKES * len(log.lines) and not _are_together(spikes, log, kind, truth):
        quieter = log.without(spikes)
        without = _judged(quieter, kind, truth, noise)
        if not without.undecided:
            best, log = without, quieter
    verdict = best.verdict
    if len(next(iter(log.columns.values()))) < FEWEST_ROWS:
        raise UnjudgedError(
            f"{log.file}: cannot be judged: {FEWEST_ROWS} rows or more are needed, at poses that differ in every joint"
        )
    if best.undecided:
        names = list(best.undecided)[:3]
        off = max(best.undecided[name] for name in names)
        raise UnjudgedError(
            f"{log.file}: cannot be judged: {', '.join(names)} is off by up to {off:.2g} and "
            f"follows no term of {kind.a_words}; is this the arm, and are q1, q2, ... its angles?"
        )
    _require_columns(log, kind, truth, verdict)
    if verdict.ok:
        _require_motion(log, kind, truth)
    _compare_with_other_convention(verdict, log, kind, truth, noise)
    verdict.warnings += log.notes()
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


def _in_units(log: Log, kind: Kind, truth: Any, noise: float | None) -> tuple[_Candidate, Log]:
    """The verdict on the log, or on it with its angles taken for degrees, and that log."""
    best = _judged(log, kind, truth, noise)
    if best.doubt and log.may_be_degrees:
        other = _judged(log.in_radians(), kind, truth, noise)
        if other.doubt < best.doubt:
            other.verdict.found.append("angles in degrees")
            return other, log.in_radians()
    return best, log


def _compare_with_other_convention(verdict: Verdict, log: Log, kind: Kind, truth: Any, noise: float | None) -> None:
    """Say that a log is right in the convention that the scenario does not state."""
    other = None if verdict.ok else truth.in_other_convention()
    if other is not None and not _judged(log, kind, other, noise).doubt:
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
            f"columns {', '.join(f'{name}1..' for name in missing)}; add them"
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


def _typical(truth: Any, kind: Kind, turned: int | None = None) -> Floats:
    """What is right at a few states drawn at random, with one of the joints perhaps turned."""
    random = np.random.default_rng(7)
    states = {name: random.uniform(-1, 1, (4, truth.joints)) for name in ("q", "qd", "qdd", "tau")}
    if turned is not None:
        states["q"][:, turned] += 0.7
    return np.asarray(truth.values(kind, truth.convention, states, {}))


def _depends(kind: Kind, truth: Any, joint: int) -> bool:
    """Whether what is due changes with a joint."""
    first, second = _typical(truth, kind), _typical(truth, kind, joint)
    return bool(np.abs(first - second).max() > TOLERANCE * np.abs(first).max())


def _judged(log: Log, kind: Kind, truth: Any, noise: float | None) -> _Candidate:
    """The verdict in the convention in which fewer entries are wrong; a draw goes to that of the arm."""
    states, entries = log.states(truth.joints), log.judged(kind)
    given = {
        quantity: log.columns[name]
        for name, quantity in quantities_of(log.columns).items()
        if quantity in truth.values_of_quantities and not name.startswith("J") and not is_entry(name)
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
        raise UsageError(f"{log.file}: {kind.a_words} has no entry {[one + 1 for one in missing[0]]}")
    verdict = Verdict(True, kind.name, convention, 0.0, file=log.file, shape=list(due.shape[1:]))
    verdict.found = [f"convention {convention}"] if convention else []
    found = _Candidate(verdict)
    flat = scales(due.reshape(len(due), -1)).reshape(due.shape[1:])
    flat = np.maximum(flat, _OF_TYPICAL * np.abs(_typical(case.truth, kind)).max())
    rights = {place: np.array([row[place] for row in due]) for place in case.entries}
    left = {place: values - rights[place] for place, values in case.entries.items()}
    sizes = {place: case.fitted[place].noise if place in case.fitted else _rms(one) for place, one in left.items()}
    level = float(np.median([size / flat[place] for place, size in sizes.items()]))
    same = float(np.median(list(sizes.values())))
    by_states = _spread(case, convention, due)
    is_exact = any(size <= TOLERANCE * flat[place] < np.ptp(rights[place]) for place, size in sizes.items())
    verdict.residual = float(max(np.abs(one).max() for one in left.values()))
    quiet: list[float] = []
    for place, one in sorted(left.items()):
        if np.abs(one).max() <= max((noise or 0.0) * SIGNIFICANT, TOLERANCE) * flat[place]:
            continue
        if noise is None and not is_exact and (words := _excuse(case, place, one, by_states[place])) is not None:
            verdict.warnings += [words] if words else []
            quiet += [] if words else [sizes[place] / flat.max()]
            if not words and _rms(one) > _NO_NOISE * flat.max():
                found.undecided[_name(kind, place)] = float(np.abs(one).max())
                found.spikes |= spikes_of(one)
            continue
        size = max(float(flat[place]) * level, same) if noise is None else float(flat[place]) * noise
        verdict.findings.append(_finding(kind, place, case.fitted.get(place), rights[place], left[place], size))
    verdict.unexplained = [one.entry for one in verdict.findings if one.reads is None and one.entry]
    level = level if case.fitted else max(quiet, default=0.0)
    if level > TOLERANCE:
        verdict.warnings.append(f"noise of {level:.1e} of the entries' scale; what is smaller cannot be judged")
    verdict.ok = not verdict.findings
    return found


def _name(kind: Kind, place: tuple[int, ...]) -> str:
    return kind.entry_name([index + 1 for index in place])


def _excuse(case: _Case, place: tuple[int, ...], left: Floats, by_states: float) -> str | None:
    """Why what is left of an entry is no mistake: "" for noise, else what is to be said; None: it is one.

    Args:
        by_states: how far the noise of the states spreads the entry.
    """
    words, rest = "", left
    rates = case.log.vector("qd", case.truth.joints) if case.kind.has_friction else None
    if rates is not None and follows(left, columns := friction_of(rates[:, place[0]]), case.step):
        by_friction = columns @ np.linalg.lstsq(columns, left, rcond=None)[0]
        rest = left - by_friction
        words = (
            f"t{place[0] + 1} leaves up to {np.abs(by_friction).max():.2g} N m that follow the rate of joint "
            f"{place[0] + 1}, as friction does: a mistake that looks like friction cannot be judged"
        )
    if not follows(rest, case.features, case.step):
        return words
    if _rms(left) > _OF_STATES * by_states:
        return None
    off = f"{np.abs(left).max():.2g} {case.kind.unit}"
    return (
        f"{_name(case.kind, place)} is off by up to {off}, as the noise of the states explains: "
        "no smaller mistake can be judged"
    )


def _spread(case: _Case, convention: str, due: Floats) -> Floats:
    """By how much the noise of the states spreads what is due, where they are logged along a motion: an entry each."""
    sizes = noise_of({name: values for name, values in case.states.items() if name in case.kind.inputs})
    if not any(size.any() for size in sizes.values()):
        return np.zeros(due.shape[1:])
    random = np.random.default_rng(5)
    other = {
        name: case.states[name] + size * random.standard_normal(case.states[name].shape) for name, size in sizes.items()
    }
    moved = _due(case.truth, case.kind, convention, {**case.states, **other}, case.given)
    return np.asarray(np.sqrt(np.mean((moved - due) ** 2, axis=0)))


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


def _finding(
    kind: Kind, place: tuple[int, ...], fitted: Fit | None, right: Floats, left: Floats, noise: float
) -> Finding:
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
