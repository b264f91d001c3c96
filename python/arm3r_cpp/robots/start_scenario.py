"""A scenario to start from, around an arm: a pose, gravity compensation, and a wall that comes towards the tip."""

from __future__ import annotations

import itertools
import math
import os
import re
from textwrap import indent

import numpy as np

from .bodies import rotation_of
from .choice import Choice
from .elbow import Elbow
from .explicit import note, own_arm
from .serial import Serial

_STEP = math.radians(15)
_GAP = 0.05  # m, between the tip and the wall


def start_scenario(choice: Choice) -> str:
    """The text of a scenario whose arm is chosen of a URDF.

    Raises:
        UsageError: the file cannot be read, or its chain is no elbow arm.
    """
    arm = own_arm(choice)
    pose = start_pose(arm.elbow, arm.chain)
    [tip] = arm.elbow.tip_position(pose[None])
    away = _away_from_axis_1(arm.elbow, pose)
    stem = os.path.splitext(os.path.basename(choice.file))[0]
    locked = ", ".join(f"{name} at {position:.6g}" for name, position in choice.lock.items())
    head = f"The arm of {os.path.basename(choice.file)}, with the tip {arm.chain.tip}"
    head += f". Locked, in rad or m: {locked}" if locked else ""
    return "\n".join([
        note(f"{head}. Gravity compensation holds it; a wall comes towards the tip and touches it after a second."),
        "format: 1",
        f"name: {re.sub('[^A-Za-z0-9_-]+', '-', stem).strip('-') or 'arm'}",
        "",
        "arm:",
        indent(arm.text, "  "),
        "initial:",
        f"  q: [{', '.join(f'{math.degrees(angle):.6g} deg' for angle in pose)}]",
        "",
        "wall:",
        f"  point: {_metres(tip + _GAP * away)}",
        f"  normal: {_metres(-away)}",
        "  motion: {type: constant, velocity: 0.05}",
        "  contact: {law: spring, stiffness: 1000}",
        "  acts_on_arm: false              # true: the arm feels the wall",
        "",
        "controller: {type: gravity_compensation}",
        "time: {stop: 2.0}",
    ])  # fmt: skip


def start_pose(elbow: Elbow, chain: Serial) -> np.ndarray:
    """Angles within the limits of the file that are far from singular poses: the tip in front, the elbow up."""
    ranges = [_grid(*joint.range) for joint in chain.joints[1:]]
    first = min(max(0.0, chain.joints[0].range[0]), chain.joints[0].range[1])
    poses = np.array([(first, *rest) for rest in itertools.product(*ranges)])
    inner = elbow.joint_sign * poses + elbow.joint_zero
    lift = inner[:, 1] + inner[:, 2]
    radius = elbow.shoulder_offset + elbow.length * np.cos(inner[:, 1]) + elbow.tip[0] * np.cos(lift)
    clearance = np.abs(np.sin(inner[:, 2])) * radius / (elbow.length + elbow.tip[0])
    return poses[np.argmax(clearance + 1e-3 * np.sin(inner[:, 1]))]  # of two that are alike, the elbow up


def _grid(least: float, greatest: float) -> list[float]:
    """Multiples of a step in a range, at most one turn; its middle where it has none."""
    least, greatest = max(least, -math.pi), min(greatest, math.pi)
    steps = range(math.ceil(least / _STEP), math.floor(greatest / _STEP) + 1)
    return [step * _STEP for step in steps] or [(least + greatest) / 2]


def _away_from_axis_1(elbow: Elbow, pose: np.ndarray) -> np.ndarray:
    """The direction, across axis 1, in which the arm stands."""
    angle = elbow.joint_sign[0] * pose[0] + elbow.joint_zero[0]
    return rotation_of(elbow.base_rotation) @ [math.cos(angle), math.sin(angle), 0.0]


def _metres(vector: np.ndarray) -> str:
    return f"[{', '.join(f'{round(number, 6) + 0.0:g}' for number in vector)}]"
