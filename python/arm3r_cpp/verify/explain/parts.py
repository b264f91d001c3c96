"""The parts of a formula of the dynamics that depend on the angles alone: what stands before each product of rates."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations
from typing import NamedTuple

import numpy as np

from ..._native import Floats

Vectors = dict[str, Floats]
"""Joint vectors "qd" and "qdd", (n,) each; one that is missing is zero."""


class Part(NamedTuple):
    """A factor of `words` in every entry: a sum of values of the formula, with weights, at some rates."""

    words: str
    """ "", "qd1^2", "qd1 qd2", "qdd3" """
    weights: tuple[tuple[float, Vectors], ...]
    factor: Callable[[Vectors], Floats]
    """The value of `words` at joint vectors (S, n)."""


def parts_of(kind: str, joints: int) -> list[Part]:
    """The parts of a kind of formula; a single one where it depends on nothing but the angles."""
    units = np.eye(joints)
    rest: tuple[tuple[float, Vectors], ...] = ((-1.0, {}),)
    if kind not in ("coriolis", "inverse"):
        return [Part("", ((1.0, {}),), lambda x: np.ones(len(x["q"])))]
    found = []
    for j in range(joints):
        square = ((1.0, {"qd": units[j]}), *rest)
        found.append(Part(f"qd{j + 1}^2", square, lambda x, j=j: x["qd"][:, j] ** 2))  # type: ignore[misc]
    for j, k in combinations(range(joints), 2):
        mixed: tuple[tuple[float, Vectors], ...] = (
            (1.0, {"qd": units[j] + units[k]}),
            (-1.0, {"qd": units[j]}),
            (-1.0, {"qd": units[k]}),
            (1.0, {}),
        )
        found.append(Part(f"qd{j + 1} qd{k + 1}", mixed, lambda x, j=j, k=k: x["qd"][:, j] * x["qd"][:, k]))  # type: ignore[misc]
    if kind == "coriolis":
        return found
    masses = [
        Part(f"qdd{j + 1}", ((1.0, {"qdd": units[j]}), *rest), lambda x, j=j: x["qdd"][:, j])  # type: ignore[misc]
        for j in range(joints)
    ]
    return [*masses, *found, Part("", ((1.0, {}),), lambda x: np.ones(len(x["q"])))]
