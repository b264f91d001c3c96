"""The geometric Jacobian of the tip (2.4)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..._native import Floats
from .kind import Kind, Model, Rows, States


class Jacobian(Kind):
    """f(q) -> (3, n), or (6, n) with linear rows first."""

    name, words, letter = "jacobian", "jacobian", "J"
    inputs, unit, shapes, planar_shape = ("q",), "m", ("3xn", "6xn"), "2xn"
    comes_with = ("kinematics", "jacobian", "jacobian_dot")
    called, letters = ("jac",), ("j",)
    columns, columns_words = r"J_?[(\[]?(\d)[_,]?(\d)[)\]]?", "J11.."
    needs_masses, depends_on_base, is_derivative = False, True, True
    quantities = ("length2", "length3")
    monomials = (("length2",), ("length3",))
    planted = (
        "-s(q1)*(a3*c(q2+q3)+a2*c(q2))", "-c(q1)*(a3*s(q2+q3)+a2*s(q2))", "-a3*s(q2+q3)*c(q1)",
        "c(q1)*(a3*c(q2+q3)+a2*c(q2))", "-s(q1)*(a3*s(q2+q3)+a2*s(q2))", "-a3*s(q2+q3)*s(q1)",
        "0", "-(a3*c(q2+q3)+a2*c(q2))", "-a3*c(q2+q3)",
    )  # fmt: skip

    def due(self, arm: Model, states: States, rows: Rows) -> Floats:
        return arm.geometric_jacobian(states["q"])[:, list(rows)]

    def weights(self, qd: Floats, column: int) -> Floats:
        """J is seen as J qd."""
        return qd[:, column]

    def lecture_test(self, free_fall: Callable[..., Any]) -> tuple[str, Floats, Floats]:
        """J qd against the sensed velocity in free fall."""
        run = free_fall()
        return "the lecture's free fall", run["q"][::20], run["qd"][::20]
