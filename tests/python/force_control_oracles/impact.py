"""A mass m that meets a surface at speed v: restitution, largest depth, largest force, and laws chosen from them."""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from .wall import Law


def kelvin_voigt_restitution(zeta: float) -> float:
    """e of the damping ratio c / (2 sqrt(k m)), with contact that ends at zero force."""
    if zeta == 1:
        return float(np.exp(-2))
    if zeta < 1:
        return float(np.exp(-2 * zeta * np.arccos(zeta) / np.sqrt(1 - zeta**2)))
    return float(np.exp(-2 * zeta * np.arccosh(zeta) / np.sqrt(zeta**2 - 1)))


def hunt_crossley_restitution(y: float) -> float:
    """e of y = beta v, 0 < y < 600: y - ln(1 + y) = -e y - ln(1 - e y); for large y in terms of w = 1 - e y."""
    if y > 1:
        w = np.exp(brentq(lambda ln: y - np.log1p(y) + 1 - np.exp(ln) + ln, -700, -1e-3, xtol=1e-15))
        return (1 - w) / y
    return brentq(lambda e: y - np.log1p(y) + e * y + np.log1p(-e * y), 1e-12, min(1, (1 - 1e-15) / y), xtol=1e-15)


def kelvin_voigt_depth(zeta: float, k: float, m: float, v: float) -> float:
    """Largest depth, m."""
    return v * np.sqrt(m / k * kelvin_voigt_restitution(zeta))


def hunt_crossley_depth(beta: float, k: float, p: float, m: float, v: float) -> float:
    """Largest depth, m."""
    y = beta * v
    return ((p + 1) * m * (y - np.log1p(y)) / (k * beta**2)) ** (1 / (p + 1))


def kelvin_voigt_peak(zeta: float, k: float, m: float, v: float) -> float:
    """Largest force, N; from zeta = 1/2 on it is that of the first touch."""
    if zeta >= 0.5:
        return 2 * zeta * v * np.sqrt(k * m)
    root = np.sqrt(1 - zeta**2)
    turn = np.arctan(root * (1 - 4 * zeta**2) / (zeta * (3 - 4 * zeta**2)))
    return v * np.sqrt(k * m) * np.exp(-zeta / root * turn)


def kelvin_voigt_chosen(e: float, depth: float, m: float, v: float) -> tuple[float, float]:
    """k N/m and c N s/m that give restitution e and this largest depth."""
    zeta = brentq(lambda zeta: kelvin_voigt_restitution(zeta) - e, 1e-12, 1e6, xtol=1e-15)
    k = m * e * (v / depth) ** 2
    return k, 2 * zeta * np.sqrt(k * m)


def hunt_crossley_chosen(e: float, depth: float, p: float, m: float, v: float) -> tuple[float, float]:
    """k N/m^p and beta s/m that give restitution e and this largest depth."""
    y = brentq(lambda y: hunt_crossley_restitution(y) - e, 1e-4, 500, xtol=1e-14)
    beta = y / v
    return (p + 1) * m * (y - np.log1p(y)) / (beta**2 * depth ** (p + 1)), beta


def impact(law: Law, m: float, v: float) -> tuple[float, float, float]:
    """Restitution, largest depth and largest force by integration, until the force ends."""

    def slope(t: float, y: np.ndarray) -> list[float]:
        return [y[1], -law.normal(y[0], y[1]) / m]

    def ends(t: float, y: np.ndarray) -> float:
        return y[0] if law.release is None else law.release(y[0], y[1])

    def deepest(t: float, y: np.ndarray) -> float:
        return y[1]

    def gone(t: float, y: np.ndarray) -> float:
        return y[0] + 1e-18

    ends.terminal, ends.direction, gone.terminal, gone.direction = True, -1, True, -1
    run = solve_ivp(
        slope, (0, 1e3), [0, v], "DOP853", events=[ends, deepest, gone], dense_output=True, rtol=1e-12, atol=1e-16
    )
    depth = run.y_events[1][0][0]
    times = np.linspace(0, run.t[-1], 20001)
    y = run.sol(times)
    force = max(law.normal(*point) for point in y.T)
    return -run.y[1, -1] / v, float(depth), float(force)
