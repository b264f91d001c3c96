"""In closed form: what an observer says, how far a pushed arm yields, what forces tell of a wall."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from .statics import series_force


def observer_step(K_O: float, t: float) -> float:
    """r / tau_ext after a step."""
    return float(1 - np.exp(-K_O * t))


def ramp_delay(slope: float, threshold: float, K_O: float) -> float:
    """Time from the start of a ramp of tau_ext (N m/s) until r meets the threshold (N m)."""
    return brentq(lambda t: slope * (t - observer_step(K_O, t) / K_O) - threshold, 1e-9, 1e3, xtol=1e-15)


def yielding_speed(F: float, m_n: float, K_R: float, K_O: float, t: float) -> float:
    """The reflex of (8.6): speed of a mass m_n at rest under a constant F, along it."""
    return F / m_n * (t + K_R * (t - observer_step(K_O, t) / K_O))


def fitted_wall(s: np.ndarray, t: np.ndarray, f: np.ndarray) -> tuple[np.ndarray, float]:
    """(8.7): (k_e, speed v, place s_E at t = 0) of f = k_e (s - s_E + v t), and the condition of the problem."""
    phi = np.stack([s, np.ones_like(s), t], axis=1)
    k, offset, drift = np.linalg.lstsq(phi, f, rcond=None)[0]
    return np.array([k, drift / k, -offset / k]), float(np.linalg.cond(phi))


def reference_for(f_d: float, s_E: float, k_e: float, K: float) -> float:
    """(7.18), `indirect`: where the reference of an impedance K must stand."""
    return s_E + f_d / k_e + f_d / K


def force_of_wrong_stiffness(f_d: float, k_e: float, believed: float, K: float) -> float:
    """Force that `reference_for` gives at a wall k_e believed to be another: balance of two springs."""
    return series_force(K, k_e, reference_for(f_d, 0.0, believed, K))
