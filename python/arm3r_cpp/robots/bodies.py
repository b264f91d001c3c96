"""Rigid bodies, joints and rotations, of which chains are made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from .._native import Floats

LARGEST = 1e12
"""Of a number that describes a chain, either way."""


def rotation_about(axis: Floats, angle: Floats) -> Floats:
    """Rodrigues' formula: (S, 3, 3) for angles (S,)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    sine, cosine = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.eye(3) + sine * cross + (1 - cosine) * (cross @ cross)


class Body(NamedTuple):
    """A rigid body: its mass, kg, centre, m, and inertia about that, kg m^2."""

    mass: float
    centre: Floats
    inertia: Floats


@dataclass
class Joint:
    """A joint and the link behind it; the link's frame is the joint's, moved by the joint."""

    is_revolute: bool
    axis: Floats
    """A unit vector in the joint's frame."""
    rotation: Floats
    """Of the joint's frame in the frame before it, (3, 3)."""
    origin: Floats
    """Of the joint's frame in the frame before it, (3,), m."""
    mass: float = 0.0
    centre: Floats = field(default_factory=lambda: np.zeros(3))
    """Of mass, in the link's frame, m."""
    inertia: Floats = field(default_factory=lambda: np.zeros((3, 3)))
    """About the centre of mass, in the axes of the link's frame, kg m^2."""
    armature: float = 0.0


def rotation_of(angles: Sequence[float] | Floats) -> Floats:
    """Of roll, pitch and yaw: about the fixed axes x, y and z, one after the other."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(angles), np.sin(angles)
    return np.array([
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ])  # fmt: skip


def joined(one: Body, other: Body) -> Body:
    """Two bodies in one frame as one (parallel axis theorem)."""
    mass = one.mass + other.mass
    if mass == 0:
        return Body(0.0, one.centre, one.inertia + other.inertia)
    centre = (one.mass * one.centre + other.mass * other.centre) / mass
    inertia = np.zeros((3, 3))
    for part in (one, other):
        arm = part.centre - centre
        inertia += part.inertia + part.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return Body(mass, centre, inertia)


def with_mass(joint: Joint, mass: float, at: Floats) -> Joint:
    """The joint's link with a point mass on it."""
    body = joined(Body(joint.mass, joint.centre, joint.inertia), Body(mass, at, np.zeros((3, 3))))
    return replace(joint, mass=body.mass, centre=body.centre, inertia=body.inertia)


def pose_words(rotation: Floats, origin: Floats) -> str:
    """ "is turned by 90 deg about x and moved by [0, 0, 0.4] m"."""
    vector = np.array([rotation[i - 1, i - 2] - rotation[i - 2, i - 1] for i in range(3)])
    angle = float(np.rad2deg(np.arctan2(np.linalg.norm(vector), np.trace(rotation) - 1)))
    found = []
    if angle > 1e-9:
        axis = vector / np.linalg.norm(vector) if np.linalg.norm(vector) > 1e-9 else np.linalg.eigh(rotation)[1][:, -1]
        place = int(np.argmax(np.abs(axis)))
        along = ("-" if axis[place] < 0 else "") + "xyz"[place] if abs(axis[place]) > 1 - 1e-9 else vector_words(axis)
        found.append(f"is turned by {angle:.6g} deg about {along}")
    if origin.any():
        found.append(f"is moved by {vector_words(origin)} m")
    return " and ".join(found)


def vector_words(vector: Floats) -> str:
    return f"[{', '.join(f'{one + 0.0:.6g}' for one in vector)}]"
