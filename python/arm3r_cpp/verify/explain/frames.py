"""Jacobians that are right in another frame, of another point, with other levers, or for the rates of Euler angles."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import islice, permutations, product
from typing import NamedTuple

import numpy as np

from ..._native import Floats

_EULER = (("roll, pitch and yaw", 2, 0, 1), ("Euler angles (ZYZ)", 2, 2, 1), ("Euler angles (XYZ)", 0, 2, -1))
"""Of turns about moving axes: their words, the first and the last axis, the sign of their product along the second."""
_JACOBIANS = {"a body": ("body",), "a space": ("space", "spatial")}
_OTHER_SPACES = re.compile("(task|work|operational|cartesian|joint|null|state)_?space")
Mistake = tuple[str, Callable[[], Floats], int]
"""Its words, what is returned with it, how far-fetched it is."""
OfFrame = tuple[str, Callable[[], Floats], int, str]
"""The same, and what it is right as: "a body Jacobian, ..." or "a space Jacobian, ..."; "" for nothing else."""


class Pose(NamedTuple):
    """Where a chain is, in S rows."""

    rotation: Floats
    """(S, 3, 3), of the tip's frame in the base"""
    position: Floats
    """(S, 3), of the tip, m"""
    axes: Floats
    """(S, 3, n), of the joints; zero for prismatic ones"""
    links: Sequence[Floats] = ()
    """(S, 3, 3) each, of axes that move with link 1, 2, ... up to the last but one"""


class Frame(NamedTuple):
    """That of a body or a space Jacobian."""

    words: str
    number: int
    """Its place among those of `of_other_frames` in which a Jacobian is right as something."""

    def rows(self, values: Floats, pose: Pose) -> Floats:
        """What is right, (S, rows, n), as it stands in this frame."""
        return next(islice(_right_as_something(values, pose), self.number, None))[1]()


def named_frames(name: str, rows: int) -> list[Frame]:
    """In what a Jacobian of so many rows is right whose name says that it is a body or a space Jacobian."""
    bare = _OTHER_SPACES.sub("", name.lower())
    called = tuple(which for which, names in _JACOBIANS.items() if any(one in bare for one in names))
    values, pose = np.zeros((1, rows, 1)), Pose(np.eye(3)[None], np.zeros((1, 3)), np.zeros((1, 3, 1)))
    found = enumerate(one[3] for one in _right_as_something(values, pose))
    return [Frame(words, number) for number, words in found if called and words.startswith(called)]


def _right_as_something(values: Floats, pose: Pose) -> Iterator[OfFrame]:
    return (one for one in of_other_frames(values, pose) if one[3])


def of_other_frames(values: Floats, pose: Pose) -> Iterator[OfFrame]:
    """
    Args:
        values: what is right, (S, 3, n) or (S, 6, n).
    """
    rotation, position = pose.rotation, pose.position
    for (number, axes), (also, first, order) in product(enumerate(_AXES), _orders(values.shape[1])):
        which = "the tip's frame" if number == 0 else "a frame that moves with the tip"
        words = f"the rows are in {which}; they should be in the base frame{also}"
        rows = partial(_rotated, rotation @ axes, values[:, order])
        yield words, rows, 1 + (number > 0) + bool(also), f"a body Jacobian, in {which}{first}"
    for (number, link), axes in product(enumerate(pose.links, 1), _AXES):
        words = f"the rows are in a frame that moves with link {number}; they should be in the base frame"
        yield words, partial(_rotated, link @ axes, values), 2, ""
    if values.shape[1] == 6:
        across = np.cross(values[:, 3:], position[:, :, None], axis=1)
        whole = np.concatenate([values[:, :3] - across, values[:, 3:]], axis=1)
        words = "the linear rows are of the last link's point at the base's origin; they should be those of the tip"
        for also, first, order in _orders(6):
            rows = partial(np.take, whole, order, axis=1)
            yield f"{words}{also}", rows, 1 + bool(also), f"a space Jacobian, of the point at the base's origin{first}"
        yield from ((*one, "") for one in _of_euler_rates(values, rotation))


def _orders(rows: int) -> Iterator[tuple[str, str, list[int]]]:
    """The order that the rows have, and that with the angular ones first: as a mistake, as a fact, and which rows."""
    yield "", "", list(range(rows))
    if rows == 6:
        yield ", and the angular rows stand above the linear ones", ", angular rows first", [3, 4, 5, 0, 1, 2]


def of_other_points(values: Floats, pose: Pose) -> Iterator[Mistake]:
    """Columns J_j = z_j x (p - o_j) whose lever begins at another point than joint j."""
    turning = [joint for joint in range(1, pose.axes.shape[2]) if pose.axes[:, :, joint].any()]
    across = np.cross(pose.axes, pose.position[:, :, None], axis=1)
    for joints in [*([one] for one in turning), *([turning] if len(turning) > 1 else [])]:
        moved = values.copy()
        moved[:, :3, joints] = across[:, :, joints]
        numbers = " and ".join(str(joint + 1) for joint in joints)
        if len(joints) == 1:
            words = f"the lever of column {numbers} begins at the base's origin; it should begin at joint {numbers}"
        else:
            words = f"the levers of columns {numbers} begin at the base's origin; they should begin at their joints"
        yield words, moved.copy, 2
    for joint in turning:
        for other in (joint - 1, joint + 1):
            if other in turning and np.allclose(pose.axes[:, :, joint], pose.axes[:, :, other], atol=1e-9):
                moved = values.copy()
                moved[:, :3, joint] = values[:, :3, other]
                words = (
                    f"the lever of column {joint + 1} begins at joint {other + 1}; it should begin at joint {joint + 1}"
                )
                yield words, moved.copy, 2


def _of_euler_rates(values: Floats, rotation: Floats) -> Iterator[Mistake]:
    """Analytical Jacobians: the angular rows are rates of angles that turn a frame which moves with the tip."""
    for (number, axes), (angles, first, last, sign) in product(enumerate(_AXES), _EULER):
        words = f"the angular rows are the rates of {angles}, an analytical Jacobian; they should be angular velocities"
        frame = rotation @ axes
        one = np.broadcast_to(np.eye(3)[first], frame.shape[:2])
        across = sign * np.cross(one, frame[:, :, last])
        across = across / np.linalg.norm(across, axis=1, keepdims=True)
        for two, step in product((across, frame[:, :, 1]), (1, -1)):  # where the last turn stays zero it may go round
            rates = partial(_as_rates, values, np.stack([one, two, frame[:, :, last]], axis=2), step)
            yield words, rates, 1 + (number > 0)


def _as_rates(values: Floats, turns: Floats, step: int) -> Floats:
    """The Jacobian with the rates of three turns about the columns of `turns` for the angular velocity.

    Args:
        step: -1 for the other order.
    """
    rates = np.linalg.solve(turns, values[:, 3:])
    return np.concatenate([values[:, :3], rates[:, ::step]], axis=1)


def _right_handed_axes() -> Iterator[Floats]:
    """The rotations that take axes to axes, the one that leaves them first."""
    for order in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            axes = np.eye(3)[:, order] * signs
            if np.linalg.det(axes) > 0:
                yield axes


_AXES = tuple(_right_handed_axes())


def _rotated(rotation: Floats, values: Floats) -> Floats:
    inverse = np.swapaxes(rotation, 1, 2)
    return np.concatenate([inverse @ values[:, first : first + 3] for first in range(0, values.shape[1], 3)], axis=1)
