"""Judges the columns of a log: entry by entry, against the noise that the log itself shows."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import product
from typing import Any

import numpy as np

from ..._native import Floats
from ...errors import Arm3rError, UnjudgedError, UsageError
from ..comparison import TOLERANCE, scales
from ..doubts import right_elsewhere
from ..explain.regression import SIGNIFICANT, Fit, columns_of, design, fits
from ..finding import Finding
from ..kinds import SPATIAL, Kind, Rows
from ..names import SHORT, quantities_of
from ..verdict import Verdict
from .noise import FEWEST_ROWS, features_of, follows, friction_in, inflation, noise_of, quantum, reverses, spikes_of
from .reading import JUDGED, Log, is_entry

_LARGER = 4.0  # than the noise of the other entries: then an entry holds what is no such sum
_OF_STATES = 2.0  # times what the noise of the states makes of an entry: nothing smaller is told from it
_OF_TYPICAL = 1e-4  # of an entry's size at any states: torques that cancel leave rounding of that
_STILL = 1e-3  # rad or m: less is no motion
_MOST_SPIKES = 0.05  # of the rows
_TOGETHER = 4  # rows: fewer may lie beside each other by chance
_NO_NOISE = 0.1  # of the largest entry: no measurement is meant to be as bad
_EQUAL, _FAR_NEARER = 1.05, 0.5
_FACTORS = {
    -1.0: "the sign is the opposite one.",
    1e3: "a thousand times too large, as numbers in mm are.",
    1e-3: "a thousand times too small.",
    180 / np.pi: "57.3 times too large, as degrees are.",
    np.pi / 180: "57.3 times too small.",
}
"""What entries are that one factor makes right."""
_APART = 6.0  # times the noise of the other entries, of their size and of their scale: no sensor is as much worse


@dataclass
class _Case:
    """A log in one reading of its columns, beside what it may be of."""

    log: Log
    kind: Kind
    truth: Any
    rows: Rows
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
    case: _Case
    verdict: Verdict
    undecided: dict[str, str] = field(default_factory=dict)
    """The entries of which the rows do not tell whether they are right, and why not."""
    is_unrelated: bool = False
    """Whether one of them has nothing to do with what is due."""
    spikes: set[int] = field(default_factory=set)
    """The rows of these entries that lie far from all others."""
    is_excused: bool = False
    """Whether friction or the noise of the states explains what an entry is off by."""

    @property
    def rank(self) -> tuple[int, bool]:
        return self.doubt, self.is_excused

    @property
    def doubt(self) -> int:
        return len(self.verdict.findings) + len(self.undecided)


def judge_log(log: Log, kind: Kind, truth: Any, *, noise: float | None = None) -> Verdict:
    """The verdict on the entries that a log has.

    Args:
        noise: of the numbers, relative to an entry's scale; None: what follows none of the terms that such a formula
            has is noise.

    Raises:
        UnjudgedError: the rows are too few, or do not tell what is right.
    """
    best = _best(log, kind, truth, noise)
    spikes = sorted(best.spikes)
    if 0 < len(spikes) <= _MOST_SPIKES * len(log.lines) and not _are_together(spikes, best.case.log, kind, truth):
        without = _judged(best.case.log.without(spikes), kind, truth, noise)
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


def _best(log: Log, kind: Kind, truth: Any, noise: float | None) -> _Candidate:
    """The verdict in that reading of the columns in which fewest entries are wrong; a draw goes to the first.

    Raises:
        UsageError: no reading of it is possible.
    """
    best: _Candidate | None = None
    refusal: Arm3rError | None = None
    for words, one in _readings(log, kind, truth):
        if best and len(one.lines) < len(log.lines) and not _is_nearer(one, best):
            continue
        try:
            found = _judged(one, kind, truth, noise)
        except Arm3rError as error:
            refusal = refusal or error
            continue
        if best is None or found.rank < best.rank:
            best = found
            best.verdict.found += words
        if not any(best.rank):
            break
    if best is None:
        assert refusal is not None
        raise refusal
    return best


def _is_nearer(log: Log, best: _Candidate) -> bool:
    """Whether an entry of a log with columns that are moved is far nearer to what is due, and none is farther."""
    case, convention = best.case, best.verdict.convention
    moved = replace(
        case,
        log=log,
        entries=log.judged(case.kind),
        states=log.states(case.truth.joints),
        given={quantity: log.columns[name] for quantity, name in _quantities(log, case.truth).items()},
    )
    off, other = (
        np.array([_rms(one) for one in _left(one, _due(one, convention, one.states)).values()]) for one in (case, moved)
    )
    return bool((other <= _EQUAL * off).all() and (other < _FAR_NEARER * off).any())


def _readings(log: Log, kind: Kind, truth: Any) -> Iterator[tuple[list[str], Log]]:
    """What the columns of a log may be, in words and as a log, the likeliest first."""
    found: list[tuple[list[str], Log]] = [([], log)]
    if names := list(_quantities(log, truth).values()):
        found.append(([f"without its column{'s' * (len(names) > 1)} {', '.join(names)}"], log.but_for(names)))
    yield from found
    if log.may_be_degrees:
        yield from (([*words, "angles in degrees"], one.in_radians(truth.revolute)) for words, one in found)
    judged = [name for name in log.columns if re.fullmatch(kind.columns, name)]
    for rows, (words, one) in product((1, -1, 2, -2) if noise_of(log.states(truth.joints)) else (), found):
        late = ", ".join(judged) if rows > 0 else "all but what is judged"
        yield [*words, f"{late} {abs(rows)} row{'s' * (abs(rows) > 1)} late"], one.later(rows, judged)


def _quantities(log: Log, truth: Any) -> dict[str, str]:
    """The columns that may be quantities of the arm, by these."""
    return {
        quantity: name
        for name, quantity in quantities_of(log.columns).items()
        if quantity in truth.values_of_quantities and not name.startswith("J") and not is_entry(name)
    }


def _explain_by_factor(verdict: Verdict, log: Log, kind: Kind, truth: Any, noise: float | None) -> None:
    """Say it where one factor makes all entries right."""
    names = [name for name in log.columns if re.fullmatch(kind.columns, name)]
    for factor, words in _FACTORS.items() if len(verdict.findings) > 1 else ():
        if not _judged(log.times(1 / factor, names), kind, truth, noise).doubt:
            verdict.findings = [Finding(one.entry, words) for one in verdict.findings]
            verdict.unexplained = []
            return


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


def _typical(case: _Case) -> Floats:
    """What is right at a few states drawn at random."""
    return _at_random(case.truth, case.kind, case.rows)


def _at_random(truth: Any, kind: Kind, rows: Rows = SPATIAL, turned: int | None = None) -> Floats:
    """The same, with one of the joints perhaps turned."""
    random = np.random.default_rng(7)
    states = {name: random.uniform(-1, 1, (4, truth.joints)) for name in ("q", "qd", "qdd", "tau")}
    if turned is not None:
        states["q"][:, turned] += 0.7
    return np.asarray(truth.values(kind, truth.convention, states, {}, rows=rows))


def _depends(kind: Kind, truth: Any, joint: int) -> bool:
    """Whether what is due changes with a joint."""
    first, second = _at_random(truth, kind), _at_random(truth, kind, turned=joint)
    return bool(np.abs(first - second).max() > TOLERANCE * np.abs(first).max())


def _judged(log: Log, kind: Kind, truth: Any, noise: float | None) -> _Candidate:
    """The verdict by that arm, frame and convention in which fewest entries are wrong; a draw goes to the own."""
    states, entries = log.states(truth.joints), log.judged(kind)
    given = {quantity: log.columns[name] for quantity, name in _quantities(log, truth).items()}
    varied = {name: one for name, one in given.items() if np.ptp(one)}
    case = _Case(
        log=log,
        kind=kind,
        truth=truth,
        rows=SPATIAL,
        noise=noise,
        entries=entries,
        states=states,
        given=given,
        fitted=_fits(kind, truth, states, given, entries),
        features=features_of(kind, truth.groups, truth.revolute, states, varied),
        step=max(quantum(values) for values in entries.values()),
    )
    best: _Candidate | None = None
    count = max(place[0] + 1 for place in entries)
    for one in (truth, *truth.open_to(kind)):
        for rows in one.rows_of(kind, 6 if count > 3 else count):
            for convention in (one.convention, *(other for other in one.conventions if other != one.convention)):
                found = _candidate(replace(case, truth=one, rows=rows), convention)
                if best is None or found.doubt < best.doubt:
                    best = found
                    best.verdict.found += one.assumed(kind, rows, list(given))
        assert best is not None
        if not best.doubt:
            break
    assert best is not None
    return best


def _due(case: _Case, convention: str, states: dict[str, Floats]) -> Floats:
    """What is right in each row, with the quantities that stand in it."""
    given, count = case.given, len(states["q"])

    def values(states: dict[str, Floats], quantities: dict[str, float]) -> Floats:
        return np.asarray(case.truth.values(case.kind, convention, states, quantities, rows=case.rows))

    if not given:
        return values(states, {})
    names = list(given)
    arms, which = np.unique(np.stack([given[name] for name in names], axis=1), axis=0, return_inverse=True)
    found: Floats | None = None
    for number, arm in enumerate(arms):
        here = np.flatnonzero(which.ravel() == number)
        part = values({name: one[here] for name, one in states.items()}, dict(zip(names, map(float, arm), strict=True)))
        found = np.zeros((count, *part.shape[1:])) if found is None else found
        found[here] = part
    assert found is not None
    return found


def _candidate(case: _Case, convention: str) -> _Candidate:
    """The verdict by one arm, in one convention."""
    log, kind, noise = case.log, case.kind, case.noise
    due = _due(case, convention, case.states)
    missing = [place for place in case.entries if len(place) != due.ndim - 1 or any(np.array(place) >= due.shape[1:])]
    if missing:
        raise UsageError(f"{log.file}: {kind.a_words} has no entry {[one + 1 for one in missing[0]]}{log.hint()}")
    verdict = Verdict(True, kind.name, convention, 0.0, file=log.file, shape=list(due.shape[1:]))
    verdict.found = [f"convention {convention}"] if convention else []
    flat = scales(due.reshape(len(due), -1)).reshape(due.shape[1:])
    flat = np.maximum(flat, _OF_TYPICAL * np.abs(_typical(case)).max())
    rights = {place: _entry(due, place) for place in case.entries}
    left = _left(case, due)
    found = _Candidate(case, verdict)
    sizes = {place: case.fitted[place].noise if place in case.fitted else _rms(one) for place, one in left.items()}
    by_states = _spread(case, convention, due)
    is_exact = any(size <= TOLERANCE * flat[place] < np.ptp(rights[place]) for place, size in sizes.items())
    is_exact = is_exact and max(np.abs(one).max() for one in left.values()) > 2 * case.step
    excuses: dict[tuple[int, ...], _Excuse] = {}
    wrong: list[tuple[int, ...]] = []
    for place, one in sorted(left.items()):
        if np.abs(one).max() <= max((noise or 0.0) * SIGNIFICANT, TOLERANCE) * flat[place]:
            continue
        excuse = None if noise is not None or is_exact else _excuse(case, place, one, by_states[place])
        if excuse is None:
            wrong.append(place)
            continue
        excuses[place] = excuse
        if excuse.doubt:
            found.undecided[_name(kind, place)] = excuse.doubt
    quiet = {place: one.rest for place, one in excuses.items() if one.is_noise and not one.doubt}
    wrong += _not_noise(case, found, quiet, {place: float(flat[place]) for place in left})
    words = [one.words for place, one in excuses.items() if one.words and place not in wrong]
    verdict.warnings += words
    found.is_excused = bool(words)
    level = float(np.median([size / flat[place] for place, size in sizes.items()]))
    same = float(np.median(list(sizes.values())))
    for place in sorted(wrong):
        size = max(float(flat[place]) * level, same) if noise is None else float(flat[place]) * noise
        verdict.findings.append(_finding(kind, place, case.fitted.get(place), rights[place], left[place], size))
    verdict.residual = float(max(np.abs(left[place]).max() for place in wrong or left))
    verdict.unexplained = [one.entry for one in verdict.findings if one.reads is None and one.entry]
    level = (
        level
        if case.fitted
        else max((_rms(one) / flat[place] for place, one in quiet.items() if place not in wrong), default=0.0)
    )
    if level > TOLERANCE:
        verdict.warnings.append(f"noise of {level:.1e} of the entries' scale; what is smaller cannot be judged")
    verdict.ok = not verdict.findings
    return found


def _not_noise(
    case: _Case, found: _Candidate, quiet: dict[tuple[int, ...], Floats], flat: dict[tuple[int, ...], float]
) -> list[tuple[int, ...]]:
    """The entries that are wrong though they seem to have noise: far more than others have. Some are left undecided."""
    wrong = []
    sizes = {place: _rms(one) for place, one in quiet.items() if np.ptp(case.entries[place])}
    for place, size in sizes.items():
        others = [(one, one / flat[other] * flat[place]) for other, one in sizes.items() if other != place]
        usual = max(np.median(others, axis=0)) if others else np.inf
        is_apart, is_large = size > _APART * usual, size > _NO_NOISE * max(flat.values())
        found.spikes |= spikes_of(quiet[place]) if is_apart or is_large else set()
        if is_apart and size > _NO_NOISE * flat[place]:
            wrong.append(place)
        elif is_apart:
            found.undecided[_name(case.kind, place)] = (
                f"leaves {size:.2g} {case.kind.unit} (rms), far more than other entries do, and these rows do not tell "
                "whether that is noise; log random poses, or a motion that excites more"
            )
        elif is_large:
            found.is_unrelated = True
            found.undecided[_name(case.kind, place)] = (
                f"is off by up to {np.abs(quiet[place]).max():.2g} and follows no term of {case.kind.a_words}; is this "
                "the arm, and are q1, q2, ... its angles?"
            )
    return wrong


def _left(case: _Case, due: Floats) -> dict[tuple[int, ...], Floats]:
    """What each entry is off by, in each row."""
    return {place: values - _entry(due, place) for place, values in sorted(case.entries.items())}


def _entry(due: Floats, place: tuple[int, ...]) -> Floats:
    return np.asarray(due.reshape(len(due), -1)[:, np.ravel_multi_index(place, due.shape[1:])])


def _name(kind: Kind, place: tuple[int, ...]) -> str:
    return kind.entry_name([index + 1 for index in place])


@dataclass
class _Excuse:
    """Why what is left of an entry is no mistake, or may be none."""

    words: str = ""
    doubt: str = ""
    """Why it cannot be told."""
    rest: Floats = field(default_factory=lambda: np.zeros(1))
    """What is left without friction."""
    is_noise: bool = True


def _excuse(case: _Case, place: tuple[int, ...], left: Floats, by_states: float) -> _Excuse | None:
    """Why what is left of an entry is no mistake; None: it is one.

    Args:
        by_states: how far the noise of the states spreads the entry.
    """
    found = _Excuse(rest=left)
    rates = case.log.vector("qd", case.truth.joints) if case.kind.has_friction else None
    friction = friction_in(left, rates[:, place[0]], case.step) if rates is not None else None
    if rates is not None and friction is not None:
        joint, found.rest = place[0] + 1, left - friction
        found.words = (
            f"t{joint} leaves up to {np.abs(friction).max():.2g} N m that follow the rate of joint {joint}, as "
            "friction does: a mistake that looks like friction cannot be judged"
        )
        if not reverses(rates[:, place[0]]):
            found.doubt = (
                f"is off by up to {np.abs(left).max():.2g} N m, and joint {joint} turns one way only: friction and "
                "other torques look alike; log rows in which it turns both ways"
            )
    if not follows(found.rest, case.features, case.step):
        return found
    if _rms(left) > _OF_STATES * by_states:
        return None
    off = f"{np.abs(left).max():.2g} {case.kind.unit}"
    words = (
        f"{_name(case.kind, place)} is off by up to {off}, as the noise of the states explains: "
        "no smaller mistake can be judged"
    )
    return _Excuse(words, is_noise=False)


def _spread(case: _Case, convention: str, due: Floats) -> Floats:
    """By how much the noise of the states spreads what is due, where they are logged along a motion: an entry each."""
    sizes = noise_of({name: values for name, values in case.states.items() if name in case.kind.inputs})
    if not any(size.any() for size in sizes.values()):
        return np.zeros(due.shape[1:])
    random = np.random.default_rng(5)
    other = {
        name: case.states[name] + size * random.standard_normal(case.states[name].shape) for name, size in sizes.items()
    }
    moved = _due(case, convention, {**case.states, **other})
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
