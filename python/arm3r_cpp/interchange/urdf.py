"""The arm as URDF."""

from __future__ import annotations

import math
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from .._native import Floats
from ..robots.arm_bodies import Arm
from ..robots.bodies import Body, Joint
from .xml_text import NO_LIMIT, document, numbers, units

NO_END = 1e5
"""rad, rad/s: stands for no limit of angle and rate; a run that exceeds it is called diverged."""


def urdf_text(arm: Arm, name: str) -> tuple[str, list[str]]:
    """The file, and what it leaves out of the arm's motion, a sentence each."""
    robot = Element("robot", name=name)
    SubElement(robot, "link", name="base")
    ends = [*(joint.origin for joint in arm.joints[1:]), arm.tip]
    for number, (joint, end) in enumerate(zip(arm.with_locked_rotors(), ends, strict=True), 1):
        _append_joint(robot, number, joint, arm)
        link = SubElement(robot, "link", name=f"link{number}")
        _append_inertial(link, Body(joint.mass, joint.centre, joint.inertia))
        _append_bar(link, end)
    tip = SubElement(robot, "joint", name="tip_joint", type="fixed")
    SubElement(tip, "parent", link="link3")
    SubElement(tip, "child", link="tip")
    SubElement(tip, "origin", xyz=numbers(*arm.tip), rpy="0 0 0")
    _append_inertial(SubElement(robot, "link", name="tip"), Body(_payload(arm), np.zeros(3), np.zeros((3, 3))))
    left_out = _left_out(arm)
    return document(robot, [*_comments(arm), *left_out]), left_out


def _append_joint(robot: Element, number: int, joint: Joint, arm: Arm) -> None:
    element = SubElement(robot, "joint", name=f"joint{number}", type="revolute")
    SubElement(element, "parent", link=f"link{number - 1}" if number > 1 else "base")
    SubElement(element, "child", link=f"link{number}")
    SubElement(element, "origin", xyz=numbers(*joint.origin), rpy=numbers(*_roll_pitch_yaw(joint.rotation)))
    SubElement(element, "axis", xyz=numbers(*joint.axis))
    limit = arm.keys["torque_limit"][number - 1]
    ends = {"lower": numbers(-NO_END), "upper": numbers(NO_END), "velocity": numbers(NO_END)}
    SubElement(element, "limit", ends, effort=numbers(limit if math.isfinite(limit) else NO_LIMIT))
    damping, friction = (numbers(arm.keys[key][number - 1]) for key in ("damping", "friction"))
    SubElement(element, "dynamics", damping=damping, friction=friction)


def _append_inertial(link: Element, body: Body) -> None:
    if body.mass == 0 and not body.inertia.any():
        return
    inertial = SubElement(link, "inertial")
    SubElement(inertial, "origin", xyz=numbers(*body.centre), rpy="0 0 0")
    SubElement(inertial, "mass", value=numbers(body.mass))
    entries = {f"i{'xyz'[i]}{'xyz'[k]}": numbers(body.inertia[i, k]) for i in range(3) for k in range(i, 3)}
    SubElement(inertial, "inertia", entries)


def _append_bar(link: Element, end: Floats) -> None:
    """What is drawn: a bar from the joint to the next one, or to the tip."""
    length, across = float(np.linalg.norm(end)), math.hypot(end[0], end[1])
    if length == 0:
        return
    visual = SubElement(link, "visual")
    turned = (0.0, math.atan2(across, end[2]), math.atan2(end[1], end[0]))  # from z, which is a cylinder's axis
    SubElement(visual, "origin", xyz=numbers(*end / 2), rpy=numbers(*turned))
    SubElement(SubElement(visual, "geometry"), "cylinder", radius=numbers(length / 40), length=numbers(length))


def _roll_pitch_yaw(rotation: Floats) -> tuple[float, float, float]:
    """Its angles about the fixed axes x, y and z: well defined at a pitch of 90 deg, too."""
    yaw = math.atan2(rotation[1, 0], rotation[0, 0])
    sine, cosine = math.sin(yaw), math.cos(yaw)
    pitch = math.atan2(-rotation[2, 0], cosine * rotation[0, 0] + sine * rotation[1, 0])
    y, z = (cosine * rotation[1, axis] - sine * rotation[0, axis] for axis in (1, 2))
    return math.atan2(-z, y), pitch, yaw


def _payload(arm: Arm) -> float:
    return float(arm.keys["payload"]["mass"])


def _comments(arm: Arm) -> list[str]:
    """What the file says itself."""
    keys = arm.keys
    said = [
        units(keys["convention"]),
        f"URDF has no gravity. In the axes of the link base it is {numbers(*keys['gravity'])} m/s^2.",
        f"A joint must have limits: {numbers(NO_END)} rad and rad/s stand for none.",
    ]
    if np.isinf(keys["torque_limit"]).any():
        said.append(f"An effort of {numbers(NO_LIMIT)} N m stands for no limit.")
    if np.any(keys["friction"]):
        sets_in = numbers(keys["friction_velocity"])
        said.append(f"The scenario's dry friction is friction times tanh(rate / {sets_in} rad/s).")
    if _payload(arm):
        said.append("The mass of the link tip is the payload.")
    return said


def _left_out(arm: Arm) -> list[str]:
    said = []
    if np.any(arm.keys["armature"]):
        said.append(f"URDF has no armature: arm.armature {numbers(*arm.keys['armature'])} kg m^2 is left out.")
    if arm.rotors:
        names = ", ".join(f"arm.rotor{rotor.joint + 1}" for rotor in arm.rotors)
        said.append(
            f"URDF has no rotors: those of {names} stand still in their links, and do not spin with the joints."
        )
    return said
