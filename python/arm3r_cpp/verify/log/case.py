"""A log beside the arm that it may be of: what is due in its rows, and what is left of each entry."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..._native import Floats
from ..explain.regression import Fit, columns_of, design, fits
from ..kinds import SPATIAL, Kind, Rows
from ..names import quantities_of
from ..verdict import Verdict
from .noise import features_of, noise_of, quantum
from .reading import Log, is_entry

Place = tuple[int, ...]
"""Of an entry, from 0."""


@dataclass
class Case:
    """A log in one reading of its columns, beside what it may be of."""

    log: Log
    kind: Kind
    truth: Any
    rows: Rows
    noise: float | None
    entries: dict[Place, Floats]
    states: dict[str, Floats]
    given: dict[str, Floats]
    """The quantities of the arm that stand in the rows."""
    fitted: dict[Place, Fit]
    features: Floats
    step: float
    """Of the measured numbers."""

    @classmethod
    def of(cls, log: Log, kind: Kind, truth: Any, noise: float | None) -> Case:
        """A log beside the arm itself, in the rows of its kind."""
        states, entries = log.states(truth.joints), log.judged(kind)
        given = {quantity: log.columns[name] for quantity, name in quantities_in(log, truth).items()}
        varied = {name: one for name, one in given.items() if np.ptp(one)}
        return cls(
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


@dataclass
class Candidate:
    """The verdict on a log by one arm, in one convention."""

    case: Case
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


def quantities_in(log: Log, truth: Any) -> dict[str, str]:
    """The columns that may be quantities of the arm, by these."""
    return {
        quantity: name
        for name, quantity in quantities_of(log.columns).items()
        if quantity in truth.values_of_quantities and not name.startswith("J") and not is_entry(name)
    }


def _fits(
    kind: Kind,
    truth: Any,
    states: dict[str, Floats],
    given: dict[str, Floats],
    entries: dict[Place, Floats],
) -> dict[Place, Fit]:
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


def due_of(case: Case, convention: str, states: dict[str, Floats]) -> Floats:
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


def left_of(case: Case, due: Floats) -> dict[Place, Floats]:
    """What each entry is off by, in each row."""
    return {place: values - entry_of(due, place) for place, values in sorted(case.entries.items())}


def entry_of(due: Floats, place: Place) -> Floats:
    return np.asarray(due.reshape(len(due), -1)[:, np.ravel_multi_index(place, due.shape[1:])])


def entry_words(kind: Kind, place: Place) -> str:
    return kind.entry_name([index + 1 for index in place])


def typical(case: Case) -> Floats:
    """What is right at a few states drawn at random."""
    return at_random(case.truth, case.kind, case.rows)


def at_random(truth: Any, kind: Kind, rows: Rows = SPATIAL, turned: int | None = None) -> Floats:
    """The same, with one of the joints perhaps turned."""
    random = np.random.default_rng(7)
    states = {name: random.uniform(-1, 1, (4, truth.joints)) for name in ("q", "qd", "qdd", "tau")}
    if turned is not None:
        states["q"][:, turned] += 0.7
    return np.asarray(truth.values(kind, truth.convention, states, {}, rows=rows))


def spread_by_states(case: Case, convention: str, due: Floats) -> Floats:
    """By how much the noise of the states spreads what is due, where they are logged along a motion: an entry each."""
    sizes = noise_of({name: values for name, values in case.states.items() if name in case.kind.inputs})
    if not any(size.any() for size in sizes.values()):
        return np.zeros(due.shape[1:])
    random = np.random.default_rng(5)
    other = {
        name: case.states[name] + size * random.standard_normal(case.states[name].shape) for name, size in sizes.items()
    }
    moved = due_of(case, convention, {**case.states, **other})
    return np.asarray(np.sqrt(np.mean((moved - due) ** 2, axis=0)))


def rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))
