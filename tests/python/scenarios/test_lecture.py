"""The scenarios that ship, the lecture's and others: their own checks, and what must hold in each of them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import arm3r_cpp as arm3r
import numpy as np
import pytest
from conftest import scenario_files
from force_scenarios import D, mirrored
from numpy.typing import NDArray

SCENARIOS = Path(__file__).parents[3] / "scenarios"
NAMES = sorted(str(path.relative_to(SCENARIOS)) for path in scenario_files())
LECTURE = [name for name in NAMES if name.startswith("lecture/")]
BESIDE_THE_PLATE = {"contact/plate_edge.yaml"}  # the tip is deeper than the face, and nothing touches it
Array = NDArray[np.float64]
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
    bound = 1e-12 * (1 + scenario.arm.reach * abs(run["qd"]).max())
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
    if "depth" in run.units and name not in BESIDE_THE_PLATE:
        assert np.array_equal(touching, run["depth"] > 0)


@pytest.mark.parametrize("name", [name for name in NAMES if not name.startswith("robots/")])
def test_the_other_convention_gives_the_same_results(name: str) -> None:
    there = mirrored(arm3r.Scenario.load(SCENARIOS / name))
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
    assert np.allclose(plain["tau"][0], recursion["tau"][0], rtol=0, atol=1e-14)
    assert np.allclose(plain["tau"], recursion["tau"], rtol=0, atol=1e-10)  # held in neutral balance, rounding drifts


def test_partial_compensation_is_the_free_fall_slowed() -> None:
    factor = np.sqrt(6 / 5)
    fall = slowed("format: 1", factor=1)
    partial = slowed(f"{{format: 1, controller: {{type: gravity_compensation, gravity: {G / 6!r}}}}}", factor=factor)
    assert np.allclose(partial["q"], fall["q"], rtol=0, atol=1e-8)
    assert np.allclose(partial["qd"] * factor, fall["qd"], rtol=0, atol=1e-7)


def test_an_arm_on_the_moon_is_slowed_more() -> None:
    factor = np.sqrt(G / G_MOON)
    fall = slowed("format: 1", factor=1)
    moon = slowed(f"{{format: 1, arm: {{gravity: [0, 0, -{G_MOON}]}}}}", factor=factor)
    assert np.allclose(moon["q"], fall["q"], rtol=0, atol=1e-8)


# ---- what the lecture's tests cannot see, and unequal links can ------------------------------------------------------

JACOBIAN = (
    "-s(q1)*(a3*c(q2+q3)+a2*c(q2))", "-c(q1)*(a3*s(q2+q3)+a2*s(q2))", "-a3*s(q2+q3)*c(q1)",
    "c(q1)*(a3*c(q2+q3)+a2*c(q2))", "-s(q1)*(a3*s(q2+q3)+a2*s(q2))", "-a3*s(q2+q3)*s(q1)",
    "0", "-(a3*c(q2+q3)+a2*c(q2))", "-a3*c(q2+q3)",
)  # fmt: skip
TORQUE = ("0", "-m2*g*(a2/2)*c(q2)-m3*g*(a2*c(q2)+(a3/2)*c(q2+q3))", "-m3*g*(a3/2)*c(q2+q3)")
SLIPS = (
    ("a2", "a3"), ("a3", "a2"), ("m2", "m3"), ("m3", "m2"), ("q2+q3", "q2"), ("q2+q3", "q2-q3"),
    ("s(", "c("), ("c(", "s("), ("q1", "0"), ("q1", "-q1"), ("/2", ""),
)  # fmt: skip
EQUAL = {"a2": 1.0, "a3": 1.0, "m2": 0.785, "m3": 0.785}
UNEQUAL = {"a2": 0.8, "a3": 0.55, "m2": 2.592, "m3": 3.051860913421635}  # of 13 and 14

Mistake = tuple[int, str]
States = list[tuple[Array, Array]]


def value(formula: str, q: Array, links: dict[str, float]) -> float:
    names = {"q1": q[0], "q2": q[1], "q3": q[2], "s": np.sin, "c": np.cos, "g": G}
    return eval(formula, names | links)


def mistakes(formulas: tuple[str, ...]) -> Iterator[Mistake]:
    """One wrong sign, zero, letter, function or angle at a time: the formula's place, and the formula with it."""
    for place, right in enumerate(formulas):
        if right != "0":
            yield from ((place, f"-({right})"), (place, "0"))
        for letters, slip in SLIPS:
            for found in re.finditer(re.escape(letters), right):
                yield place, right[: found.start()] + slip + right[found.end() :]


def seen(formulas: tuple[str, ...], mistake: Mistake, states: States, links: dict[str, float]) -> bool:
    """Whether an entry times its joint rate is off by 1e-9 in one of the states; a torque has no rate."""
    place, wrong = mistake
    return any(
        abs((value(wrong, q, links) - value(formulas[place], q, links)) * rate[place % 3]) > 1e-9 for q, rate in states
    )


def random_states() -> States:
    random = np.random.default_rng(1)
    return [(random.uniform(-3, 3, 3), random.uniform(-3, 3, 3)) for _ in range(20)]


def lecture_fall() -> States:
    run = run_of("lecture/06_jacobian_by_three_velocities.yaml")
    return list(zip(run["q"], run["qd"], strict=True))[::20]


def lecture_holds() -> States:
    return [(np.radians(pose), np.ones(3)) for pose in ((0, -30, 60), (0, -45, 90))]


def start_of_14() -> States:
    scenario = arm3r.Scenario.load(SCENARIOS / "lecture/14_unequal_fall.yaml")
    return [(np.array(scenario["initial.q"]), np.array(scenario["initial.qd"]))]


@pytest.mark.parametrize(
    ("formulas", "lecture", "counts"),
    [(JACOBIAN, lecture_fall, (73, 26, 60, 73)), (TORQUE, lecture_holds, (22, 13, 15, 22))],
    ids=["jacobian", "gravity torque"],
)
def test_how_many_planted_mistakes_are_seen(
    formulas: tuple[str, ...], lecture: Callable[[], States], counts: tuple[int, ...]
) -> None:
    """The table of docs/lecture.md. A mistake that changes nothing anywhere is none."""
    planted = [m for m in mistakes(formulas) if seen(formulas, m, random_states(), UNEQUAL)]
    tests = ((lecture(), EQUAL), (random_states(), EQUAL), (start_of_14(), UNEQUAL))
    assert (len(planted), *(sum(seen(formulas, m, *test) for m in planted) for test in tests)) == counts


@pytest.mark.parametrize("name", ["01_hold_pose_a", "03_hold_pose_b", "13_unequal_hold"])
def test_the_lectures_own_formulas_are_right(name: str) -> None:
    scenario = arm3r.Scenario.load(SCENARIOS / f"lecture/{name}.yaml")
    links = UNEQUAL if name.startswith("13") else EQUAL
    q = np.array(scenario["initial.q"])
    assert np.allclose([value(f, q, links) for f in JACOBIAN], scenario.arm.jacobian(q).ravel(), rtol=0, atol=1e-12)
    assert np.allclose([value(f, q, links) for f in TORQUE], scenario.arm.gravity_torque(q), rtol=0, atol=1e-12)


@pytest.mark.parametrize("slip", ["t1 = q1", "a3/2 as a2/2", "cos(q2+q3) as cos(q2)"])
def test_three_slips_of_the_lecture_hide_in_its_holds_and_show_in_13(slip: str) -> None:
    wrong = {
        "t1 = q1": (0, "q1"),
        "a3/2 as a2/2": (2, TORQUE[2].replace("a3/2", "a2/2")),
        "cos(q2+q3) as cos(q2)": (2, TORQUE[2].replace("q2+q3", "q2")),
    }[slip]
    assert not seen(TORQUE, wrong, lecture_holds(), EQUAL)
    assert seen(TORQUE, wrong, start_of_14(), UNEQUAL)
