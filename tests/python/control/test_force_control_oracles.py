"""The oracles of force control against their reference numbers, by simulation and by closed form or root."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from force_control_oracles import (
    LECTURE_CONTACT,
    QA,
    SETTINGS,
    XA,
    Arm,
    Run,
    estimation,
    hunt_crossley,
    impact,
    kelvin_voigt,
    laws,
    linear,
    residual,
    run_of,
    sampled,
    simulate,
    spring,
    statics,
    varied,
    wall_of,
)

pytestmark = pytest.mark.sample(15)  # they hold the oracles, not arm3r

X = np.array([1.0, 0.0, 0.0])
M_N = 0.5535415113
SPEED = 0.05


@cache
def run(name: str, **solver: Any) -> Run:
    return run_of(SETTINGS[name], **solver)


def close(value: Any, abs: float) -> Any:
    return pytest.approx(value, abs=abs, rel=0)


# ---- the arm itself -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("q", "M", "gravity", "qdd", "tip", "masses"),
    [
        (
            QA,
            [1.5700294375, 1.7008464167, 0.4579232083, 0.2616732083],
            [0, 13.3337086009, 3.3334271502],
            [0, -8.3383680662, 1.8530942086],
            [0.9265471043, 0, -12.8376504826],
            [0.5535415113, 0.5233431458, 0.3426662953],
        ),
        (
            np.deg2rad([0, 45, -90]),
            [1.046699375, 1.3083464167, 0.2616732083, 0.2616732083],
            [0, 10.8869274837, 2.7217318709],
            [0, -7.8010935484, -2.6001694937],
            [-1.8385974812, 0, -12.8710097786],
            [0.4186755633, 0.5233496875, 0.4186755633],
        ),
    ],
    ids="AB",
)
def test_lecture_poses(q: Any, M: list[float], gravity: list[float], qdd: Any, tip: Any, masses: list[float]) -> None:
    s = Arm().at(q)
    assert s.M[[0, 1, 1, 2], [0, 1, 2, 2]] == close(M, 6e-11)
    assert s.gravity == close(gravity, 6e-11)
    released = s.acceleration(np.zeros(3), np.zeros(3))
    assert released == pytest.approx(qdd, rel=1e-9)
    assert s.J @ released == pytest.approx(tip, rel=1e-9, abs=1e-12)
    assert [s.mass_along(axis) for axis in np.eye(3)] == pytest.approx(masses, rel=1e-9)


FALL = {0.25: [0, 0.242042028476, -0.906741979672], 1.0: [0, -2.397111940695, -0.961986889314]}


def test_free_fall() -> None:
    fall = simulate(Arm(), laws.constant([0, 0, 0]), QA, 1.0)
    for t, q in FALL.items():
        assert fall.motion(t).q == close(q, 1e-9)


def test_a_sixth_of_the_gravity_torque_slows_the_fall() -> None:
    lighter = 9.81 / 6 / 9.80665
    assert lighter == close(0.1667236, 5e-8)
    assert np.sqrt(1 - lighter) == close(0.9128398, 1e-7)

    def sixth(t: float, s: Any, force: Any, z: Any) -> tuple[np.ndarray, np.ndarray]:
        return s.gravity / 6, np.zeros(0)

    slow = simulate(Arm(), sixth, QA, 1.0 / np.sqrt(5 / 6))
    assert slow.motion(0.5).q == close([0, -0.600079936916, 0.176654860952], 1e-9)
    assert slow.motion(0.25 / np.sqrt(5 / 6)).q == close(FALL[0.25], 1e-9)


def test_spin_keeps_momentum_and_energy() -> None:
    spin = simulate(Arm(), laws.constant([0, 0, 0]), QA, 2.0, qd=[2, 0.5, -1])
    for t in (0.0, 1.0, 2.0):
        s = spin.motion(t)
        assert (s.M @ s.qd)[0] == pytest.approx(3.140058875, rel=1e-9)
        assert s.energy == pytest.approx(7.103649802083, rel=1e-9)


def test_coriolis_matrix_is_the_christoffel_matrix() -> None:
    arm, q, qd, h = (
        Arm(lengths=(0.8, 1.1), coms=(0.3, 0.7)),
        np.array([0.4, 0.7, -1.3]),
        np.array([0.5, -0.7, 1.1]),
        1e-5,
    )
    slopes = np.array([(arm.at(q + h * e).M - arm.at(q - h * e).M) / (2 * h) for e in np.eye(3)])
    C = np.einsum("kij,k->ij", slopes, qd) + np.einsum("jik,k->ij", slopes, qd) - np.einsum("ijk,k->ij", slopes, qd)
    C, s, v = C / 2, arm.at(q, qd), np.array([0.2, 0.9, -0.4])
    assert s.rates == close(C @ qd, 1e-9)
    assert s.rates_transposed == close(C.T @ qd, 1e-9)
    assert s.coriolis_times(v) == close(C @ v, 1e-9)


# ---- energy balance and restitution ---------------------------------------------------------------------------------


def test_the_energy_balance_closes() -> None:
    bounced = run("energy balance", energies=True, rtol=1e-8, atol=1e-11)
    times = np.linspace(0, 2, 101)
    assert np.abs(residual(bounced, times)).max() < 1e-9
    modes = [mode for mode, _ in bounced.events]
    assert modes == ["separated", "free", "contact", "separated", "free", "contact", "separated", "free", "contact"]
    energy = [bounced.motion(t).energy for t in times]
    assert 3.8 < min(energy) < max(energy) < 4.2


def test_a_surface_forgotten_where_its_force_ends_loses_energy() -> None:
    bounced = run("energy balance, two contact modes", energies=True, method="LSODA", rtol=1e-9, atol=1e-12)
    assert residual(bounced, [0.0, 2.0])[1] == close(-1.87e-3, 5e-6)


@pytest.mark.parametrize(("zeta", "e"), [(0.1, 0.744079398), (0.3, 0.450975453), (1.0, 0.135335283), (2.5, None)])
def test_restitution_of_kelvin_voigt(zeta: float, e: float | None) -> None:
    k, m, v = 1e4, 0.7, 0.3
    closed = impact.kelvin_voigt_restitution(zeta)
    if e:
        assert closed == close(e, 1e-9)
    found = impact.impact(kelvin_voigt(k, 2 * zeta * np.sqrt(k * m)), m, v)
    assert found[0] == close(closed, 1e-8)
    assert found[1] == pytest.approx(impact.kelvin_voigt_depth(zeta, k, m, v), rel=1e-8)
    assert found[2] == pytest.approx(impact.kelvin_voigt_peak(zeta, k, m, v), rel=1e-6)


@pytest.mark.parametrize(("y", "e"), [(0.05, 0.967738579), (0.3, 0.832869792), (1, 0.593624260), (3, 0.306896798)])
@pytest.mark.parametrize("p", [1.0, 1.5, 2.2])
def test_restitution_of_hunt_crossley(y: float, e: float, p: float) -> None:
    k, m, v = 1e6, 0.7, 0.3
    assert impact.hunt_crossley_restitution(y) == close(e, 1e-9)
    found = impact.impact(hunt_crossley(k, p, y / v), m, v)
    assert found[0] == close(e, 1e-8)
    assert found[1] == pytest.approx(impact.hunt_crossley_depth(y / v, k, p, m, v), rel=1e-8)


@pytest.mark.parametrize("e", [0.05, 0.4, 0.9])
def test_a_law_chosen_for_a_restitution_and_a_depth_has_them(e: float) -> None:
    m, v, depth = 0.7, 0.3, 2e-3
    assert impact.impact(kelvin_voigt(*impact.kelvin_voigt_chosen(e, depth, m, v)), m, v)[:2] == close((e, depth), 1e-8)
    k, beta = impact.hunt_crossley_chosen(e, depth, 1.5, m, v)
    assert impact.impact(hunt_crossley(k, 1.5, beta), m, v)[:2] == close((e, depth), 1e-8)


def test_restitution_of_the_arm_on_the_lecture_wall() -> None:
    bounce = run("restitution")
    (_, make), (_, leave) = bounce.events
    before, after = (bounce.wall.rate(t, bounce.motion(t).xd) for t in (make, leave))
    assert before == close(SPEED, 1e-12)
    assert -after / before == close(0.833439, 5e-7)


# ---- joint PD, computed torque --------------------------------------------------------------------------------------


def test_rest_of_joint_pd() -> None:
    q = [0, 0.4561275554, -1.0784721080]
    gains = SETTINGS["joint PD sag"]["controller"]
    rest = statics.joint_pd_rest(gains["Kp"], gains["q_d"])
    assert rest.q == close(q, 1e-10)
    assert rest.x == close([1.7102788926, 0, -0.1424668694], 1e-10)
    assert run("joint PD sag", rtol=1e-10).motion(12.0).q == close(q, 1e-9)
    assert run("joint PD with gravity compensation", rtol=1e-10).motion(12.0).q == close(QA, 1e-10)


@pytest.mark.parametrize(("t", "left"), [(0.1, 0.7357588823), (0.2, 0.4060058497), (0.5, 0.0404276820)])
def test_error_of_computed_torque(t: float, left: float) -> None:
    assert (1 + 10 * t) * np.exp(-10 * t) == close(left, 1e-10)
    e0 = [0.3, -0.2, 0.4]
    assert QA - run("computed torque").motion(t).q == close(np.multiply(left, e0), 1e-9)

    def swing(t: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        w, size = np.array([3.0, 4.0, 5.0]), np.array([0.3, 0.2, 0.4])
        return QA + size * np.sin(w * t), size * w * np.cos(w * t), -size * w**2 * np.sin(w * t)

    tracked = simulate(Arm(), laws.computed_torque(100.0, 20.0, swing), swing(0)[0] - e0, t, qd=swing(0)[1])
    assert swing(t)[0] - tracked.motion(t).q == close(np.multiply(left, e0), 1e-9)


def test_computed_torque_under_a_constant_force() -> None:
    end, push = run("computed torque push").motion(4.0), SETTINGS["computed torque push"]["push"]
    assert end.M @ (100.0 * (QA - end.q)) == close(-end.J.T @ push, 1e-6)
    assert end.q == close(statics.computed_torque_rest(100.0, QA, push).q, 1e-9)


# ---- Cartesian stiffness --------------------------------------------------------------------------------------------


def test_stiffness_control_is_series_springs() -> None:
    pressed = run("stiffness fixed wall", rtol=1e-9)
    assert statics.series_force(500, 5000, 0.05) == close(22.7272727273, 1e-10)
    assert pressed.pressing([6.0]) == close([22.7272727273], 1e-8)
    assert pressed.motion(6.0).x == close([1.7045454545, 0, 0], 1e-10)


def test_stiffness_control_on_the_lecture_wall() -> None:
    def closed(t: float) -> float:
        return statics.moving_series_force(500, 100, 5000, SPEED, XA[0] - (2 - SPEED * t))

    pressed = run("stiffness moving wall", rtol=1e-9)
    assert closed(10.0) == close(109.609871, 5e-7)
    assert statics.series_force(500, 5000, XA[0] - 1.5) == close(105.4776398, 5e-8)
    assert closed(10.0) - 105.4776398 == close(4.132231, 1e-6)
    assert closed(12.0) == close(155.064417, 5e-7)
    assert pressed.pressing([10.0, 12.0]) == close([109.609342, 155.064046], 6e-7)
    assert np.abs(pressed.tips(np.linspace(6.2, 12, 30))[:, 2]).max() < 1e-5


@pytest.mark.parametrize(("mm", "percent", "half"), [(50.0, -10.236, 5e-4), (5.0, -0.9563, 5e-5), (0.5, -0.0950, 5e-5)])
def test_joint_stiffness(mm: float, percent: float, half: float) -> None:
    name = f"joint stiffness {mm} mm"
    series = statics.series_force(500, 5000, mm / 1000)
    q_d = SETTINGS[name]["controller"]["q_d"]
    rest = statics.joint_stiffness_rest(500.0, q_d, x_E=1.70, k=5000.0)
    force = 5000 * (rest.x[0] - 1.70)
    assert 100 * (force / series - 1) == close(percent, half)
    assert run(name, rtol=1e-8).pressing([6.0])[0] == pytest.approx(force, rel=1e-7)


# ---- impedance and admittance ---------------------------------------------------------------------------------------


def test_shaped_impedance_is_a_second_order_step() -> None:
    loop = linear.impedance_loop(2, 40, 200, k=1000, ahead=0.05)
    poles = loop.poles
    assert np.abs(poles) == close(24.494897, 5e-7)
    assert -poles.real / np.abs(poles) == close(0.408248, 5e-7)
    assert loop.settled == close(8.3333333333, 1e-10)
    assert loop.peak(0.5) == close((0.1404962946, 10.3781345700), 1e-10)
    step, times = run("shaped impedance step"), np.linspace(0, 1, 101)
    assert step.pressing(times) == close(loop.forces(times), 1e-8)
    assert np.abs(step.tips(times)[:, 1:]).max() < 1e-12


def test_the_energy_of_an_impedance_never_rises() -> None:
    step = run("impedance step")
    x_d = SETTINGS["impedance step"]["controller"]["x_d"]

    def storage(t: float) -> float:
        s = step.motion(t)
        depth = step.wall.depth(t, s.x)
        return 0.5 * s.qd @ s.M @ s.qd + 100 * (s.x - x_d) @ (s.x - x_d) + 500 * depth**2

    assert np.diff([storage(t) for t in np.linspace(0, 2, 1001)]).max() < 1e-13
    assert step.pressing([2.0]) == close([8.3333333333], 1e-5)


def test_limit_of_admittance() -> None:
    k, w = linear.admittance_limit(2, 40, 200, 50, 1)
    assert k == close(1440, 1e-6)
    assert w == close(22.3607, 5e-5)
    a4, a3, a2, a1 = 2, 40 + 100 * 2, 200 + 100 * 40 + 2500 * 2, 100 * 200 + 2500 * 40
    assert (a3 * a2 * a1 - a4 * a1**2) / (a3**2 * 2500) - 200 == close(1440, 1e-9)


@pytest.mark.parametrize(("name", "k", "amplitude"), [("below", 1396.8, 2.7e-5), ("above", 1483.2, 1.59e-4)])
def test_admittance_decays_or_grows(name: str, k: float, amplitude: float) -> None:
    swing, times = run(f"admittance {name} the limit", rtol=1e-9), np.linspace(5, 6, 101)
    loop = linear.admittance_loop(2, 40, 200, 50, 1, k=k, ahead=0.05, off=1e-4)
    forces = swing.pressing(times)
    assert forces == close(loop.forces(times), 1e-7)
    swings = np.abs(loop.forces(np.linspace(5, 6, 2001)) - loop.settled)
    assert swings.max() / k == pytest.approx(amplitude, rel=0.02)
    assert run("admittance soft wall").pressing([6.0]) == close([5.0], 1e-9)


# ---- hybrid position/force ------------------------------------------------------------------------------------------

PI = {"f_d": 20.0, "kP": 0.5, "kI": 5.0, "m_f": 1.0, "b": 70.0}
PI_LOOP = {key: PI[key] for key in ("kP", "kI", "m_f", "b")}


@pytest.mark.parametrize(
    ("name", "kI", "settled", "largest", "at", "poles"),
    [
        ("hybrid moving wall, kI 0", 0.0, 27.0, 27.501376, 0.066, [-35 - 35.7071j, -35 + 35.7071j]),
        ("hybrid moving wall", 5.0, 20.0, 26.622660, 0.048, [-27.5580 - 30.3350j, -27.5580 + 30.3350j, -14.8840]),
    ],
)
def test_hybrid_on_a_moving_wall(name: str, kI: float, settled: float, largest: float, at: float, poles: Any) -> None:
    loop = linear.hybrid_loop(**PI | {"kI": kI}, k=5000, v=SPEED, u0=0.004)
    assert loop.poles == close(np.array(poles), 1e-4)
    assert loop.settled == close(settled, 1e-9)
    forces = loop.forces(np.arange(200) / 1000)
    assert (forces.argmax() / 1000, forces.max()) == (close(at, 1e-12), close(largest, 6e-7))
    peak = loop.peak(0.5)
    assert peak == (close(at, 5e-4), close(largest, 3e-4))
    assert peak[1] > largest
    pressed, times = run(name), np.linspace(0, 1, 201)
    assert pressed.pressing(times) == close(loop.forces(times), 1e-7)
    assert np.abs(pressed.tips(times)[:, 1:]).max() < 1e-12


@pytest.mark.parametrize(
    ("name", "kI", "settled"), [("hybrid first contact, kI 0", 0.0, 27.0), ("hybrid first contact", 5.0, 20.0)]
)
def test_hybrid_from_first_contact_on(name: str, kI: float, settled: float) -> None:
    pressed = run(name)
    assert pressed.events[0][1] == close(LECTURE_CONTACT, 1e-11)
    loop = linear.hybrid_loop(**PI | {"kI": kI}, k=5000, v=SPEED, u0=0.0)
    after = np.linspace(0.001, 1, 201)
    assert pressed.pressing(LECTURE_CONTACT + after) == close(loop.forces(after), 1e-6)
    assert loop.peak(0.5)[1] > linear.hybrid_loop(**PI | {"kI": kI}, k=5000, v=SPEED, u0=0.004).peak(0.5)[1] + 0.5
    assert pressed.pressing([12.0]) == close([settled], 1e-8)
    assert pressed.motion(12.0).x == close([1.4 + settled / 5000, 0, 0], 1e-10)


def test_hybrid_with_a_biased_sensor() -> None:
    assert run("hybrid biased sensor").pressing([3.0]) == close([18.5], 1e-9)


def test_hybrid_by_the_transposed_jacobian() -> None:
    assert run("hybrid Jacobian transpose", rtol=1e-9).pressing([4.0]) == close([20.0], 1e-4)


def test_hybrid_approach_and_stability() -> None:
    free = simulate(Arm(), laws.hybrid(20.0, 0.5, 0.0, 1.0, 70.0, 400.0, 40.0, XA), QA, 0.5, memory=[0.0])
    assert free.motion(0.5).xd == close([0.5 * 20 / 70, 0, 0], 1e-9)
    for kI, stable in ((0.999 * 35, True), (1.001 * 35, False)):
        assert (linear.hybrid_loop(**PI | {"kI": kI}, k=5000, u0=0.0).poles.real.max() < 0) == stable


def unstable_share(count: int) -> float:
    """Of the poses in the plane q1 = 0, those where Raibert and Craig's position loop along x pushes the wrong way."""
    rng, slowest = np.random.default_rng(1), []
    while len(slowest) < count:
        s = Arm().at([0, *rng.uniform(-np.pi, np.pi, 2)])
        if np.linalg.cond(s.J) < 20:
            P = np.linalg.solve(s.J, np.diag([1, 0, 0]) @ s.J)
            slowest.append(np.linalg.eigvals(np.linalg.solve(s.M, P)).real.min())
    return np.mean(np.array(slowest) < -1e-9)


def test_raibert_craig_is_unstable_in_a_tenth_of_the_poses() -> None:
    assert 0.07 < unstable_share(1000) < 0.13


# ---- parallel control, adaptive reference, estimation ---------------------------------------------------------------

PARALLEL = {"f_d": 20.0, "m": 1.0, "K_D": 80.0, "K_P": 100.0, "K_F": 0.5, "K_I": 6.0}


@pytest.mark.parametrize(
    ("name", "v", "settled"),
    [("parallel fixed wall", 0.0, 20.0), ("parallel moving wall", SPEED, 20 + 100 * SPEED / 6)],
)
def test_parallel_control(name: str, v: float, settled: float) -> None:
    loop = linear.parallel_loop(**PARALLEL, k=5000, v=v, u0=0.004, ahead=0.0)
    assert loop.poles == close(np.array([-28.1468 - 21.7540j, -28.1468 + 21.7540j, -23.7064]), 1e-4)
    assert loop.settled == close(settled, 1e-9)
    pressed, times = run(name, rtol=1e-8), np.linspace(0, 1, 51)
    assert pressed.pressing(times) == close(loop.forces(times), 1e-6)
    assert pressed.pressing([12.0]) == close([settled], 1e-7)
    assert pressed.motion(12.0).x == close([1.7320508076 - 12 * v + (settled - 20) / 5000, 0.1, -0.05], 1e-7)


def test_limit_of_parallel_control() -> None:
    for K_I, stable in ((0.999 * 80 * 2600 / 5000, True), (1.001 * 80 * 2600 / 5000, False)):
        loop = linear.parallel_loop(**PARALLEL | {"K_I": K_I}, k=5000, v=0.0, u0=0.0, ahead=0.0)
        assert (loop.poles.real.max() < 0) == stable


def test_adaptive_reference() -> None:
    gains = {"M": 2.0, "B": 80.0, "K": 200.0}
    assert linear.seeking_limit(**gains, k=5000) == close(0.208, 1e-12)
    loop = linear.seeking_loop(20.0, 0.02, **gains, k=5000, v=SPEED, u0=0.004, ahead=0.1)
    assert loop.settled == close(22.5, 1e-9)
    pressed, times = run("adaptive reference moving wall", rtol=1e-9), np.linspace(0, 1, 51)
    assert pressed.pressing(times) == close(loop.forces(times), 1e-6)
    assert pressed.pressing([6.0]) == close([22.5], 1e-8)


def fitted(name: str) -> tuple[np.ndarray, float]:
    pressed, times = run(name), np.linspace(1, 3, 1001)
    return estimation.fitted_wall(pressed.tips(times)[:, 0], times, pressed.pressing(times))


def test_fitted_wall() -> None:
    (k, v, place), condition = fitted("wall stiffness estimate")
    assert (k, v, place) == (close(5000, 1e-7), close(SPEED, 1e-12), close(XA[0] - 0.004, 1e-12))
    assert condition == pytest.approx(1.6e4, rel=0.05)
    assert fitted("wall stiffness not identifiable")[1] > 1e10


@pytest.mark.parametrize(
    ("name", "believed", "f"), [("overestimated", 6000, 19.6969697), ("underestimated", 4000, 20.4545455)]
)
def test_force_of_a_wrong_stiffness(name: str, believed: float, f: float) -> None:
    assert estimation.force_of_wrong_stiffness(20, 5000, believed, 500) == close(f, 5e-8)
    assert 20 * 5000 / 5500 * (1 + 500 / believed) == close(f, 5e-8)
    assert run(f"wall stiffness {name}").pressing([2.0]) == close([f], 5e-8)


# ---- momentum observer and reaction ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["observer force step", "observer force step by a wall"])
def test_observer_after_a_step_on_a_held_arm(name: str) -> None:
    held, t = run(name), np.log(10) / 50
    assert t == close(0.0460517, 5e-8)
    s = held.motion(t)
    r = laws.reaction(s, held.state(t)[6:9], 50.0)
    assert s.q == close(QA, 1e-14)
    assert r / 0.9 == close([6.92820323, 5.19615242, -2.40192379], 1e-8)
    assert np.linalg.solve(s.J.T, r) == close([-9, 3.6, 2.7], 1e-9)


def test_the_observer_is_a_filter() -> None:
    setting = SETTINGS["observer moving wall"]
    observed = laws.observed(laws.joint_pd([400, 400, 200], [60, 60, 25], QA), 50.0)

    def with_filter(t: float, s: Any, force: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        torque, rate = observed(t, s, force, z[:3])
        return torque, np.concatenate([rate, 50 * (s.J.T @ force - z[3:])])

    pushed = simulate(Arm(), with_filter, QA, 8.0, start=5.3, memory=np.zeros(6), wall=wall_of(setting), rtol=1e-10)
    times = np.linspace(5.3, 8, 201)
    gap = [laws.reaction(pushed.motion(t), pushed.state(t)[6:9], 50.0) - pushed.state(t)[9:12] for t in times]
    assert np.abs(gap).max() < 1e-11
    assert np.abs(pushed.state(8.0)[9:12]).max() > 5


def test_sampled_observer() -> None:
    samples = sampled.observer_samples(50.0, 1e-3, 60)
    assert samples[[20, 60]] == close([0.6415140776, 0.9539302010], 1e-10)
    assert samples == close(1 - 0.95 ** np.arange(61), 1e-14)


@pytest.mark.parametrize("K_R", [0, 1, 3])
def test_a_reflex_yields(K_R: int) -> None:
    pushed = run(f"reflex K_R {K_R}")
    for t in (0.05, 0.1, 0.2):
        closed = -estimation.yielding_speed(0.01, M_N, K_R, 50.0, t)
        assert pushed.motion(t).xd[0] == pytest.approx(closed, rel=3e-3)


def test_observer_on_a_ramp() -> None:
    slope = abs((Arm().at(QA).J.T @ [-100, 0, 0])[2])
    assert slope == close(50, 1e-12)
    t = estimation.ramp_delay(slope, 0.5, 50.0)
    assert t == close(0.0239658087, 1e-10)
    assert slope * (t - (1 - np.exp(-50 * t)) / 50) == close(0.5, 1e-12)
    period, s, p = 1e-5, 0.0, 0
    r = 0.0
    while r < 0.5:
        s, p = s + period * (r - slope * p * period), p + 1
        r = -50.0 * s
    assert p * period == close(t, 2 * period)


def test_reactions() -> None:
    detected = {name: run(f"reaction {name}", rtol=1e-7) for name in ("ignore", "stop", "float", "reflex")}
    instants = [reaction.events[0][1] for reaction in detected.values()]
    assert np.ptp(instants) == 0
    peaks = {
        name: reaction.pressing(np.linspace(LECTURE_CONTACT, LECTURE_CONTACT + 1, 201)).max()
        for name, reaction in detected.items()
    }
    assert peaks["reflex"] < peaks["float"] < peaks["stop"] <= peaks["ignore"]
    assert detected["float"].mode == detected["reflex"].mode == "free"


# ---- sampled data ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("zeta", "period", "below", "above"),
    [(1, 0.05, 0.946904, 1.053570), (0.5, 0.1, 0, 0), (0.3, 0.06, 0.992919, 1.007317)],
)
def test_longest_period(zeta: float, period: float, below: float, above: float) -> None:
    Kp, Kd = 400.0, 40.0 * zeta
    assert sampled.longest_period(Kp, Kd) == pytest.approx(period, rel=1e-6)
    assert min(2 * Kd / Kp, 2 / Kd) == close(period, 1e-12)
    for factor, radius in ((0.98, below), (1.02, above)):
        if radius:
            assert sampled.spectral_radius(sampled.held_recursion(Kp, Kd, factor * period)) == close(radius, 5e-7)


@pytest.mark.parametrize("factor", [0.98, 1.02])
@pytest.mark.parametrize(("name", "longest"), [("zeta 1", 0.05), ("zeta 0.3", 0.06)])
def test_an_arm_in_samples_follows_the_recursion(name: str, longest: float, factor: float) -> None:
    setting = varied(SETTINGS[f"sampling period {name}"], period=factor * longest)
    gains = setting["controller"]
    A = sampled.held_recursion(gains["Kp"], gains["Kd"], setting["period"])
    expected = np.linalg.matrix_power(A, 60) @ [1e-7, 0]
    end = run_of(setting, rtol=1e-12, atol=1e-17).motion(60 * setting["period"])
    assert end.q - QA == pytest.approx(np.full(3, expected[0]), rel=1e-3)
    assert end.qd == pytest.approx(np.full(3, expected[1]), rel=1e-3)


def test_delay_margin() -> None:
    crossover, phase, delay = linear.delay_margin(**PI_LOOP, k=5000)
    assert crossover == close(33.594, 5e-4)
    assert np.rad2deg(phase) == close(47.79, 5e-3)
    assert delay == close(24.826e-3, 5e-7)
    assert linear.delayed_pole(**PI_LOOP, k=5000, delay=delay) == close(1j * crossover, 1e-9)


@pytest.mark.parametrize(("name", "factor"), [("below", 0.95), ("above", 1.05)])
def test_a_late_force_decays_or_grows(name: str, factor: float) -> None:
    delay = factor * linear.delay_margin(**PI_LOOP, k=5000)[2]
    assert SETTINGS[f"force delay {name} the margin"]["delay"] == close(delay, 1e-12)
    late = run(f"force delay {name} the margin", rtol=1e-9)
    pole = linear.delayed_pole(**PI_LOOP, k=5000, delay=delay)
    assert (pole.real > 0) == (factor > 1)
    period = 2 * np.pi / pole.imag
    first = np.linspace(1.0, 1.0 + period, 60)
    early, later = (late.pressing(times) - 20 for times in (first, first + 5 * period))
    assert later == close(early * np.exp(5 * period * pole.real), 0.01 * np.abs(early).max())


def test_slowest_filter() -> None:
    rate = linear.filter_limit(**PI_LOOP, k=5000)
    assert rate == close(21.434, 5e-4)
    assert rate / (2 * np.pi) == close(3.411, 5e-4)
    slow = {"filter_rate": 0.8 * rate}
    setting = varied(SETTINGS["force delay below the margin"], controller=slow, memory=[0.0, 0.0], stop=0.6)
    del setting["delay"]
    loop = linear.filtered_hybrid_loop(**PI, k=5000, rate=0.8 * rate, u0=0.004 + 1e-6)
    times = np.linspace(0, 0.6, 61)
    assert run_of(setting).pressing(times) == close(loop.forces(times), 1e-8)
    assert loop.poles.real.max() > 0


def test_passivity_controller() -> None:
    wall = {"k": 5000.0, "m": 0.5, "period": 1e-3, "gap": 1e-3, "speed": 0.2, "ticks": 60}
    bare, controlled = (sampled.passivity_run(**wall, controlled=on)[-1] for on in (False, True))
    assert -bare[1] == close(0.2165860765, 1e-10)
    assert -controlled[1] == close(0.2, 1e-12)
    assert 0.5 * 0.5 * (bare[1] ** 2 - 0.2**2) == close(-bare[2], 1e-15)


# ---- instability, energy tank, stiff contact, invariance ------------------------------------------------------------


def test_kinematic_instability() -> None:
    setting = SETTINGS["instability raibert_craig"]
    pose = np.deg2rad([0, -75, 45])
    s = Arm().at(pose)
    P = np.linalg.solve(s.J, np.diag([1, 0, 0]) @ s.J)
    assert np.linalg.eigvals(np.linalg.solve(s.M, P)).real.min() == close(-0.4323820891, 1e-10)
    assert np.linalg.cond(s.J) == close(6.1, 0.05)
    x = s.x[0]
    off = {
        name: [run(f"instability {name}", atol=1e-16).motion(t).x[0] - x for t in (0, 0.5, 1)]
        for name in ("raibert_craig", "projected", "dynamic")
    }
    assert setting["q"] == close(pose, 1e-5)
    assert [offsets[0] for offsets in off.values()] == close([1e-6] * 3, 1e-12)
    growth = (10 * 0.4323820891 + np.sqrt((10 * 0.4323820891) ** 2 + 100 * 0.4323820891)) / 2
    assert np.log(off["raibert_craig"][2] / off["raibert_craig"][1]) / 0.5 == pytest.approx(growth, rel=0.1)
    assert off["raibert_craig"][2] > 50e-6
    assert abs(off["projected"][2]) < 0.1e-6
    assert off["dynamic"][2] == close(1e-6 * 6 * np.exp(-5), 1e-12)


def test_energy_tank() -> None:
    x_d, times = SETTINGS["variable stiffness tank"]["controller"]["x_d"], np.linspace(0, 2, 401)

    def storage(name: str) -> tuple[np.ndarray, np.ndarray]:
        swing = run(name)
        motions = [swing.motion(t) for t in times]
        energy = [0.5 * s.qd @ s.M @ s.qd + 100 * (s.x - x_d) @ (s.x - x_d) for s in motions]
        return np.array(energy), np.array([swing.state(t)[6] for t in times])

    bare, _ = storage("variable stiffness no tank")
    assert bare[-1] > 1000 * bare[0]
    energy, tank = storage("variable stiffness tank")
    assert (energy + tank).max() - (energy + tank)[0] < 1e-11
    assert tank.min() > 0


@pytest.mark.parametrize(
    ("law", "method", "steps"),
    [
        (spring(1e4), "RK45", 78),
        (spring(1e4), "DOP853", 39),
        (spring(1e4), "LSODA", 144),
        (spring(1e6), "RK45", 415),
        (kelvin_voigt(1e7, 2 * np.sqrt(1e7 * M_N)), "Radau", 107),
    ],
)
def test_steps_of_stiff_contact(law: Any, method: str, steps: int) -> None:
    setting = SETTINGS["stiff damping"]
    gains = {key: value for key, value in setting["controller"].items() if key != "type"}
    wall = wall_of(setting)
    wall = type(wall)(law, wall.point, wall.normal, wall.advance, wall.speed)
    control = laws.cartesian_stiffness(**gains)
    counted = simulate(
        Arm(), control, QA, setting["stop"], start=setting["start"], wall=wall, method=method, rtol=1e-6, atol=1e-9
    )
    assert steps / 2 < counted.steps < 2 * steps


def test_turned_about_the_vertical() -> None:
    turn = np.deg2rad(37)
    R = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    setting = varied(SETTINGS["observer moving wall"], start=LECTURE_CONTACT - 0.1, stop=6.0)
    turned = varied(
        setting,
        q=QA + turn * X,
        wall={"point": R @ setting["wall"]["point"], "normal": R @ setting["wall"]["normal"]},
        controller={"q_d": QA + turn * X},
    )
    straight, aside, times = run_of(setting), run_of(turned), np.linspace(5.3, 6, 40)
    assert [aside.motion(t).q for t in times] == close(
        np.array([straight.motion(t).q + turn * X for t in times]), 1e-12
    )
    assert aside.pressing(times) == close(straight.pressing(times), 1e-9)


def test_conventions_move_the_tip_alike() -> None:
    D = np.array([1, -1, -1])
    setting = varied(SETTINGS["observer moving wall"], start=LECTURE_CONTACT - 0.1, stop=6.0)
    lowering = varied(setting, arm={"raises": -1}, q=D * QA, controller={"q_d": D * QA})
    lowering["arm"] = {"raises": -1}
    slide, simscape, times = run_of(setting), run_of(lowering), np.linspace(5.3, 6, 40)
    assert simscape.tips(times) == close(slide.tips(times), 1e-12)
    assert simscape.motion(6.0).gravity == close(D * slide.motion(6.0).gravity, 1e-10)


# ---- laws that no scenario covers -----------------------------------------------------------------------------------


def random_states(count: int) -> list[Any]:
    rng = np.random.default_rng(7)
    return [
        Arm().at([rng.uniform(-3, 3), rng.uniform(-1, 1), -rng.uniform(0.5, 2.5)], rng.uniform(-2, 2, 3))
        for _ in range(count)
    ]


def test_contact_stiffness_against_inertia() -> None:
    s = Arm().at(QA)
    normal, full = (
        np.linalg.eigvals(np.linalg.solve(s.M, s.J.T @ K @ s.J)).real.max() for K in (np.outer(X, X), np.eye(3))
    )
    assert normal == close(1 / M_N, 1e-8)
    assert (normal, full) == (close(1.81, 5e-3), close(3.91, 5e-3))
    assert s.mobility[2, 0] / s.mobility[0, 0] == close(0.80, 5e-3)


def test_impedance_closed_loop() -> None:
    place, rate, acceleration, force = np.array([[1.2, 0.3, 0.4], [0.3, -0.5, 0.2], [1.5, 0.7, -2], [-10, 4, 3]])
    for s in random_states(20):
        control = laws.natural_impedance(40.0, 200.0, lambda t: (place, rate, acceleration))
        qdd = s.acceleration(control(0.0, s, force, np.zeros(0))[0], force)
        e, ed, edd = s.x - place, s.xd - rate, s.J @ qdd + s.bias - acceleration
        inertia, joints = np.linalg.inv(s.mobility), np.linalg.solve(s.J, ed)
        mu_ed = np.linalg.solve(s.J.T, s.coriolis_times(joints)) - inertia @ s.J_dot @ joints
        assert inertia @ edd + mu_ed + 40 * ed + 200 * e == pytest.approx(force, abs=1e-9, rel=1e-9)


def test_the_storage_of_an_impedance_changes_by_damping_and_force() -> None:
    def circle(t: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        w, turn = 3.0, np.array([0.1 * np.cos(3 * t), 0.1 * np.sin(3 * t), 0.05 * np.sin(6 * t)])
        rate = w * np.array([-0.1 * np.sin(3 * t), 0.1 * np.cos(3 * t), 0.1 * np.cos(6 * t)])
        return np.array([1.5, 0, 0]) + turn, rate, -(w**2) * turn * [1, 1, 4]

    push = np.array([-1.0, 0.4, 0.3])
    moved = simulate(Arm(), laws.natural_impedance(40.0, 200.0, circle), QA, 0.5, push=push)

    def terms(t: float) -> tuple[float, float]:
        s, (place, rate, _) = moved.motion(t), circle(t)
        e, ed = s.x - place, s.xd - rate
        return 0.5 * ed @ np.linalg.solve(s.mobility, ed) + 100 * e @ e, ed @ push - 40 * ed @ ed

    knots, weights = np.polynomial.legendre.leggauss(40)
    gained = sum(0.25 * w * terms(0.25 + 0.25 * knot)[1] for knot, w in zip(knots, weights, strict=True))
    assert terms(0.5)[0] - terms(0.0)[0] == close(gained, 1e-9)
    assert abs(gained) > 0.1


def test_operational_space_control_is_inverse_dynamics() -> None:
    a, force, wanted = np.array([[1.0, -2.0, 0.5], [-10.0, 4.0, 3.0], [20.0, 0.0, 0.0]])
    for s in random_states(20):
        exact = laws.inverse_dynamics(s, a, force)
        assert laws.operational_space(s, a, force, np.zeros(3)) == pytest.approx(exact, rel=1e-10, abs=1e-10)
        qdd = s.acceleration(laws.operational_space(s, a, np.zeros(3), wanted), force)
        assert s.J @ qdd + s.bias == pytest.approx(a + s.mobility @ (wanted + force), rel=1e-9, abs=1e-9)


def test_admittance_with_feedforward_is_the_impedance() -> None:
    setting = SETTINGS["shaped impedance step"]
    gains = {"M": 2.0, "B": 40.0, "K": 200.0, "x_d": setting["controller"]["x_d"], "w": 50.0, "zeta": 1.0}
    control = laws.admittance(**gains, forward=True)
    through = simulate(Arm(), control, QA, 0.5, wall=wall_of(setting), memory=[*XA, 0, 0, 0])
    times = np.linspace(0, 0.5, 26)
    assert through.pressing(times) == close(run("shaped impedance step").pressing(times), 1e-7)


def test_noise_of_encoder_and_filter() -> None:
    for alpha in (0.05, 0.3, 1.0):
        assert sampled.filtered_noise(alpha) ** 2 == pytest.approx(alpha / (2 - alpha), rel=1e-9)
    step, period = 2 * np.pi / 4096, 1e-3
    ramp = (np.sqrt(2) / 7) * np.arange(200_000) * step
    error = np.diff(step * np.round(ramp / step)) / period - np.sqrt(2) / 7 * step / period
    assert np.abs(error).max() <= step / period
    q = np.random.default_rng(3).uniform(0, 1, 200_000) * 100 * step
    independent = np.diff(step * np.round(q / step) - q) / period
    assert independent.std() == pytest.approx(step / (period * np.sqrt(6)), rel=0.01)
