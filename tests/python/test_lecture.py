"""The scenarios that ship, the lecture's and others: their own checks, and what must hold in each of them."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest

SCENARIOS = Path(__file__).parents[2] / "scenarios"
NAMES = sorted(str(path.relative_to(SCENARIOS)) for path in SCENARIOS.rglob("*.yaml"))
LECTURE = [name for name in NAMES if name.startswith("lecture/")]
D = np.array([1, -1, -1])
G, G_MOON = 9.80665, 1.62

every_scenario = pytest.mark.parametrize("name", NAMES)


@cache
def run_of(name: str) -> arm3r.Run:
    return arm3r.Scenario.load(SCENARIOS / name).run()


def slowed(text: str, *, factor: float, rows: int = 201) -> arm3r.Run:
    """A run whose rows are `factor` apart from those of the free fall, in time."""
    scenario = arm3r.Scenario(text)
    scenario["time"] = {"stop": 0.01 * factor * (rows - 1), "log_every": 0.01 * factor}
    scenario["solver.rtol"] = 1e-11
    return scenario.run()


# ---- in every scenario ----------------------------------------------------------------------------------------------


@every_scenario
def test_every_statement_holds(name: str) -> None:
    run = run_of(name)
    assert run.checks
    assert [check for check in run.checks if not check["passed"]] == []


@every_scenario
def test_jacobian_agrees_with_the_transform_sensor_at_every_row(name: str) -> None:
    run, scenario = run_of(name), arm3r.Scenario.load(SCENARIOS / name)
    reach = scenario["arm.link2.length"] + scenario["arm.link3.length"]
    bound = 1e-12 * (1 + reach * abs(run["qd"]).max())
    assert abs(run["tip_jv"] - run["tip_v"]).max() <= bound


@every_scenario
def test_both_forces_sum_to_zero_at_every_row(name: str) -> None:
    run = run_of(name)
    assert not np.any(run["f_on_tip"] + run["f_on_wall"])


@every_scenario
def test_contact_flag_force_and_depth_tell_the_same_story(name: str) -> None:
    run = run_of(name)
    touching = run["contact"] == 1
    assert np.array_equal(touching, np.any(run["f_on_wall"], axis=1))
    if "depth" in run.units:
        assert np.array_equal(touching, run["depth"] > 0)


@every_scenario
def test_the_other_convention_tells_the_same_story(name: str) -> None:
    here = arm3r.Scenario.load(SCENARIOS / name)
    there = here.copy()
    there["arm.convention"] = {"simscape": "slide", "slide": "simscape"}[here["arm.convention"]]
    for key in ("initial.q", "initial.qd"):
        there[key] = D * here[key]
    there["checks"] = []
    one, other = run_of(name), there.run()
    for column in ("tip", "tip_v", "f_on_wall"):
        assert np.array_equal(one[column], other[column]), column
    for column in ("q", "qd", "tau", "tau_g"):
        assert np.array_equal(one[column], D * other[column]), column


# ---- what the lecture says, beyond single numbers -------------------------------------------------------------------


def test_the_files_are_numbered_without_gaps() -> None:
    assert [int(Path(name).name[:2]) for name in LECTURE] == list(range(1, len(LECTURE) + 1))


@pytest.mark.parametrize("pose", ["a", "b"])
def test_closed_form_and_recursion_hold_with_the_same_torque(pose: str) -> None:
    plain, recursion = (run_of(name) for name in LECTURE if f"hold_pose_{pose}" in name)
    assert np.allclose(plain["tau"], recursion["tau"], rtol=0, atol=1e-12)


def test_partial_compensation_is_the_free_fall_slowed() -> None:
    factor = np.sqrt(6 / 5)
    fall = slowed("format: 1", factor=1)
    partial = slowed(
        f"{{format: 1, controller: {{type: gravity_compensation, gravity: {G / 6!r}}}}}", factor=factor
    )
    assert np.allclose(partial["q"], fall["q"], rtol=0, atol=1e-8)
    assert np.allclose(partial["qd"] * factor, fall["qd"], rtol=0, atol=1e-7)


def test_an_arm_on_the_moon_is_slowed_more() -> None:
    factor = np.sqrt(G / G_MOON)
    fall = slowed("format: 1", factor=1)
    moon = slowed(f"{{format: 1, arm: {{gravity: [0, 0, -{G_MOON}]}}}}", factor=factor)
    assert np.allclose(moon["q"], fall["q"], rtol=0, atol=1e-8)


# ---- what the lecture's holds cannot see, and the unequal arm can ---------------------------------------------------


def length_and_mass(link: dict[str, Any]) -> tuple[float, float]:
    area = np.prod(link["section"]) if link["shape"] == "brick" else np.pi * link["radius"] ** 2
    return link["length"], link["length"] * area * link["density"]


def slide_torque(q: np.ndarray, scenario: arm3r.Scenario, *, fault: str = "") -> np.ndarray:
    """The slide's gravity torque in the lecture's code signs, with one of its misprints planted."""
    (a2, m2), (a3, m3) = (length_and_mass(scenario[f"arm.link{i}"]) for i in (2, 3))
    last = a2 / 2 if fault == "a2/2" else a3 / 2
    c2 = np.cos(q[1])
    c23 = c2 if fault == "cos q2" else np.cos(q[1] + q[2])
    t3 = -m3 * G * last * c23
    t2 = -m2 * G * a2 / 2 * c2 - m3 * G * a2 * c2 + t3
    return np.array([q[0] if fault == "t1 = q1" else 0.0, t2, t3])


@pytest.mark.parametrize("fault", ["t1 = q1", "a2/2", "cos q2"])
def test_a_misprint_of_the_slide_hides_in_the_lecture_and_shows_in_13(fault: str) -> None:
    def error(name: str, fault: str) -> float:
        scenario = arm3r.Scenario.load(SCENARIOS / "lecture" / name)
        q = np.array(scenario["initial.q"])
        return abs(slide_torque(q, scenario, fault=fault) - scenario.arm.gravity_torque(q)).max()

    assert error("01_hold_pose_a.yaml", "") < 1e-12
    assert error("13_unequal_hold.yaml", "") < 1e-12
    assert error("01_hold_pose_a.yaml", fault) < 1e-12
    assert error("03_hold_pose_b.yaml", fault) < 1e-12
    assert error("13_unequal_hold.yaml", fault) > 0.1
