"""Kinematics and dynamics of random elbow arms against the truth, the recursion and Pinocchio.

A failure prints the seed and the keys of the arm; ARM3R_SEED sets another seed, the gates that of the day.
"""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from elbow_arms import (
    CONVENTIONS,
    WITH_OFFSETS,
    arm_of,
    as_elbow,
    base_of,
    inner_angles,
    joint_angles,
    moved,
    random_arm,
    random_states,
    random_turn,
    scenario_of,
    signs_and_zeros,
    told_in,
)  # fmt: skip
from elbow_truth import Pinocchio, Truth, apply, transpose
from random_scenarios import Draw, Keys, sample_seed, yaml_of

SEED = sample_seed()
STATES = 20
D = np.array([1.0, -1.0, -1.0])

LENGTHS, MASSES, TORQUES = 1e-13, 1e-14, 1e-12
"""m, of places and Jacobians of arms that reach two metres; of the largest entry of M; of the largest torque of its
kind: rounding of a few dozen sums, in which torques lose two digits where large parts cancel"""


def drawn_arms(numbers: range, **options: Any) -> Iterator[tuple[str, Keys, arm3r.Arm, dict[str, np.ndarray]]]:
    """What to say in a failure, the keys, the arm, and states."""
    for number in numbers:
        rng = np.random.default_rng([SEED, number])
        keys = random_arm(rng, **options)
        yield f"seed {SEED}, arm {number}\n{yaml_of({'arm': keys})}", keys, arm_of(keys), random_states(rng, STATES)


class Worst:
    """The worst gaps of all arms, each in parts of what is allowed."""

    def __init__(self) -> None:
        self.gaps: dict[str, float] = {}

    def hold(self, name: str, ours: Any, theirs: Any, limit: float, told: str) -> None:
        gap = float(np.max(abs(np.asarray(ours) - theirs), initial=0.0)) / limit
        assert gap <= 1, f"{name}: {gap * limit:.1e} where {limit:.1e} is allowed, {told}"
        self.gaps[name] = max(self.gaps.get(name, 0.0), gap)

    def tell(self) -> None:
        print(f"seed {SEED}, parts of what is allowed: " + ", ".join(f"{k} {gap:.1e}" for k, gap in self.gaps.items()))


# ---- the truth -------------------------------------------------------------------------------------------------------


def hold_to_the_truth(worst: Worst, told: str, keys: Keys, arm: arm3r.Arm, states: dict[str, np.ndarray]) -> None:
    truth, (q, qd, tau, f) = Truth(keys), states.values()
    J, M, rate = truth.jacobian(q), truth.mass_matrix(q), truth.jacobian_dot(q, qd)
    bias, gravity = truth.velocity_product(q, qd), truth.gravity_torque(q)
    largest = abs(M).max()
    torque = max(abs(bias).max(), abs(gravity).max(), abs(tau).max())
    for name in ("tip_position", "elbow_position", "centres", "jacobian", "geometric_jacobian"):
        worst.hold(name, getattr(arm, name)(q), getattr(truth, name)(q), LENGTHS, told)
    worst.hold("jacobian_dot", arm.jacobian_dot(q, qd), rate, LENGTHS * max(1, abs(rate).max()), told)
    worst.hold(
        "manipulability", arm.manipulability(q), abs(np.linalg.det(J)), LENGTHS * max(1, abs(J).max() ** 3), told
    )
    sensed = arm.tip_sensor(q, qd)
    worst.hold("sensed position", sensed[0], truth.tip_position(q), LENGTHS, told)
    worst.hold("sensed velocity", sensed[1], apply(J, qd), LENGTHS * max(1, abs(apply(J, qd)).max()), told)

    worst.hold("mass_matrix", arm.mass_matrix(q), M, MASSES * largest, told)
    assert np.array_equal(arm.mass_matrix(q), transpose(arm.mass_matrix(q))), told
    worst.hold("velocity_product", arm.velocity_product(q, qd), bias, TORQUES * abs(bias).max(), told)
    worst.hold("gravity_torque", arm.gravity_torque(q), gravity, TORQUES * max(abs(gravity).max(), 1e-3), told)
    kinetic, potential = truth.energy(q, qd)
    worst.hold("kinetic energy", arm.energy(q, qd)[0], kinetic, TORQUES * abs(kinetic).max(), told)
    worst.hold("potential energy", arm.energy(q, qd)[1], potential, TORQUES * max(abs(potential).max(), 1e-3), told)

    qdd = arm.forward_dynamics(q, qd, tau, f_on_tip=f)
    needed = max(torque, abs(apply(M, qdd)).max())
    inverse = truth.inverse_dynamics(q, qd, qdd, f)
    worst.hold("forward dynamics", inverse, tau, TORQUES * needed, told)
    asked = truth.inverse_dynamics(q, qd, tau, f)
    worst.hold(
        "inverse dynamics", arm.inverse_dynamics(q, qd, tau, f_on_tip=f), asked, TORQUES * abs(asked).max(), told
    )
    by_recursion = arm.recursion_inverse_dynamics(q, qd, tau, f_on_tip=f)
    worst.hold("inverse dynamics by recursion", by_recursion, asked, TORQUES * abs(asked).max(), told)
    by_recursion = truth.inverse_dynamics(q, qd, arm.recursion_forward_dynamics(q, qd, tau, f_on_tip=f), f)
    worst.hold("forward dynamics by recursion", by_recursion, tau, TORQUES * needed, told)


def hold_to_pinocchio(worst: Worst, told: str, keys: Keys, arm: arm3r.Arm, states: dict[str, np.ndarray]) -> None:
    peer = Pinocchio(keys)
    for q, qd in zip(states["q"][:3], states["qd"][:3], strict=True):
        M, (tip, J, rate) = peer.mass_matrix(q), peer.tip(q, qd)
        bias, gravity = peer.velocity_product(q, qd), peer.gravity_torque(q)
        worst.hold("tip of Pinocchio", arm.tip_position(q), tip, LENGTHS, told)
        worst.hold("Jacobian of Pinocchio", arm.geometric_jacobian(q), J, LENGTHS, told)
        worst.hold("its rate", arm.jacobian_dot(q, qd), rate, LENGTHS * max(1, abs(rate).max()), told)
        worst.hold("M of Pinocchio", arm.mass_matrix(q), M, MASSES * abs(M).max(), told)
        terms = (abs(arm.coriolis_matrix(q, qd)) @ abs(qd)).max()  # which may all but cancel where the rates are apart
        worst.hold("C qd of Pinocchio", arm.velocity_product(q, qd), bias, TORQUES * max(terms, 1e-2), told)
        worst.hold("gravity of Pinocchio", arm.gravity_torque(q), gravity, TORQUES * max(abs(gravity).max(), 1), told)


def check_truth(numbers: range) -> None:
    worst = Worst()
    for told, keys, arm, states in drawn_arms(numbers):
        hold_to_the_truth(worst, told, keys, arm, states)
        hold_to_pinocchio(worst, told, keys, arm, states)
    worst.tell()


def test_random_arms_are_the_truth() -> None:
    check_truth(range(40))


@pytest.mark.gate
@pytest.mark.random
def test_many_random_arms_are_the_truth() -> None:
    check_truth(range(1000, 2000))


def test_coriolis_matrices_are_those_of_christoffel() -> None:
    """C qd is the velocity product, M' - 2 C is skew, and C(q, a) b = C(q, b) a: no other matrix has all three."""
    for told, keys, arm, (states) in drawn_arms(range(40)):
        q, qd, other, _ = states.values()
        C, rate = arm.coriolis_matrix(q, qd), Truth(keys).mass_matrix_dot(q, qd)
        limit = TORQUES * (1 + abs(C).max() + abs(rate).max())
        assert abs(apply(C, qd) - arm.velocity_product(q, qd)).max() <= limit * abs(qd).max(), told
        assert abs(rate - C - transpose(C)).max() <= limit, told
        swapped = apply(C, other) - apply(arm.coriolis_matrix(q, other), qd)
        assert abs(swapped).max() <= limit * abs(other).max() * 3, told


def test_what_the_tip_feels() -> None:
    """Effective mass and operational-space inertia, relative to the condition of what is inverted."""
    for told, keys, arm, states in drawn_arms(range(40)):
        truth, (q, _, _, f) = Truth(keys), states.values()
        J, M = truth.jacobian(q), truth.mass_matrix(q)
        mobility = J @ np.linalg.solve(M, transpose(J))
        push = f / np.linalg.norm(f, axis=-1, keepdims=True)
        due = 1 / np.sum(push * apply(mobility, push), axis=-1)
        condition = np.linalg.cond(M) * np.linalg.cond(mobility)
        assert np.all(abs(arm.effective_mass(q, f) - due) <= 1e-14 * condition * due + 1e-13), told
        regular = np.linalg.cond(J) < 100
        inertia = arm.operational_space_inertia(q[regular])
        left = inertia @ mobility[regular] - np.eye(3)
        assert np.all(abs(left).max(axis=(-1, -2)) <= 1e-13 * condition[regular]), told


def slope(f: Callable[..., np.ndarray], at: list[np.ndarray], place: int, joint: int) -> np.ndarray:
    """The derivative of f with respect to an argument's joint: a central difference of fourth order."""
    h = 1e-3

    def beside(steps: int) -> np.ndarray:
        return f(*(x + steps * h * np.eye(3)[joint] if i == place else x for i, x in enumerate(at)))

    return (8 * (beside(1) - beside(-1)) - (beside(2) - beside(-2))) / (12 * h)


def test_derivatives_are_slopes() -> None:
    """Differences of the truth over 1e-3 rad are exact to about 1e-10 of the torques, but for the steep tanh."""
    for told, keys, arm, states in drawn_arms(range(10)):
        truth, (q, qd, qdd, f) = Truth(keys), (x[:4] for x in states.values())
        found = arm.inverse_dynamics_derivatives(q, qd, qdd, f_on_tip=f)
        torque = partial(truth.inverse_dynamics, f_on_tip=f)
        for place, joint in np.ndindex(3, 3):
            due = slope(torque, [q, qd, qdd], place, joint)
            limit = 1e-2 if "friction" in keys and place == 1 else 1e-8
            assert abs(found[place][..., joint] - due).max() <= limit * (10 + abs(due).max()), (told, place, joint)
        forward = arm.forward_dynamics_derivatives(q, qd, truth.inverse_dynamics(q, qd, qdd, f), f_on_tip=f)
        M = truth.mass_matrix(q)
        for ours, due in zip(forward, (-found[0], -found[1], np.eye(3)), strict=True):
            assert abs(M @ ours - due).max() <= 1e-9 * (1 + abs(due).max()), told


# ---- inverse kinematics ----------------------------------------------------------------------------------------------


class Reach:
    """The arm as inverse kinematics sees it: two bars in a plane that passes axis 1 at a distance."""

    def __init__(self, keys: Keys) -> None:
        signs = signs_and_zeros(keys)[0]
        (x, y, z), upper = keys["link3"]["tip"], keys["link2"]
        self.keys, self.position, self.base = keys, *base_of(keys)
        self.shoulder, self.upper, self.lower = keys.get("shoulder_offset", 0.0), upper["length"], float(np.hypot(x, y))
        self.aside = -(signs[1] * upper.get("offset", 0.0) + signs[2] * z)  # along v
        self.bend = signs[2] * np.arctan2(y, x)

    def cosine(self, p: np.ndarray, front: bool) -> float:
        """Of the elbow's angle; NaN within the cylinder that the tip cannot enter."""
        x, y, z = self.base.T @ (p - self.position)
        square = x**2 + y**2 - self.aside**2
        rho = (1 if front else -1) * np.sqrt(square if square >= 0 else np.nan) - self.shoulder
        return float((rho**2 + z**2 - self.upper**2 - self.lower**2) / (2 * self.upper * self.lower))

    def branch(self, q: np.ndarray) -> tuple[float, float]:
        """The tip's distance from axis 1 along u, and how far the elbow lies above the line from shoulder to tip."""
        _, second, third = inner_angles(self.keys, q)
        third += second + self.bend
        elbow = self.upper * np.array([np.cos(second), np.sin(second)])
        tip = elbow + self.lower * np.array([np.cos(third), np.sin(third)])
        above = (tip[0] * elbow[1] - tip[1] * elbow[0]) / np.linalg.norm(tip)
        return self.shoulder + float(tip[0]), float(np.copysign(1, tip[0]) * above)


def check_inverse_kinematics(numbers: range) -> None:
    """Each branch that reaches the point returns it, is the branch that it says, and one of them is the pose itself.

    A branch is left out where the point is within 1e-9 of the end of its reach, and a side is not asked for where the
    elbow lies on the line.
    """
    tried = 0
    for told, keys, arm, states in drawn_arms(numbers):
        truth, reach = Truth(keys), Reach(keys)
        for q in states["q"]:
            p, found = truth.tip_position(q), []
            for front in (True, False):
                cosine = reach.cosine(p, front)
                if abs(abs(cosine) - 1) < 1e-9:
                    continue
                if not abs(cosine) <= 1:
                    with pytest.raises(arm3r.UsageError):
                        arm.inverse_kinematics(p, front=front)
                    continue
                for elbow in ("up", "down"):
                    pose = arm.inverse_kinematics(p, front=front, elbow=elbow)
                    assert abs(truth.tip_position(pose) - p).max() <= LENGTHS, told
                    radius, above = reach.branch(pose)
                    assert abs(radius) < 1e-9 or (radius > 0) == front, (told, q, front, elbow)
                    assert abs(above) < 1e-9 or (above > 0) == (elbow == "up"), (told, q, front, elbow)
                    found.append(pose)
            tried += len(found)
            if found and arm.manipulability(q) > 0.01:
                away = [abs(np.angle(np.exp(1j * (pose - q)))).max() for pose in found]
                assert min(away) <= 1e-9, (told, q)
    assert tried > 2 * STATES * len(numbers)


def test_all_four_branches_return_the_tip() -> None:
    check_inverse_kinematics(range(15))


@pytest.mark.gate
@pytest.mark.random
def test_all_four_branches_of_many_arms_return_the_tip() -> None:
    check_inverse_kinematics(range(1000, 2000))


def test_no_pose_reaches_into_the_cylinder_of_the_lateral_offset() -> None:
    """However long the links: the tip passes axis 1 at 0.15 m, and comes no nearer."""
    arm, reach = arm_of(WITH_OFFSETS), Reach(WITH_OFFSETS)
    assert reach.aside == pytest.approx(-0.15)

    def at(radius: float) -> np.ndarray:
        return reach.position + reach.base @ [radius * np.cos(0.7), radius * np.sin(0.7), 0.5]

    points = np.array([at(0.4), at(0.1499), at(0.0)])
    with pytest.raises(arm3r.UsageError) as raised:
        arm.inverse_kinematics(points)
    assert raised.value.index == (1,)
    assert abs(arm.tip_position(arm.inverse_kinematics(at(0.1501))) - at(0.1501)).max() <= LENGTHS
    rng = np.random.default_rng(4)
    tips = (arm.tip_position(rng.uniform(-4, 4, (2000, 3))) - reach.position) @ reach.base
    assert np.hypot(tips[:, 0], tips[:, 1]).min() >= 0.15 - 1e-12


def test_above_turns_over_where_the_tip_is_behind_the_shoulder_and_in_front_of_the_axis() -> None:
    arm, reach = arm_of(WITH_OFFSETS), Reach(WITH_OFFSETS)
    point = reach.position + reach.base @ [0.15 * np.cos(0.7), 0.17 * np.sin(0.7) + 0.06, 0.4]
    for elbow in ("up", "down"):
        pose = arm.inverse_kinematics(point, front=True, elbow=elbow)
        radius, above = reach.branch(pose)
        assert 0 < radius < WITH_OFFSETS["shoulder_offset"]
        assert (above > 0.01) == (elbow == "up") and abs(above) > 0.01


def test_an_arm_is_singular_at_the_cylinder_and_where_its_elbow_is_straight() -> None:
    """det J = 0 to rounding, and no inertia of the tip exists; the shoulder offset moves the pose, not the law."""
    arm, reach = arm_of(WITH_OFFSETS), Reach(WITH_OFFSETS)
    straight = joint_angles(WITH_OFFSETS, [0.3, 0.4, -reach.bend])
    for second in np.linspace(-3, 3, 13):
        cosine = -(reach.shoulder + reach.upper * np.cos(second)) / reach.lower
        if abs(cosine) < 1:
            on_cylinder = joint_angles(WITH_OFFSETS, [0.3, second, np.arccos(cosine) - second - reach.bend])
            assert arm.manipulability(on_cylinder) < 1e-15
    assert arm.manipulability(straight) < 1e-15
    assert arm.manipulability([0.3, 0.4, 0.9]) > 1e-3
    with pytest.raises(arm3r.UsageError):
        arm.operational_space_inertia(straight)


# ---- symmetries ------------------------------------------------------------------------------------------------------


def same_motion(told: str, keys: Keys, other: Keys, states: dict[str, np.ndarray], R: Any, by: Any) -> None:
    q, qd, tau, f = states.values()
    ways = signs_and_zeros(keys)[0] * signs_and_zeros(other)[0]
    here, there = arm_of(keys), arm_of(other)
    Q, V = joint_angles(other, inner_angles(keys, q)), ways * qd
    assert abs(here.tip_position(q) @ R.T + by - there.tip_position(Q)).max() <= 2 * LENGTHS, told
    ours = here.forward_dynamics(q, qd, tau, f_on_tip=f)
    theirs = ways * there.forward_dynamics(Q, V, ways * tau, f_on_tip=f @ R.T)
    M = here.mass_matrix(q)
    torque = abs(here.inverse_dynamics(q, qd, 0 * q)).max() + abs(apply(M, ours)).max()
    assert abs(apply(M, ours - theirs)).max() <= TORQUES * torque, told
    assert np.allclose(here.energy(q, qd)[0], there.energy(Q, V)[0], rtol=1e-12), told


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_the_same_arm_moves_alike_in_every_convention(convention: str) -> None:
    for told, keys, _, states in drawn_arms(range(30)):
        rng = np.random.default_rng([SEED, 2])
        other = told_in(keys, convention, sign=rng.choice([-1, 1], 3), zero=rng.uniform(-3, 3, 3))
        same_motion(told, keys, other, states, np.eye(3), np.zeros(3))


def test_slide_simscape_and_urdf_without_zeros_have_the_same_bits() -> None:
    """Only signs differ, and a sign takes no rounding."""
    for told, keys, slide, states in drawn_arms(range(30), conventions=["slide"]):
        q, qd, tau, f = states.values()
        for other in (told_in(keys, "simscape"), told_in(keys, "urdf", sign=[1, -1, -1])):
            arm = arm_of(other)
            assert np.array_equal(arm.tip_position(D * q), slide.tip_position(q)), told
            assert np.array_equal(arm.mass_matrix(D * q), D[:, None] * slide.mass_matrix(q) * D), told
            accelerations = arm.forward_dynamics(D * q, D * qd, D * tau, f_on_tip=f)
            assert np.array_equal(accelerations, D * slide.forward_dynamics(q, qd, tau, f_on_tip=f)), told


def test_an_arm_moves_alike_at_every_place() -> None:
    for number, (told, keys, _, states) in enumerate(drawn_arms(range(30))):
        rng = np.random.default_rng([SEED, number, 3])
        R, by = random_turn(rng), rng.uniform(-1, 1, 3)
        same_motion(told, keys, moved(keys, R, by), states, R, by)


def test_an_array_of_states_has_the_bits_of_each_state_alone() -> None:
    for told, _, arm, states in drawn_arms(range(10)):
        q, qd, tau, f = (x[:9] for x in states.values())
        together = [
            arm.mass_matrix(q), arm.velocity_product(q, qd), arm.forward_dynamics(q, qd, tau, f_on_tip=f),
            arm.recursion_forward_dynamics(q, qd, tau, f_on_tip=f), arm.jacobian_dot(q, qd), arm.gravity_torque(q),
        ]  # fmt: skip
        for i in range(len(q)):
            alone = [
                arm.mass_matrix(q[i]), arm.velocity_product(q[i], qd[i]),
                arm.forward_dynamics(q[i], qd[i], tau[i], f_on_tip=f[i]),
                arm.recursion_forward_dynamics(q[i], qd[i], tau[i], f_on_tip=f[i]), arm.jacobian_dot(q[i], qd[i]),
                arm.gravity_torque(q[i]),
            ]  # fmt: skip
            assert all(np.array_equal(a[i], b) for a, b in zip(together, alone, strict=True)), told


def test_an_arm_comes_back_from_its_numbers_its_text_and_its_pickle() -> None:
    for told, keys, arm, states in drawn_arms(range(10)):
        q, qd, tau, _ = states.values()
        text = scenario_of(keys).to_yaml()
        for other in (arm3r.Arm(arm.params), arm3r.Scenario(text).arm, pickle.loads(pickle.dumps(arm)), copy.copy(arm)):
            assert np.array_equal(other.tip_position(q), arm.tip_position(q)), told
            assert np.array_equal(other.forward_dynamics(q, qd, tau), arm.forward_dynamics(q, qd, tau)), told


# ---- planar arms -----------------------------------------------------------------------------------------------------


def planar_arm(rng: np.random.Generator) -> Keys:
    """With explicit numbers, as an elbow arm needs them."""
    draw = Draw(rng)

    def link() -> Keys:
        length, (a, b, c) = draw.number(0.3, 1.1), draw.numbers(0.005, 0.05)
        inertia = [float(f"{part:.6g}") for part in (b + c, a + c, a + b)]
        return {
            "length": length,
            "mass": draw.number(0.3, 3),
            "com": draw.number(0.1, 0.9) * length,
            "inertia": inertia,
        }

    return {
        "convention": draw.one_of(["slide", "simscape"]),
        "base_height": draw.number(-0.5, 0.5),
        "gravity": draw.numbers(-9, 9),
        "link1": {"mass": draw.number(0.3, 3), "com": draw.number(-0.1, 0.1), "inertia_axial": draw.number(0.01, 0.1)},
        "link2": link(),
        "link3": link(),
        "payload": {"mass": draw.number(0.1, 1.5)},
        "armature": draw.numbers(0.005, 0.1),
        "damping": draw.numbers(0, 0.5),
    }


def test_a_planar_arm_is_an_elbow_arm_without_offsets() -> None:
    """To 1e-12: the same sums in another order."""
    for number in range(40):
        rng = np.random.default_rng([SEED, number, 4])
        keys = planar_arm(rng)
        planar, elbow = arm_of(keys), arm_of(as_elbow(keys))
        q, qd, tau, f = random_states(rng, STATES).values()
        told = f"seed {SEED}, planar arm {number}\n{yaml_of({'arm': keys})}"
        for name in (
            "tip_position",
            "elbow_position",
            "centres",
            "geometric_jacobian",
            "mass_matrix",
            "gravity_torque",
        ):
            assert np.allclose(getattr(elbow, name)(q), getattr(planar, name)(q), rtol=1e-12, atol=1e-12), (told, name)
        for name in ("jacobian_dot", "coriolis_matrix", "velocity_product", "energy"):
            ours, theirs = getattr(elbow, name)(q, qd), getattr(planar, name)(q, qd)
            assert np.allclose(ours, theirs, rtol=1e-12, atol=1e-11), (told, name)
        for name in ("forward_dynamics", "recursion_forward_dynamics"):
            ours, theirs = (getattr(arm, name)(q, qd, tau, f_on_tip=f) for arm in (elbow, planar))
            assert np.allclose(ours, theirs, rtol=1e-11, atol=1e-12 * abs(theirs).max()), (told, name)
        p = planar.tip_position(q)
        for front in (True, False):
            for side in ("up", "down"):
                poses = (arm.inverse_kinematics(p, front=front, elbow=side) for arm in (elbow, planar))
                turns = np.exp(1j * np.array(list(poses)))
                far = planar.manipulability(q) > 1e-3
                assert abs(turns[0] - turns[1])[far].max(initial=0) <= 1e-10, (told, front, side)
