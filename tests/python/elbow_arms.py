"""Random elbow arms as keys of a scenario, and the same arm in another convention or at another place.

>>> arm = random_arm(np.random.default_rng(7))
>>> arm3r.Scenario(yaml_of({"format": 1, "arm": arm})).arm.tip_position([0.1, 0.2, 0.3])

No length, mass or angle is round, and every tensor is that of a body. Inner angles are those of `slide`: theta2 and
theta3 raise.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
from random_scenarios import Draw, Keys, random_scenario, yaml_of

CONVENTIONS = ("slide", "simscape", "urdf")
HALF_TURN = np.array([1.0, -1.0, -1.0])
"""About x: what turns a link's frame into that of the opposite joint axis."""

WITH_OFFSETS: Keys = {
    "model": "elbow",
    "convention": "simscape",
    "base": {"position": [0.1, -0.2, 0.3], "rotation": [0.2, -0.4, 0.9]},
    "shoulder_offset": 0.3,
    "link1": {"mass": 3.7, "com": [0.01, -0.02, 0.03], "inertia": [0.011, 0.012, 0.01, 0.001, -0.002, 0.0005]},
    "link2": {
        "length": 0.43,
        "offset": 0.12,
        "mass": 8.4,
        "com": [0.2, 0.01, 0.11],
        "inertia": [0.02, 0.2, 0.21, 0.003, -0.002, 0.004],
    },
    "link3": {
        "tip": [0.38, 0.05, -0.27],
        "mass": 2.3,
        "com": [0.2, 0.02, 0.01],
        "inertia": [0.004, 0.05, 0.052, 0.001, 0.002, -0.0005],
    },
    "armature": [0.5, 0.4, 0.2],
}
"""An arm like those of the industry, with all offsets: the tip passes axis 1 at 0.15 m."""


def scenario_of(arm: Keys, **sections: Any) -> arm3r.Scenario:
    """A scenario with this arm and these sections."""
    return arm3r.Scenario(yaml_of({"format": 1, "arm": arm, **sections}))


def arm_of(arm: Keys) -> arm3r.Arm:
    """The library's arm of these keys."""
    return scenario_of(arm).arm


# ---- at random -------------------------------------------------------------------------------------------------------


def random_arm(rng: np.random.Generator, *, conventions: Sequence[str] = CONVENTIONS) -> Keys:
    """An arm of human size with every key that an elbow arm has, each of them left out or zero now and then."""
    return drawn_arm(Draw(rng), conventions)


def drawn_arm(draw: Draw, conventions: Sequence[str] = CONVENTIONS) -> Keys:
    """The same from a draw."""
    length, reach = draw.number(0.3, 1.1), draw.number(0.3, 1.1)
    angle = draw.number(-3, 3) if draw.chance(0.4) else draw.number(-0.2, 0.2)
    tip = [reach * np.cos(angle), reach * np.sin(angle), _offset(draw)]
    arm: Keys = {
        "model": "elbow",
        "convention": draw.one_of(conventions),
        "shoulder_offset": _offset(draw, 0.4),
        "link2": {"length": length, "offset": _offset(draw), **random_body(draw, 0.5 * length)},
        "link3": {"tip": [float(f"{part:.6g}") for part in tip], **random_body(draw, 0.5 * reach)},
        "armature": draw.numbers(0.005, 0.1),
    }
    rotation = [draw.number(-3, 3), draw.number(-1.5, 1.5), draw.number(-3, 3)]
    arm |= draw.some(
        0.8, base=lambda: {"position": draw.numbers(-0.5, 0.5), **draw.some(0.8, rotation=lambda: rotation)}
    )
    arm |= draw.some(0.8, link1=lambda: random_body(draw, 0.2))
    arm |= {f"rotor{joint}": _rotor(draw) for joint in (1, 2, 3) if draw.chance(0.6)}
    arm |= draw.some(0.3, damping=lambda: draw.numbers(0, 1), payload=lambda: {"mass": draw.number(0.1, 1.5)})
    if draw.chance(0.2):
        arm |= {"friction": draw.numbers(0, 0.5), "friction_velocity": draw.scale(0.02, 0.2)}
    if draw.chance(0.6):
        arm["gravity"] = draw.one_of([[0, 0, 0], draw.numbers(-9, 9), draw.numbers(-9, 9)])
    if arm["convention"] == "urdf":
        arm |= draw.some(
            0.8, joint_sign=lambda: [draw.one_of([-1, 1]) for _ in range(3)], joint_zero=lambda: draw.numbers(-3, 3)
        )
    return arm


def random_elbow_scenario(
    rng: np.random.Generator, *, conventions: Sequence[str] = CONVENTIONS, **options: Any
) -> Keys:
    """`random_scenario` with an elbow arm that starts well away from singular poses."""

    def start(draw: Draw) -> tuple[Keys, Keys]:
        arm = drawn_arm(draw, conventions)
        arm |= draw.some(0.2, torque_limit=lambda: draw.numbers(10, 60))
        return arm, _initial(draw, arm)

    return random_scenario(rng, start=start, **options)


def _initial(draw: Draw, arm: Keys) -> Keys:
    """With the tip away from the cylinder that it reaches around axis 1, and the elbow bent."""
    upper, (x, y, _) = arm["link2"]["length"], arm["link3"]["tip"]
    reach, bend = math.hypot(x, y), signs_and_zeros(arm)[0][2] * math.atan2(y, x)
    radius = 0.0
    while abs(radius) < 0.25:
        elbow = draw.one_of([-1, 1]) * draw.number(0.5, 2.2)
        shoulder = -elbow / 2 + draw.number(-0.7, 0.7) + draw.one_of([0, 0, 0, math.pi])
        radius = arm["shoulder_offset"] + upper * math.cos(shoulder) + reach * math.cos(shoulder + elbow)
    q = joint_angles(arm, [draw.number(-3, 3), shoulder, elbow - bend])
    return {"q": [float(f"{angle:.6g}") for angle in q], **draw.some(0.4, qd=lambda: draw.numbers(-0.5, 0.5))}


def random_body(draw: Draw, size: float) -> Keys:
    """Mass, centre and tensor of six points in a box of this size whose centre is anywhere near the joint."""
    mass = draw.number(0.3, 5)
    points = np.array([draw.numbers(-size, size) for _ in range(6)])
    points -= points.mean(axis=0)
    tensor = mass / 6 * (np.sum(points**2) * np.eye(3) - points.T @ points) + 1e-3 * np.eye(3)
    xx, yy, zz, xy, xz, yz = (float(f"{tensor[i]:.6g}") for i in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)])
    com = [draw.number(-size, 2 * size), *draw.numbers(-size / 2, size / 2, 2)]
    return {"mass": mass, "com": com, "inertia": [xx, yy, zz, xy, xz, yz]}


def _offset(draw: Draw, size: float = 0.25) -> float:
    """A length that may be zero or negative."""
    return draw.one_of([0.0, draw.number(-size, size), draw.number(-size, size)])


def _rotor(draw: Draw) -> Keys:
    """Often with a spin axis of no special direction, and a gear that turns it over."""
    rotor = {"inertia": draw.scale(1e-5, 1e-3), "ratio": draw.one_of([-1, 1, 1]) * draw.number(1, 120)}
    return rotor | draw.some(0.6, mass=lambda: draw.number(0.1, 2), axis=draw.direction)


def random_states(rng: np.random.Generator, count: int) -> dict[str, np.ndarray]:
    """Angles, rates, torques and forces on the tip: (count, 3) each."""
    sizes = {"q": 4.0, "qd": 5.0, "tau": 20.0, "f": 30.0}
    return {name: rng.uniform(-size, size, (count, 3)) for name, size in sizes.items()}


# ---- conventions -----------------------------------------------------------------------------------------------------


def signs_and_zeros(arm: Keys) -> tuple[np.ndarray, np.ndarray]:
    """s and o of theta = s q + o."""
    if arm["convention"] == "urdf":
        return np.array(arm.get("joint_sign", [1, 1, 1])), np.array(arm.get("joint_zero", [0, 0, 0]), float)
    return np.array([1, 1, 1] if arm["convention"] == "slide" else [1, -1, -1]), np.zeros(3)


def inner_angles(arm: Keys, q: Any) -> np.ndarray:
    """theta of joint angles in the arm's convention: (..., 3), rad."""
    signs, zeros = signs_and_zeros(arm)
    return signs * np.asarray(q) + zeros


def joint_angles(arm: Keys, theta: Any) -> np.ndarray:
    """Its inverse."""
    signs, zeros = signs_and_zeros(arm)
    return signs * (np.asarray(theta) - zeros)


def told_in(arm: Keys, convention: str, *, sign: Any = (1, 1, 1), zero: Any = (0, 0, 0)) -> Keys:
    """The same arm in another convention; `sign` and `zero` are those of `urdf`.

    Where the positive axis of joint 2 or 3 turns over, the frame of its link makes half a turn about x. The default
    axis of a rotor is the positive one of its joint and its rate counts along that: it stays.
    """
    other = copy.deepcopy(arm)
    for key in ("joint_sign", "joint_zero"):
        other.pop(key, None)
    other["convention"] = convention
    if convention == "urdf":
        other |= {"joint_sign": [int(one) for one in sign], "joint_zero": [float(one) for one in zero]}
    turns_over = signs_and_zeros(arm)[0] != signs_and_zeros(other)[0]
    for link in ("link2", "link3"):
        if turns_over[int(link[-1]) - 1]:
            _turn_over(other[link])
    for joint in (1, 2, 3):
        rotor = other.get(f"rotor{joint}", {})
        if "axis" in rotor and joint == 3 and turns_over[1]:
            rotor["axis"] = _half_turn(rotor["axis"])
        if "axis" in rotor and turns_over[joint - 1]:
            rotor["ratio"] = -rotor["ratio"]
    return other


def _half_turn(vector: Any) -> list[float]:
    return [float(part) for part in HALF_TURN * vector]


def _turn_over(link: Keys) -> None:
    """Its numbers in the frame that has made half a turn about x."""
    for key in ("com", "tip"):
        if key in link:
            link[key] = _half_turn(link[key])
    if "offset" in link:
        link["offset"] = -link["offset"]
    if "inertia" in link:
        xx, yy, zz, xy, xz, yz = link["inertia"]
        link["inertia"] = [xx, yy, zz, -xy, -xz, yz]


# ---- places ----------------------------------------------------------------------------------------------------------


def rotation_matrix(roll_pitch_yaw: Any) -> np.ndarray:
    """Rz(yaw) Ry(pitch) Rx(roll)."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(roll_pitch_yaw), np.sin(roll_pitch_yaw)
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def roll_pitch_yaw(R: np.ndarray) -> list[float]:
    """Its inverse."""
    pitch = np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0]))
    return [float(np.arctan2(R[2, 1], R[2, 2])), float(pitch), float(np.arctan2(R[1, 0], R[0, 0]))]


def base_of(arm: Keys) -> tuple[np.ndarray, np.ndarray]:
    """Position and rotation matrix of the base."""
    base = arm.get("base", {})
    return np.array(base.get("position", [0, 0, 0]), float), rotation_matrix(base.get("rotation", [0, 0, 0]))


def moved(arm: Keys, R: np.ndarray, by: Any) -> Keys:
    """The arm and the gravity that it feels turned by R about the origin, and then moved."""
    position, rotation = base_of(arm)
    base = {"position": (R @ position + by).tolist(), "rotation": roll_pitch_yaw(R @ rotation)}
    gravity = R @ np.array(arm.get("gravity", [0, 0, -9.80665]))
    return {**copy.deepcopy(arm), "base": base, "gravity": gravity.tolist()}


def random_turn(rng: np.random.Generator) -> np.ndarray:
    """A rotation about an axis of any direction."""
    Q, R = np.linalg.qr(rng.normal(size=(3, 3)))
    Q = Q * np.sign(np.diag(R))
    return Q * np.linalg.det(Q)


# ---- planar arms -----------------------------------------------------------------------------------------------------


def as_elbow(arm: Keys) -> Keys:
    """A planar arm whose links have explicit numbers (mass, com, inertia) as an elbow arm."""
    height = arm.get("base_height", 0.0)
    column = arm["link1"]
    axial = column["inertia_axial"]
    other = {key: copy.deepcopy(value) for key, value in arm.items() if key not in ("base_height", "link1")}
    other |= {
        "model": "elbow",
        "base": {"position": [0, 0, height]},
        "link1": {"mass": column["mass"], "com": [0, 0, column["com"] - height], "inertia": [axial] * 3 + [0] * 3},
    }
    for name, end in (("link2", "length"), ("link3", "tip")):
        link = arm[name]
        length = link["length"]
        other[name] = {
            end: length if end == "length" else [length, 0, 0],
            "mass": link["mass"],
            "com": [link["com"], 0, 0],
            "inertia": [*link["inertia"], 0, 0, 0],
        }
    return other
