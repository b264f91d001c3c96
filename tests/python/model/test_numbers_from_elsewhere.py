"""Numbers computed elsewhere, by other programs and on paper: the lecture's wall, holds, falls, spins and bounces."""

from __future__ import annotations

from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest

G = 9.80665
A, B = np.deg2rad([0, 30, -60]), np.deg2rad([0, 45, -90])  # the lecture's poses, slide
D = {"slide": np.array([1, 1, 1]), "simscape": np.array([1, -1, -1])}


@pytest.fixture(params=list(D))
def convention(request: pytest.FixtureRequest) -> str:
    return request.param


def scenario_of(convention: str, q: np.ndarray, **keys: Any) -> arm3r.Scenario:
    """The lecture's arm at rest at q (slide); keys with __ for the dots."""
    scenario = arm3r.Scenario()
    scenario["arm.convention"] = convention
    scenario["initial.q"] = (D[convention] * q).tolist()
    for key, value in keys.items():
        scenario[key.replace("__", ".")] = value
    return scenario


def end(convention: str, stop: float, column: str = "q", **keys: Any) -> np.ndarray:
    """Joint column at the end, in slide."""
    return D[convention] * scenario_of(convention, A, time__stop=stop, **keys).run()[column][-1]


HOLD = {"controller": {"type": "gravity_compensation"}}
WALL = {**HOLD, "wall": {}, "time__log_every": 1.0}


# ---- the lecture's wall, one-way ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("q", "contact", "forces"),
    [
        (A, 5.358983848622454, {6: 32.0508075689, 10: 232.0508075689}),
        (B, 11.715728752538, {12: 14.2135623731}),
    ],
    ids="AB",
)
def test_wall_meets_the_held_arm(convention: str, q: np.ndarray, contact: float, forces: dict[int, float]) -> None:
    run = scenario_of(convention, q, **WALL, time__stop=12.0).run()
    assert [event.type for event in run.events] == ["make"]
    assert run.events[0].t == pytest.approx(contact, abs=1e-9, rel=0)
    for t, force in forces.items():
        assert run["f_on_wall_x"][t] == pytest.approx(force, abs=1e-6, rel=0)
    assert np.ptp(run["q"], axis=0).max() <= 1e-9
    assert np.abs(np.diff(run["contact"])).sum() == 1


def test_turned_arm_misses_the_plate_but_not_the_plane(convention: str) -> None:
    q = np.deg2rad([20, 30, -60])
    plate = scenario_of(convention, q, **WALL, time__stop=12.0)
    assert plate.run().events == []
    plate["wall.size"] = "infinite"
    assert plate.run().events[0].t == pytest.approx(7.448092746, abs=1e-9, rel=0)


# ---- gravity compensation -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("algorithm", ["closed_form", "recursion"])
def test_full_compensation_holds(convention: str, algorithm: str) -> None:
    controller = {"type": "gravity_compensation", "algorithm": algorithm}
    assert np.abs(end(convention, 10.0, controller=controller) - A).max() <= 1e-9


FALL = {
    0.25: [0, 0.242042028476, -0.906741979672],
    0.5: [0, -0.846709769664, 0.517746303397],
    1.0: [0, -2.397111940695, -0.961986889314],
}


@pytest.mark.parametrize("t", FALL)
def test_without_torque_it_falls(convention: str, t: float) -> None:
    assert np.abs(end(convention, t) - FALL[t]).max() <= 1e-7


@pytest.mark.parametrize("t", FALL)
def test_a_sixth_of_the_compensation_slows_the_fall(convention: str, t: float) -> None:
    sixth = {"type": "gravity_compensation", "gravity": G / 6}
    tight = {"method": "dopri5", "rtol": 1e-11, "atol": 1e-13}
    slowed = end(convention, t / np.sqrt(5 / 6), controller=sixth, solver=tight)
    assert np.abs(slowed - end(convention, t, solver=tight)).max() <= 1e-8


def test_a_sixth_of_the_compensation_after_half_a_second(convention: str) -> None:
    q = end(convention, 0.5, controller={"type": "gravity_compensation", "gravity": G / 6})
    assert np.abs(q - [0, -0.600079936916, 0.176654860952]).max() <= 1e-7


def test_a_model_ten_percent_too_heavy_lifts(convention: str) -> None:
    heavy = {"type": "gravity_compensation", "model": {"link3": {"mass": 0.785 * 1.1}}}
    qdd = end(convention, 0.0, "qdd", controller=heavy)
    assert np.abs(qdd - [0, 0.4632457585, 0.4632179649]).max() <= 1e-9


def test_the_lecturers_slip_of_the_tongue_lets_the_arm_sink(convention: str) -> None:
    spoken = {"type": "gravity_compensation", "gravity": 9.8065}
    scenario = scenario_of(convention, A, controller=spoken)
    run = scenario.run()
    change = D[convention] * (run["q"][-1] - run["q"][0])
    assert np.abs(change - [0, -0.0063902112, 0.0014645058]).max() <= 1e-7
    assert run["tip_z"][0] - run["tip_z"][-1] == pytest.approx(9.804e-3, abs=1e-6, rel=0)
    assert np.abs(change + A - end(convention, 10 * np.sqrt(1 - 9.8065 / G))).max() <= 1e-7
    assert any("9.8065" in warning for warning in run.summary["warnings"])


@pytest.mark.parametrize(("limit", "holds"), [(13.40, True), (13.30, False)])
def test_torque_limit_of_joint_2(convention: str, limit: float, holds: bool) -> None:
    moved = np.abs(end(convention, 2.0, **HOLD, arm__torque_limit=["inf", limit, "inf"]) - A).max()
    assert moved <= 1e-9 if holds else moved > 1


# ---- motion without losses ------------------------------------------------------------------------------------------

SLENDER = {f"arm__link{i}": {"length": 1.0, "shape": "slender", "mass": 0.785} for i in (2, 3)}
HANGING = np.array([0, -np.pi / 2, 0])


def modes(arm: arm3r.Arm, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (rad/s) and shapes of small motions of joints 2 and 3 about q."""
    h = 1e-4
    K = np.stack([(arm.gravity_torque(q + h * e) - arm.gravity_torque(q - h * e)) / (2 * h) for e in np.eye(3)], axis=1)
    squares, shapes = np.linalg.eig(np.linalg.solve(arm.mass_matrix(q)[1:, 1:], K[1:, 1:]))
    order = np.argsort(squares)
    return np.sqrt(squares[order]), (shapes / shapes[0])[:, order]


@pytest.mark.parametrize(
    ("links", "frequencies"),
    [(SLENDER, [2.679656359, 7.187443342]), ({}, [2.679646489, 7.187213134])],
    ids=["slender", "brick"],
)
def test_frequencies_of_the_hanging_arm(convention: str, links: dict[str, Any], frequencies: list[float]) -> None:
    scenario = scenario_of(convention, HANGING, **links)
    found, shapes = modes(scenario.arm, D[convention] * HANGING)
    assert found == pytest.approx(frequencies, rel=1e-7)
    if links:
        assert found**2 == pytest.approx(G * (3 + np.array([-6, 6]) / np.sqrt(7)), rel=1e-7)
        assert shapes[1, 0] == pytest.approx(0.4305008740, rel=1e-6)


def test_period_of_the_slow_swing(convention: str) -> None:
    slow = modes(scenario_of("slide", HANGING).arm, HANGING)[1][:, 0]
    start = HANGING + 1e-3 * np.array([0, *slow])
    run = scenario_of(convention, start, time={"stop": 4.0, "log_every": 0.001}).run()
    angle = D[convention][1] * run["q2"] - HANGING[1]
    before = np.flatnonzero((angle[:-1] > 0) & (angle[1:] <= 0))
    crossings = run.t[before] + 0.001 * angle[before] / (angle[before] - angle[before + 1])
    assert np.diff(crossings) == pytest.approx([2.344781395], abs=1e-6, rel=0)


def test_spin_keeps_momentum_and_energy(convention: str) -> None:
    scenario = scenario_of(convention, A, time__stop=10.0)
    scenario["initial.qd"] = (D[convention] * [2, 0.5, -1]).tolist()
    run, arm = scenario.run(), scenario.arm
    momentum = arm.mass_matrix(run["q"])[:, 0, 0] * run["qd1"]
    energy = np.sum(arm.energy(run["q"], run["qd"]), axis=0)
    assert momentum == pytest.approx(3.140058875, rel=1e-8)
    assert energy == pytest.approx(7.103649802083, rel=1e-8)


# ---- the bounce off the lecture's wall ------------------------------------------------------------------------------

MASS, SPEED = 0.5535415113, 0.05


def bounce(convention: str, stiffness: float) -> tuple[arm3r.Run, dict[str, Any]]:
    wall = {"contact": {"law": "spring", "stiffness": stiffness}, "acts_on_arm": True}
    scenario = scenario_of(convention, A, **HOLD, wall=wall, time__stop=5.5)
    run = scenario.run()
    make, leave = run.events
    return run, {
        "duration": leave.t - make.t,
        "peak": run.summary["peak_force"],
        "velocity": scenario.arm.jacobian(leave.q) @ leave.qd,
        "qd": D[convention] * leave.qd,
        "work": run["work_wall"][-1],
    }


@pytest.mark.parametrize(
    ("stiffness", "duration", "peak", "velocity"),
    [
        (1e4, 23.3581243e-3, 3.71968183, [-0.100099048, 0, -0.079803695]),
        (1e6, 2.33720168e-3, 37.1998482, [-0.100009940, 0, -0.079926513]),
    ],
    ids=["1e4", "1e6"],
)
def test_bounce(convention: str, stiffness: float, duration: float, peak: float, velocity: list[float]) -> None:
    run, found = bounce(convention, stiffness)
    assert found["duration"] == pytest.approx(duration, rel=1e-6)
    assert found["peak"] == pytest.approx(peak, rel=1e-6)
    assert found["velocity"] == pytest.approx(velocity, rel=1e-6, abs=1e-7)
    assert run.summary["energy_residual_max"] < 1e-9


def test_bounce_of_a_stiff_wall_is_that_of_the_closed_form(convention: str) -> None:
    _, found = bounce(convention, 1e6)
    assert found["duration"] == pytest.approx(np.pi * np.sqrt(MASS / 1e6), rel=2e-4)
    assert found["peak"] == pytest.approx(SPEED * np.sqrt(1e6 * MASS), rel=2e-4)
    assert found["velocity"][0] == pytest.approx(-2 * SPEED, rel=2e-4)
    assert found["qd"] == pytest.approx([0, 0.0538465, -0.2], rel=5e-3, abs=1e-12)
    assert found["work"] == pytest.approx(2.76752413e-3, rel=1e-6)
    assert found["work"] == pytest.approx(2 * MASS * SPEED**2, rel=2e-4)


def test_deviation_from_the_closed_form_falls_with_the_root_of_the_stiffness(convention: str) -> None:
    deviation = [
        1 - bounce(convention, stiffness)[1]["duration"] / (np.pi * np.sqrt(MASS / stiffness))
        for stiffness in (1e4, 1e6)
    ]
    assert deviation[0] / deviation[1] == pytest.approx(10, rel=0.02)
