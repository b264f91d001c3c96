"""Where an arm comes to rest, by roots of the balance of torques; springs in series."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.optimize import root

from .arm import Arm, Motion


def rest(balance: Callable[[Motion], np.ndarray], near: Sequence[float]) -> Motion:
    """The resting state near q = `near` where the balance of joint torques is nought."""
    arm = Arm()
    found = root(lambda q: balance(arm.at(q)), near, tol=1e-14)
    assert np.abs(balance(arm.at(found.x))).max() < 1e-9, found.message
    return arm.at(found.x)


def joint_pd_rest(Kp: Sequence[float], q_d: Sequence[float]) -> Motion:
    """Of (7.6) without compensation."""
    return rest(lambda s: np.multiply(Kp, q_d - s.q) - s.gravity, q_d)


def computed_torque_rest(Kp: float, q_d: Sequence[float], force: Sequence[float]) -> Motion:
    """Of (7.7) that does not cancel the force on the tip."""
    return rest(lambda s: s.M @ (Kp * (q_d - s.q)) + s.J.T @ force, q_d)


def joint_stiffness_rest(K_P: float, q_d: Sequence[float], *, x_E: float, k: float) -> Motion:
    """Of (7.10) against the plane x = x_E."""
    J = Arm().at(q_d).J
    return rest(lambda s: K_P * (J.T @ J) @ (q_d - s.q) - s.J[0] * k * (s.x[0] - x_E), q_d)


def series_force(K: float, k: float, ahead: float) -> float:
    """Of the spring K to a point `ahead` of a wall k."""
    return K * k / (K + k) * ahead


def moving_series_force(K: float, D: float, k: float, v: float, ahead: float) -> float:
    """Of (7.9) on a wall that comes at v, after the transient; `ahead` now."""
    return series_force(K, k, ahead) + D * v * (k / (K + k)) ** 2
