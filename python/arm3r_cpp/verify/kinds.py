"""The kinds of formula that are judged: what they take, and what they return."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from .._native import Floats
from ..errors import UsageError

Rows = tuple[int, ...]
"""Rows of a Jacobian, linear ones first, or of a position: 0 to 2 along the base's axes, 3 to 5 about them."""
SPATIAL: Rows = (0, 1, 2)


class Kind(NamedTuple):
    """A kind of formula of an arm with n joints."""

    name: str
    words: str
    inputs: tuple[str, ...]
    """The joint vectors that it depends on: "q", "qd", "qdd", "tau"."""
    unit: str
    shapes: tuple[str, ...]
    """The shapes that it may return; the first one is that of the truth."""
    letter: str
    """What its entries are called."""


KINDS = {
    kind.name: kind
    for kind in (
        Kind("jacobian", "jacobian", ("q",), "m", ("3xn", "6xn"), "J"),
        Kind("gravity", "gravity torque", ("q",), "N m", ("n",), "t"),
        Kind("kinematics", "tip position", ("q",), "m", ("3", "4x4"), "p"),
        Kind("mass", "mass matrix", ("q",), "kg m^2", ("nxn",), "M"),
        Kind("coriolis", "Coriolis and centrifugal torque", ("q", "qd"), "N m", ("n", "nxn"), "h"),
        Kind("inverse", "inverse dynamics", ("q", "qd", "qdd"), "N m", ("n",), "t"),
        Kind("forward", "forward dynamics", ("q", "qd", "tau"), "rad/s^2", ("n", "2n"), "qdd"),
        Kind("controller", "controller", ("q", "qd"), "N m", ("n",), "t"),
    )
}


def entry_name(kind: Kind, entry: Sequence[int]) -> str:
    """J(2,3), t1, M(1,2) ..."""
    return f"{kind.letter}({','.join(map(str, entry))})" if len(entry) > 1 else f"{kind.letter}{entry[0]}"


def shape_of(word: str, joints: int) -> tuple[int, ...]:
    """The shape that "3xn" means for an arm with so many joints."""
    return tuple(joints * int(part[:-1] or 1) if part.endswith("n") else int(part) for part in word.split("x"))


def standard_form(kind: Kind, values: Floats, joints: int, qd: Floats | None) -> Floats:
    """What a formula returned, (N, ...), in the shape in which it is compared.

    Raises:
        UsageError: the shape is none that the kind has.
    """
    shape = values.shape[1:]
    allowed = [shape_of(word, joints) for word in kind.shapes]
    if shape not in allowed:
        vector = next((one for one in allowed if len(one) == 1 and one in ((shape[:1]), shape[1:])), None)
        if len(shape) == 2 and 1 in shape and vector:
            return values.reshape(len(values), *vector)
        flat = next((one for one in allowed if shape == (int(np.prod(one)),)), None)
        if flat is None:
            names = " or ".join("x".join(map(str, one)) for one in allowed)
            got = "x".join(map(str, shape)) or "1"
            raise UsageError(f"returns {got} numbers, where a {kind.words} has {names}")
        return values.reshape(len(values), *flat)
    if kind.name == "forward" and qd is not None and shape == (2 * joints,):
        return _without_rates(values, qd)
    if kind.name == "kinematics" and shape == (4, 4):
        return values[:, :3, 3]
    if kind.name == "coriolis" and len(shape) == 2 and qd is not None:
        return np.einsum("nij,nj->ni", values, qd)
    return values


def _without_rates(values: Floats, qd: Floats) -> Floats:
    """The accelerations of the derivative of a state.

    Raises:
        UsageError: its first half is not qd.
    """
    joints = qd.shape[1]
    if not np.allclose(values[:, :joints], qd, rtol=1e-9, atol=1e-9):
        raise UsageError(
            f"returns {2 * joints} numbers, the derivative of the state (q, qd), and the first half is not qd"
        )
    return values[:, joints:]
