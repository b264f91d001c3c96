"""The arm from rotation matrices and the velocities of its bodies (Kane); rates of matrices by one complex step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

G = 9.80665
STEP = 1e-40  # its square is nothing beside 1, so real parts are exact and slopes have no truncation error
BRICK = (1.3083333333333334e-5, 6.542320833333333e-2, 6.542320833333333e-2)  # about the link, its joint, the third axis


@dataclass(frozen=True)
class Arm:
    """Two links on a column. m, kg, kg m^2 (inertias about each com, link axes), N m; raises = -1: simscape."""

    lengths: tuple[float, float] = (1.0, 1.0)
    masses: tuple[float, float] = (0.785, 0.785)
    coms: tuple[float, float] = (0.5, 0.5)
    column: float = BRICK[0]
    inertias: tuple[Sequence[float], Sequence[float]] = (BRICK, BRICK)
    armature: Sequence[float] = (0.0, 0.0, 0.0)
    viscous: Sequence[float] = (0.0, 0.0, 0.0)
    coulomb: Sequence[float] = (0.0, 0.0, 0.0)
    eps: float = 1e-3
    gravity: Sequence[float] = (0.0, 0.0, -G)
    raises: int = 1

    @cached_property
    def weights(self) -> np.ndarray:
        """Of the 13 velocities of the bodies: com 2, com 3, column, turn of 2, turn of 3."""
        return np.concatenate([np.repeat(self.masses, 3), [self.column], *self.inertias])

    @cached_property
    def pull(self) -> np.ndarray:
        """Weight of links 2 and 3, N (6)."""
        return np.concatenate([m * np.asarray(self.gravity) for m in self.masses])

    def friction(self, qd: np.ndarray) -> np.ndarray:
        return np.asarray(self.viscous) * qd + np.asarray(self.coulomb) * np.tanh(qd / self.eps)

    def at(self, q: Sequence[float], qd: Sequence[float] = (0.0, 0.0, 0.0)) -> Motion:
        return Motion(self, np.asarray(q, dtype=float), np.asarray(qd, dtype=float))

    def reach(self, x: Sequence[float], elbow: int = -1) -> np.ndarray:
        """Joint angles that bring the tip to x, in front; elbow is the sign of q3 of the slide convention."""
        a2, a3 = self.lengths
        out, up = np.hypot(x[0], x[1]), x[2]
        q3 = elbow * np.arccos((out**2 + up**2 - a2**2 - a3**2) / (2 * a2 * a3))
        q2 = np.arctan2(up, out) - np.arctan2(a3 * np.sin(q3), a2 + a3 * np.cos(q3))
        return np.array([np.arctan2(x[1], x[0]), self.raises * q2, self.raises * q3])


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def tilt(c: complex, s: complex) -> np.ndarray:
    """Rotation about -y, which raises the x axis."""
    return np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])


class Motion:
    """The arm in one state: tip x, xd, its Jacobian J, and on demand mass matrix M and the torques of the model."""

    def __init__(self, arm: Arm, q: np.ndarray, qd: np.ndarray) -> None:
        self.arm, self.q, self.qd = arm, q, qd
        c, s = np.cos(q + 1j * STEP * qd), np.sin(q + 1j * STEP * qd)
        yaw = np.array([[c[0], -s[0], 0], [s[0], c[0], 0], [0, 0, 1]])
        link2 = yaw @ tilt(c[1], arm.raises * s[1])
        link3 = link2 @ tilt(c[2], arm.raises * s[2])
        column, joint, still = yaw[:, 2], -arm.raises * yaw[:, 1], np.zeros(3)
        elbow = arm.lengths[0] * link2[:, 0]

        def jacobian(point: np.ndarray, *, on_link3: bool) -> np.ndarray:
            third = cross(joint, point - elbow) if on_link3 else still
            return np.array([cross(column, point), cross(joint, point), third]).T

        com2, com3 = arm.coms[0] * link2[:, 0], elbow + arm.coms[1] * link3[:, 0]
        tip = elbow + arm.lengths[1] * link3[:, 0]
        velocities = np.concatenate(
            [
                jacobian(com2, on_link3=False),
                jacobian(com3, on_link3=True),
                [[1, 0, 0]],
                link2.T @ np.array([column, joint, still]).T,
                link3.T @ np.array([column, joint, joint]).T,
            ]
        )
        tip_jacobian = jacobian(tip, on_link3=True)
        self.coms = np.concatenate([com2, com3]).real
        self.x, self.J, self.V = tip.real, tip_jacobian.real, velocities.real
        self.J_dot, self.V_dot = tip_jacobian.imag / STEP, velocities.imag / STEP
        self.xd = self.J @ qd
        self.bias = self.J_dot @ qd

    @cached_property
    def M(self) -> np.ndarray:
        return self.V.T @ (self.arm.weights[:, None] * self.V) + np.diag(self.arm.armature)

    @cached_property
    def M_dot(self) -> np.ndarray:
        half = self.V_dot.T @ (self.arm.weights[:, None] * self.V)
        return half + half.T

    @cached_property
    def rates(self) -> np.ndarray:
        """C qd."""
        turns = self.V @ self.qd
        momenta = self.arm.weights * turns
        torque = self.V.T @ (self.arm.weights * (self.V_dot @ self.qd))
        for body in (slice(7, 10), slice(10, 13)):
            torque = torque + self.V[body].T @ cross(turns[body], momenta[body])
        return torque

    @cached_property
    def rates_transposed(self) -> np.ndarray:
        """C^T qd of the Christoffel matrix: M_dot = C + C^T."""
        return self.M_dot @ self.qd - self.rates

    def coriolis_times(self, v: np.ndarray) -> np.ndarray:
        """C(q, qd) v of the Christoffel matrix, by polarisation of C(q, qd) qd."""
        return (self.arm.at(self.q, self.qd + v).rates - self.arm.at(self.q, self.qd - v).rates) / 4

    @cached_property
    def gravity(self) -> np.ndarray:
        """The torque that holds the arm."""
        return -self.V[:6].T @ self.arm.pull

    @cached_property
    def mobility(self) -> np.ndarray:
        """J M^-1 J^T, the inverse of the operational-space inertia."""
        return self.J @ np.linalg.solve(self.M, self.J.T)

    def mass_along(self, n: Sequence[float]) -> float:
        return float(1 / (n @ self.mobility @ n))

    @property
    def energy(self) -> float:
        return float(0.5 * self.qd @ self.M @ self.qd - self.arm.pull @ self.coms)

    def acceleration(self, torque: np.ndarray, force: np.ndarray) -> np.ndarray:
        """qdd under a torque and a force on the tip."""
        resisted = self.rates + self.gravity + self.arm.friction(self.qd)
        return np.linalg.solve(self.M, torque + self.J.T @ force - resisted)
