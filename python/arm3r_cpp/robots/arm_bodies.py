"""The arm of a scenario as three bodies on three joints."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from .._native import Floats
from .bodies import Body, Joint, rotation_of, with_mass

Keys = Mapping[str, Any]


class Rotor(NamedTuple):
    """A rotor that a gear of `ratio` turns with its joint. It spins on the link before that joint."""

    joint: int
    """Of the joints, from 0."""
    inertia: float
    """About its spin axis, kg m^2."""
    ratio: float
    axis: Floats
    """Unit vector in the frame of the link that carries it."""


@dataclass
class Arm:
    """Joints and links from the base on, in the scenario's axes."""

    joints: list[Joint]
    """The links' frames are those of the scenario's keys. The masses of the rotors are in their links."""
    rotors: list[Rotor]
    tip: Floats
    """In the frame of link 3, m."""
    keys: Keys
    """The resolved keys under `arm`: those that both models share are used as they are."""

    def rates(self, rotor: Rotor) -> Floats | None:
        """The spin of a rotor is the sum of these times the joint rates; None where it depends on the angles, too."""
        rates = np.zeros(3)
        rates[rotor.joint] = rotor.ratio
        if rotor.joint > 0:
            carrier = self.joints[rotor.joint - 1].axis
            rates[rotor.joint - 1] += rotor.axis @ carrier
            if rotor.joint == 2 and np.abs(np.cross(rotor.axis, carrier)).max() > 1e-12:
                return None
        return rates

    def with_locked_rotors(self) -> list[Joint]:
        """The joints with links that hold their rotors fast."""
        joints = list(self.joints)
        for rotor in self.rotors:
            if rotor.joint > 0:
                carrier = joints[rotor.joint - 1]
                spin = rotor.inertia * np.outer(rotor.axis, rotor.axis)
                joints[rotor.joint - 1] = replace(carrier, inertia=carrier.inertia + spin)
        return joints


def arm_of(keys: Keys) -> Arm:
    """The arm of the resolved keys under `arm`, of either model."""
    given = keys if keys.get("model") == "elbow" else {**keys, **_as_elbow(keys)}
    sign, zero = _signs_and_zeros(given)
    base = given.get("base", {})
    links = [given.get(f"link{i}", {}) for i in (1, 2, 3)]
    frames = [
        rotation_of(base.get("rotation", (0, 0, 0))) @ rotation_of((0, 0, zero[0])),
        _turned_up(zero[1]) @ np.array([[1, 0, 0], [0, 0, -sign[1]], [0, sign[1], 0]]),
        rotation_of((0, 0, sign[1] * zero[2])) @ np.diag([1, sign[1] * sign[2], sign[1] * sign[2]]),
    ]
    origins = [
        np.array(base.get("position", (0, 0, 0)), float),
        np.array([given.get("shoulder_offset", 0), 0, 0], float),
        np.array([links[1]["length"], 0, links[1].get("offset", 0)], float),
    ]
    axes = [np.array([0, 0, float(sign[0])]), *[np.array([0, 0, 1.0])] * 2]
    joints = [
        Joint(True, axis, frame, origin, *_body(link), armature=armature)
        for axis, frame, origin, link, armature in zip(axes, frames, origins, links, keys["armature"], strict=True)
    ]
    rotors = []
    for place, joint in enumerate(list(joints)):
        rotor = given.get(f"rotor{place + 1}", {})
        if rotor.get("mass") and place > 0:
            joints[place - 1] = with_mass(joints[place - 1], rotor["mass"], joint.origin)
        if rotor.get("inertia"):
            axis = np.array(rotor.get("axis", joint.rotation @ joint.axis), float)
            spin = axis / np.linalg.norm(axis)
            rotors.append(Rotor(place, rotor["inertia"], rotor.get("ratio", 1), spin))
    return Arm(joints, rotors, np.array(links[2]["tip"], float), keys)


def _signs_and_zeros(keys: Keys) -> tuple[Any, Any]:
    """s and o of theta = s q + o, theta the angles of which positive ones turn left and raise the arm."""
    if keys["convention"] == "urdf":
        return keys.get("joint_sign", (1, 1, 1)), keys.get("joint_zero", (0, 0, 0))
    return {"slide": (1, 1, 1), "simscape": (1, -1, -1)}[keys["convention"]], (0, 0, 0)


def _turned_up(angle: float) -> Floats:
    """The rotation that raises x by an angle towards z."""
    return rotation_of((0, -angle, 0))


def _body(link: Keys) -> Body:
    xx, yy, zz, xy, xz, yz = link.get("inertia", (0, 0, 0, 0, 0, 0))
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], float)
    return Body(link.get("mass", 0), np.array(link.get("com", (0, 0, 0)), float), inertia)


# ---- the planar arm -------------------------------------------------------------------------------------------------


def _as_elbow(keys: Keys) -> Keys:
    """The planar arm in the keys of the elbow arm."""
    links = []
    for name, place in (("link2", "length"), ("link3", "tip")):
        link = keys[name]
        mass, inertia = _solid(link)
        end = link["length"] if place == "length" else [link["length"], 0, 0]
        com = [link.get("com", link["length"] / 2), 0, 0]
        links.append({place: end, "mass": mass, "com": com, "inertia": [*link.get("inertia", inertia), 0, 0, 0]})
    return {
        "base": {"position": [0, 0, keys["base_height"]]},
        "link1": _column(keys["link1"], keys["base_height"]),
        "link2": links[0],
        "link3": links[1],
    }


def _column(link: Keys, base_height: float) -> Keys:
    """Link 1, of which the motion shows the inertia about axis 1 alone: the others are taken as equal to that."""
    mass, inertia = (link["mass"], (0, 0, 0)) if link["shape"] == "explicit" else _solid(link)
    com, axial = link.get("com", link.get("length", 0) / 2), link.get("inertia_axial", inertia[0])
    return {"mass": mass, "com": [0, 0, com - base_height], "inertia": [axial] * 3 + [0, 0, 0]}


def _solid(link: Keys) -> tuple[float, tuple[float, float, float]]:
    """Mass of a shape, where it is not given, and principal inertias, x along the length."""
    length = link["length"]
    if link["shape"] == "brick":
        height, width = link["section"]
        m = link.get("mass", link.get("density", 0) * length * height * width)
        squares = (width**2 + height**2, length**2 + width**2, length**2 + height**2)
        return m, (m * squares[0] / 12, m * squares[1] / 12, m * squares[2] / 12)
    if link["shape"] == "cylinder":
        radius = link["radius"]
        m = link.get("mass", link.get("density", 0) * length * math.pi * radius**2)
        across = m * (3 * radius**2 + length**2) / 12
        return m, (m * radius**2 / 2, across, across)
    across = link["mass"] * length**2 / 12  # slender
    return link["mass"], (0, across, across)
