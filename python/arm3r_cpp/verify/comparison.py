"""A formula beside the truth: both at the same states and arms, entry by entry."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .._native import Floats
from ..errors import UsageError
from ..user_functions.programs import Edit, ProgramError
from .explain.frames import Frame, Pose
from .explain.repair import wrong_entries
from .formula import Formula
from .kinds import ANGULAR, KINDS, SPATIAL, Kind, Rows
from .samples import Samples, random_states
from .truth.three_r import FOLLOWING

TOLERANCE = 1e-9  # of an entry's scale
_ARMS, _STATES = 5, 8


class OtherShape(ProgramError):
    """The formula returned numbers in a shape that its kind has not."""

    def __init__(self, message: str, shape: tuple[int, ...]) -> None:
        super().__init__(message)
        self.shape = shape


@dataclass
class Comparison:
    """What a formula returns and what is due, for one kind of formula.

    `parameters` are the formula's names of quantities that are varied; the arm's own values stand in the first arm.
    """

    formula: Formula
    truth: Any
    kind: Kind
    parameters: dict[str, str]
    convention: str = ""
    follows: tuple[str, ...] = FOLLOWING[0]
    """What changes with a link's length: see `ThreeR.arm`."""
    rows: Rows = SPATIAL
    degrees: bool = False
    frame: Frame | None = None
    """That of a body or a space Jacobian, where a name says that it is one."""
    shape: tuple[int, ...] = ()
    error: float = 0.0
    """The median difference, relative to the entries' scales."""
    edited: dict[Any, Floats | None] = field(default_factory=dict)
    """What the formula returns at the first samples with edits: the same for all that it may mean."""

    def __post_init__(self) -> None:
        self.known = sorted(set(self.parameters.values()))
        self.call = self.formula.bind(self.kind, self.truth.joints, self.parameters, self.known)
        self.convention = self.convention or self.truth.convention
        random = np.random.default_rng(20)
        self.first, self.second, self.fresh = (self._samples(random, states) for states in (1, _STATES, _STATES))

    def _samples(self, random: np.random.Generator, states: int) -> Samples:
        """The arm itself, unless all of its states are in the other samples, and random arms."""
        if not self.known:
            return Samples(random_states(random, states if states == 1 else 2 * states, self.truth.joints), [{}])
        count = 1 if states == 1 else _ARMS
        arms = [self.truth.random_quantities(set(self.known), random) for _ in range(count)]
        return Samples(random_states(random, states, self.truth.joints), arms)

    @property
    def own(self) -> dict[str, float]:
        """The arm's own values of the quantities that are varied."""
        return {name: self.truth.values_of_quantities[name] for name in self.known}

    def values(self, samples: Samples, edit: Edit | None = None) -> Floats:
        """What the formula returns, in the form of the truth: (rows, ...).

        Raises:
            ProgramError: it failed, or returned what is no such formula.
        """
        if self.degrees:
            samples = Samples({**samples.states, "q": np.rad2deg(samples.states["q"])}, samples.arms)
        raw = self.formula.values(self.call, samples, self.known, edit)
        try:
            values = self.kind.standard_form(raw, self.truth.joints, samples.tiled("qd"))
        except UsageError as error:
            raise OtherShape(str(error), raw.shape[1:]) from None
        return self._unwrapped(values, samples) if self._has_angle else values

    @property
    def _has_angle(self) -> bool:
        """Whether a position has a row that is an angle, in a plane."""
        return not self.kind.is_derivative and len(self.rows) == 3 and self.rows[2] > 2

    def _unwrapped(self, values: Floats, samples: Samples) -> Floats:
        """With the angle in the turn in which it is due."""
        turn = 2 * np.pi
        off = np.round((values[:, 2] - self.due(samples)[:, 2]) / turn)
        return np.column_stack([values[:, :2], values[:, 2] - turn * off])

    def calls(self) -> int:
        """How many functions the formula calls at the first samples."""
        return self.formula.calls(self.call, self.first, self.known)

    def first_values(self, edit: Edit) -> Floats:
        """What the formula returns at the first samples with an edit, which is evaluated once.

        Raises:
            ProgramError: it failed.
        """
        key = (edit.start, edit.end, edit.new, self.degrees)
        if key not in self.edited:
            try:
                self.edited[key] = self.values(self.first, edit)
            except (ProgramError, ValueError):
                self.edited[key] = None
        values = self.edited[key]
        if values is None:
            raise ProgramError("the edit makes it fail")
        return values

    def due(
        self, samples: Samples, changes: Mapping[str, Floats] | None = None, states: Mapping[str, Floats] | None = None
    ) -> Floats:
        """What is right: (rows, ...).

        Args:
            changes: quantities with other values, in each row.
            states: other joint vectors, in each row.
        """
        values = self.due_of(self.kind, samples, states, changes)
        return self.frame.rows(values, self.pose(samples, states, changes)) if self.frame else values

    def pose(
        self,
        samples: Samples,
        states: Mapping[str, Floats] | None = None,
        changes: Mapping[str, Floats] | None = None,
    ) -> Pose:
        """Of the tip, the axes and the links: a link's axes are the tip's where all later joints are at zero."""
        q = (states or {}).get("q", samples.tiled("q"))
        rotation, *links = (
            self.truth.rotation(self.convention, np.where(np.arange(q.shape[1]) < moving, q, 0.0))
            for moving in (q.shape[1], *range(1, q.shape[1]))
        )
        position = self.due_of(KINDS["kinematics"], samples, states, changes, rows=SPATIAL)
        axes = self.due_of(KINDS["jacobian"], samples, states, changes, rows=ANGULAR)
        return Pose(rotation, position, axes, links)

    def due_of(
        self,
        kind: Kind,
        samples: Samples,
        states: Mapping[str, Floats] | None = None,
        changes: Mapping[str, Floats] | None = None,
        rows: Rows | None = None,
    ) -> Floats:
        """What is right of any kind of formula, by default in the rows of this one."""
        count = len(samples.states["q"])
        results = []
        for number, arm in enumerate(samples.arms):
            part = slice(number * count, (number + 1) * count)
            here = samples.states | {name: values[part] for name, values in (states or {}).items()}
            new = {name: float(values[part][0]) for name, values in (changes or {}).items()}
            quantities = {**arm, **new}
            results.append(
                self.truth.values(kind, self.convention, here, quantities, follows=self.follows, rows=rows or self.rows)
            )
        return np.concatenate(results)

    def wrong(self, values: Floats, samples: Samples, due: Floats | None = None) -> frozenset[int]:
        """The flat places of the entries that differ."""
        due = self.due(samples) if due is None else due
        if values.shape != due.shape:
            raise ProgramError(f"returns {_words(values.shape[1:])} numbers; it should return {_words(due.shape[1:])}")
        flat, right = (one.reshape(len(one), -1) for one in (values, due))
        return wrong_entries(flat, right, scales(right), TOLERANCE)

    def entry(self, place: int) -> list[int]:
        """[row, column] from 1."""
        return [int(one) + 1 for one in np.unravel_index(place, self.shape)]

    def given(self, samples: Samples) -> dict[str, Floats]:
        """The values of the varied quantities in each row; of the others, the arm's own."""
        count = len(samples.states["q"])
        own = self.truth.values_of_quantities
        return {name: np.repeat([arm.get(name, own[name]) for arm in samples.arms], count) for name in own}


@dataclass
class Solved(Comparison):
    """A formula of the forward dynamics, solved for the torque: q'' = A tau + b gives tau = A^-1 (q'' - b)."""

    @classmethod
    def of(cls, case: Comparison) -> Solved:
        names = ("formula", "truth", "kind", "parameters", "convention", "follows", "rows", "degrees", "shape")
        return cls(**{name: getattr(case, name) for name in names})

    def __post_init__(self) -> None:
        super().__post_init__()
        self.forward, self.kind = self.kind, KINDS["inverse"]

    def values(self, samples: Samples, edit: Edit | None = None) -> Floats:
        """The torque that makes the formula return samples' accelerations."""
        n = self.truth.joints
        torques = [np.zeros(n), *np.eye(n)]
        bias, *columns = (self._accelerations(samples, torque) for torque in torques)
        matrix = np.stack([column - bias for column in columns], axis=2)
        try:
            return np.asarray(np.linalg.solve(matrix, (samples.tiled("qdd") - bias)[..., None])[..., 0])
        except np.linalg.LinAlgError:
            raise ProgramError("does not depend on the torque") from None

    def _accelerations(self, samples: Samples, torque: Floats) -> Floats:
        states = {**samples.states, "tau": np.tile(torque, (len(samples.states["q"]), 1))}
        here = Samples(states, samples.arms)
        return self.forward.standard_form(
            self.formula.values(self.call, here, self.known), len(torque), here.tiled("qd")
        )


def scales(due: Floats) -> Floats:
    """The scale of each entry: its largest value, and where it is zero that of all entries."""
    largest = np.abs(due).max(axis=0)
    whole = largest.max() if largest.size else 1.0
    return np.where(largest > 1e-9 * whole, largest, whole if whole else 1.0)


def _words(shape: tuple[int, ...]) -> str:
    return "x".join(map(str, shape)) or "1"
