"""A chain of three revolute joints as an elbow arm: axis 2 across axis 1, axis 3 parallel to axis 2.

At the angles q of the file the inner angles are theta = sign q + zero. u, v and k are the axes of link 1: k along
axis 1, u towards the shoulder. Link 2 lies at the angle theta2 from u towards k, link 3 at theta2 + theta3.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from .._native import Floats
from ..errors import UsageError
from .bodies import Body, rotation_of
from .serial import Serial

ROUNDING = 1e-9
"""Below this, rad and m, a number is what the rounded angles of a file, such as 1.570796327, leave of zero."""
_LEAST_LENGTH = 1e-6  # m


class Misfit(NamedTuple):
    """By which angles the axes of a chain miss those of an elbow arm, rad."""

    across: float
    """Of axis 2 to the plane across axis 1."""
    parallel: float
    """Of axis 3 to axis 2."""


class Elbow(NamedTuple):
    """The geometry and the bodies of an elbow arm; names as those of the keys."""

    base_position: Floats
    base_rotation: Floats
    """Roll, pitch, yaw."""
    joint_zero: Floats
    joint_sign: Floats
    shoulder_offset: float
    length: float
    offset: float
    tip: Floats
    """In the frame of link 3, whose x points to the tip: y is zero."""
    bodies: list[Body]
    """Of the links, in their frames."""

    def tip_position(self, q: Floats) -> Floats:
        """In the root link's axes: (S, 3) -> (S, 3), m."""
        first, second, third = (self.joint_sign * q + self.joint_zero).T
        along = self.shoulder_offset + self.length * np.cos(second) + self.tip[0] * np.cos(second + third)
        height = self.length * np.sin(second) + self.tip[0] * np.sin(second + third)
        aside = -self.joint_sign[1] * self.offset - self.joint_sign[2] * self.tip[2]
        cosine, sine = np.cos(first), np.sin(first)
        point = np.stack([along * cosine - aside * sine, along * sine + aside * cosine, height], axis=-1)
        return self.base_position + point @ rotation_of(self.base_rotation).T


class _Frame(NamedTuple):
    """Of a link, in the root link's frame at q = 0."""

    rotation: Floats
    origin: Floats
    axis: Floats
    """Of its joint."""


def _frames_at_zero(chain: Serial) -> list[_Frame]:
    rotation, origin = np.eye(3), np.zeros(3)
    found = []
    for part in chain.parts:
        origin, rotation = origin + rotation @ part.origin, rotation @ part.rotation
        found.append(_Frame(rotation, origin, rotation @ part.axis))
    return found


def misfit(chain: Serial) -> Misfit:
    """How far the axes of a chain are from those of an elbow arm; the angles do not depend on q."""
    one, two, three = (frame.axis for frame in _frames_at_zero(chain))
    return Misfit(math.asin(min(1.0, abs(float(one @ two)))), _angle_between_lines(two, three))


def _angle_between_lines(one: Floats, other: Floats) -> float:
    return math.atan2(float(np.linalg.norm(np.cross(one, other))), abs(float(one @ other)))


def as_elbow(chain: Serial, file: str) -> Elbow:
    """The chain as an elbow arm, whatever its axes are: axis 2 is turned across axis 1, axis 3 parallel to axis 2.

    Each link keeps what it measures along and across its own axis.

    Raises:
        UsageError: axes 2 and 3 are one line, or the tip lies on axis 3.
    """
    one, two, three = _frames_at_zero(chain)
    tip = three.origin + three.rotation @ chain.tool
    up, base_rotation = _base(one.axis)
    lateral = _unit(two.axis - (two.axis @ up) * up)

    # The shoulder is where axis 2 is nearest to axis 1, and the base's origin lies on axis 1 at its height.
    shoulder = two.origin - (lateral @ (two.origin - one.origin)) / (lateral @ two.axis) * two.axis
    base = one.origin + (up @ (shoulder - one.origin)) / (up @ one.axis) * one.axis

    forward = np.cross(lateral, up)
    forward *= _forward_sign(forward, shoulder - base, tip - base, base_rotation)
    left = np.cross(up, forward)
    sign = np.array([np.sign(up @ one.axis), -np.sign(left @ two.axis), -np.sign(left @ three.axis)])

    second, third = _link_axes(three.origin - shoulder, two.axis), _link_axes(tip - three.origin, three.axis)
    length, offset = (second.T @ (three.origin - shoulder))[[0, 2]]
    reach, aside = (third.T @ (tip - three.origin))[[0, 2]]
    names = [joint.name for joint in chain.joints]
    if length < _LEAST_LENGTH:
        raise UsageError(f"{file}: {names[1]} and {names[2]} have one axis; an elbow arm has a link between them")
    if reach < _LEAST_LENGTH:
        raise UsageError(f"{file}: {chain.tip} lies on the axis of {names[2]}, which cannot move it; name another tip")

    lifts = [math.atan2(axes[:, 0] @ up, axes[:, 0] @ forward) for axes in (second, third)]
    base_axes = rotation_of(base_rotation)
    turn = math.atan2(forward @ base_axes[:, 1], forward @ base_axes[:, 0])
    origins, axes = [base, shoulder, three.origin], [np.column_stack([forward, left, up]), second, third]
    return Elbow(
        _tidied(base),
        base_rotation,
        np.array([_tidy_angle(one) for one in (turn, lifts[0], lifts[1] - lifts[0])]),
        sign,
        _tidy(float(forward @ (shoulder - base))),
        float(length),
        _tidy(offset),
        np.array([reach, 0.0, _tidy(aside)]),
        [
            _body(Body(part.mass, part.centre, part.inertia), frame, origin, link)
            for part, frame, origin, link in zip(chain.parts, (one, two, three), origins, axes, strict=True)
        ],
    )


def _base(axis: Floats) -> tuple[Floats, Floats]:
    """A direction of axis 1 that points up, and the angles of a base whose z it is; none where it is the root's z."""
    upward = -axis if axis[2] < -ROUNDING else axis
    pitch = math.atan2(math.hypot(upward[0], upward[1]), upward[2])
    yaw = math.atan2(upward[1], upward[0]) if pitch > ROUNDING else 0.0
    rotation = np.array([0.0, _tidy_angle(pitch), _tidy_angle(yaw)])
    return rotation_of(rotation)[:, 2], rotation


def _forward_sign(forward: Floats, shoulder: Floats, tip: Floats, base_rotation: Floats) -> float:
    """1 or -1: forward is where the shoulder is, else where the tip is at q = 0, else the base's x."""
    reach = float(np.linalg.norm(tip))
    for direction in (shoulder, tip):
        if abs(forward @ direction) > 1e-4 * reach:
            return float(np.sign(forward @ direction))
    x, y, _ = forward @ rotation_of(base_rotation)
    return float(np.sign(x if abs(x) > ROUNDING else y))


def _link_axes(along: Floats, lateral: Floats) -> Floats:
    """Columns x, y, z: z is lateral, x lies along a vector as far as that is across it."""
    x = along - (along @ lateral) * lateral
    x = _unit(x) if np.linalg.norm(x) > 0 else x
    return np.column_stack([x, np.cross(lateral, x), lateral])


def _unit(vector: Floats) -> Floats:
    return vector / np.linalg.norm(vector)


def _body(body: Body, frame: _Frame, origin: Floats, axes: Floats) -> Body:
    """A body of a link's frame in a frame of other origin and axes."""
    centre = axes.T @ (frame.origin + frame.rotation @ body.centre - origin)
    turn = axes.T @ frame.rotation
    inertia = turn @ body.inertia @ turn.T
    products = ~np.eye(3, dtype=bool) & (np.abs(inertia) < ROUNDING * np.abs(inertia).max())
    inertia[products] = 0.0
    return Body(body.mass, _tidied(centre), inertia)


def _tidy(number: float) -> float:
    return 0.0 if abs(number) < ROUNDING else float(number)


def _tidied(vector: Floats) -> Floats:
    return np.array([_tidy(number) for number in vector])


def _tidy_angle(angle: float) -> float:
    """From -pi to pi; a multiple of 90 deg that is meant is one."""
    angle = math.remainder(angle, 2 * math.pi)
    meant = round(angle / (math.pi / 2)) * (math.pi / 2)
    angle = meant if abs(angle - meant) < ROUNDING else angle
    return angle + 2 * math.pi if angle <= -math.pi else angle
