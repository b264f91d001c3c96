"""A control law."""

from __future__ import annotations

from ..._native import Floats
from .kind import Kind, Model, Rows, States


class Controller(Kind):
    """f(q, qd) -> (n,), N m, as the law of a scenario at its start."""

    name, words, letter = "controller", "controller", "t"
    inputs, unit, shapes = ("q", "qd"), "N m", ("n",)
    called = ("control", "law", "ctrl")
    is_of_arm, is_read = False, False

    def due(self, arm: Model, states: States, rows: Rows) -> Floats:
        return arm.law_torque(states["q"], states["qd"])
