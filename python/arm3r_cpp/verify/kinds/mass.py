"""The mass matrix (3.3)."""

from __future__ import annotations

from ..._native import Floats
from .kind import Kind, Model, Rows, States


class Mass(Kind):
    """f(q) -> (n, n), kg m^2."""

    name, words, letter = "mass", "mass matrix", "M"
    inputs, unit, shapes = ("q",), "kg m^2", ("nxn",)
    comes_with = ("mass", "coriolis", "gravity")
    called, letters = ("mass", "inertia", "mmat"), ("m",)
    letters_beside = ("a", "b", "d", "h")
    columns, columns_words = r"M_?[(\[]?(\d)[_,]?(\d)[)\]]?", "M11.."
    depends_on_inertia = True
    order, has_products = 2, True

    def due(self, arm: Model, states: States, rows: Rows) -> Floats:
        return arm.mass_matrix(states["q"])
