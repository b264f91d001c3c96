"""The forward dynamics (3.8)."""

from __future__ import annotations

import numpy as np

from ..._native import Floats
from ...errors import UsageError
from .kind import Kind, Model, Rows, States, times_each, times_rates


class Forward(Kind):
    """f(q, qd, tau) -> (n,), or the derivative (2n,) of the state (q, qd); rad/s^2."""

    name, words, letter = "forward", "forward dynamics", "qdd"
    inputs: tuple[str, ...] = ("q", "qd", "tau")
    unit, shapes = "rad/s^2", ("n", "2n")
    called = ("forward_dyn", "fwddyn", "fd", "aba", "accel")
    columns, columns_words = r"qdd(\d)", "qdd1.."
    is_logged_anyway = True
    depends_on_gravity, depends_on_inertia = True, True
    is_read = is_linear = False

    def due(self, arm: Model, states: States, rows: Rows) -> Floats:
        return arm.forward_dynamics(states["q"], states["qd"], states["tau"])

    def features(self, first: Floats, second: Floats, states: States) -> list[Floats]:
        return [*times_rates(second, states["qd"]), *times_each(second, states["tau"]), second]

    def taking(self, vectors: set[str]) -> Kind:
        return WithoutTorque() if "qd" in vectors and "tau" not in vectors else self

    def _compared(self, values: Floats, qd: Floats | None) -> Floats:
        """The accelerations of the derivative of a state.

        Raises:
            UsageError: its first half is not qd.
        """
        if qd is None or values.shape[1] == qd.shape[1]:
            return values
        joints = qd.shape[1]
        if not np.allclose(values[:, :joints], qd, rtol=1e-9, atol=1e-9):
            raise UsageError(
                f"returns {2 * joints} numbers, the derivative of the state (q, qd), and the first half is not qd"
            )
        return values[:, joints:]


class WithoutTorque(Forward):
    """f(q, qd), or f(t, x): of an arm that no torque drives, as an integrator calls it."""

    inputs = ("q", "qd")

    def due(self, arm: Model, states: States, rows: Rows) -> Floats:
        return super().due(arm, {**states, "tau": np.zeros_like(states["q"])}, rows)

    def features(self, first: Floats, second: Floats, states: States) -> list[Floats]:
        return [*times_rates(second, states["qd"]), second]
