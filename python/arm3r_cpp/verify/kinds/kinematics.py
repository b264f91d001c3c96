"""The tip's position (2.3)."""

from __future__ import annotations

import numpy as np

from ..._native import Floats
from ...errors import UsageError
from .kind import Kind, Model, Rows, States


class Kinematics(Kind):
    """f(q) -> (3,), or a transform (4, 4), m."""

    name, words, letter = "kinematics", "tip position", "p"
    inputs, unit, shapes, planar_shape = ("q",), "m", ("3", "4x4"), "2"
    comes_with = ("kinematics", "jacobian", "jacobian_dot")
    called = ("kin", "fk", "tip", "position", "pose", "effector")
    columns, columns_words = r"(?:p_?|tip_)([123xyz])", "p1.."
    is_logged_anyway = True
    needs_masses, depends_on_base = False, True
    quantities = ("length2", "length3", "height")
    monomials = (("length2",), ("length3",), ("height",))

    def due(self, arm: Model, states: States, rows: Rows) -> Floats:
        return arm.tip_position(states["q"])[:, list(rows)]

    def _compared(self, values: Floats, qd: Floats | None) -> Floats:
        """
        Raises:
            UsageError: a matrix is no transform.
        """
        if values.ndim < 3:
            return values
        if np.abs(values[:, 3] - [0, 0, 0, 1]).max() > 1e-9:  # NaN shows nothing
            raise UsageError("returns a 4x4 matrix whose last row is not 0 0 0 1")
        return values[:, :3, 3]
