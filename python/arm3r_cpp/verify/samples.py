"""States and arms at which formulas are compared: generic ones, none of them in a special pose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .._native import Floats

VECTORS = ("q", "qd", "qdd", "tau")
STATE = "state"
"""q and qd in one vector, as a solver of differential equations has them."""


@dataclass
class Samples:
    """Joint vectors (S, n), and for each arm the quantities that differ from the arm's own."""

    states: dict[str, Floats]
    arms: list[dict[str, float]]

    def __len__(self) -> int:
        return len(self.states["q"]) * len(self.arms)

    def table(self, names: list[str]) -> Floats:
        """A row for each arm and state: q, qd, qdd, tau, then the arm's quantities in the order of names."""
        joints = np.concatenate([self.states[vector] for vector in VECTORS], axis=1)
        numbers = np.array([[arm[name] for name in names] for arm in self.arms]).reshape(len(self.arms), len(names))
        return np.concatenate([np.tile(joints, (len(self.arms), 1)), np.repeat(numbers, len(joints), axis=0)], axis=1)

    def tiled(self, vector: str) -> Floats:
        """A joint vector in each row of the table."""
        return np.tile(self.states[vector], (len(self.arms), 1))


def columns(vector: str, joints: int) -> tuple[int, ...]:
    """Where a joint vector stands in the table."""
    if vector == STATE:
        return (*columns("q", joints), *columns("qd", joints))
    first = VECTORS.index(vector) * joints
    return tuple(range(first, first + joints))


def random_states(random: np.random.Generator, count: int, joints: int) -> dict[str, Floats]:
    """Angles in (-3, 3), rates and accelerations in (-2, 2), torques in (-5, 5)."""
    ranges = {"q": 3.0, "qd": 2.0, "qdd": 2.0, "tau": 5.0}
    return {vector: random.uniform(-limit, limit, (count, joints)) for vector, limit in ranges.items()}
