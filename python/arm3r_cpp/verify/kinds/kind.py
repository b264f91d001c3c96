"""What every kind of formula has."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from copy import copy
from itertools import combinations_with_replacement
from typing import Any, Protocol, TypeVar

import numpy as np

from ..._native import Floats
from ...errors import UsageError

Rows = tuple[int, ...]
"""Rows of a Jacobian, linear ones first, or of a position: 0 to 2 along the base's axes, 3 to 5 about them."""
SPATIAL: Rows = (0, 1, 2)
ANGULAR: Rows = (3, 4, 5)
States = Mapping[str, Floats]
"""Joint vectors "q", "qd", "qdd", "tau", each (S, n)."""
AnyKind = TypeVar("AnyKind", bound="Kind")


class Model(Protocol):
    """An arm, as the kinds of formulas ask it: joint vectors (S, n) in, arrays of S rows out."""

    def tip_position(self, q: Floats, /) -> Floats:
        """(S, 3), m; behind it there may be the angles about the base's axes."""

    def geometric_jacobian(self, q: Floats, /) -> Floats:
        """(S, 6, n), linear rows first."""

    def geometric_jacobian_dot(self, q: Floats, qd: Floats, /) -> Floats:
        """Its rate, (S, 6, n)."""

    def gravity_torque(self, q: Floats, /) -> Floats: ...
    def mass_matrix(self, q: Floats, /) -> Floats: ...
    def velocity_product(self, q: Floats, qd: Floats, /) -> Floats: ...
    def inverse_dynamics(self, q: Floats, qd: Floats, qdd: Floats, /) -> Floats: ...
    def forward_dynamics(self, q: Floats, qd: Floats, tau: Floats, /) -> Floats: ...
    def law_torque(self, q: Floats, qd: Floats, /) -> Floats:
        """The torque of the law that controls it, (S, n)."""


class Kind(ABC):
    """A kind of formula of an arm with n joints."""

    name: str
    words: str
    """What sentences call it."""
    inputs: tuple[str, ...]
    """The joint vectors that it depends on: "q", "qd", "qdd", "tau"."""
    unit: str
    shapes: tuple[str, ...]
    """The shapes that it may return; the first one is that of the truth."""
    planar_shape: str = ""
    """Another one that it may return for an arm that moves in a plane."""
    letter: str
    """What its entries are called."""

    # ---- by which names it is found ----
    called: tuple[str, ...]
    """Parts of the names of functions; those that begin with _ stand behind one, or first."""
    letters: tuple[str, ...] = ()
    """Whole names of functions and outputs."""
    letters_beside: tuple[str, ...] = ()
    """Names of an output with others beside it whose names tell their kinds, as textbooks have them."""
    columns: str = ""
    """The columns of a log that are its entries, a regular expression; "" where none are."""
    columns_words: str = ""
    is_logged_anyway = False
    """Whether a log of other entries may have them, too: what an arm measures."""

    # ---- what it depends on ----
    needs_masses = True
    depends_on_gravity = False
    depends_on_base = False
    """On where the base stands."""
    depends_on_inertia = False
    has_friction = False
    """Whether what is measured of it holds the friction of the joints."""
    is_of_arm = True
    """Whether the arm alone tells what is due; else a law does, whose numbers are not the arm's."""

    # ---- what its entries are made of ----
    is_read = True
    """Whether its entries are sums of sines and cosines of the angles, with monomials of the arm's numbers."""
    order = 1
    """The highest sine or cosine of an angle in them."""
    quantities: tuple[str, ...] = ()
    """The arm's numbers in which a correct formula is written where its text does not tell; (): those that it has."""
    monomials: tuple[tuple[str, ...], ...] = ()
    """The products of the arm's numbers in them, where they are few."""
    has_products = False
    """Whether products of masses and lengths, and inertias, stand in them."""
    polynomial_in: tuple[str, ...] = ()
    """The joint vectors of which they are polynomials."""
    is_derivative = False
    """Whether its columns are derivatives with respect to the angles, and its rows components of vectors."""
    is_linear = True
    """Whether it is linear in masses and inertias."""
    is_product = False
    """Whether a matrix of it is judged by its product with the rates."""
    comes_with: tuple[str, ...] = ()
    """The kinds that a function returns with it, `M, C, g = dynamics(q, qd)`: their names may be letters, and it takes
    what any of them depends on."""
    planted: tuple[str, ...] = ()
    """The lecture's own formulas of its entries, row by row, of a2, a3, m2, m3, g, c(...), s(...), q1 to q3."""

    @property
    def a_words(self) -> str:
        """`words` with their article."""
        return self.words if self.words.endswith("dynamics") else f"a {self.words}"

    @abstractmethod
    def due(self, arm: Any, states: States, rows: Rows) -> Floats:
        """What is right at the states, (S, ...).

        Args:
            arm: a `Model`, with those of its functions that the kind needs.
            rows: of a Jacobian or a position.
        """

    def features(self, first: Floats, second: Floats, states: States) -> list[Floats]:
        """What the terms of its entries are made of: blocks of columns, (S, ...) each.

        Args:
            first, second: the sines and cosines of the angles up to the first and up to the second order.
        """
        return [first if self.order == 1 else second]

    def weights(self, qd: Floats, column: int) -> Floats:
        """What an entry of a column is multiplied with in a test before it is seen, (S,)."""
        return np.ones(len(qd))

    def lecture_test(self, free_fall: Callable[..., Any]) -> tuple[str, Floats, Floats] | None:
        """The lecture's own test: its name, and the states, q and qd (S, 3).

        Args:
            free_fall: gives the run of the lecture's free fall.
        """
        return None

    def in_plane(self: AnyKind) -> AnyKind:
        """The kind with what a formula of an arm that moves in a plane may return, too."""
        other = copy(self)
        other.shapes = (*self.shapes, *([self.planar_shape] if self.planar_shape else []))
        return other

    def taking(self, vectors: set[str]) -> Kind:
        """The kind of a formula whose arguments are these joint vectors."""
        return self

    def entry_name(self, entry: Sequence[int]) -> str:
        """J(2,3), t1, M(1,2) ..."""
        return f"{self.letter}({','.join(map(str, entry))})" if len(entry) > 1 else f"{self.letter}{entry[0]}"

    def standard_form(self, values: Floats, joints: int, qd: Floats | None) -> Floats:
        """What a formula returned, (S, ...), in the shape in which it is compared.

        Raises:
            UsageError: the shape is none that the kind has.
        """
        shape = values.shape[1:]
        allowed = [_numbers(word, joints) for word in self.shapes]
        if shape in allowed:
            return self._compared(values, qd)
        vector = next((one for one in allowed if len(one) == 1 and one in ((shape[:1]), shape[1:])), None)
        if len(shape) == 2 and 1 in shape and vector:
            return values.reshape(len(values), *vector)
        flat = next((one for one in allowed if shape == (int(np.prod(one)),)), None)
        if flat is None:
            names = " or ".join("x".join(map(str, one)) for one in allowed)
            got = "x".join(map(str, shape)) or "1"
            raise UsageError(f"returns {got} number{'s' * (got != '1')}, where {self.a_words} has {names}")
        return values.reshape(len(values), *flat)

    def joints_of(self, shape: tuple[int, ...]) -> int:
        """How many joints an arm has whose formulas have this shape; 0: none of up to ten, or any."""
        words = [word for word in (*self.shapes, self.planar_shape) if "n" in word]
        return next((n for n in range(1, 11) if any(_numbers(word, n) == shape for word in words)), 0)

    def is_planar(self, shape: tuple[int, ...], joints: int) -> bool:
        """Whether it is that of an arm with so many joints that moves in a plane."""
        return bool(self.planar_shape) and _numbers(self.planar_shape, joints) == shape

    def _compared(self, values: Floats, qd: Floats | None) -> Floats:
        """What is compared of values in one of the kind's shapes."""
        return values


def _numbers(word: str, joints: int) -> tuple[int, ...]:
    """The shape that "3xn" means for an arm with so many joints."""
    return tuple(joints * int(part[:-1] or 1) if part.endswith("n") else int(part) for part in word.split("x"))


def times_rates(second: Floats, qd: Floats) -> list[Floats]:
    """Columns times each product of two rates."""
    pairs = combinations_with_replacement(range(qd.shape[1]), 2)
    return [second * (qd[:, i] * qd[:, j])[:, None] for i, j in pairs]


def times_each(columns: Floats, vector: Floats) -> list[Floats]:
    """Columns times each element of a joint vector."""
    return [columns * vector[:, [joint]] for joint in range(vector.shape[1])]
