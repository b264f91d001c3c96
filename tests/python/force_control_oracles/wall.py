"""A plane without edges that moves along its normal, and what it does to a tip."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .arm import Motion


@dataclass(frozen=True)
class Law:
    """Normal force (depth m, rate m/s) -> N and its elastic part; where `release` falls below 0, contact ends."""

    normal: Callable[[float, float], float]
    elastic: Callable[[float], float]
    stored: Callable[[float], float]
    release: Callable[[float, float], float] | None = None
    friction: float = 0.0
    slip: float = 1e-3


def spring(k: float) -> Law:
    return Law(lambda depth, _: k * depth, lambda depth: k * depth, lambda depth: k * depth**2 / 2)


def kelvin_voigt(k: float, c: float, friction: float = 0.0, slip: float = 1e-3) -> Law:
    def normal(depth: float, rate: float) -> float:
        return k * depth + c * rate

    return Law(normal, lambda depth: k * depth, lambda depth: k * depth**2 / 2, normal, friction, slip)


def hunt_crossley(k: float, p: float, beta: float) -> Law:
    def elastic(depth: float) -> float:
        return k * max(depth, 0.0) ** p

    return Law(
        lambda depth, rate: elastic(depth) * (1 + beta * rate),
        elastic,
        lambda depth: k * max(depth, 0.0) ** (p + 1) / (p + 1),
        lambda _, rate: 1 + beta * rate,
    )


@dataclass(frozen=True)
class Wall:
    """Outward normal, a point at t = 0, and how far it has come along the normal: advance(t) m, speed(t) m/s."""

    law: Law
    point: np.ndarray
    normal: np.ndarray
    advance: Callable[[float], float]
    speed: Callable[[float], float]

    def depth(self, t: float, x: np.ndarray) -> float:
        return float(self.normal @ (self.point - x) + self.advance(t))

    def velocity(self, t: float) -> np.ndarray:
        return self.speed(t) * self.normal

    def rate(self, t: float, xd: np.ndarray) -> float:
        return float(self.speed(t) - self.normal @ xd)

    def sliding(self, xd: np.ndarray) -> np.ndarray:
        """Velocity of the tip along the surface, which itself moves along the normal only."""
        return xd - self.normal * (self.normal @ xd)

    def force(self, t: float, s: Motion) -> np.ndarray:
        """On the tip, while contact lasts."""
        f = self.law.normal(self.depth(t, s.x), self.rate(t, s.xd))
        sliding = self.sliding(s.xd)
        drag = self.law.friction * f / np.sqrt(sliding @ sliding + self.law.slip**2)
        return f * self.normal - drag * sliding

    def release(self, t: float, s: Motion) -> float:
        return self.law.release(self.depth(t, s.x), self.rate(t, s.xd))
