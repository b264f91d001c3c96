"""What a control law that a user writes sees at a sample."""

from __future__ import annotations

from typing import Any, NoReturn

from .. import _native
from .._native import Floats


class _Over:
    def __getattr__(self, name: str) -> NoReturn:
        raise RuntimeError("this state is over: it holds during its tick only; keep its numbers, such as state.q")


OVER: Any = _Over()  # what a state has after its tick


def state_of(memory: _native.StateMemory) -> LawState:
    """The state that reads its numbers from a memory."""
    state = LawState.__new__(LawState)
    read_from(state, memory)
    return state


def read_from(state: LawState, memory: _native.StateMemory) -> None:
    """Let a state read its numbers from another memory; OVER: from none any more."""
    state._now = memory


class LawState:
    """What the controller sees at a sample: the readings of the scenario's sensors, and what is computed from them.

    Without a `sensors` section the readings are the true values. Joint vectors follow the arm's convention, and vectors
    in space are in base axes. Every array is a copy that the caller may keep and change.
    """

    __slots__ = ("_now",)

    _now: _native.StateMemory

    @property
    def tick(self) -> int:
        """The number of samples before this one."""
        return int(self._now.struct.tick)

    @property
    def t(self) -> float:
        """The time of the sample, s."""
        return self._now.struct.t

    @property
    def period(self) -> float:
        """The time from one sample to the next, s."""
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
        """The position of the tip at this q: (3,), m."""
        return self._now.tip.copy()

    @property
    def tip_velocity(self) -> Floats:
        """The velocity of the tip, J qd: (3,), m/s."""
        return self._now.tip_velocity.copy()

    @property
    def jacobian(self) -> Floats:
        """The Jacobian of the tip's position at this q: (3, 3), m."""
        return self._now.jacobian.copy()

    @property
    def tau_g(self) -> Floats:
        """The torque that holds the arm at this q: (3,), N m."""
        return self._now.tau_g.copy()

    @property
    def f_on_tip(self) -> Floats:
        """The contact force on the tip: (3,), N."""
        return self._now.f_on_tip.copy()

    @property
    def contact(self) -> bool:
        """Whether that force says contact: from more than 1 N of pressing until less than 0.5 N."""
        return self._now.struct.contact > 0

    @property
    def wall_normal(self) -> Floats:
        """The unit vector from the wall towards the arm: (3,); without a wall 0."""
        return self._now.wall_normal.copy()

    @property
    def wall_point(self) -> Floats:
        """A point of the wall's face: (3,), m; without a wall 0."""
        return self._now.wall_point.copy()

    @property
    def wall_velocity(self) -> Floats:
        """The velocity of the wall's frame: (3,), m/s; without a wall 0."""
        return self._now.wall_velocity.copy()

    @property
    def residual(self) -> Floats:
        """The external torque that the momentum observer estimates: (3,), N m; without an observer 0."""
        return self._now.residual.copy()

    @property
    def collision(self) -> bool:
        """Whether the observer reports a collision."""
        return self._now.struct.collision > 0

    @property
    def stiffness_estimate(self) -> float:
        """The stiffness of the wall that the estimator found, N/m; 0 without an estimator, or if not identifiable."""
        return self._now.struct.stiffness_estimate

    @property
    def stiffness_sigma(self) -> float:
        """The standard deviation of the estimated stiffness, N/m; 0 where the stiffness is not identifiable."""
        return self._now.struct.stiffness_sigma

    @property
    def wall_speed_estimate(self) -> float:
        """The speed of the wall towards the arm that the estimator found, m/s; 0 where the stiffness is."""
        return self._now.struct.wall_speed_estimate

    @property
    def identifiable(self) -> bool:
        """Whether the data determine both stiffness and speed."""
        return self._now.struct.identifiable > 0

    @property
    def q_true(self) -> Floats:
        """The true joint angles, without sensor errors: (3,), rad."""
        return self._now.q_true.copy()

    @property
    def qd_true(self) -> Floats:
        """The true joint rates: (3,), rad/s."""
        return self._now.qd_true.copy()

    @property
    def f_on_tip_true(self) -> Floats:
        """The true contact force on the tip: (3,), N."""
        return self._now.f_on_tip_true.copy()
