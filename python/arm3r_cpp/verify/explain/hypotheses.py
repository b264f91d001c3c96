"""Mistakes that change a formula as a whole: each is a truth of its own, which the formula is compared with."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import permutations
from typing import NamedTuple

import numpy as np

from ..._native import Floats
from ..kinds import Kind
from .christoffel import of_other_indices
from .frames import Pose, of_other_frames, of_other_points
from .quantities import States, Truth, of_other_quantities

FACTORS: dict[float, str] = {
    -1.0: "has the wrong sign",
    180 / np.pi: "is in degrees; it should be in radians",
    2.0: "is twice what it should be",
    0.5: "is half of what it should be",
    1e3: "is 1000 times what it should be: millimetres?",
    1e-3: "is a thousandth of what it should be",
    1e6: "is 1e6 times what it should be: millimetres?",
    np.pi / 180: "is pi/180 times what it should be: per degree?",
}
"""The factors by which all of a result may be wrong, and what is said of "the result" then."""


class Hypothesis(NamedTuple):
    cause: str
    values: Callable[[], Floats]
    weight: int = 1
    """How far-fetched it is."""
    is_of_result: bool = False
    """Whether all of the result is so, which several edits could mend as well."""


def hypotheses(
    kind: Kind,
    truth: Truth,
    states: States,
    revolute: Sequence[bool],
    pose: Callable[[], Pose] | None,
    given: dict[str, Floats],
    *,
    in_degrees: bool = False,
) -> Iterator[Hypothesis]:
    """All of them, each to be evaluated when it is asked for.

    Args:
        revolute: of each joint.
        pose: of the tip and of the joints' axes, in all rows; None where it is not known.
        given: the values of each quantity in all rows.
        in_degrees: whether the formula is given angles in degrees; `states` are in radians.
    """
    yield from _angles(truth, states, revolute, kind, in_degrees)
    yield from _order(truth, states, len(revolute))
    yield from _outputs(kind, lambda: truth(states, {}), len(revolute), pose)
    if "tau" in kind.inputs:
        words = "the result is multiplied by the mass matrix; it should be by its inverse"
        yield Hypothesis(words, lambda: _by_mass_matrix(truth, states))
    if kind.is_product:
        for words, values in of_other_indices(lambda qd: truth({**states, "qd": qd}, {}), states["qd"]):
            yield Hypothesis(words, values, 2)
    yield from (Hypothesis(*one) for one in of_other_quantities(kind, truth, states, given))


_WRONG_ANGLES: dict[str, Callable[[Floats], Floats]] = {
    "90 degrees too large: it counts from another direction": lambda q: q + np.pi / 2,
    "90 degrees too small: it counts from another direction": lambda q: q - np.pi / 2,
    "180 degrees off: it counts from the opposite direction": lambda q: q + np.pi,
    "half as large as it is": lambda q: q / 2,
    "twice as large as it is": lambda q: 2 * q,
}


def _angles(
    truth: Truth, states: States, revolute: Sequence[bool], kind: Kind, in_degrees: bool
) -> Iterator[Hypothesis]:
    q = states["q"]
    turning = [joint for joint, is_revolute in enumerate(revolute) if is_revolute]

    def with_q(change: Callable[[Floats], Floats], joints: Sequence[int] = turning) -> Callable[[], Floats]:
        """What is right at other values of some joints."""
        new = q.copy()
        new[:, joints] = change(q[:, joints])
        return lambda: truth({**states, "q": new}, {})

    if in_degrees:
        words = "the angles are taken in radians, while the arguments' names or the comments say degrees"
        yield Hypothesis(words, with_q(np.rad2deg))
        yield Hypothesis("the angles are turned from degrees into radians twice", with_q(np.deg2rad))
    else:
        yield Hypothesis("the angles are taken in degrees; they should be in radians", with_q(np.deg2rad))
        words = "the angles are turned into degrees before they are used; they should stay in radians"
        yield Hypothesis(words, with_q(np.rad2deg))
    yield Hypothesis("all joint angles have the wrong sign", with_q(np.negative), 2)
    units, change = (("radians", "degrees"), np.rad2deg) if in_degrees else (("degrees", "radians"), np.deg2rad)
    for joint in range(len(revolute)):
        yield Hypothesis(f"q{joint + 1} has the wrong sign", with_q(np.negative, [joint]), 2)
        if revolute[joint]:
            words = f"q{joint + 1} is taken in {units[0]}; it should be in {units[1]}"
            yield Hypothesis(words, with_q(change, [joint]), 2)
            yield from (Hypothesis(f"q{joint + 1} is taken {words}", with_q(wrong, [joint]), 2)
                        for words, wrong in _WRONG_ANGLES.items())  # fmt: skip
    for joint in turning:
        if joint - 1 in turning:
            yield from _of_two_links(partial(with_q, joints=[joint]), q, joint, kind)


def _of_two_links(
    with_angle: Callable[[Callable[[Floats], Floats]], Callable[[], Floats]], q: Floats, joint: int, kind: Kind
) -> Iterator[Hypothesis]:
    """The angle between a link and the one before is left out, or taken for that to the base."""
    number = joint + 1
    words = f"q{number} is left out of all angles: link {number} turns with link {joint}"
    yield Hypothesis(words, with_angle(np.zeros_like), 2)
    absolute = with_angle(lambda angle: angle - q[:, [joint - 1]])
    words = f"q{number} is taken as the absolute angle of its link; it should be the angle relative to link {joint}"
    yield Hypothesis(words, absolute)
    if kind.is_derivative:
        yield Hypothesis(f"{words} (and in the derivatives, too)", partial(_absolute_columns, absolute, joint))


def _by_mass_matrix(truth: Truth, states: States) -> Floats:
    """M (tau - h - g), from qdd = M^-1 (tau - h - g), whose change with the torque is M^-1."""
    still, right = (truth({**states, "tau": tau}, {}) for tau in (np.zeros_like(states["tau"]), states["tau"]))
    units = np.eye(still.shape[1])
    moved = [truth({**states, "tau": np.broadcast_to(one, still.shape)}, {}) - still for one in units]
    mass = np.linalg.inv(np.stack(moved, axis=2))
    return np.asarray((mass @ mass @ right[..., None])[..., 0])


def _order(truth: Truth, states: States, joints: int) -> Iterator[Hypothesis]:
    for order in list(permutations(range(joints)))[1:] if joints <= 4 else [tuple(range(joints))[::-1]]:
        names = ", ".join(f"q{joint + 1}" for joint in np.argsort(order))
        moved = {vector: values[:, order] for vector, values in states.items()}
        yield Hypothesis(f"the joints are taken in the order {names}", partial(truth, {**states, **moved}, {}))


def _absolute_columns(due: Callable[[], Floats], joint: int) -> Floats:
    """The columns of a Jacobian with respect to absolute angles: that of the joint before loses the next one's."""
    values = due().copy()
    values[..., joint - 1] -= values[..., joint]
    return values


def _outputs(
    kind: Kind, due: Callable[[], Floats], joints: int, pose: Callable[[], Pose] | None
) -> Iterator[Hypothesis]:
    values = due()
    rows = values.shape[1]
    for factor, words in FACTORS.items():
        cost = 1 if factor == -1 else 2
        yield Hypothesis(f"the result {words}", partial(np.multiply, factor, values), cost, is_of_result=True)
    for row in range(rows):
        signs = np.where(np.arange(rows) == row, -1.0, 1.0)
        yield Hypothesis(
            f"{'row' if values.ndim == 3 else 'entry'} {row + 1} has the wrong sign",
            partial(np.multiply, values, signs.reshape(-1, *[1] * (values.ndim - 2))),
        )
    for order in list(permutations(range(rows)))[1:] if rows <= 3 else [(3, 4, 5, 0, 1, 2)] * (rows == 6):
        if rows == 6:
            words = "the angular rows stand above the linear ones; the linear rows should be first"
        else:
            what = "rows" if values.ndim == 3 else "entries"
            words = f"the {what} stand in the order {', '.join(str(row + 1) for row in order)}"
        yield Hypothesis(words, partial(np.take, values, order, axis=1))
    if values.ndim == 3:
        if rows == values.shape[2]:
            yield Hypothesis("the matrix is transposed", lambda: np.swapaxes(values, 1, 2))
            yield Hypothesis(
                "the matrix is the inverse of what it should be", lambda: np.asarray(np.linalg.inv(values), np.float64)
            )
        for column in range(joints):
            signs = np.where(np.arange(joints) == column, -1.0, 1.0)
            yield Hypothesis(f"column {column + 1} has the wrong sign", partial(np.multiply, values, signs))
        for order in list(permutations(range(joints)))[1:] if joints <= 4 else []:
            yield Hypothesis(
                f"the columns stand in the order {', '.join(str(one + 1) for one in order)}",
                partial(np.take, values, order, axis=2),
            )
    if kind.is_derivative and pose is not None and rows in (3, 6):
        here = pose()
        yield from (Hypothesis(*one[:3]) for one in of_other_frames(values, here))
        if kind.inputs == ("q",):
            yield from (Hypothesis(*one) for one in of_other_points(values, here))
