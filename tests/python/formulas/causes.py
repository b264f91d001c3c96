"""What a sentence about a whole formula says that it returns, worked out without the package's own explanations."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Words = re.Match[str]


class Known(NamedTuple):
    """What is known of the arm and of the formula that a sentence is about."""

    due_of: Callable[[dict[str, Floats], dict[str, Any]], Floats]
    """What is right at states, of the arm with other values of its scenario."""
    states: dict[str, Floats]
    numbers: dict[str, float]
    in_degrees: bool
    """Whether the formula is given its angles in degrees."""

    @property
    def due(self) -> Floats:
        return self.due_of(self.states, {})

    def at(self, q: Floats) -> Floats:
        return self.due_of({**self.states, "q": q}, {})

    def with_angle(self, joint: int, change: Callable[[Floats], Floats]) -> Floats:
        q = self.states["q"].copy()
        q[:, joint] = change(q)
        return self.at(q)

    def of_arm(self, **changes: Any) -> Floats:
        return self.due_of(self.states, {f"arm.{key.replace('_', '.')}": value for key, value in changes.items()})


def said(sentence: str, known: Known) -> Floats | None:
    """The values that a formula has if a sentence about it is true; None where the sentence is about single entries.

    Raises:
        AssertionError: the sentence is not known here.
    """
    text = sentence[:1].lower() + sentence[1:].rstrip(".")
    if _OF_ENTRIES.match(sentence) or _NOT_CHECKED.match(text):
        return None
    for pattern, values in _SENTENCES:
        if words := re.fullmatch(pattern, text):
            return values(known, words)
    raise AssertionError(f"what does this say? {sentence}")


_OF_ENTRIES = re.compile(r"(J|Jdot|M|t|h|p|qdd)(\(\d,\d\)|\d) |[xyz] |.*(\bis wrong|would be right, too)")
_NOT_CHECKED = re.compile(r"the rows are in|the linear rows are of|the angular rows|in the convention|it is right in")


def _absolute(known: Known, words: Words) -> Floats:
    joint = int(words[1]) - 1
    values = known.with_angle(joint, lambda q: q[:, joint] - q[:, joint - 1]).copy()
    if "derivatives" in words[0]:
        values[..., joint - 1] -= values[..., joint]
    return values


def _in_another_unit(known: Known, words: Words) -> Floats:
    joint, change = int(words[1]) - 1, np.rad2deg if known.in_degrees else np.deg2rad
    return known.with_angle(joint, lambda q: change(q[:, joint]))


def _in_order(known: Known, words: Words) -> Floats:
    order = np.argsort(_numbers(words))
    return known.due_of({name: values[:, order] for name, values in known.states.items()}, {})


def _numbers(words: Words) -> list[int]:
    return [int(one) - 1 for one in re.findall(r"\d", words[0])]


def _signed(due: Floats, axis: int, number: str) -> Floats:
    signs = np.ones([due.shape[axis] if one == axis else 1 for one in range(due.ndim)])
    signs[(..., int(number) - 1, *[0] * (due.ndim - 1 - axis))] = -1
    return due * signs


def _twice(known: Known, words: Words) -> Floats:
    n = known.numbers
    across = {link: n[f"I{link}"] + n[f"m{link}"] * n[f"l{link}"] ** 2 for link in "23"}
    return known.of_arm(**{f"link{link}_inertia": [n[f"axial{link}"], one, one] for link, one in across.items()})


def _for(known: Known, *places: tuple[str, str]) -> Floats:
    """With the value of one quantity, a2, in the place of another, a3."""
    keys = {"a": "length", "m": "mass", "l": "com"}
    return known.of_arm(**{f"link{other[1]}_{keys[other[0]]}": known.numbers[one] for one, other in places})


_FACTORS = {"twice": 2.0, "half": 0.5, "1000 times": 1e3, "a thousandth": 1e-3, "1e6 times": 1e6}
_SENTENCES: tuple[tuple[str, Callable[[Known, Words], Floats]], ...] = (
    ("the angles are taken in degrees; .*", lambda known, words: known.at(np.deg2rad(known.states["q"]))),
    ("the angles are turned into degrees before .*", lambda known, words: known.at(np.rad2deg(known.states["q"]))),
    ("the angles are taken in radians, while .*", lambda known, words: known.at(np.rad2deg(known.states["q"]))),
    ("the angles are turned from .* twice", lambda known, words: known.at(np.deg2rad(known.states["q"]))),
    ("all joint angles have the wrong sign", lambda known, words: known.at(-known.states["q"])),
    (
        r"q(\d) has the wrong sign",
        lambda known, words: known.with_angle(int(words[1]) - 1, lambda q: -q[:, int(words[1]) - 1]),
    ),
    (r"q(\d) is taken in .*", _in_another_unit),
    (r"q(\d) is taken as the absolute angle of its link; .*", _absolute),
    (r"the joints are taken in the order .*", _in_order),
    ("the result has the wrong sign", lambda known, words: -known.due),
    ("the result is in degrees; .*", lambda known, words: np.rad2deg(known.due)),
    (rf"the result is ({'|'.join(_FACTORS)}) .*", lambda known, words: known.due * _FACTORS[words[1]]),
    (r"(?:row|entry) (\d) has the wrong sign", lambda known, words: _signed(known.due, 1, words[1])),
    (r"column (\d) has the wrong sign", lambda known, words: _signed(known.due, 2, words[1])),
    (r"the (?:rows|entries) stand in the order .*", lambda known, words: known.due[:, _numbers(words)]),
    (r"the columns stand in the order .*", lambda known, words: known.due[:, :, _numbers(words)]),
    ("the matrix is transposed", lambda known, words: np.swapaxes(known.due, 1, 2)),
    ("(..) and (..) are exchanged", lambda known, words: _for(known, (words[1], words[2]), (words[2], words[1]))),
    ("(..) stands in the place of (..)", lambda known, words: _for(known, (words[1], words[2]))),
    (r"the centre of mass of link (\d) is .*", lambda known, words: _for(known, (f"a{words[1]}", f"l{words[1]}"))),
    ("the centres of mass of links 2 and 3 are .*", lambda known, words: _for(known, ("a2", "l2"), ("a3", "l3"))),
    (r"the mass m(\d) is missing", lambda known, words: known.of_arm(**{f"link{words[1]}_mass": 1e-9})),
    ("the parallel-axis term m l.2 is counted twice.*", _twice),
    ("g is missing", lambda known, words: known.of_arm(gravity=[0, 0, -1])),
    ("g is multiplied in twice", lambda known, words: known.of_arm(gravity=[0, 0, -(known.numbers["g"] ** 2)])),
    ("gravity is left out", lambda known, words: known.of_arm(gravity=[0, 0, 0])),
    ("gravity has the wrong direction", lambda known, words: known.of_arm(gravity=[0, 0, known.numbers["g"]])),
)
