"""Mistakes planted in the lecture's own formulas, one at a time: how many of them would a test see?"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

import numpy as np

from .._native import Floats
from .kinds import Kind

_SLIPS = (
    ("a2", "a3"), ("a3", "a2"), ("m2", "m3"), ("m3", "m2"), ("q2+q3", "q2"), ("q2+q3", "q2-q3"), ("s(", "c("),
    ("c(", "s("), ("q1", "0"), ("q1", "-q1"), ("/2", ""),
)  # fmt: skip
_UNEQUAL = {"a2": 0.8, "a3": 0.55, "m2": 2.592, "m3": 3.052, "g": 9.80665}
_NAMES = {"length2": "a2", "length3": "a3", "mass2": "m2", "mass3": "m3", "gravity": "g"}


def _mistakes(kind: Kind) -> Iterator[tuple[int, str]]:
    """The place of a formula, and the formula with one wrong sign, zero, letter, function or angle."""
    for place, right in enumerate(kind.planted):
        if right != "0":
            yield from ((place, f"-({right})"), (place, "0"))
        for letters, slip in _SLIPS:
            for found in re.finditer(re.escape(letters), right):
                yield place, right[: found.start()] + slip + right[found.end() :]


@cache
def _compiled(formula: str) -> Any:
    return compile(formula, "planted", "eval")


def _value(formula: str, q: Floats, numbers: Mapping[str, float]) -> Floats:
    names: dict[str, Any] = {"q1": q[:, 0], "q2": q[:, 1], "q3": q[:, 2], "s": np.sin, "c": np.cos, **numbers}
    return np.broadcast_to(np.asarray(eval(_compiled(formula), names), float), (len(q),))


def _is_seen(kind: Kind, mistake: tuple[int, str], q: Floats, qd: Floats, numbers: Mapping[str, float]) -> bool:
    place, wrong = mistake
    error = _value(wrong, q, numbers) - _value(kind.planted[place], q, numbers)
    return bool(np.abs(error * kind.weights(qd, place % 3)).max() > 1e-9)


@cache
def _planted(kind: Kind) -> tuple[tuple[int, str], ...]:
    """The mistakes that change something somewhere."""
    random = np.random.default_rng(1)
    q, qd = random.uniform(-3, 3, (20, 3)), random.uniform(-3, 3, (20, 3))
    return tuple(one for one in _mistakes(kind) if _is_seen(kind, one, q, qd, _UNEQUAL))


def planted_and_seen(kind: Kind, q: Floats, qd: Floats, quantities: Mapping[str, float]) -> tuple[int, int]:
    """How many mistakes are planted in the lecture's formulas of a kind, and how many a test sees.

    Args:
        q, qd: the states of the test, (S, 3), in the convention simscape.
        quantities: those of the test's arm.
    """
    if not kind.planted:
        return 0, 0
    numbers = {_NAMES[name]: value for name, value in quantities.items() if name in _NAMES}
    planted = _planted(kind)
    return len(planted), sum(_is_seen(kind, one, q, qd, numbers) for one in planted)
