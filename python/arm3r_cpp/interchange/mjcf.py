"""The arm, its motors and its wall as MJCF, the format of MuJoCo."""

from __future__ import annotations

import math
from collections.abc import Sequence
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from ..robots.arm_bodies import Arm, Rotor
from ..robots.bodies import Body, Joint
from .wall import Wall
from .xml_text import NO_LIMIT, document, numbers, units

STEP = 2e-4
"""s"""
LEAST = 1e-14
"""kg, kg m^2: MuJoCo takes no moving body whose mass or principal inertias are 1e-15 or less."""


def mjcf_text(
    arm: Arm, name: str, q: Sequence[float], qd: Sequence[float], *, start: float = 0.0, wall: Wall | None = None
) -> tuple[str, list[str]]:
    """The file, with the state at the start as keyframe, and what it leaves out, a sentence each."""
    root = Element("mujoco", model=name)
    SubElement(root, "compiler", angle="radian")
    gravity = numbers(*arm.keys["gravity"])
    option = SubElement(root, "option", integrator="RK4", timestep=numbers(STEP), gravity=gravity)
    SubElement(option, "flag", contact="disable")
    bars = {"type": "capsule", "size": numbers(_thickness(arm)), "mass": "0", "contype": "0", "conaffinity": "0"}
    SubElement(SubElement(root, "default"), "geom", bars)
    world = SubElement(root, "worldbody")
    _append_links(world, arm)
    _append_tendons(root, arm)
    actuators = SubElement(root, "actuator")
    _append_motors(actuators, arm)
    state = {"time": numbers(start), "qpos": numbers(*q), "qvel": numbers(*qd)}
    if wall is not None:
        state |= _append_wall(world, actuators, wall, start)
    SubElement(SubElement(root, "keyframe"), "key", {"name": "start", **state})
    left_out = _left_out(arm)
    return document(root, [*_comments(arm, wall), *left_out]), left_out


def obstacles(arm: Arm) -> list[str]:
    """Why MuJoCo cannot have this arm: key, value, rule."""
    found = []
    for number, joint in enumerate(arm.joints, 1):
        xx, yy, zz = np.linalg.eigvalsh(joint.inertia)
        if xx + yy < zz * (1 - 1e-12) or xx < -1e-12 * zz:
            words = f"arm.link{number}.inertia: principal inertias {numbers(xx, yy, zz)} kg m^2; "
            found.append(words + "none may be negative or exceed the sum of the other two")
    for rotor in arm.rotors:
        if arm.rates(rotor) is None:
            words = f"arm.rotor{rotor.joint + 1}.axis: {numbers(*rotor.axis)}; "
            found.append(words + "it must be parallel to the joint's axis, else its coupling changes with the angles")
    return found


# ---- bodies ---------------------------------------------------------------------------------------------------------


def _append_links(world: Element, arm: Arm) -> None:
    parent = world
    ends = [*(joint.origin for joint in arm.joints[1:]), arm.tip]
    for number, (joint, end) in enumerate(zip(arm.joints, ends, strict=True), 1):
        xyaxes = numbers(*joint.rotation[:, 0], *joint.rotation[:, 1])
        parent = SubElement(parent, "body", name=f"link{number}", pos=numbers(*joint.origin), xyaxes=xyaxes)
        own = {key: arm.keys[key][number - 1] for key in ("damping", "friction")}
        element = SubElement(parent, "joint", name=f"joint{number}", axis=numbers(*joint.axis))
        element.set("armature", numbers(_armature(arm, number - 1)))
        element.set("damping", numbers(own["damping"]))
        if own["friction"]:
            element.set("frictionloss", numbers(own["friction"]))
        _append_inertial(parent, _heavy_enough(joint))
        if end.any():
            SubElement(parent, "geom", fromto=numbers(0, 0, 0, *end))
    SubElement(parent, "site", name="tip", pos=numbers(*arm.tip))
    if mass := arm.keys["payload"]["mass"]:
        payload = SubElement(parent, "body", name="payload", pos=numbers(*arm.tip))
        SubElement(payload, "inertial", pos="0 0 0", mass=numbers(mass), diaginertia="0 0 0")


def _append_inertial(parent: Element, body: Body) -> None:
    entries = [body.inertia[i, k] for i, k in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
    place = {"pos": numbers(*body.centre), "mass": numbers(body.mass)}
    SubElement(parent, "inertial", place, fullinertia=numbers(*entries))


def _heavy_enough(joint: Joint) -> Body:
    """The link as MuJoCo takes it: what is less than the least mass or principal inertia is raised to it."""
    least = LEAST + 1e-15 * float(np.trace(joint.inertia))
    missing = max(0.0, least - np.linalg.eigvalsh(joint.inertia)[0])
    return Body(max(joint.mass, LEAST), joint.centre, joint.inertia + missing * np.eye(3))


def _thickness(arm: Arm) -> float:
    """Of the bars that are drawn, m."""
    return float(np.linalg.norm(arm.joints[2].origin) + np.linalg.norm(arm.tip)) / 80


# ---- rotors and motors ----------------------------------------------------------------------------------------------


def _turned_by(arm: Arm, rotor: Rotor) -> list[tuple[int, float]]:
    """The joints that a rotor spins with, and its spin over the rate of each."""
    rates = arm.rates(rotor)
    return [] if rates is None else [(joint, float(rate)) for joint, rate in enumerate(rates) if rate]


def _armature(arm: Arm, joint: int) -> float:
    """Of a joint: its own, and that of the rotors that spin with it alone."""
    spins = [(rotor.inertia, turned) for rotor in arm.rotors if len(turned := _turned_by(arm, rotor)) == 1]
    own = [inertia * rate**2 for inertia, [(place, rate)] in spins if place == joint]
    return arm.joints[joint].armature + sum(own)


def _append_tendons(root: Element, arm: Arm) -> None:
    """A rotor that spins with two joints is the armature of a tendon whose length is its angle."""
    coupled = [rotor for rotor in arm.rotors if len(_turned_by(arm, rotor)) > 1]
    tendons = SubElement(root, "tendon") if coupled else root
    for rotor in coupled:
        tendon = SubElement(tendons, "fixed", name=f"rotor{rotor.joint + 1}", armature=numbers(rotor.inertia))
        for joint, rate in _turned_by(arm, rotor):
            SubElement(tendon, "joint", joint=f"joint{joint + 1}", coef=numbers(rate))


def _append_motors(actuators: Element, arm: Arm) -> None:
    for number, limit in enumerate(arm.keys["torque_limit"], 1):
        motor = SubElement(actuators, "motor", name=f"motor{number}", joint=f"joint{number}")
        if limit == 0:
            motor.set("gear", "0")  # a range must not be empty
        elif math.isfinite(limit):
            motor.set("ctrlrange", numbers(-limit, limit))
            motor.set("forcerange", numbers(-limit, limit))


# ---- the wall -------------------------------------------------------------------------------------------------------


def _append_wall(world: Element, actuators: Element, wall: Wall, start: float) -> dict[str, str]:
    """A spring that only pushes, between the tip and the face. Returns its part of the keyframe.

    The actuator measures the height of the tip above the place of the face at t = 0; its activation is how far the face
    has come since. Its control is the speed of the face: its range leaves nothing else.
    """
    SubElement(world, "site", name="face", pos=numbers(*wall.face), zaxis=numbers(*wall.normal))
    spring = SubElement(actuators, "general", name="wall", site="tip", refsite="face", gear="0 0 1 0 0 0")
    spring.set("biastype", "affine")
    spring.set("biasprm", numbers(0, -wall.stiffness, 0))
    spring.set("forcerange", numbers(0, NO_LIMIT))
    if wall.speed == 0:
        spring.set("gainprm", "0")
        return {}
    spring.set("dyntype", "integrator")
    spring.set("gainprm", numbers(wall.stiffness))
    spring.set("ctrlrange", numbers(wall.speed, math.nextafter(wall.speed, math.inf)))
    return {"act": numbers(wall.speed * start), "ctrl": numbers(0, 0, 0, wall.speed)}


# ---- what is said ---------------------------------------------------------------------------------------------------


def _comments(arm: Arm, wall: Wall | None) -> list[str]:
    said = [
        units(arm.keys["convention"]),
        "The controls are the torques of the joints. The keyframe start is the state at the scenario's start.",
    ]
    if wall is not None:
        said.append("The actuator wall is the wall's spring: it pushes the tip along the axis z of the site face.")
    if wall is not None and wall.speed:
        said.append("Its activation is the way of the face since t = 0, its control the speed of the face.")
    return said


def _left_out(arm: Arm) -> list[str]:
    if not np.any(arm.keys["friction"]):
        return []
    words = (
        "MuJoCo's dry friction (frictionloss) holds a joint at rest; that of arm3r, tanh(rate / friction_velocity), "
    )
    return [words + "lets it creep: the motions differ where a joint stops."]
