"""The exact linear closed loops along the wall's normal, u = depth, and what follows from their polynomials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq


@dataclass(frozen=True)
class Loop:
    """y' = A y + c from y0; y[0] is the depth u, k u the force."""

    A: np.ndarray
    c: np.ndarray
    y0: np.ndarray
    k: float

    @property
    def poles(self) -> np.ndarray:
        return np.sort_complex(np.linalg.eigvals(self.A))

    @property
    def settled(self) -> float:
        """Force in the end, N."""
        return float(self.k * np.linalg.solve(self.A, -self.c)[0])

    @cached_property
    def modes(self) -> tuple[np.ndarray, np.ndarray]:
        """Poles, and what each adds to the force at t = 0."""
        poles, shapes = np.linalg.eig(self.A)
        weights = np.linalg.solve(shapes, self.y0 + np.linalg.solve(self.A, self.c))
        return poles, self.k * shapes[0] * weights

    def forces(self, times: Sequence[float]) -> np.ndarray:
        poles, sizes = self.modes
        return self.settled + (np.exp(np.multiply.outer(times, poles)) @ sizes).real

    def peak(self, until: float) -> tuple[float, float]:
        """Time and size of the first maximum of the force before `until`."""
        poles, sizes = self.modes

        def climbing(t: float) -> float:
            return float((np.exp(t * poles) @ (poles * sizes)).real)

        times = np.linspace(0, until, 1001)[1:]
        turn = next(i for i, t in enumerate(times) if climbing(t) <= 0)
        t = brentq(climbing, times[turn - 1], times[turn], xtol=1e-15)
        return t, float(self.forces([t])[0])


def loop(A: Sequence[Sequence[float]], c: Sequence[float], y0: Sequence[float], k: float) -> Loop:
    return Loop(np.array(A, dtype=float), np.array(c, dtype=float), np.array(y0, dtype=float), k)


def hybrid_loop(
    f_d: float, kP: float, kI: float, m_f: float, b: float, *, k: float, v: float = 0.0, u0: float, sd0: float = 0.0
) -> Loop:
    """(7.14): y = (u, tip speed into the wall[, int e_f]); the wall comes at v."""
    A = [[0, 1, 0], [-k * kP / m_f, -b / m_f, kI / m_f], [-k, 0, 0]]
    c, y0 = [v, kP * f_d / m_f, f_d], [u0, sd0, 0]
    n = 3 if kI else 2
    return loop([row[:n] for row in A[:n]], c[:n], y0[:n], k)


def filtered_hybrid_loop(
    f_d: float, kP: float, kI: float, m_f: float, b: float, *, k: float, rate: float, u0: float
) -> Loop:
    """(7.14), e_f through a first-order filter of that rate (1/s): y = (u, speed, int of the filtered e_f, itself)."""
    A = [[0, 1, 0, 0], [0, -b / m_f, kI / m_f, kP / m_f], [0, 0, 0, 1], [-rate * k, 0, 0, -rate]]
    return loop(A, [0, 0, 0, rate * f_d], [u0, 0, 0, 0], k)


def parallel_loop(
    f_d: float, m: float, K_D: float, K_P: float, K_F: float, K_I: float, *, k: float, v: float, u0: float, ahead: float
) -> Loop:
    """(7.16): y = (u, speed, K_P (x_d - s) + K_I int e_f); `ahead` is x_d - s at first."""
    A = [[0, 1, 0], [-k * K_F / m, -K_D / m, 1 / m], [-k * K_I, -K_P, 0]]
    return loop(A, [v, K_F * f_d / m, K_I * f_d], [u0, 0, K_P * ahead], k)


def impedance_loop(M: float, B: float, K: float, *, k: float, ahead: float) -> Loop:
    """(7.12) from the touching rest on a fixed wall, x_d `ahead` of it."""
    return loop([[0, 1], [-(K + k) / M, -B / M]], [0, K * ahead / M], [0, 0], k)


def admittance_loop(
    M: float, B: float, K: float, w: float, zeta: float, *, k: float, ahead: float, off: float = 0.0
) -> Loop:
    """(7.17) on a fixed wall: y = (u, speed, x_c, its speed) past the wall, the tip `off` the balance."""
    A = [[0, 1, 0, 0], [-w * w, -2 * zeta * w, w * w, 0], [0, 0, 0, 1], [-k / M, 0, -K / M, -B / M]]
    balance = K * ahead / (K + k)
    return loop(A, [0, 0, 0, K * ahead / M], [balance + off, 0, balance, 0], k)


def seeking_loop(
    f_d: float, k_r: float, M: float, B: float, K: float, *, k: float, v: float, u0: float, ahead: float
) -> Loop:
    """(7.18): y = (u, speed, K (x_r - s)); `ahead` is x_r - s at first."""
    A = [[0, 1, 0], [-k / M, -B / M, 1 / M], [-K * k_r * k, -K, 0]]
    return loop(A, [v, 0, K * k_r * f_d], [u0, 0, K * ahead], k)


def admittance_limit(M: float, B: float, K: float, w: float, zeta: float) -> tuple[float, float]:
    """(7.17): largest stable k, N/m, and the frequency there, rad/s; of the poles, not of Routh's table."""

    def growth(k: float) -> float:
        return admittance_loop(M, B, K, w, zeta, k=k, ahead=0.0).poles.real.max()

    k = brentq(growth, 1.0, 1e6, xtol=1e-9)
    poles = admittance_loop(M, B, K, w, zeta, k=k, ahead=0.0).poles
    return k, float(abs(poles[poles.real.argmax()].imag))


def seeking_limit(M: float, B: float, K: float, k: float) -> float:
    """(7.18): largest stable k_r."""

    def growth(k_r: float) -> float:
        return seeking_loop(0.0, k_r, M, B, K, k=k, v=0.0, u0=0.0, ahead=0.0).poles.real.max()

    return brentq(growth, 1e-6, 10.0, xtol=1e-15)


def filter_limit(kP: float, kI: float, m_f: float, b: float, *, k: float) -> float:
    """(7.14): slowest stable filter on e_f, rad/s."""

    def growth(rate: float) -> float:
        return filtered_hybrid_loop(0.0, kP, kI, m_f, b, k=k, rate=rate, u0=0.0).poles.real.max()

    return brentq(growth, 5.0, 200.0, xtol=1e-12)


def open_force_loop(s: complex, kP: float, kI: float, m_f: float, b: float, k: float) -> complex:
    return k * (kP * s + kI) / (s * s * (m_f * s + b))


def delay_margin(kP: float, kI: float, m_f: float, b: float, *, k: float) -> tuple[float, float, float]:
    """(7.14): crossover rad/s, phase margin rad, delay of e_f up to which it is stable, s."""
    crossover = brentq(lambda w: abs(open_force_loop(1j * w, kP, kI, m_f, b, k)) - 1, 1e-2, 1e4, xtol=1e-12)
    phase = np.pi + np.angle(open_force_loop(1j * crossover, kP, kI, m_f, b, k))
    return crossover, float(phase), float(phase / crossover)


def delayed_pole(kP: float, kI: float, m_f: float, b: float, *, k: float, delay: float) -> complex:
    """(7.14): the slowest pole of 1 + L(s) exp(-s delay) = 0, by Newton's rule from the crossover."""
    s = 1j * delay_margin(kP, kI, m_f, b, k=k)[0]
    for _ in range(50):
        echo = k * np.exp(-s * delay)
        value = m_f * s**3 + b * s**2 + echo * (kP * s + kI)
        s = s - value / (3 * m_f * s**2 + 2 * b * s + echo * (kP - delay * (kP * s + kI)))
    return s
