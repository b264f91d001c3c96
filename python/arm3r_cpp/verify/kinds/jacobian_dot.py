"""The rate of the geometric Jacobian (2.6)."""

from __future__ import annotations

from ..._native import Floats
from .kind import Kind, Model, Rows, States


class JacobianDot(Kind):
    """f(q, qd) -> (3, n), or (6, n) with linear rows first."""

    name, words, letter = "jacobian_dot", "rate of the jacobian", "Jdot"
    inputs, unit, shapes, planar_shape = ("q", "qd"), "m/s", ("3xn", "6xn"), "2xn"
    comes_with = ("kinematics", "jacobian", "jacobian_dot")
    called = (
        "jdot", "j_dot", "jacobian_dot", "jacobiandot", "jac_dot", "_djac", "_d_jac", "jacobian_rate", "jacobianrate",
        "jacobian_deriv", "jacobianderiv", "jacobian_time",
    )  # fmt: skip
    letters = ("dj", "jd")
    needs_masses, depends_on_base, is_derivative = False, True, True
    quantities = ("length2", "length3")
    polynomial_in = ("qd",)

    def due(self, arm: Model, states: States, rows: Rows) -> Floats:
        return arm.geometric_jacobian_dot(states["q"], states["qd"])[:, list(rows)]
