"""scipy's DOP853 on the arm, the right-hand side in plain Python."""

from __future__ import annotations

import math
from importlib.metadata import version
from typing import Any

import numpy as np
from peer_arms import STIFFNESS, WALL_FAR, WALL_SPEED, joint_angles, link_angles, rate, reach
from scipy.integrate import solve_ivp

BUILD = f"scipy {version('scipy')}, solve_ivp, DOP853, right-hand side in Python"


def falling(t: float, y: np.ndarray) -> list[float]:
    return rate(math, y.tolist())


def depth(t: float, y: np.ndarray) -> float:
    return reach(math, y.tolist()) - (WALL_FAR - WALL_SPEED * t)


def pushed(t: float, y: np.ndarray, touches: bool) -> list[float]:
    return rate(math, y.tolist(), weight=0, push=-STIFFNESS * depth(t, y) if touches else 0.0)


def solve(start: np.ndarray, rtol: float, times: np.ndarray | None = None) -> Any:
    """One fall of 2 s, from rest in link angles; `times`: where its states are wanted."""
    options = {"method": "DOP853", "rtol": rtol, "atol": rtol * 1e-3, "t_eval": times}
    return solve_ivp(falling, (0.0, 2.0), np.append(start, np.zeros(3)), **options)


class Falls:
    """Free falls of 2 s, one after the other, from rest in the poses q: (runs, 3), rad."""

    def __init__(self, q: np.ndarray, rtol: float) -> None:
        self._starts, self._rtol = link_angles(q), rtol

    def run(self) -> None:
        self._ends = np.array([self._one(start) for start in self._starts])

    def _one(self, start: np.ndarray) -> np.ndarray:
        return solve(start, self._rtol).y[:3, -1]

    @property
    def q(self) -> np.ndarray:
        """Final joint angles: (runs, 3), rad."""
        return joint_angles(self._ends)


class Pushes(Falls):
    """Ten seconds of the lecture's wall pushing the compensated arm, taken up again at each make and break."""

    def _one(self, start: np.ndarray) -> np.ndarray:
        options = {"method": "DOP853", "rtol": self._rtol, "atol": self._rtol * 1e-3, "max_step": 0.5}
        t, y, touches = 0.0, np.append(start, np.zeros(3)), False
        while t < 10.0:

            def crosses(t: float, y: np.ndarray, touches: bool) -> float:
                return depth(t, y)

            crosses.terminal, crosses.direction = True, -1.0 if touches else 1.0
            leg = solve_ivp(pushed, (t, 10.0), y, args=(touches,), events=crosses, **options)
            t, y, touches = leg.t[-1], leg.y[:, -1], not touches
        return y[:3]
