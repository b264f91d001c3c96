"""Jacobians that are right in another frame, of another point, or for the rates of Euler angles."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import permutations, product

import numpy as np

from ..._native import Floats

_EULER = (("roll, pitch and yaw", 2, 0, 1), ("Euler angles (ZYZ)", 2, 2, 1), ("Euler angles (XYZ)", 0, 2, -1))
"""Of turns about moving axes: their words, the first and the last axis, the sign of their product along the second."""
Mistake = tuple[str, Callable[[], Floats], int]
"""Its words, what is returned with it, how far-fetched it is."""


def of_other_frames(values: Floats, rotation: Floats, position: Floats) -> Iterator[Mistake]:
    """
    Args:
        values: what is right, (S, 3, n) or (S, 6, n).
        rotation, position: of the tip's frame in the base, (S, 3, 3) and (S, 3).
    """
    turned = [("", values)]
    if values.shape[1] == 6:
        turned.append((", and the angular rows stand above the linear ones", np.roll(values, 3, axis=1)))
    for (number, axes), (also, rows) in product(enumerate(_AXES), turned):
        which = "the tip's frame" if number == 0 else "a frame that moves with the tip"
        words = f"the rows are in {which}; they should be in the base frame{also}"
        yield words, partial(_rotated, rotation @ axes, rows), 1 + (number > 0) + bool(also)
    if values.shape[1] == 6:
        across = np.cross(values[:, 3:], position[:, :, None], axis=1)
        whole = np.concatenate([values[:, :3] - across, values[:, 3:]], axis=1)
        words = "the linear rows are of the last link's point at the base's origin; they should be those of the tip"
        yield words, lambda: whole, 1
        yield from _of_euler_rates(values, rotation)


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
