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


def _twice(known: Known, links: str) -> Floats:
    n = known.numbers
    across = {link: n[f"I{link}"] + n[f"m{link}"] * n[f"l{link}"] ** 2 for link in links}
    return known.of_arm(**{f"link{link}_inertia": [n[f"axial{link}"], one, one] for link, one in across.items()})


def _parallel_axes(known: Known, words: Words) -> Floats:
    twice = _twice(known, words[2] or "23")
    return twice if "twice" in words[1] else 2 * known.due - twice


def _centres(known: Known, words: Words) -> Floats:
    """Of one link or of both, at the end or in the middle."""
    part = 1.0 if "end" in words[2] else 0.5
    return known.of_arm(**{f"link{link}_com": part * known.numbers[f"a{link}"] for link in re.findall(r"\d", words[1])})


def _without_q(known: Known, words: Words) -> Floats:
    return known.with_angle(int(words[1]) - 1, lambda q: 0 * q[:, 0])


def _christoffel(known: Known, words: Words) -> Floats:
    """The sums from the symbols Gamma_ijk, which the torques of unit rates tell: dM_ij/dq_k = Gamma_ijk + Gamma_jik."""
    units = np.eye(3)

    def torque(qd: Floats) -> Floats:
        return known.due_of({**known.states, "qd": np.broadcast_to(qd, known.states["q"].shape)}, {})

    symbols = np.stack([[(torque(j + k) - torque(j) - torque(k)) / 2 for k in units] for j in units])  # (j, k, S, i)
    rates = np.einsum("jksi->sijk", symbols) + np.einsum("iksj->sijk", symbols)
    qd = known.states["qd"]
    terms = {
        "dM/dt qd": np.einsum("sijk,sj,sk->si", rates, qd, qd),
        "d(qd^T M qd)/dq": np.einsum("sjki,sj,sk->si", rates, qd, qd),
    }
    total = np.zeros_like(qd)
    for sign, half, word in re.findall(r"(-?) ?(1/2 )?(dM/dt qd|d\(qd\^T M qd\)/dq)", words[1]):
        total = total + (-1 if sign else 1) * (0.5 if half else 1) * terms[word]
    return total


def _lever(known: Known, words: Words) -> Floats:
    """Columns of the parallel joints 2 and 3 with levers from another joint, or from the base, d1 below joint 2."""
    values, q1 = known.due.copy(), known.states["q"][:, 0]
    reach = np.cos(q1) * values[:, 1, 0] - np.sin(q1) * values[:, 0, 0]
    turn = np.sign(values[:, 2, 1] / reach)  # whether joint 2 raises
    from_base = values[:, :, 1].copy()
    from_base[:, :2] -= (turn * known.numbers["d1"] * np.array([np.cos(q1), np.sin(q1)])).T
    for column in re.findall(r"\d", words[1]):
        begin = {"the base's origin": from_base, "joint 2": known.due[:, :, 1], "joint 3": known.due[:, :, 2]}[words[2]]
        values[:, :, int(column) - 1] = begin
    return values


def _about_joint2(known: Known, words: Words) -> Floats:
    carried = known.of_arm(link2_mass=1e-9)[:, 1]
    return np.column_stack([known.due[:, :2], carried])


def _for(known: Known, *places: tuple[str, str]) -> Floats:
    """With the value of one quantity, a2, in the place of another, a3; c: centre of mass, i: inertia across a link."""
    keys = {"a": "length", "m": "mass", "c": "com", "i": "inertia"}
    changes: dict[str, Any] = {}
    for one, other in places:
        what, link = other
        value: Any = known.numbers[{"c": "l", "i": "I"}.get(what, what) + one[1]]
        changes[f"link{link}_{keys[what]}"] = [known.numbers[f"axial{link}"], value, value] if what == "i" else value
    return known.of_arm(**changes)


def _other_angle(known: Known, words: Words) -> Floats:
    joint = int(words[1]) - 1
    factor = {"half": 0.5, "twice": 2.0}.get(words[2], 1.0)
    added = np.deg2rad({"90 degrees too large": 90, "90 degrees too small": -90, "180 degrees": 180}.get(words[2], 0))
    return known.with_angle(joint, lambda q: factor * q[:, joint] + added)


def _by_mass_matrix(known: Known, words: Words) -> Floats:
    """With the mass matrix of the arm, from accelerations that three torques give beside none."""
    n = known.due.shape[1]
    zero = known.due_of({**known.states, "tau": 0 * known.states["tau"]}, {})
    inverse = np.empty((len(zero), n, n))
    for joint in range(n):
        inverse[:, :, joint] = known.due_of({**known.states, "tau": 0 * zero + np.eye(n)[joint]}, {}) - zero
    return np.linalg.solve(inverse, np.linalg.solve(inverse, known.due[..., None]))[..., 0]


_LEFT_OUT: dict[str, dict[str, Any]] = {
    "height of joint 2 above the base frame": {"arm.base_height": 0.0},
    "payload": {"arm.payload.mass": 0.0},
    "armature": {"arm.armature": [0.0] * 3},
    "damping": {"arm.damping": [0.0] * 3},
    "friction": {"arm.friction": [0.0] * 3},
    "inertia of link 1 about its axis": {"arm.link1.inertia_axial": 2e-9},  # some, or the mass matrix may be singular
}


def _rods(known: Known, words: Words) -> Floats:
    changes = dict(_LEFT_OUT["inertia of link 1 about its axis"]) if words[1] else {}
    for link in "23":
        changes |= {f"arm.link{link}.shape": "slender", f"arm.link{link}.mass": known.numbers[f"m{link}"]}
    return known.due_of(known.states, changes)


_FACTORS = {
    "twice": 2.0,
    "half": 0.5,
    "1000 times": 1e3,
    "a thousandth": 1e-3,
    "1e6 times": 1e6,
    "pi/180 times": np.pi / 180,
}
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
    (r"q(\d) is taken (half|twice|90 degrees too large|90 degrees too small|180 degrees).*", _other_angle),
    ("the matrix is the inverse of what it should be", lambda known, words: np.linalg.inv(known.due)),
    ("the result is multiplied by the mass matrix; .*", _by_mass_matrix),
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
    (r"the centres? of mass of (links? [23 and]+) (?:is|are) taken at the link(?:'s|s') (\w+)", _centres),
    (
        "the (centre of mass|inertia) of link (.) stands in the place of that of link (.)",
        lambda known, words: _for(known, (words[1][0] + words[2], words[1][0] + words[3])),
    ),
    (
        "that of link (.) stands in the place of the (centre of mass|inertia) of link (.)",
        lambda known, words: _for(known, (words[2][0] + words[1], words[2][0] + words[3])),
    ),
    (
        "the (centre of mass|inertia) of link 2 and that of link 3 are exchanged",
        lambda known, words: _for(
            known, (words[1][0] + "2", words[1][0] + "3"), (words[1][0] + "3", words[1][0] + "2")
        ),
    ),
    (
        "the point is the centre of mass of link 3; .*",
        lambda known, words: known.of_arm(link3_length=known.numbers["l3"]),
    ),
    ("the third moment is taken about joint 2; .*", _about_joint2),
    (r"q(\d) is left out of all angles: .*", _without_q),
    ("the Christoffel symbols have other indices or signs: the result is (.*); it should be .*", _christoffel),
    (r"the levers? of columns? ([23 and]+) begins? at (.*); (?:it|they) should begin at .*", _lever),
    (r"the mass m(\d) is missing", lambda known, words: known.of_arm(**{f"link{words[1]}_mass": 1e-9})),
    (
        r"the parallel-axis term m l.2 is (missing|counted twice): the inertia(?:s are| of link (\d) is) about .*",
        _parallel_axes,
    ),
    (rf"the ({'|'.join(_LEFT_OUT)}) is left out", lambda known, words: known.due_of(known.states, _LEFT_OUT[words[1]])),
    (r"links 2 and 3 are slender rods; the arm's have a width \(.*\)(, and the inertia of link 1 .*)?", _rods),
    ("g is missing", lambda known, words: known.of_arm(gravity=[0, 0, -1])),
    ("g is multiplied in twice", lambda known, words: known.of_arm(gravity=[0, 0, -(known.numbers["g"] ** 2)])),
    ("gravity is left out", lambda known, words: known.of_arm(gravity=[0, 0, 0])),
    ("gravity has the wrong direction", lambda known, words: known.of_arm(gravity=[0, 0, known.numbers["g"]])),
)
