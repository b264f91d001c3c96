"""The inverse dynamics (3.1)."""

from __future__ import annotations

from ..._native import Floats
from .kind import Kind, Model, Rows, States, times_each, times_rates


class Inverse(Kind):
    """f(q, qd, qdd) -> (n,), N m."""

    name, words, letter = "inverse", "inverse dynamics", "t"
    inputs, unit, shapes = ("q", "qd", "qdd"), "N m", ("n",)
    comes_with = ("mass", "coriolis", "gravity", "inverse")
    called = ("inverse_dyn", "invdyn", "id", "rnea", "inverse")
    columns, columns_words = r"tau(\d)", "tau1.."
    is_logged_anyway = True
    depends_on_gravity, depends_on_inertia, has_friction = True, True, True
    has_products, polynomial_in = True, ("qd", "qdd")

    def due(self, arm: Model, states: States, rows: Rows) -> Floats:
        return arm.inverse_dynamics(states["q"], states["qd"], states["qdd"])

    def features(self, first: Floats, second: Floats, states: States) -> list[Floats]:
        return [*times_rates(second, states["qd"]), *times_each(second, states["qdd"]), first]
