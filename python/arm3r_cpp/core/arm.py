"""The arm's kinematics and dynamics, for one state or for millions in one call."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from textwrap import indent
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from .._native import Floats, ffi, lib
from ..answers.meant_names import Answering, no_attribute
from .params import numbers_of, param_defaults


class Arm(metaclass=Answering):
    """An arm: every function takes (..., 3) arrays, broadcasts them over the leading axes and returns new arrays.

    Joint vectors q, qd, qdd (rad, rad/s, rad/s^2) and tau (N m) follow the arm's convention; points, velocities and
    forces are in base axes. Without leading axes a scalar result is a number.

    Every function raises TypeError for arguments that are not arrays of real numbers, ValueError for wrong shapes and
    for numbers that are not finite (naming argument and index), and `UsageError` where the model has no answer.
    """

    def __init__(self, params: ArrayLike | None = None) -> None:
        """The arm of a flat parameter array (`Scenario.params`); by default the lecture's.

        Raises:
            UsageError, ScenarioError: the array has the wrong length, or does not describe an arm.
        """
        self._params = param_defaults() if params is None else np.array(params, np.float64)
        self._handle = _native.create("arm", lib.arm3r_arm_create, _native.readable(self._params), self._params.size)

    @classmethod
    def from_urdf(
        cls,
        path: str | os.PathLike[str],
        *,
        joints: Sequence[str] | None = None,
        lock: Mapping[str, float | str] | None = None,
        tip: str | None = None,
        axis_tolerance: float = 1e-6,
    ) -> Arm:
        """An elbow arm from a URDF: three revolute joints, axis 2 across axis 1, axis 3 parallel to axis 2.

        Angles, rates and torques are those of the file. `arm3r import` prints the same arm in a scenario.

        Args:
            joints: names of those that move, from base to tip; by default the first three that are not locked.
            lock: positions of other joints, in rad or such as "-90 deg".
            tip: the link whose frame is the tip; by default the only one without a child.
            axis_tolerance: by which the axes may be off, rad.

        Raises:
            UsageError: the file cannot be read, or its arm is no elbow arm; the message says what would help.
        """
        from ..robots.explicit import explicit_arm

        request = {"urdf": path, "joints": joints, "lock": lock, "tip": tip, "axis_tolerance": axis_tolerance}
        keys = indent(explicit_arm(request), "  ")
        texts = (*_native.utf8(f"format: 1\narm:\n{keys}", "text"), *_native.utf8(os.fspath(path), "path"))
        return cls(numbers_of(_native.create("scenario", lib.arm3r_scenario_create, *texts)))

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            raise no_attribute("Arm", name, dir(Arm))

    @property
    def params(self) -> Floats:
        """The flat parameter array it was made of, as a copy."""
        return self._params.copy()

    def __reduce__(self) -> tuple[Any, ...]:
        return Arm, (self._params,)

    def _batch(self, function: Callable[..., int], *shapes: tuple[int, ...], **arguments: Any) -> list[Any]:
        """One call: (..., 3) arrays in, one array of each shape out."""
        states = _native.States(**arguments)
        results = [np.empty(states.leading + shape) for shape in shapes]
        states.call(function, self._handle, *map(_native.writable, results))
        return [result if result.shape else float(result) for result in results]

    def _one(self, function: Callable[..., int], *shape: int, **arguments: Any) -> Any:
        return self._batch(function, shape, **arguments)[0]

    def tip_position(self, q: ArrayLike) -> Floats:
        """(..., 3) -> (..., 3), m."""
        return self._one(lib.arm3r_arm_tip_position, 3, q=q)

    def elbow_position(self, q: ArrayLike) -> Floats:
        """(..., 3) -> (..., 3), m."""
        return self._one(lib.arm3r_arm_elbow_position, 3, q=q)

    def points(self, q: ArrayLike) -> Floats:
        """The points that the arm is drawn through: (..., 3) -> (..., 7, 3), m.

        That of axis 1 nearest to the origin, that at the height of joint 2, joint 2, the end of link 2 in its plane,
        joint 3, the end of link 3 in its plane, the tip. Of a planar arm some coincide.
        """
        return self._one(lib.arm3r_arm_points, 7, 3, q=q)

    @property
    def reach(self) -> float:
        """No tip is farther from the point of axis 1 at the height of joint 2, m."""
        reach = _native.ffi.new("double *")
        _native.call(lib.arm3r_arm_reach, self._handle, reach)
        return float(reach[0])

    def centres(self, q: ArrayLike) -> Floats:
        """Centres of mass of the three links: (..., 3) -> (..., 3, 3), m, a row a link."""
        return self._one(lib.arm3r_arm_centres, 3, 3, q=q)

    def jacobian(self, q: ArrayLike) -> Floats:
        """Of the tip's position: (..., 3) -> (..., 3, 3), m."""
        return self._one(lib.arm3r_arm_jacobian, 3, 3, q=q)

    def geometric_jacobian(self, q: ArrayLike) -> Floats:
        """(..., 3) -> (..., 6, 3): three linear rows (m), then three angular ones."""
        return self._one(lib.arm3r_arm_geometric_jacobian, 6, 3, q=q)

    def jacobian_dot(self, q: ArrayLike, qd: ArrayLike) -> Floats:
        """Time derivative of the Jacobian: (..., 3, 3), m/s."""
        return self._one(lib.arm3r_arm_jacobian_dot, 3, 3, q=q, qd=qd)

    def mass_matrix(self, q: ArrayLike) -> Floats:
        """(..., 3) -> (..., 3, 3), kg m^2, armature and payload included."""
        return self._one(lib.arm3r_arm_mass_matrix, 3, 3, q=q)

    def coriolis_matrix(self, q: ArrayLike, qd: ArrayLike) -> Floats:
        """Of Christoffel symbols, so that dM/dt - 2C is skew: (..., 3, 3), N m s/rad."""
        return self._one(lib.arm3r_arm_coriolis_matrix, 3, 3, q=q, qd=qd)

    def velocity_product(self, q: ArrayLike, qd: ArrayLike) -> Floats:
        """C(q, qd) qd: (..., 3), N m."""
        return self._one(lib.arm3r_arm_velocity_product, 3, q=q, qd=qd)

    def gravity_torque(self, q: ArrayLike) -> Floats:
        """The torque that holds the arm, +dU/dq: (..., 3), N m."""
        return self._one(lib.arm3r_arm_gravity_torque, 3, q=q)

    def operational_space_inertia(self, q: ArrayLike) -> Floats:
        """(J M^-1 J^T)^-1: (..., 3, 3), kg. Raises UsageError where the pose is singular."""
        return self._one(lib.arm3r_arm_operational_space_inertia, 3, 3, q=q)

    def effective_mass(self, q: ArrayLike, direction: ArrayLike) -> Floats | float:
        """Mass felt at the tip along a direction (..., 3) of any length: (...,), kg."""
        return self._one(lib.arm3r_arm_effective_mass, q=q, direction=direction)

    def manipulability(self, q: ArrayLike) -> Floats | float:
        """`|det J|`: (...,), m^3."""
        return self._one(lib.arm3r_arm_manipulability, q=q)

    def energy(self, q: ArrayLike, qd: ArrayLike) -> tuple[Floats | float, Floats | float]:
        """Kinetic and potential energy (zero at the base origin): two of shape (...,), J."""
        kinetic, potential = self._batch(lib.arm3r_arm_energy, (), (), q=q, qd=qd)
        return kinetic, potential

    def forward_dynamics(
        self, q: ArrayLike, qd: ArrayLike, tau: ArrayLike, f_on_tip: ArrayLike | None = None
    ) -> Floats:
        """Acceleration under joint torques and a force on the tip (N), with damping and friction: (..., 3), rad/s^2."""
        return self._one(lib.arm3r_arm_forward_dynamics, 3, q=q, qd=qd, tau=tau, f_on_tip=f_on_tip)

    def inverse_dynamics(
        self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike, f_on_tip: ArrayLike | None = None
    ) -> Floats:
        """Joint torques that give an acceleration, under a force on the tip (N): (..., 3), N m."""
        return self._one(lib.arm3r_arm_inverse_dynamics, 3, q=q, qd=qd, qdd=qdd, f_on_tip=f_on_tip)

    def forward_dynamics_derivatives(
        self, q: ArrayLike, qd: ArrayLike, tau: ArrayLike, f_on_tip: ArrayLike | None = None
    ) -> tuple[Floats, Floats, Floats]:
        """The derivatives of `forward_dynamics` with respect to q, qd and tau: three of shape (..., 3, 3).

        The number in row i and column j is that of qdd[i] with respect to q[j] (1/s^2), to qd[j] (1/s) and to tau[j]
        (1/(kg m^2)): the last matrix is the inverse of the mass matrix. They are exact to rounding (automatic
        differentiation; `arm3r docs model`, 3.13). f_on_tip is constant in base axes.
        """
        found = self._batch(
            lib.arm3r_arm_forward_dynamics_derivatives, *[(3, 3)] * 3, q=q, qd=qd, tau=tau, f_on_tip=f_on_tip
        )
        return found[0], found[1], found[2]

    def inverse_dynamics_derivatives(
        self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike, f_on_tip: ArrayLike | None = None
    ) -> tuple[Floats, Floats, Floats]:
        """The derivatives of `inverse_dynamics` with respect to q, qd and qdd: three of shape (..., 3, 3).

        The number in row i and column j is that of tau[i] with respect to q[j] (N m/rad), to qd[j] (N m s/rad) and to
        qdd[j] (kg m^2): the last matrix is the mass matrix. They are exact to rounding, as those of the forward
        dynamics. f_on_tip is constant in base axes.
        """
        found = self._batch(
            lib.arm3r_arm_inverse_dynamics_derivatives, *[(3, 3)] * 3, q=q, qd=qd, qdd=qdd, f_on_tip=f_on_tip
        )
        return found[0], found[1], found[2]

    def linearize(
        self, q: ArrayLike, qd: ArrayLike, tau: ArrayLike, f_on_tip: ArrayLike | None = None
    ) -> tuple[Floats, Floats]:
        """The linear state-space model about a state, d(q, qd)/dt = A (q, qd) + B tau for small deviations of each.

        A is (..., 6, 6) and B is (..., 6, 3), in SI units and radians; `arm3r docs model` (3.14). f_on_tip is constant.

        >>> A, B = arm.linearize(q, [0, 0, 0], arm.gravity_torque(q))  # about rest
        """
        by_q, by_qd, by_tau = self.forward_dynamics_derivatives(q, qd, tau, f_on_tip)
        leading = by_q.shape[:-2]
        A, B = np.zeros((*leading, 6, 6)), np.zeros((*leading, 6, 3))
        A[..., :3, 3:] = np.eye(3)
        A[..., 3:, :3], A[..., 3:, 3:], B[..., 3:, :] = by_q, by_qd, by_tau
        return A, B

    def recursion_forward_dynamics(
        self, q: ArrayLike, qd: ArrayLike, tau: ArrayLike, f_on_tip: ArrayLike | None = None
    ) -> Floats:
        """`forward_dynamics` by the independent Newton-Euler recursion."""
        return self._one(lib.arm3r_arm_recursion_forward_dynamics, 3, q=q, qd=qd, tau=tau, f_on_tip=f_on_tip)

    def recursion_inverse_dynamics(
        self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike, f_on_tip: ArrayLike | None = None
    ) -> Floats:
        """`inverse_dynamics` by the independent Newton-Euler recursion."""
        return self._one(lib.arm3r_arm_recursion_inverse_dynamics, 3, q=q, qd=qd, qdd=qdd, f_on_tip=f_on_tip)

    def tip_sensor(self, q: ArrayLike, qd: ArrayLike) -> tuple[Floats, Floats]:
        """Position and velocity of the tip by the independent recursion: two of shape (..., 3), m and m/s."""
        position, velocity = self._batch(lib.arm3r_arm_tip_sensor, (3,), (3,), q=q, qd=qd)
        return position, velocity

    def inverse_kinematics(self, p: ArrayLike, *, front: bool = True, elbow: Literal["up", "down"] = "up") -> Floats:
        """Joint angles that put the tip at p (..., 3), m: (..., 3), rad.

        Args:
            front: joint 1 faces the point; else it faces away and the arm reaches over itself.
            elbow: on which side of the line from shoulder to tip the elbow lies.

        Raises:
            UsageError: a point is out of reach; `index` is the first one's.
        """
        if not isinstance(front, (bool, np.bool_)):
            raise TypeError(f"front: True or False is needed, got {front!r}")
        if elbow not in ("up", "down"):
            raise ValueError(f"elbow: 'up' or 'down' is needed, got {elbow!r}")
        states = _native.States(p=p)
        q = np.empty((*states.leading, 3))
        states.call(
            lib.arm3r_arm_inverse_kinematics, self._handle, bool(front), elbow == "up", _native.writable(q), ffi.NULL
        )
        return q
