"""What tests would have seen: the entries and joints that they excite, the findings, and planted mistakes."""

from __future__ import annotations

import os
from collections.abc import Iterable
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from .._native import Floats
from ..run import Run
from ..scenario import Scenario
from ..user_functions.programs import ProgramError
from .comparison import Comparison
from .finding import Finding, Judgement
from .log.reading import read_log
from .planted import planted_and_seen
from .samples import Samples
from .truth.three_r import CONVENTIONS, ThreeR

_VISIBLE = 1e-9  # m/s of J qd, N m of a torque
D = np.array([1.0, -1.0, -1.0])
_UNEQUAL = {"length2": 0.8, "length3": 0.55, "mass2": 2.592, "mass3": 3.052}


class Trial(NamedTuple):
    """States at which somebody compared a formula with something: (S, n)."""

    name: str
    q: Floats
    qd: Floats
    convention: str = CONVENTIONS[0]
    quantities: dict[str, float] | None = None
    """Of the arm that was tested, where it is another one."""


@cache
def _free_fall() -> Run:
    return Scenario("{format: 1, time: {stop: 10, log_every: 0.01}}").run()


def tests_of(given: Iterable[Any], joints: int) -> list[Trial]:
    """The tests that the user names: scenarios, their paths, logs, or arrays of poses (S, n)."""
    found = []
    for number, one in enumerate(given, start=1):
        if isinstance(one, (str, os.PathLike)) and not os.fspath(one).endswith((".yaml", ".yml")):
            states = read_log(one).states(joints)
            found.append(Trial(os.fspath(one), states["q"], states["qd"]))
        elif isinstance(one, (str, os.PathLike, Scenario)):
            scenario = one if isinstance(one, Scenario) else Scenario.load(one)
            run, arm = scenario.run(), ThreeR(scenario)
            found.append(Trial(str(scenario.name), run["q"], run["qd"], arm.convention, arm.values_of_quantities))
        else:
            poses = np.atleast_2d(np.asarray(one, float))
            found.append(Trial(f"poses {number}", poses, np.ones_like(poses)))
    return found


def seen_by_tests(verdict: Judgement, case: Comparison, given: Iterable[Any]) -> None:
    """Fill in for each finding whether each test sees it, and for each test what it excites."""
    tests = tests_of(given, case.truth.joints)
    if isinstance(case.truth, ThreeR):
        own = case.kind.lecture_test(_free_fall)
        tests = [*([Trial(*own)] if own else []), *tests]
    for test in tests:
        if case.convention != test.convention and isinstance(case.truth, ThreeR):
            test = test._replace(q=test.q * D, qd=test.qd * D, convention=case.convention)
        verdict.coverage[test.name] = _excited(case, test)
        for finding in verdict.findings:
            if finding.entry is None:
                continue
            finding.seen_by[test.name] = _sees(case, test, finding)
            if not finding.seen_by[test.name]:
                finding.unseen_because[test.name] = _reason(case, test, finding)


def _samples(case: Comparison, test: Trial) -> Samples:
    own = {**case.truth.values_of_quantities, **(test.quantities or {})}
    zero = np.zeros_like(test.q)
    return Samples({"q": test.q, "qd": test.qd, "qdd": zero, "tau": zero}, [{name: own[name] for name in case.known}])


def _error(case: Comparison, test: Trial, finding: Finding) -> Floats:
    """What the test sees of a wrong entry, in each state; a number that is not the arm's stands as it is written."""
    samples = _samples(case, test)
    written = {}
    for name, constant in case.formula.constants.items():
        if (
            finding.old is not None
            and name in case.parameters
            and constant.name in finding.cause.split(" is ")[0].split()
        ):
            written[case.parameters[name]] = constant.value
    here = Samples(samples.states, [{**samples.arms[0], **written}])
    place = tuple(one - 1 for one in finding.entry or [])
    difference = case.values(here) - case.due(samples)
    column = int(np.ravel_multi_index(place, case.shape))
    return difference.reshape(len(difference), -1)[:, column] * case.kind.weights(test.qd, place[-1])


def _sees(case: Comparison, test: Trial, finding: Finding) -> bool:
    try:
        return bool(~(np.abs(_error(case, test, finding)).max() <= _VISIBLE))
    except ProgramError:
        return False


def _reason(case: Comparison, test: Trial, finding: Finding) -> str:
    """Why a test does not see a finding: the first of its special values without which it would."""
    column = (finding.entry or [1])[-1] - 1
    tries: list[tuple[str, Trial]] = []
    rates = range(test.qd.shape[1]) if "qd" in case.kind.inputs else [column] if case.kind.is_derivative else []
    for joint in rates:
        if np.abs(test.qd[:, joint]).max() <= _VISIBLE:
            moving = test.qd.copy()
            moving[:, joint] = 1.0
            tries.append((f"there qd{joint + 1} = 0", test._replace(qd=moving)))
    for joint in range(test.q.shape[1]):
        if np.abs(test.q[:, joint]).max() <= _VISIBLE:
            moved = test.q.copy()
            moved[:, joint] = 0.7
            tries.append((f"there q{joint + 1} = 0", test._replace(q=moved)))
            tries.append(
                (f"there q{joint + 1} = 0 and qd{joint + 1} = 0", test._replace(q=moved, qd=np.ones_like(test.qd)))
            )
    if test.q.shape[1] == 3 and np.abs(test.q[:, 2] + 2 * test.q[:, 1]).max() <= 1e-9:
        tries.append(("there q3 = -2 q2", test._replace(q=test.q + np.array([0, 0, 0.3]))))
    if isinstance(case.truth, ThreeR):
        tries.append(("there the links are equal", test._replace(quantities=_UNEQUAL)))
    return next((words for words, other in tries if _sees(case, other, finding)), "")


def _excited(case: Comparison, test: Trial) -> dict[str, Any]:
    """The joints that move or are turned, the entries that show, and how many planted mistakes are seen."""
    due = case.due(_samples(case, test))
    entries = []
    for place in np.ndindex(due.shape[1:]):
        if np.abs(due[(slice(None), *place)] * case.kind.weights(test.qd, place[-1])).max() > _VISIBLE:
            entries.append([one + 1 for one in place])
    moved = test.qd if case.kind.is_derivative else test.q
    joints = [int(joint) + 1 for joint in np.flatnonzero(np.abs(moved).max(axis=0) > _VISIBLE)]
    found: dict[str, Any] = {"joints": joints, "entries": entries}
    if isinstance(case.truth, ThreeR):
        sign = D if test.convention == CONVENTIONS[1] else np.ones(3)
        numbers = {**case.truth.values_of_quantities, **(test.quantities or {})}
        planted, seen = planted_and_seen(case.kind, test.q * sign, test.qd * sign, numbers)
        found |= {"planted": planted, "seen": seen} if planted else {}
    return found
