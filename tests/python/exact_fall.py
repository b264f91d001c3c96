"""A free fall much more exactly than the program computes it: extended precision, another method, other code.

The equation of motion is (3.3) to (3.5) as the page has it, not (3.8); the method is the extrapolation of Gragg,
Bulirsch and Stoer, whose coefficients are ratios of integers.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import arm3r_cpp as arm3r
import numpy as np

Exact = np.longdouble
ROWS = 10  # of the extrapolation's table: order 20
TOLERANCE = 1e-17
LONGEST_STEP = 0.1  # s


def exact_angles(scenario: arm3r.Scenario, times: Any) -> Any:
    """Joint angles, (n, 3), rad, of a fall without torque, friction or wall; times[0] is its start."""
    change = np.array([1, -1, -1]) if scenario["arm.convention"] == "simscape" else np.ones(3)
    slope = slope_of(scenario["arm"])
    y = np.concatenate([change * scenario["initial.q"], change * scenario["initial.qd"]]).astype(Exact)
    t, step, found = Exact(times[0]), Exact(LONGEST_STEP), [y]
    for until in map(Exact, times[1:]):
        while t < until:
            h = min(step, until - t)
            end, error = extrapolated_step(slope, y, h)
            if error > TOLERANCE * max(1, np.abs(end).max()):
                step = h / 2
                continue
            y, t = end, until if h == until - t else t + h
            step = min(step * Exact(1.3), Exact(LONGEST_STEP)) if error < TOLERANCE / 1e4 else step
        found.append(y)
    return np.array(found)[:, :3] * change


def extrapolated_step(slope: Callable[[Any], Any], y: Any, H: Any) -> tuple[Any, float]:
    """The state after a step, and an estimate of its error."""
    table: list[list[Any]] = []
    for k in range(1, ROWS + 1):
        h = H / (2 * k)
        before, now = y, y + h * slope(y)
        for _ in range(2 * k - 1):
            before, now = now, before + 2 * h * slope(now)
        row = [(before + now + h * slope(now)) / 2]
        for j in range(1, k):
            ratio = (Exact(k) / Exact(k - j)) ** 2
            row.append(row[-1] + (row[-1] - table[-1][j - 1]) / (ratio - 1))
        table.append(row)
    return table[-1][-1], float(np.abs(table[-1][-1] - table[-1][-2]).max())


def slope_of(arm: dict[str, Any]) -> Callable[[Any], Any]:
    """The derivative of (q, qd), in the slide convention, of an arm of brick links."""
    A1, A2, A3, B, B2, B3, J3, G2, G3 = (Exact(number) for number in lumped(arm))
    g = -Exact(arm["gravity"][2])

    def slope(y: Any) -> Any:
        q2, q3, qd1, qd2, qd3 = y[1:]
        S2, C2, S23, C23, S3, C3 = (f(x) for x in (q2, q2 + q3, q3) for f in (np.sin, np.cos))
        P, Q = A2 * C2 + B * C23, A3 * C23 + B * C2
        h2, h3, b = -(S2 * P + S23 * Q), -S23 * Q, B * S3
        C = [
            [h2 * qd2 + h3 * qd3, h2 * qd1, h3 * qd1],
            [-h2 * qd1, -b * qd3, -b * (qd2 + qd3)],
            [-h3 * qd1, b * qd2, 0],
        ]
        tau = -(np.array(C) @ y[3:]) - np.array([0, g * (G2 * C2 + G3 * C23), g * G3 * C23])
        M11, M22, M23, M33 = A1 + C2 * P + C23 * Q, B2 + B3 + 2 * B * C3, B3 + B * C3, B3 + J3
        det = M22 * M33 - M23 * M23
        qdd = [tau[0] / M11, (M33 * tau[1] - M23 * tau[2]) / det, (M22 * tau[2] - M23 * tau[1]) / det]
        return np.array([*y[3:], *qdd], dtype=Exact)

    return slope


def lumped(arm: dict[str, Any]) -> tuple[float, ...]:
    """(3.2)"""
    (m2, a2, l2, x2, y2, z2), (m3, a3, l3, x3, y3, z3) = brick(arm["link2"]), brick(arm["link3"])
    m_p, rotor = arm["payload"]["mass"], arm["armature"]
    A1 = arm["link1"]["inertia_axial"] + rotor[0] + x2 + x3
    A2, B2 = y2 - x2 + m2 * l2**2 + (m3 + m_p) * a2**2, z2 + rotor[1] + m2 * l2**2 + (m3 + m_p) * a2**2
    A3, B3 = y3 - x3 + m3 * l3**2 + m_p * a3**2, z3 + m3 * l3**2 + m_p * a3**2
    return A1, A2, A3, m3 * a2 * l3 + m_p * a2 * a3, B2, B3, rotor[2], m2 * l2 + (m3 + m_p) * a2, m3 * l3 + m_p * a3


def brick(link: dict[str, Any]) -> tuple[float, ...]:
    """Mass, length, centre of mass, and inertias about x, y, z."""
    a, (h, w) = link["length"], link["section"]
    m = link["mass"] if "mass" in link else link["density"] * a * h * w
    return m, a, a / 2, m * (w * w + h * h) / 12, m * (a * a + w * w) / 12, m * (a * a + h * h) / 12
