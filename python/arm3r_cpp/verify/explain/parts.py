"""The parts of a formula of the dynamics that depend on the angles alone: what stands before each product of rates."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations
from typing import NamedTuple

import numpy as np

from ..._native import Floats
from ..kinds import Kind

Vectors = dict[str, Floats]
"""Joint vectors "qd" and "qdd", (n,) each; one that is missing is zero."""


class Part(NamedTuple):
    """A factor of `words` in every entry: a sum of values of the formula, with weights, at some rates."""

    words: str
    """ "", "qd1^2", "qd1 qd2", "qdd3" """
    weights: tuple[tuple[float, Vectors], ...]
    factor: Callable[[Vectors], Floats]
    """The value of `words` at joint vectors (S, n)."""


def parts_of(kind: Kind, joints: int) -> list[Part]:
    """The parts of a kind of formula; a single one where it depends on nothing but the angles."""
    rest = Part("", ((1.0, {}),), lambda x: np.ones(len(x["q"])))
    if not kind.polynomial_in:
        return [rest]
    units = np.eye(joints)
    found = [_linear("qdd", j, units[j]) for j in range(joints) if "qdd" in kind.polynomial_in]
    found += [_square(j, units[j]) for j in range(joints)]
    found += [_mixed(j, k, units[j], units[k]) for j, k in combinations(range(joints), 2)]
    return [*found, *(_linear("qd", j, units[j]) for j in range(joints)), rest]


def _linear(vector: str, j: int, unit: Floats) -> Part:
    """The odd part; nothing of it is due before a rate, but a lost factor leaves one."""
    weights: tuple[tuple[float, Vectors], ...] = ((0.5, {vector: unit}), (-0.5, {vector: -unit}))
    return Part(f"{vector}{j + 1}", weights, lambda x: x[vector][:, j])


def _square(j: int, unit: Floats) -> Part:
    weights: tuple[tuple[float, Vectors], ...] = ((0.5, {"qd": unit}), (0.5, {"qd": -unit}), (-1.0, {}))
    return Part(f"qd{j + 1}^2", weights, lambda x: x["qd"][:, j] ** 2)


def _mixed(j: int, k: int, one: Floats, other: Floats) -> Part:
    weights: tuple[tuple[float, Vectors], ...] = tuple(
        (0.25 * first * second, {"qd": first * one + second * other}) for first in (1, -1) for second in (1, -1)
    )
    return Part(f"qd{j + 1} qd{k + 1}", weights, lambda x: x["qd"][:, j] * x["qd"][:, k])
