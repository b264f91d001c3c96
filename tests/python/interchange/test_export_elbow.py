"""Elbow arms in exported files: offsets, a turned base, joint zeros and signs, full tensors, rotors."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from arm3r_cpp.interchange import mjcf
from arm3r_cpp.interchange.urdf import urdf_text
from arm3r_cpp.robots.arm_bodies import arm_of
from exported import Numbers, by_mujoco, by_pinocchio, largest_difference

ARMS, LIMIT = 100, 1e-12


def about(axis: int, angle: float) -> np.ndarray:
    i, k = (axis + 1) % 3, (axis + 2) % 3
    turned = np.eye(3)
    turned[i, i] = turned[k, k] = math.cos(angle)
    turned[i, k], turned[k, i] = -math.sin(angle), math.sin(angle)
    return turned


def tensor(entries: list[float]) -> np.ndarray:
    xx, yy, zz, xy, xz, yz = entries
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def random_body(rng: np.random.Generator) -> dict[str, Any]:
    """Which a body may be: its principal inertias obey the triangle's rule."""
    a, b, c = rng.uniform(0.005, 0.05, 3)
    turned = about(0, rng.uniform(0, 3)) @ about(1, rng.uniform(0, 3)) @ about(2, rng.uniform(0, 3))
    i = turned @ np.diag([b + c, a + c, a + b]) @ turned.T
    inertia = [i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]]
    return {"mass": rng.uniform(0.3, 3), "com": rng.uniform(-0.3, 0.3, 3).tolist(), "inertia": inertia}


def random_rotor(rng: np.random.Generator, **given: Any) -> dict[str, Any]:
    return {"inertia": rng.uniform(1e-5, 1e-3), "ratio": rng.uniform(-50, 50), "mass": rng.uniform(0, 1), **given}


def random_elbow(rng: np.random.Generator) -> dict[str, Any]:
    """Resolved keys; the rotor of joint 3 spins about the joint's axis, one way or the other."""
    convention = str(rng.choice(["simscape", "slide", "urdf"]))
    keys: dict[str, Any] = {
        "model": "elbow",
        "convention": convention,
        "base": {"position": rng.uniform(-1, 1, 3).tolist(), "rotation": rng.uniform(-3, 3, 3).tolist()},
        "shoulder_offset": rng.uniform(-0.3, 0.3),
        "link1": random_body(rng),
        "link2": {"length": rng.uniform(0.3, 1), "offset": rng.uniform(-0.2, 0.2), **random_body(rng)},
        "link3": {"tip": rng.uniform(-0.8, 0.8, 3).tolist(), **random_body(rng)},
        "rotor1": random_rotor(rng),
        "rotor2": random_rotor(rng, axis=rng.normal(size=3).tolist()),
        "rotor3": random_rotor(rng, axis=[0, 0, float(rng.choice([-2, 2]))]),
        "armature": rng.uniform(0, 0.1, 3).tolist(),
        "damping": [0.1, 0.2, 0.3],
        "friction": [0, 0, 0],
        "friction_velocity": 1e-3,
        "torque_limit": [np.inf] * 3,
        "payload": {"mass": rng.uniform(0.1, 1)},
        "gravity": rng.uniform(-10, 10, 3).tolist(),
    }
    if convention == "urdf":
        keys["joint_sign"] = rng.choice([-1, 1], 3).tolist()
        keys["joint_zero"] = [rng.uniform(-3, 3), float(rng.choice([-np.pi / 2, np.pi / 2, 0.7])), rng.uniform(-3, 3)]
    return keys


def numbers_of(keys: dict[str, Any], q: np.ndarray) -> Numbers:
    """From the places and axes of the links in space."""
    sign, zero = np.array([1, -1, -1]), np.zeros(3)
    if keys["convention"] != "simscape":
        sign, zero = np.array(keys.get("joint_sign", [1, 1, 1])), np.array(keys.get("joint_zero", [0, 0, 0]))
    theta, (roll, pitch, yaw) = sign * q + zero, keys["base"]["rotation"]
    base = about(2, yaw) @ about(1, pitch) @ about(0, roll)
    link1 = base @ about(2, theta[0])
    u, v, k = link1.T
    frames = [link1]
    for place, raised in ((1, theta[1]), (2, theta[1] + theta[2])):
        x, z = math.cos(raised) * u + math.sin(raised) * k, -sign[place] * v
        frames.append(np.column_stack([x, np.cross(z, x), z]))
    first = np.array(keys["base"]["position"])
    second = first + keys["shoulder_offset"] * u
    third = second + keys["link2"]["length"] * frames[1][:, 0] + keys["link2"]["offset"] * frames[1][:, 2]
    origins, axes = [first, second, third], [sign[0] * k, frames[1][:, 2], frames[2][:, 2]]

    def jacobian(point: np.ndarray, links: int) -> np.ndarray:
        columns = [np.cross(axes[i], point - origins[i]) if i < links else np.zeros(3) for i in range(3)]
        return np.column_stack(columns)

    def angular(links: int) -> np.ndarray:
        return np.column_stack([axes[i] if i < links else np.zeros(3) for i in range(3)])

    tip = third + frames[2] @ keys["link3"]["tip"]
    points = [(keys["payload"]["mass"], jacobian(tip, 3))]
    mass_matrix = np.diag(keys["armature"]).astype(float)
    for i in range(3):
        link, rotor = keys[f"link{i + 1}"], keys[f"rotor{i + 1}"]
        points.append((link["mass"], jacobian(origins[i] + frames[i] @ link["com"], i + 1)))
        turns = frames[i].T @ angular(i + 1)
        mass_matrix += turns.T @ tensor(link["inertia"]) @ turns
        points.append((rotor["mass"], jacobian(origins[i], i)))
        carrier = base if i == 0 else frames[i - 1]
        along = np.array(rotor.get("axis", carrier.T @ axes[i]))
        spin = rotor["ratio"] * np.eye(3)[i] + (carrier @ along / np.linalg.norm(along)) @ angular(i)
        mass_matrix += rotor["inertia"] * np.outer(spin, spin)
    mass_matrix += sum(mass * J.T @ J for mass, J in points)
    weight = -sum(mass * J.T @ keys["gravity"] for mass, J in points)
    return Numbers(tip, jacobian(tip, 3), mass_matrix, weight)


def as_urdf_has_it(keys: dict[str, Any]) -> dict[str, Any]:
    """Without armature, and with rotors that stand still in their links."""
    still = {f"rotor{i}": {**keys[f"rotor{i}"], "ratio": 0} for i in (1, 2, 3)}
    return {**keys, **still, "armature": [0, 0, 0]}


def mjcf_of(keys: dict[str, Any]) -> str:
    return mjcf.mjcf_text(arm_of(keys), "elbow", (0, 0, 0), (0, 0, 0))[0]


@pytest.mark.parametrize("seed", range(ARMS))
def test_other_programs_compute_the_same_elbow(seed: int) -> None:
    rng = np.random.default_rng(seed)
    keys, q = random_elbow(rng), rng.uniform(-4, 4, 3)
    assert largest_difference(numbers_of(keys, q), by_mujoco(mjcf_of(keys), q)) <= LIMIT
    keys["rotor3"]["axis"] = rng.normal(size=3).tolist()
    theirs = by_pinocchio(urdf_text(arm_of(keys), "elbow")[0], keys["gravity"], q)
    assert largest_difference(numbers_of(as_urdf_has_it(keys), q), theirs) <= LIMIT


def test_the_jacobian_compared_with_is_that_of_the_tip() -> None:
    for seed in range(10):
        rng = np.random.default_rng(seed)
        keys, q, step = random_elbow(rng), rng.uniform(-4, 4, 3), 1e-6
        steps = step * np.eye(3)
        moved = [numbers_of(keys, q + one).tip - numbers_of(keys, q - one).tip for one in steps]
        np.testing.assert_allclose(numbers_of(keys, q).jacobian, np.column_stack(moved) / (2 * step), atol=1e-8)


def test_links_and_rotors_may_be_left_out() -> None:
    keys, q = random_elbow(np.random.default_rng(5)), np.array([0.4, -0.9, 1.3])
    nothing = {"mass": 0, "com": [0, 0, 0], "inertia": [0] * 6}
    whole = {**keys, "link1": nothing, **{f"rotor{i}": {"inertia": 0, "ratio": 1, "mass": 0} for i in (1, 2, 3)}}
    for name in ("link1", "rotor1", "rotor2", "rotor3"):
        del keys[name]
    assert largest_difference(numbers_of(whole, q), by_mujoco(mjcf_of(keys), q)) <= LIMIT
    theirs = by_pinocchio(urdf_text(arm_of(keys), "elbow")[0], keys["gravity"], q)
    assert largest_difference(numbers_of({**whole, "armature": [0, 0, 0]}, q), theirs) <= LIMIT


def test_rotors_without_an_axis_spin_about_their_joints() -> None:
    keys, q = random_elbow(np.random.default_rng(6)), np.array([0.4, -0.9, 1.3])
    for i in (1, 2, 3):
        keys[f"rotor{i}"].pop("axis", None)
    assert largest_difference(numbers_of(keys, q), by_mujoco(mjcf_of(keys), q)) <= LIMIT


def test_a_point_mass_is_a_link() -> None:
    keys, q = random_elbow(np.random.default_rng(7)), np.array([0.4, -0.9, 1.3])
    keys["link2"]["inertia"] = keys["link3"]["inertia"] = [0] * 6
    assert largest_difference(numbers_of(keys, q), by_mujoco(mjcf_of(keys), q)) <= LIMIT


def test_what_mujoco_cannot_have_is_named() -> None:
    keys = random_elbow(np.random.default_rng(8))
    assert mjcf.obstacles(arm_of(keys)) == []
    keys["rotor3"]["axis"] = [0, 0.6, 0.8]
    keys["link3"]["inertia"] = [0.066, 0.086, 0.0125, 0, 0, 0]
    inertia, axis = mjcf.obstacles(arm_of(keys))
    assert inertia.startswith("arm.link3.inertia: principal inertias 0.0125 0.066 0.086 kg m^2; none may")
    assert axis.startswith("arm.rotor3.axis: 0 0.6 0.8; it must be parallel")


def test_urdf_says_which_rotors_stand_still() -> None:
    text, left_out = urdf_text(arm_of(random_elbow(np.random.default_rng(9))), "elbow")
    assert len(left_out) == 2 and all(f"<!-- {sentence} -->" in text for sentence in left_out)
    assert "arm.rotor1, arm.rotor2, arm.rotor3 stand still" in left_out[1]
