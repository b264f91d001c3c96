"""The Coriolis and centrifugal torque (3.4)."""

from __future__ import annotations

import numpy as np

from ..._native import Floats
from .kind import Kind, Model, Rows, States, times_rates


class Coriolis(Kind):
    """f(q, qd) -> (n,), or a matrix (n, n), which is not unique: it is judged by its product with qd; N m."""

    name, words, letter = "coriolis", "Coriolis and centrifugal torque", "h"
    inputs, unit, shapes = ("q", "qd"), "N m", ("n", "nxn")
    comes_with = ("mass", "coriolis", "gravity")
    called, letters = ("coriolis", "centrifugal", "cmat", "velocity_product"), ("c", "h")
    columns, columns_words = r"h_?(\d)", "h1.."
    depends_on_inertia = True
    has_products, polynomial_in, is_product = True, ("qd",), True

    def due(self, arm: Model, states: States, rows: Rows) -> Floats:
        return arm.velocity_product(states["q"], states["qd"])

    def features(self, first: Floats, second: Floats, states: States) -> list[Floats]:
        return times_rates(second, states["qd"])

    def _compared(self, values: Floats, qd: Floats | None) -> Floats:
        return np.einsum("nij,nj->ni", values, qd) if values.ndim == 3 and qd is not None else values
