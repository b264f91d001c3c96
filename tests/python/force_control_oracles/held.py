"""An arm under torques that are computed at ticks and act later, each for a period: every hold is its own piece."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from .arm import Arm, Motion

Piece = tuple[np.ndarray, float]
"""A torque, N m, and how long it acts, s."""


@dataclass
class Held:
    """What happened: the states at the ticks, the torques put out, and what acted in the period behind each tick."""

    states: list[Motion] = field(default_factory=list)
    outputs: list[np.ndarray] = field(default_factory=list)
    acted: list[list[Piece]] = field(default_factory=list)
    turned: list[list[np.ndarray]] = field(default_factory=list)
    """How far the joints turned during each of these pieces, rad."""


def simulate_held(
    arm: Arm,
    law: Callable[[int, Motion, Held], np.ndarray],
    q: Sequence[float],
    period: float,
    delay: float,
    ticks: int,
    *,
    qd: Sequence[float] = (0.0, 0.0, 0.0),
    push: Sequence[float] = (0.0, 0.0, 0.0),
) -> Held:
    """law(tick, motion, what happened before) -> the torque that is put out at the tick. push: N, constant."""
    held = Held()
    whole, share = int(np.floor(delay)), delay - np.floor(delay)
    q, qd = np.asarray(q, float), np.asarray(qd, float)
    for tick in range(ticks + 1):
        s = arm.at(q, qd)
        held.outputs.append(law(tick, s, held))
        held.states.append(s)
        early, late = (held.outputs[max(0, tick - whole - back)] for back in (1, 0))
        held.acted.append([(early, share * period), (late, (1 - share) * period)])
        held.turned.append([])
        for torque, duration in held.acted[-1]:
            before = q
            q, qd = moved(arm, q, qd, torque, np.asarray(push, float), duration)
            held.turned[-1].append(q - before)
    return held


def moved(
    arm: Arm, q: np.ndarray, qd: np.ndarray, torque: np.ndarray, push: np.ndarray, duration: float, steps: int = 4
) -> tuple[np.ndarray, np.ndarray]:
    """Classical Runge-Kutta under a constant torque."""

    def slope(y: np.ndarray) -> np.ndarray:
        return np.concatenate([y[3:], arm.at(y[:3], y[3:]).acceleration(torque, push)])

    y, h = np.concatenate([q, qd]), duration / steps
    for _ in range(steps if duration > 0 else 0):
        k1 = slope(y)
        k2 = slope(y + h / 2 * k1)
        k3 = slope(y + h / 2 * k2)
        y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + slope(y + h * k3))
    return y[:3], y[3:]


class Observer:
    """The momentum observer by Euler's rule, with the torque that acts between two ticks."""

    def __init__(self, gain: float, period: float) -> None:
        self.gain, self.period, self.residuals = gain, period, []
        self.momentum = None

    def see(self, tick: int, s: Motion, held: Held) -> np.ndarray:
        p = s.M @ s.qd
        if tick == 0:
            self.momentum = p
        else:
            before = held.states[-1]
            impulse = sum(torque * duration for torque, duration in held.acted[-1])
            model = before.rates_transposed - before.gravity - before.arm.friction(before.qd) + self.residuals[-1]
            self.momentum = self.momentum + impulse + self.period * model
        self.residuals.append(self.gain * (p - self.momentum))
        return self.residuals[-1]


def potential(s: Motion) -> float:
    return float(-s.arm.pull @ s.coms)


def given_out(s: Motion, held: Held) -> float:
    """What the torques have done to the arm since the last tick, but for lifting it, J."""
    work = sum(torque @ way for (torque, _), way in zip(held.acted[-1], held.turned[-1], strict=True))
    return work - (potential(s) - potential(held.states[-1]))
