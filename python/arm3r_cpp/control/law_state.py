"""What a control law of your own sees."""

from __future__ import annotations

from typing import Any, NoReturn

from .. import _native
from .._native import Floats


class _Over:
    def __getattr__(self, name: str) -> NoReturn:
        raise RuntimeError("this state is over: it holds during its tick only; keep its numbers, such as state.q")


OVER: Any = _Over()  # what a state has after its tick


def state_of(memory: _native.StateMemory) -> LawState:
    """A state that sees what stands in a memory."""
    state = LawState.__new__(LawState)
    state._now = memory
    return state


class LawState:
    """What the controller sees at a sample: what the scenario's sensors read, and what follows from it.

    Without a sensors section that is the truth. Joint vectors are in the arm's convention, vectors in space in base
    axes; arrays are copies, the caller's own.
    """

    __slots__ = ("_now",)

    _now: _native.StateMemory

    @property
    def tick(self) -> int:
        """Samples before this one."""
        return int(self._now.struct.tick)

    @property
    def t(self) -> float:
        """s"""
        return self._now.struct.t

    @property
    def period(self) -> float:
        """From sample to sample, s."""
        return self._now.struct.period

    @property
    def q(self) -> Floats:
        """Joint angles: (3,), rad."""
        return self._now.q.copy()

    @property
    def qd(self) -> Floats:
        """Joint rates: (3,), rad/s."""
        return self._now.qd.copy()

    @property
    def tip(self) -> Floats:
        """Position of the tip at this q: (3,), m."""
        return self._now.tip.copy()

    @property
    def tip_velocity(self) -> Floats:
        """J qd: (3,), m/s."""
        return self._now.tip_velocity.copy()

    @property
    def jacobian(self) -> Floats:
        """J at this q: (3, 3), m."""
        return self._now.jacobian.copy()

    @property
    def tau_g(self) -> Floats:
        """Torque that holds the arm at this q: (3,), N m."""
        return self._now.tau_g.copy()

    @property
    def f_on_tip(self) -> Floats:
        """Contact force on the tip: (3,), N."""
        return self._now.f_on_tip.copy()

    @property
    def contact(self) -> bool:
        """Whether that force says contact: from more than 1 N of pressing until less than 0.5 N."""
        return self._now.struct.contact > 0

    @property
    def wall_normal(self) -> Floats:
        """From the wall towards the arm: (3,), unit; without a wall 0."""
        return self._now.wall_normal.copy()

    @property
    def wall_point(self) -> Floats:
        """A point of the wall's face: (3,), m; without a wall 0."""
        return self._now.wall_point.copy()

    @property
    def wall_velocity(self) -> Floats:
        """Of the wall's frame: (3,), m/s; without a wall 0."""
        return self._now.wall_velocity.copy()

    @property
    def residual(self) -> Floats:
        """External torque as the momentum observer has it: (3,), N m; without one 0."""
        return self._now.residual.copy()

    @property
    def collision(self) -> bool:
        """Whether the observer takes a collision for going on."""
        return self._now.struct.collision > 0

    @property
    def stiffness_estimate(self) -> float:
        """Of the wall, by the estimator, N/m; 0 without one, or where it is not identifiable."""
        return self._now.struct.stiffness_estimate

    @property
    def wall_speed_estimate(self) -> float:
        """Of the wall towards the arm, likewise, m/s."""
        return self._now.struct.wall_speed_estimate

    @property
    def identifiable(self) -> bool:
        """Whether the data tell the two apart."""
        return self._now.struct.identifiable > 0

    @property
    def q_true(self) -> Floats:
        """What q is, which no controller knows: (3,), rad."""
        return self._now.q_true.copy()

    @property
    def qd_true(self) -> Floats:
        """What qd is: (3,), rad/s."""
        return self._now.qd_true.copy()

    @property
    def f_on_tip_true(self) -> Floats:
        """What f_on_tip is: (3,), N."""
        return self._now.f_on_tip_true.copy()
