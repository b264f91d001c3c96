"""The torque that holds the arm (3.5)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..._native import Floats
from .kind import Kind, Model, Rows, States


class Gravity(Kind):
    """f(q) -> (n,), N m."""

    name, words, letter = "gravity", "gravity torque", "t"
    inputs, unit, shapes = ("q",), "N m", ("n",)
    comes_with = ("mass", "coriolis", "gravity")
    called, letters = ("grav", "tau_g", "taug", "g_torque"), ("g",)
    columns, columns_words = r"(?:g|tau_g)_?(\d)", "g1.."
    depends_on_gravity = True
    quantities = ("length2", "length3", "mass2", "mass3", "gravity")
    monomials = tuple((f"mass{i}", "gravity", f"length{j}") for i in (2, 3) for j in (2, 3))
    planted = ("0", "-m2*g*(a2/2)*c(q2)-m3*g*(a2*c(q2)+(a3/2)*c(q2+q3))", "-m3*g*(a3/2)*c(q2+q3)")

    def due(self, arm: Model, states: States, rows: Rows) -> Floats:
        return arm.gravity_torque(states["q"])

    def lecture_test(self, free_fall: Callable[..., Any]) -> tuple[str, Floats, Floats]:
        """The torque in two poses that it holds."""
        poses = np.radians([[0.0, -30.0, 60.0], [0.0, -45.0, 90.0]])
        return "the lecture's two holds", poses, np.zeros_like(poses)
