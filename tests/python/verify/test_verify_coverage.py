"""Which tests would have seen a mistake, and why not: said of terms that are added to right formulas of the rates."""

from __future__ import annotations

import itertools
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arm3r_cpp import verify
from formulas.outcomes import FOLDER, arm_of

RANDOM = np.random.default_rng(11)
VECTORS = ("q", "qd", "qdd", "tau")
COLUMNS = [f"{vector}{joint}" for vector in VECTORS for joint in (1, 2, 3)]
GENERIC = dict(zip(COLUMNS, RANDOM.uniform(0.3, 1.9, len(COLUMNS)), strict=True))
ZERO = [
    [],
    ["qd1", "qd2", "qd3"],
    ["qd2", "qd3"],
    ["qd1", "qd3"],
    ["qd1", "qd2"],
    ["qd1"],
    ["q1", "q3", "qd2", "qd3"],
    ["q1", "q2", "q3"],
    ["q1", "qd2"],
    ["q3", "qd1", "qd2", "qdd1", "qdd2", "qdd3", "tau1", "tau2", "tau3"],
    ["qdd2", "qdd3", "tau3"],
]
"""What is zero throughout, test by test."""
CORIOLIS, JDOT = "unequal/coriolis_vector.py", "unequal/jacobian_dot_columns.py"
INVERSE, FORWARD = "unequal/inverse_lagrange.py", "unequal/forward_cramer.py"
ADDED = [
    (CORIOLIS, "d2*qd2 + d3*w)", "d2*qd2 + d3*w) + sin(q3)*qd1*qd2", "sin(q3)*qd1*qd2"),
    (CORIOLIS, "qd3*(2*qd2 + qd3)", "qd3*(2*qd2 + qd3) + qd2*qd3", "qd2*qd3"),
    (CORIOLIS, "+ C*s3*qd2**2", "+ C*s3*qd2**2 - qd1**2", "qd1**2"),
    (INVERSE, "np.array([t1, t2, t3])", "np.array([t1, t2, t3 + np.sin(q1)*w2*w3])", "sin(q1)*qd2*qd3"),
    (INVERSE, "np.array([t1, t2, t3])", "np.array([t1, t2 + b2, t3])", "qdd2"),
    (INVERSE, "np.array([t1, t2, t3])", "np.array([t1, t2 + s3*b2, t3])", "sin(q3)*qdd2"),
    (JDOT, "return np.array([", "return qd[1]*np.sin(q[0])*np.eye(3)[[0, 2, 2]]*[1, 0, 0] + np.array([", "qd2*sin(q1)"),
    (JDOT, "return np.array([", "return qd[2]*np.eye(3)*[0, 1, 0] + np.array([", "qd3"),
    (FORWARD, "[r1/M11,", "[r1/M11 + tau[2]*qd[0],", "tau3*qd1"),
]
"""A file, what is replaced in it by what, and the error that this makes, of a nonzero factor."""


def states(zero: list[str]) -> dict[str, float]:
    return {name: 0.0 if name in zero else value for name, value in GENERIC.items()}


def is_seen(error: str, at: dict[str, float]) -> bool:
    return bool(abs(eval(error, {"sin": np.sin}, at)) > 1e-9)


def reason(error: str, zero: list[str]) -> set[frozenset[str]]:
    """The smallest sets of columns that hide an error: each true, and each enough when it is no longer zero."""
    for count in (1, 2, 3):
        found = {
            frozenset(columns)
            for columns in itertools.combinations(zero, count)
            if is_seen(error, states([one for one in zero if one not in columns]))
        }
        if found:
            return found
    return set()


@pytest.mark.sample(1)
@pytest.mark.parametrize("added", ADDED, ids=lambda added: f"{Path(added[0]).stem} + {added[3]}")
def test_why_a_test_at_special_rates_misses_a_mistake(added: tuple[str, ...], tmp_path: Path) -> None:
    file, right, wrong, error = added
    text = (FOLDER / file).read_text()
    assert right in text
    path = tmp_path / Path(file).name
    path.write_text(text.replace(right, wrong, 1))
    logs = [tmp_path / f"{number}.csv" for number in range(len(ZERO))]
    for log, zero in zip(logs, ZERO, strict=True):
        row = ",".join(str(value) for value in states(zero).values())
        log.write_text(f"{','.join(COLUMNS)}\n{row}\n{row}\n")
    kind = "jacobian_dot" if "_dot" in file else Path(file).stem.partition("_")[0]
    verdict = verify.formula_verdict(path, kind, arm_of("unequal"), seen_by=logs)
    (finding,) = verdict.findings
    for log, zero in zip(logs, ZERO, strict=True):
        assert finding.seen_by[str(log)] == is_seen(error, states(zero)), (zero, error)
        if not finding.seen_by[str(log)]:
            said = frozenset(re.findall(r"(\w+\d) = 0", finding.unseen_because[str(log)]))
            assert said in reason(error, zero), (zero, error, finding.unseen_because[str(log)])


def test_a_fall_from_rest_shows_accelerations_without_a_torque(tmp_path: Path) -> None:
    path = tmp_path / "inverse.py"
    text = (FOLDER / INVERSE).read_text()
    path.write_text(text.replace("[t1, t2, t3]", "[t1, t2 + 0.01*b3, t3]"))
    scenario = arm_of("unequal").copy()
    scenario.update({"time.stop": 0.01, "time.log_every": 0.01})
    verdict = verify.inverse(path, scenario, seen_by=[scenario])
    (finding,) = verdict.findings
    assert finding.entry == [2] and finding.seen_by == {"unequal": True}
    assert verdict.coverage["unequal"]["entries"] == [[2], [3]]


def test_poses_are_in_the_convention_of_the_formula(tmp_path: Path) -> None:
    """cos(q2) for cos(q2) - sin(q2) + sin(0.5) is right where q2 = 0.5, not where it is -0.5."""
    slide = arm_of("unequal", "slide")
    path = tmp_path / "gravity.py"
    path.write_text(
        "from math import cos, sin\n\n\ndef gravity(q):\n    g, second = 9.80665, 2.1*0.21*cos(q[1] + q[2])\n"
        "    first = (1.3*0.37 + 2.1*0.8)*(cos(q[1]) + sin(q[1]) - sin(0.5))\n"
        "    return [0, g*(first + second), g*second]\n"
    )
    poses: Any = np.array([[0.3, 0.5, 0.9]])
    (finding,) = verify.gravity(path, slide, seen_by=[poses, -poses]).findings
    assert (finding.seen_by["poses 1"], finding.seen_by["poses 2"]) == (False, True)


def test_what_one_entry_shows_is_no_blind_spot(tmp_path: Path) -> None:
    """A mistake that spoils several entries is seen where one of them is."""
    path = tmp_path / "jacobian.py"
    text = (FOLDER / "unequal" / "jacobian_shorthand.py").read_text()
    assert "c23, s23 = cos(q[1]+q[2])" in text
    path.write_text(text.replace("c23, s23 = cos(q[1]+q[2])", "c23, s23 = cos(q[1]-q[2])"))
    verdict = verify.jacobian(path, arm_of("unequal"))
    name = "the lecture's free fall"
    seen = [one.seen_by[name] for one in verdict.findings]
    assert any(seen) and not all(seen) and f"{name} cannot see it" not in str(verdict), str(verdict)


@pytest.mark.parametrize("head", ["def gravity(q, g=10):", "g = 10\n\n\ndef gravity(q):"])
def test_a_number_that_is_not_the_arms_is_seen_where_the_entry_is(head: str, tmp_path: Path) -> None:
    path = tmp_path / "gravity.py"
    path.write_text(
        f"from math import cos\n\n{head}\n    third = -2.1*0.21*g*cos(q[1] + q[2])\n"
        "    return [0, third - (1.3*0.37 + 2.1*0.8)*g*cos(q[1]), third]\n"
    )
    findings = verify.gravity(path, arm_of("unequal"), seen_by=[[[0.1, 0.2, 0.3]]]).findings
    assert [one.entry for one in findings] == [[2], [3]]
    assert all("g is 10" in one.cause and one.new == "9.80665" and all(one.seen_by.values()) for one in findings)
