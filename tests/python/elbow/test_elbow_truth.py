"""The truth that elbow arms are compared with, itself compared with Pinocchio and with Lagrange's equations.

Nothing here calls the library's arm. Random arms; a failure prints the seed and the keys, ARM3R_SEED sets the seed.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from elbow_arms import (
    CONVENTIONS,
    inner_angles,
    joint_angles,
    moved,
    random_arm,
    random_states,
    random_turn,
    signs_and_zeros,
    told_in,
)
from elbow_truth import Pinocchio, Truth, apply, transpose
from random_scenarios import Keys, sample_seed, yaml_of

SEED = sample_seed()
STATES = 3
LIMITS = {
    "tip": 1e-14, "Jacobian": 1e-14, "rate of the Jacobian": 1e-14, "M": 1e-14, "C qd": 1e-13, "gravity": 1e-13,
    "kinetic energy": 1e-14, "potential energy": 1e-13, "acceleration": 1e-13,
}  # fmt: skip
"""Ten to a hundred times the rounding of sums of seven bodies; Pinocchio turns rotors by angles of hundreds of rad."""


def drawn_arms(numbers: range) -> Iterator[tuple[int, Keys, dict[str, np.ndarray]]]:
    """Number, arm and states."""
    for number in numbers:
        rng = np.random.default_rng([SEED, number])
        yield number, random_arm(rng), random_states(rng, STATES)


def gaps(arm: Keys, states: dict[str, np.ndarray]) -> dict[str, float]:
    """How far the truth is from Pinocchio, relative to the size of each quantity; accelerations per condition.

    The terms of C qd have the size of M times squared rates, and cancel: what is left of them may be small.
    """
    truth, peer = Truth(arm), Pinocchio(arm)
    worst = dict.fromkeys(LIMITS, 0.0)
    for q, qd, tau, _ in zip(*states.values(), strict=True):
        M, (tip, J, rate) = peer.mass_matrix(q), peer.tip(q, qd)
        kinetic, potential = truth.energy(q, qd)
        pairs = {
            "tip": (truth.tip_position(q), tip, 1.0),
            "Jacobian": (truth.geometric_jacobian(q), J, 1.0),
            "rate of the Jacobian": (truth.jacobian_dot(q, qd), rate, 10.0),
            "M": (truth.mass_matrix(q), M, abs(M).max()),
            "C qd": (truth.velocity_product(q, qd), peer.velocity_product(q, qd), abs(M).max() * (qd @ qd)),
            "gravity": (truth.gravity_torque(q), peer.gravity_torque(q), 10.0),
            "kinetic energy": (kinetic, peer.energy(q, qd)[0], kinetic),
            "potential energy": (potential, peer.energy(q, qd)[1], 10.0),
        }
        qdd = peer.forward_dynamics(q, qd, tau - truth.friction_torque(qd))
        pairs["acceleration"] = truth.forward_dynamics(q, qd, tau, 0 * q), qdd, abs(qdd).max() * np.linalg.cond(M)
        for name, (ours, theirs, size) in pairs.items():
            worst[name] = max(worst[name], float(abs(ours - theirs).max() / size))
    return worst


def check_peer(numbers: range) -> None:
    worst = dict.fromkeys(LIMITS, 0.0)
    for number, arm, states in drawn_arms(numbers):
        found = gaps(arm, states)
        wrong = {name: gap for name, gap in found.items() if not gap <= LIMITS[name]}
        assert not wrong, f"seed {SEED}, arm {number}: {wrong}\n{yaml_of({'arm': arm})}"
        worst = {name: max(worst[name], found[name]) for name in worst}
    print(f"seed {SEED}, {len(numbers)} arms, worst: " + ", ".join(f"{name} {gap:.1e}" for name, gap in worst.items()))


def test_the_truth_is_pinocchios() -> None:
    check_peer(range(30))


@pytest.mark.gate
@pytest.mark.random
def test_the_truth_is_pinocchios_for_many_arms() -> None:
    check_peer(range(1000, 2000))


# ---- Lagrange's equations --------------------------------------------------------------------------------------------


def exact_energies(arm: Keys, q: Any, qd: Any) -> tuple[Any, Any]:
    """Kinetic and potential energy in 40 digits from positions alone; rates are derivatives along q + qd t.

    A body's energy of turning is half the trace of R' P R'^T, with P = tr(I)/2 - I: no angular velocity is needed. That
    of a rotor comes from how far a vector of its frame across the axis turns about the axis.
    """
    signs, zeros = ([mp.mpf(float(part)) for part in parts] for parts in signs_and_zeros(arm))
    gravity = mp.matrix([mp.mpf(part) for part in arm.get("gravity", [0, 0, -9.80665])])
    base = arm.get("base", {})
    roll, pitch, yaw = (mp.mpf(part) for part in base.get("rotation", [0, 0, 0]))

    def about(axis: int, angle: Any) -> Any:
        R, (i, j) = mp.eye(3), [k % 3 for k in (axis + 1, axis + 2)]
        R[i, i] = R[j, j] = mp.cos(angle)
        R[j, i] = mp.sin(angle)
        R[i, j] = -R[j, i]
        return R

    def column(values: Any) -> Any:
        return mp.matrix([mp.mpf(float(value)) for value in values])

    lift = mp.matrix([[1, 0, 0], [0, 0, -1], [0, 1, 0]])  # x stays, z becomes the axis that raises
    over = mp.matrix([[1, 0, 0], [0, -1, 0], [0, 0, -1]])
    world = about(2, yaw) * about(1, pitch) * about(0, roll)
    place = column(base.get("position", [0, 0, 0]))
    upper = arm["link2"]
    elbow = column([upper["length"], 0, upper.get("offset", 0)])

    def frames(q: Any) -> list[tuple[Any, Any]]:
        theta = [s * angle + o for s, angle, o in zip(signs, q, zeros, strict=True)]
        first = world * about(2, theta[0])
        raised, further = first * lift * about(2, theta[1]), first * lift * about(2, theta[1] + theta[2])
        second, third = (R if s > 0 else R * over for R, s in ((raised, signs[1]), (further, signs[2])))
        shoulder = place + first * column([arm.get("shoulder_offset", 0), 0, 0])
        return [(world, place), (first, place), (second, shoulder), (third, shoulder + second * elbow)]

    bodies = [(frame, arm.get(f"link{frame}", {})) for frame in (1, 2, 3)]
    bodies.append((3, {"mass": arm.get("payload", {}).get("mass", 0), "com": arm["link3"]["tip"]}))
    frames_now, step = frames(q), mp.mpf(10) ** -15
    after, before = (frames([a + way * step * b for a, b in zip(q, qd, strict=True)]) for way in (1, -1))

    def rate(later: Any, earlier: Any) -> Any:
        return (later - earlier) / (2 * step)

    kinetic = sum(mp.mpf(a) * v**2 for a, v in zip(arm["armature"], qd, strict=True)) / 2
    potential = mp.mpf(0)
    for frame, body in bodies:
        mass, com = mp.mpf(body.get("mass", 0)), column(body.get("com", [0, 0, 0]))
        xx, yy, zz, xy, xz, yz = (mp.mpf(part) for part in body.get("inertia", [0] * 6))
        P = mp.eye(3) * (xx + yy + zz) / 2 - mp.matrix([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        v = rate(*(R * com + at for R, at in (after[frame], before[frame])))
        turning = rate(after[frame][0], before[frame][0])
        product = turning * P * turning.T
        kinetic += (mass * (v.T * v)[0] + product[0, 0] + product[1, 1] + product[2, 2]) / 2
        R, at = frames_now[frame]
        potential -= mass * ((R * com + at).T * gravity)[0]
    for joint in (1, 2, 3):
        if not (rotor := arm.get(f"rotor{joint}")):
            continue
        R, carrier = frames_now[joint - 1][0], joint - 1
        own = [[0, 0, signs[0]], [0, -signs[1], 0], [0, 0, signs[1] * signs[2]]][carrier]
        axis = column(rotor.get("axis", own))
        axis /= mp.norm(axis)
        spin = R.T * rate(after[carrier][0], before[carrier][0])  # the matrix of the angular velocity, own axes
        turning = column([0, 0, 0])
        turning[0], turning[1], turning[2] = spin[2, 1], spin[0, 2], spin[1, 0]
        speed = mp.mpf(rotor["ratio"]) * qd[carrier] + (axis.T * turning)[0]
        seat = joint if joint > 1 else 0
        v = rate(after[seat][1], before[seat][1])
        mass = mp.mpf(rotor.get("mass", 0))
        kinetic += (mp.mpf(rotor["inertia"]) * speed**2 + mass * (v.T * v)[0]) / 2
        potential -= mass * (frames_now[seat][1].T * gravity)[0]
    return kinetic, potential


def exact_torques(arm: Keys, q: np.ndarray, qd: np.ndarray) -> dict[str, np.ndarray]:
    """M, C qd and the gravity torque from the energies: d/dt dT/dqd - dT/dq + dU/dq."""
    q, qd = [mp.mpf(float(x)) for x in q], [mp.mpf(float(x)) for x in qd]
    unit, step, zero = [[mp.mpf(i == j) for j in range(3)] for i in range(3)], mp.mpf(10) ** -10, [mp.mpf(0)] * 3

    def beside(i: int, way: int) -> list[Any]:
        return [x + way * step * e for x, e in zip(q, unit[i], strict=True)]

    def mass_matrix(q: Any) -> Any:
        alone = [exact_energies(arm, q, e)[0] for e in unit]
        M = mp.matrix(3, 3)
        for i in range(3):
            for j in range(3):
                both = [a + b for a, b in zip(unit[i], unit[j], strict=True)]
                M[i, j] = 2 * alone[i] if i == j else exact_energies(arm, q, both)[0] - alone[i] - alone[j]
        return M

    slopes = [(mass_matrix(beside(i, 1)) - mass_matrix(beside(i, -1))) / (2 * step) for i in range(3)]
    v = mp.matrix(qd)
    moving = sum((slope * rate for slope, rate in zip(slopes, qd, strict=True)), mp.zeros(3)) * v
    C_qd = [moving[i] - (v.T * slopes[i] * v)[0] / 2 for i in range(3)]
    gravity = [
        (exact_energies(arm, beside(i, 1), zero)[1] - exact_energies(arm, beside(i, -1), zero)[1]) / (2 * step)
        for i in range(3)
    ]
    M = mass_matrix(q)
    return {
        "M": np.array([[float(M[i, j]) for j in range(3)] for i in range(3)]),
        "C qd": np.array(C_qd, float),
        "gravity": np.array(gravity, float),
    }


@pytest.mark.parametrize("number", range(4))
def test_the_truth_obeys_lagranges_equations(number: int) -> None:
    """In 40 digits: differences of 1e-10 rad are exact to 1e-19, so what is left is the rounding of the truth."""
    rng = np.random.default_rng([SEED, number, 1])
    arm, states = random_arm(rng), random_states(rng, 1)
    q, qd = states["q"][0], states["qd"][0]
    truth = Truth(arm)
    with mp.workdps(40):
        due = exact_torques(arm, q, qd)
        energies = [float(part) for part in exact_energies(arm, [mp.mpf(x) for x in q], [mp.mpf(x) for x in qd])]
    found = {"M": truth.mass_matrix(q), "C qd": truth.velocity_product(q, qd), "gravity": truth.gravity_torque(q)}
    for name, value in found.items():
        scale = max(abs(due[name]).max(), 1e-3)
        assert abs(value - due[name]).max() <= 1e-13 * scale, f"seed {SEED}: {name}\n{yaml_of({'arm': arm})}"
    assert np.allclose(truth.energy(q, qd), energies, rtol=1e-13, atol=1e-13)


# ---- the same arm ----------------------------------------------------------------------------------------------------


def same_physics(arm: Keys, other: Keys, states: dict[str, np.ndarray], R: np.ndarray, by: np.ndarray) -> None:
    """Asserts that the other arm, turned by R and moved, does the same at the same inner angles."""
    q, qd = states["q"], states["qd"]
    signs, others = signs_and_zeros(arm)[0], signs_and_zeros(other)[0]
    Q, V = joint_angles(other, inner_angles(arm, q)), signs * others * qd
    here, there = Truth(arm), Truth(other)
    assert np.allclose(here.tip_position(q) @ R.T + by, there.tip_position(Q), rtol=0, atol=1e-13)
    assert np.allclose(apply(here.jacobian(q), qd) @ R.T, apply(there.jacobian(Q), V), rtol=0, atol=1e-12)
    assert np.allclose(here.energy(q, qd)[0], there.energy(Q, V)[0], rtol=1e-12)
    turned = signs * others
    for name in ("gravity_torque", "velocity_product"):
        ours, theirs = getattr(here, name), getattr(there, name)
        a, b = (ours(q), theirs(Q)) if name == "gravity_torque" else (ours(q, qd), theirs(Q, V))
        assert np.allclose(a, turned * b, rtol=0, atol=1e-12 * (1 + abs(a).max())), name


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_an_arm_is_the_same_in_every_convention(convention: str) -> None:
    for _, arm, states in drawn_arms(range(40)):
        rng = np.random.default_rng([SEED, 2])
        other = told_in(arm, convention, sign=rng.choice([-1, 1], 3), zero=rng.uniform(-3, 3, 3))
        same_physics(arm, other, states, np.eye(3), np.zeros(3))


def test_an_arm_is_the_same_at_every_place() -> None:
    for number, arm, states in drawn_arms(range(40)):
        rng = np.random.default_rng([SEED, number, 3])
        R, by = random_turn(rng), rng.uniform(-1, 1, 3)
        same_physics(arm, moved(arm, R, by), states, R, by)


def test_the_rate_of_the_mass_matrix_takes_no_energy() -> None:
    """qd . (M' qd - 2 C qd) = 0, to the rounding of its terms."""
    for _, arm, states in drawn_arms(range(40)):
        truth, q, qd = Truth(arm), states["q"], states["qd"]
        rate = apply(truth.mass_matrix_dot(q, qd), qd)
        power = np.sum(qd * (rate - 2 * truth.velocity_product(q, qd)), axis=-1)
        assert np.all(abs(power) <= 1e-12 * np.sum(abs(qd) * (abs(rate) + 1), axis=-1))
        h = 1e-6
        slope = (truth.mass_matrix(q + h * qd) - truth.mass_matrix(q - h * qd)) / (2 * h)
        M_rate = truth.mass_matrix_dot(q, qd)
        assert abs(slope - M_rate).max() <= 1e-7 * (1 + abs(M_rate).max())
        assert np.array_equal(M_rate, transpose(M_rate))
