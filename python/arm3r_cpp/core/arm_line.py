"""The arm as the line that pictures and films show."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .._native import Floats
from ..robots.bodies import rotation_of
from .arm import Arm
from .scenario import Scenario

SAME = 1e-9  # m: points that are nearer to each other are one
JOINTS = (2, 4)  # joints 2 and 3 among the arm's points


class ArmLine(NamedTuple):
    """From the point of axis 1 at the height of joint 2 to the tip. A planar arm has joint 2, joint 3 and the tip."""

    points: Floats
    """(..., points, 3), m: each differs from the one before."""
    joints: list[int]
    """Where joints 2 and 3 are among them."""


def arm_line(arm: Arm, q: ArrayLike) -> ArmLine:
    """At joint angles (..., 3). The distances between neighbours, and so which of them coincide, are the arm's own."""
    points = arm.points(q)
    apart = np.linalg.norm(np.diff(points.reshape(-1, 7, 3)[0, 1:], axis=0), axis=1) > SAME
    kept = np.flatnonzero([False, True, *apart])
    return ArmLine(points[..., kept, :], [int(np.searchsorted(kept, joint, side="right")) - 1 for joint in JOINTS])


def heading(scenario: Scenario, q: ArrayLike) -> float:
    """Where the arm points, seen from above, rad: of a planar arm q1, of an elbow arm the direction of its tip."""
    points = scenario.arm.points(q)
    ahead = points[-1] - points[1]
    return float(np.asarray(q)[0] if scenario["arm.model"] == "planar" else np.arctan2(ahead[1], ahead[0]))


def base_axes(scenario: Scenario) -> Floats:
    """(3, 3): the base's x, y and z as columns, z along axis 1."""
    return rotation_of(scenario["arm.base.rotation"]) if scenario["arm.model"] == "elbow" else np.eye(3)
