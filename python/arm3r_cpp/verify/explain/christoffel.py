"""Coriolis torques of Christoffel symbols with other indices, signs or factors."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import product

import numpy as np

from ..._native import Floats

_RIGHT = (1.0, -0.5)
"""Factors of (dM/dt) qd and of d(qd^T M qd)/dq."""
_WRONG = [
    (first, second)
    for first, second in product((0.0, 0.5, 1.0), (-1.0, -0.5, 0.0, 0.5, 1.0))
    if first != -2 * second  # else it is a multiple of what is right
]


def of_other_indices(torque: Callable[[Floats], Floats], qd: Floats) -> Iterator[tuple[str, Callable[[], Floats]]]:
    """(dM/dt) qd - 1/2 d(qd^T M qd)/dq with other factors: whatever indices are mixed up, the sum is one of these.

    Args:
        torque: what is right at rates (S, n); a quadratic form, whose values at sums and differences of rates give its
            derivatives with respect to them.
        qd: the rates, (S, n).
    """
    due = torque(qd)
    of_energy = np.empty_like(due)  # d(qd^T M qd)/dq
    for joint, unit in enumerate(np.eye(qd.shape[1])):
        mixed = (torque(qd + unit) - torque(qd - unit)) / 4
        of_energy[:, joint] = 2 * np.einsum("si,si->s", qd, mixed)
    of_momentum = due + of_energy / 2  # (dM/dt) qd
    for first, second in _WRONG:
        words = f"the result is {_sum(first, second)}; it should be {_sum(*_RIGHT)}"
        values = partial(np.add, first * of_momentum, second * of_energy)
        yield f"the Christoffel symbols have other indices or signs: {words}", values


def _sum(first: float, second: float) -> str:
    terms = [(first, "dM/dt qd"), (second, "d(qd^T M qd)/dq")]
    parts = [("-" if factor < 0 else "+", "1/2 " * (abs(factor) == 0.5) + word) for factor, word in terms if factor]
    return " ".join(f"{sign} {word}" for sign, word in parts).removeprefix("+ ")
