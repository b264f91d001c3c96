"""What tests would have seen: the entries and joints that they excite, the findings, and planted mistakes."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from functools import cache
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from .._native import Floats
from ..core.run import Run
from ..core.scenario import Scenario
from ..user_functions.programs import ProgramError
from .comparison import Comparison
from .explain.constants import stated_numbers
from .finding import Finding, Judgement
from .log.reading import read_log
from .planted import planted_and_seen
from .samples import VECTORS, Samples
from .truth.elbow import truth_of_arm
from .truth.three_r import CONVENTIONS, ThreeR

_VISIBLE = 1e-9  # m/s of J qd, N m of a torque
D = np.array([1.0, -1.0, -1.0])
_UNEQUAL = {"length2": 0.8, "length3": 0.55, "mass2": 2.592, "mass3": 3.052}
_ORDER = ("qd", "qdd", "tau", "q")
_MOST_REASONS = 3  # columns that are zero, of which none alone hides a mistake
Column = tuple[str, int]
"""A joint vector, and the joint."""


class Trial(NamedTuple):
    """States at which somebody compared a formula with something: joint vectors "q", "qd", "qdd", "tau", (S, n)."""

    name: str
    states: dict[str, Floats]
    convention: str | None = None
    """That of the states, where it need not be the formula's."""
    quantities: dict[str, float] | None = None
    """Of the arm that was tested, where it is another one."""

    def vanishing(self, vectors: Iterable[str]) -> list[Column]:
        """The columns that are zero throughout."""
        return [
            (vector, int(joint))
            for vector in vectors
            for joint in np.flatnonzero(np.abs(self.states[vector]).max(axis=0) <= _VISIBLE)
        ]

    def with_vector(self, vector: str, values: Floats) -> Trial:
        return self._replace(states={**self.states, vector: values})

    def with_some(self, columns: Iterable[Column]) -> Trial:
        """The test with other numbers in columns."""
        states = {vector: values.copy() for vector, values in self.states.items()}
        for vector, joint in columns:
            states[vector][:, joint] = 0.7 + 0.19 * joint
        return self._replace(states=states)


@cache
def _free_fall() -> Run:
    return Scenario("{format: 1, time: {stop: 10, log_every: 0.01}}").run()


def tests_of(given: Iterable[Any], joints: int) -> list[Trial]:
    """The tests that the user names: scenarios, their paths, logs, or arrays of poses (S, n)."""
    found = []
    for number, one in enumerate(given, start=1):
        if isinstance(one, (str, os.PathLike)) and not os.fspath(one).endswith((".yaml", ".yml")):
            found.append(Trial(os.fspath(one), read_log(one).states(joints)))
        elif isinstance(one, (str, os.PathLike, Scenario)):
            scenario = one if isinstance(one, Scenario) else Scenario.load(one)
            run, arm = scenario.run(), truth_of_arm(scenario)
            states = {vector: run[vector] for vector in VECTORS}
            found.append(Trial(str(scenario.name), states, arm.convention or None, arm.values_of_quantities))
        else:
            poses = np.atleast_2d(np.asarray(one, float))
            found.append(_at(f"poses {number}", poses, np.ones_like(poses)))
    return found


def _at(name: str, q: Floats, qd: Floats, convention: str | None = None) -> Trial:
    return Trial(name, {"q": q, "qd": qd, "qdd": np.zeros_like(q), "tau": np.zeros_like(q)}, convention)


def seen_by_tests(verdict: Judgement, case: Comparison, given: Iterable[Any]) -> None:
    """Fill in for each finding whether each test sees it, and for each test what it excites."""
    tests = tests_of(given, case.truth.joints)
    if isinstance(case.truth, ThreeR):
        own = case.kind.lecture_test(_free_fall)
        tests = [*([_at(*own, CONVENTIONS[0])] if own else []), *tests]
    for test in tests:
        if test.convention not in (None, case.convention) and isinstance(case.truth, ThreeR):
            test = test._replace(states={vector: values * D for vector, values in test.states.items()})
        verdict.coverage[test.name] = _excited(case, test)
        for finding in verdict.findings:
            if finding.entry is None:
                continue
            finding.seen_by[test.name] = _sees(case, test, finding)
            if not finding.seen_by[test.name]:
                finding.unseen_because[test.name] = _reason(case, test, finding)


def _samples(case: Comparison, test: Trial) -> Samples:
    own = {**case.truth.values_of_quantities, **(test.quantities or {})}
    return Samples(test.states, [{name: own[name] for name in case.known}])


def _error(case: Comparison, test: Trial, finding: Finding) -> Floats:
    """What the test sees of a wrong entry, in each state; a number that is not the arm's stands as it is written."""
    samples = _samples(case, test)
    names = finding.cause.split(" is ")[0].split() if finding.old is not None else []
    numbers = [one for one in stated_numbers(case.formula) if one.name in case.parameters and one.name in names]
    written = {case.parameters[one.name]: one.value for one in numbers}
    here = Samples(samples.states, [{**samples.arms[0], **written}])
    place = tuple(one - 1 for one in finding.entry or [])
    difference = case.values(here) - case.due(samples)
    column = int(np.ravel_multi_index(place, case.shape))
    return difference.reshape(len(difference), -1)[:, column] * case.kind.weights(test.states["qd"], place[-1])


def _sees(case: Comparison, test: Trial, finding: Finding) -> bool:
    try:
        return bool(~(np.abs(_error(case, test, finding)).max() <= _VISIBLE))
    except ProgramError:
        return False


def _reason(case: Comparison, test: Trial, finding: Finding) -> str:
    """Why a test does not see a finding: the fewest of its special values without which it would."""
    return next((words for words, other in _others(case, test, finding) if _sees(case, other, finding)), "")


def _others(case: Comparison, test: Trial, finding: Finding) -> Iterator[tuple[str, Trial]]:
    """Tests without some of the special values, and these in words."""
    place = (finding.entry or [1])[-1] - 1
    weight = {"qd"} if case.kind.is_derivative and "qd" not in case.kind.inputs else set()
    zero = [
        (vector, joint)
        for vector, joint in test.vanishing(one for one in _ORDER if one in {*case.kind.inputs, *weight})
        if vector not in weight or joint == place
    ]
    for count in range(1, _MOST_REASONS + 1):
        for columns in combinations(zero, count):
            yield f"there {_all_of([f'{vector}{joint + 1} = 0' for vector, joint in columns])}", test.with_some(columns)
        if count == 1:
            yield from _special(case, test)


def _special(case: Comparison, test: Trial) -> Iterator[tuple[str, Trial]]:
    """Of the lecture's own tests: link 3 that hangs as link 2 does, and equal links."""
    q = test.states["q"]
    if q.shape[1] == 3 and np.abs(q[:, 2] + 2 * q[:, 1]).max() <= 1e-9:
        yield "there q3 = -2 q2", test.with_vector("q", q + np.array([0, 0, 0.3]))
    if isinstance(case.truth, ThreeR):
        yield "there the links are equal", test._replace(quantities=_UNEQUAL)


def _all_of(words: list[str]) -> str:
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def _excited(case: Comparison, test: Trial) -> dict[str, Any]:
    """The joints that move or are turned, the entries that show, and how many planted mistakes are seen."""
    entries = [[one + 1 for one in place] for place in np.argwhere(_shows(case, test)).tolist()]
    moved = test.states["qd" if case.kind.is_derivative else "q"]
    joints = [int(joint) + 1 for joint in np.flatnonzero(np.abs(moved).max(axis=0) > _VISIBLE)]
    found: dict[str, Any] = {"joints": joints, "entries": entries}
    if isinstance(case.truth, ThreeR):
        sign = D if case.convention == CONVENTIONS[1] else np.ones(3)
        numbers = {**case.truth.values_of_quantities, **(test.quantities or {})}
        q, qd = test.states["q"] * sign, test.states["qd"] * sign
        planted, seen = planted_and_seen(case.kind, q, qd, numbers)
        found |= {"planted": planted, "seen": seen} if planted else {}
    return found


def _shows(case: Comparison, test: Trial) -> Any:
    """For each entry whether something of it shows: also where its parts, of rates and torques, cancel as in a fall."""
    vectors = [one for one in case.kind.inputs if one != "q"]
    doubled = [test.with_vector(vector, 2 * test.states[vector]) for vector in vectors]
    found: Any = False
    for one in (test, *doubled):
        due = case.due(_samples(case, one))
        weights = np.stack([case.kind.weights(test.states["qd"], column) for column in range(due.shape[-1])], axis=1)
        size = np.abs(due * weights.reshape(len(due), *[1] * (due.ndim - 2), -1)).max(axis=0)
        found = found | (size > _VISIBLE)
    return found
