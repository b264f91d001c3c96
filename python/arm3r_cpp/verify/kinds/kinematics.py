"""The tip's position (2.3)."""

from __future__ import annotations

from ..._native import Floats
from .kind import Kind, Model, Rows, States


class Kinematics(Kind):
    """f(q) -> (3,), or a transform (4, 4), m."""

    name, words, letter = "kinematics", "tip position", "p"
    inputs, unit, shapes, planar_shape = ("q",), "m", ("3", "4x4"), "2"
    called = ("kin", "fk", "tip", "position", "pose", "effector")
    columns, columns_words = r"(?:p_?|tip_)([123xyz])", "p1.."
    is_logged_anyway = True
    needs_masses, depends_on_base = False, True
    quantities = ("length2", "length3", "height")
    monomials = (("length2",), ("length3",), ("height",))

    def due(self, arm: Model, states: States, rows: Rows) -> Floats:
        return arm.tip_position(states["q"])[:, list(rows)]

    def _compared(self, values: Floats, qd: Floats | None) -> Floats:
        return values[:, :3, 3] if values.ndim == 3 else values
