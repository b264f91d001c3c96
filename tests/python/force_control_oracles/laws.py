"""The control laws of docs/model.md, a few lines each. The model is the plant, a cancelled force the true one."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from .arm import Arm, Motion
from .simulator import Control

Vector = Sequence[float]
Reference = Callable[[float], tuple[np.ndarray, np.ndarray, np.ndarray]]
"""reference(t) -> (place, rate, acceleration), of the tip or of the joints; a bare place rests."""

NONE = np.zeros(0)
X = (1.0, 0.0, 0.0)


def reference_of(place: Vector | Reference) -> Reference:
    if callable(place):
        return place
    at = np.asarray(place, dtype=float)
    return lambda t: (at, np.zeros(3), np.zeros(3))


def inverse_dynamics(s: Motion, a: np.ndarray, force: np.ndarray) -> np.ndarray:
    """ID(a): the tip accelerates by a whatever pushes it."""
    return s.M @ np.linalg.solve(s.J, a - s.bias) + s.rates + s.gravity - s.J.T @ force


def pressing(force: np.ndarray, p_in: Vector) -> float:
    return float(-np.dot(p_in, force))


def sideways(p_in: Vector) -> np.ndarray:
    """S_p of a force along p_in."""
    return np.eye(3) - np.outer(p_in, p_in)


def constant(torque: Vector) -> Control:
    """A torque that does not change."""
    return lambda t, s, force, z: (np.asarray(torque, dtype=float), NONE)


def gravity_compensation() -> Control:
    """The torque that holds the arm at rest."""
    return lambda t, s, force, z: (s.gravity, NONE)


def joint_pd(Kp: Vector, Kd: Vector, q_d: Vector, *, gravity: bool = True) -> Control:
    """(7.6)."""

    def control(t: float, s: Motion, force: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.multiply(Kp, np.subtract(q_d, s.q)) - np.multiply(Kd, s.qd) + gravity * s.gravity, NONE

    return control


def computed_torque(Kp: float, Kd: float, q_d: Vector | Reference, *, cancel: bool = True) -> Control:
    """(7.7)."""
    reference = reference_of(q_d)

    def control(t: float, s: Motion, force: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        place, rate, acceleration = reference(t)
        wanted = acceleration + Kd * (rate - s.qd) + Kp * (place - s.q)
        return s.M @ wanted + s.rates + s.gravity - cancel * (s.J.T @ force), NONE

    return control


def hold_tip(K: float, D: float, x_d: Vector, *, selected: Vector = (1, 1, 1)) -> Control:
    """(7.8); selected leaves directions alone, as `hybrid` does without its force part."""

    def control(t: float, s: Motion, force: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return inverse_dynamics(s, np.multiply(selected, K * (x_d - s.x) - D * s.xd), force), NONE

    return control


def cartesian_stiffness(K_P: float, K_D: float, x_d: Vector) -> Control:
    """(7.9), and (7.11) with a reference at rest."""
    return lambda t, s, force, z: (s.gravity + s.J.T @ (K_P * (x_d - s.x) - K_D * s.xd), NONE)


def joint_stiffness(K_P: float, K_D: float, q_d: Vector) -> Control:
    """(7.10), K_q = J_d^T K_P J_d."""
    J = Arm().at(q_d).J
    return lambda t, s, force, z: (s.gravity + J.T @ (K_P * (J @ (q_d - s.q)) - K_D * (J @ s.qd)), NONE)


def natural_impedance(B: float, K: float, x_d: Vector | Reference) -> Control:
    """(7.11)."""
    reference = reference_of(x_d)

    def control(t: float, s: Motion, force: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        place, rate, acceleration = reference(t)
        joints = np.linalg.solve(s.J, rate)
        feedforward = s.M @ np.linalg.solve(s.J, acceleration - s.J_dot @ joints) + s.coriolis_times(joints)
        return s.gravity + feedforward - s.J.T @ (B * (s.xd - rate) + K * (s.x - place)), NONE

    return control


def impedance(M: float, B: float, K: float, x_d: Vector | Reference) -> Control:
    """(7.12)."""
    reference = reference_of(x_d)

    def control(t: float, s: Motion, force: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        place, rate, acceleration = reference(t)
        a = acceleration + (force - B * (s.xd - rate) - K * (s.x - place)) / M
        return inverse_dynamics(s, a, force), NONE

    return control


def operational_space(s: Motion, a: np.ndarray, force: np.ndarray, forward: np.ndarray) -> np.ndarray:
    """(7.13): cancelled (the force that acts, forward = 0), or force = 0 and the wanted force fed forward."""
    inertia = np.linalg.inv(s.mobility)
    mu_xd = np.linalg.solve(s.J.T, s.rates) - inertia @ s.bias
    p = np.linalg.solve(s.J.T, s.gravity)
    return s.J.T @ (inertia @ a + forward + mu_xd + p) - s.J.T @ force


def hybrid_joints(Kp: float, Kv: float, x_d: Vector, position: Vector, *, projected: bool = False) -> Control:
    """(7.14), raibert_craig and projected, without their force part; position is the diagonal of S_p."""
    S_p = np.diag(position).astype(float)

    def control(t: float, s: Motion, force: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        to_joints = np.linalg.pinv(S_p @ s.J, rcond=1e-9) if projected else np.linalg.solve(s.J, S_p)
        return s.gravity + to_joints @ (S_p @ (Kp * (x_d - s.x) - Kv * s.xd)), NONE

    return control


def hybrid_transposed(
    f_d: float, kP: float, kI: float, b: float, K: float, D: float, x_d: Vector, p_in: Vector = X
) -> Control:
    """(7.14), jacobian_transpose. Memory: int e_f."""
    S_p = sideways(p_in)

    def control(t: float, s: Motion, force: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        e_f = f_d - pressing(force, p_in)
        along = f_d + kP * e_f + kI * z[0] - b * np.dot(p_in, s.xd)
        return s.gravity + s.J.T @ (S_p @ (K * (x_d - s.x) - D * s.xd) + np.multiply(along, p_in)), np.array([e_f])

    return control


def hybrid(
    f_d: float,
    kP: float,
    kI: float,
    m_f: float,
    b: float,
    K: float,
    D: float,
    x_d: Vector,
    *,
    p_in: Vector = X,
    bias: float = 0.0,
    dither: tuple[float, float] = (0.0, 0.0),
    filter_rate: float | None = None,
    felt: Callable[[float, float], float] | None = None,
) -> Control:
    """(7.14), dynamic. Memory: int e_f[, e_f after the filter]. dither: N, Hz, on f_d. felt(t, f): the measured f."""
    S_p = sideways(p_in)

    def error(t: float, force: np.ndarray) -> float:
        f = pressing(force, p_in)
        wanted = f_d + dither[0] * np.sin(2 * np.pi * dither[1] * t)
        return wanted - (felt(t, f) if felt else f) - bias

    def control(t: float, s: Motion, force: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        e_f = error(t, force)
        used = z[1] if filter_rate else e_f
        along = (kP * used + kI * z[0] - b * np.dot(p_in, s.xd)) / m_f
        a = S_p @ (K * (x_d - s.x) - D * s.xd) + np.multiply(along, p_in)
        lag = [filter_rate * (e_f - used)] if filter_rate else []
        return inverse_dynamics(s, a, force), np.array([used, *lag])

    return control


def parallel(
    f_d: float, m: float, K_D: float, K_P: float, K_F: float, K_I: float, x_d: Vector, p_in: Vector = X
) -> Control:
    """(7.16), x_d at rest. Memory: int e_f."""

    def control(t: float, s: Motion, force: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        e_f = f_d - pressing(force, p_in)
        a = (K_P * (x_d - s.x) - K_D * s.xd + np.multiply(K_F * e_f + K_I * z[0], p_in)) / m
        return inverse_dynamics(s, a, force), np.array([e_f])

    return control


def admittance(M: float, B: float, K: float, x_d: Vector, w: float, zeta: float, *, forward: bool = False) -> Control:
    """(7.17), inner loop `position`, with forward `exact`. Memory: x_c, xd_c."""

    def control(t: float, s: Motion, force: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        x_c, xd_c = z[:3], z[3:6]
        xdd_c = (force - B * xd_c - K * (x_c - x_d)) / M
        a = w * w * (x_c - s.x) - 2 * zeta * w * s.xd + forward * (xdd_c + 2 * zeta * w * xd_c)
        return inverse_dynamics(s, a, force), np.concatenate([xd_c, xdd_c])

    return control


def observed(law: Control, K_O: float, *, yielding: float = 0.0) -> Control:
    """(8.4) beside a law without memory, from rest; yielding: K_R of (8.6). Memory: int (tau + C^T qd - tau_g + r)."""

    def control(t: float, s: Motion, force: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        r = reaction(s, z, K_O)
        torque = law(t, s, force, NONE)[0] + yielding * r
        return torque, torque + s.rates_transposed - s.gravity - s.arm.friction(s.qd) + r

    return control


def reaction(s: Motion, memory: np.ndarray, K_O: float) -> np.ndarray:
    """r of `observed`."""
    return K_O * (s.M @ s.qd - memory[:3])


def seeking(f_d: float, k_r: float, M: float, B: float, K: float, x_r: Vector, p_in: Vector = X) -> Control:
    """(7.18), `integral`, from x_r on. Memory: how far the reference has gone along p_in."""

    def control(t: float, s: Motion, force: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        a = (force - B * s.xd - K * (s.x - x_r - np.multiply(z[0], p_in))) / M
        return inverse_dynamics(s, a, force), np.array([k_r * (f_d - pressing(force, p_in))])

    return control


def smooth(x: float) -> float:
    """From 0 at 0 to 1 at 1, two derivatives everywhere."""
    x = min(max(x, 0.0), 1.0)
    return x**3 * (10 + x * (6 * x - 15))


def tank(
    K_0: float,
    swing: tuple[float, float],
    D: float,
    x_d: Vector,
    E_lo: float,
    E_hi: float,
    E_max: float,
    *,
    bounded: bool = True,
) -> Control:
    """(7.19), dK = swing[0] sin(2 pi swing[1] t). Memory: E, filled until 90 to 100 % of E_max."""

    def control(t: float, s: Motion, force: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        e = s.x - x_d
        gamma = smooth((z[0] - E_lo) / (E_hi - E_lo)) if bounded else 1.0
        w = -gamma * swing[0] * np.sin(2 * np.pi * swing[1] * t) * e
        filling = smooth(10 * (1 - z[0] / E_max)) * D * (s.xd @ s.xd)
        return s.gravity + s.J.T @ (w - D * s.xd - K_0 * e), np.array([filling - s.xd @ w])

    return control
