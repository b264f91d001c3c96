"""Loops that act at ticks: recursions, the discrete observer, the passivity controller of one degree of freedom."""

from __future__ import annotations

import numpy as np


def held_recursion(Kp: float, Kd: float, period: float) -> np.ndarray:
    """(e, ed) from tick to tick of edd = -(Kp e + Kd ed) held over the period."""
    half = period**2 / 2
    return np.array([[1 - half * Kp, period - half * Kd], [-period * Kp, 1 - period * Kd]])


def spectral_radius(A: np.ndarray) -> float:
    return float(abs(np.linalg.eigvals(A)).max())


def longest_period(Kp: float, Kd: float) -> float:
    """Where `held_recursion` turns unstable, s: by bisection on its spectral radius."""
    low, high = 1e-6, 10.0
    low = next(t for t in np.geomspace(low, high, 4000)[::-1] if spectral_radius(held_recursion(Kp, Kd, t)) < 1)
    high = 1.01 * low
    for _ in range(60):
        middle = (low + high) / 2
        if spectral_radius(held_recursion(Kp, Kd, middle)) < 1:
            low = middle
        else:
            high = middle
    return low


def observer_samples(K_O: float, period: float, ticks: int) -> np.ndarray:
    """r_k / tau_ext of the sampled momentum observer of a held arm, k = 0 .. ticks: its own recursion, p = 0."""
    s, samples = 0.0, []
    for _ in range(ticks + 1):
        r = -K_O * s
        samples.append(r)
        s += period * (-1.0 + r)  # tau - tau_g = -tau_ext while it stands
    return np.array(samples)


def filtered_noise(alpha: float) -> float:
    """Standard deviation of y += alpha (x - y) over that of white x: its impulse response, summed."""
    response = alpha * (1 - alpha) ** np.arange(int(40 / alpha))
    return float(np.sqrt(response @ response))


def passivity_run(
    k: float, m: float, period: float, gap: float, speed: float, ticks: int, *, controlled: bool
) -> np.ndarray:
    """(7.20): a free mass against a sampled spring wall. Rows at the ticks: x (into the wall), v, E observed, f."""
    x, v, E = -gap, speed, 0.0
    rows, before = [], None
    for _ in range(ticks):
        f = k * max(x, 0.0)
        if before is not None:
            moved = x - before[0]
            E += before[1] * moved
            if controlled and E < 0 and moved != 0:
                f -= E / moved
        rows.append((x, v, E, f))
        before = x, f
        x, v = x + period * v - period**2 * f / (2 * m), v - period * f / m
    return np.array(rows)


def foreseen_run(k: float, m: float, period: float, gap: float, speed: float, ticks: int) -> np.ndarray:
    """The same mass where a brake takes what the next period would create. Rows at the ticks: x, v, reserve, f."""

    def stored(x: float) -> float:
        return 0.5 * k * max(x, 0.0) ** 2

    x, v, E = -gap, speed, 0.0
    rows = []
    for _ in range(ticks):
        f = k * max(x, 0.0)
        way = period * v - period**2 * f / (2 * m)
        given = stored(x + way) - stored(x) - f * way
        excess = given + 0.01 * abs(given) - E
        if excess > 0:
            most = 2 * m * (way / period) ** 2
            roots = np.roots([most, -(given + most), excess])
            f += 2 * min(roots.real) / period**2 * m * way
        rows.append((x, v, E, f))
        moved = period * v - period**2 * f / (2 * m)
        E += f * moved - stored(x + moved) + stored(x)
        x, v = x + moved, v - period * f / m
    return np.array(rows)
