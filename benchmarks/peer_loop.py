"""peer_loop.c, as built beside the C++ benchmarks."""

from __future__ import annotations

import ctypes
import time
from pathlib import Path

import numpy as np
from peer_arms import A1, A2, A3, B2, B3, G2, G3, LENGTH, STIFFNESS, WALL_NEAR, WALL_SPEED, B, joint_angles, link_angles

ARM = (ctypes.c_double * 10)(A1, A2, A3, B2, B3, B, G2, G3, LENGTH, LENGTH)
WALL = (ctypes.c_double * 3)(WALL_NEAR, WALL_SPEED, STIFFNESS)


class Loop:
    """RK4 steps of many arms, from rest in the poses q: (n, 3), rad."""

    def __init__(self, library: Path, q: np.ndarray, *, pushed: bool, step: float, steps: int) -> None:
        loaded = ctypes.CDLL(str(library))
        loaded.loop_build.restype = ctypes.c_char_p
        self.build = loaded.loop_build().decode() + ", fused multiply-add, libmvec"
        self._loop = loaded.loop_pushed if pushed else loaded.loop_falling
        self._start = np.concatenate([link_angles(q), np.zeros_like(q)], axis=-1).T.copy()
        self._state = self._start.copy()
        state = self._state.ctypes.data_as(ctypes.c_void_p)
        self._arguments = ARM, WALL, ctypes.c_double(step), steps, ctypes.c_size_t(len(q)), state

    def run(self) -> float:
        """The nanoseconds of the steps."""
        self._state[:] = self._start
        begun = time.perf_counter_ns()
        self._loop(*self._arguments)
        return time.perf_counter_ns() - begun

    @property
    def q(self) -> np.ndarray:
        """Final joint angles: (n, 3), rad."""
        return joint_angles(self._state[:3].T)
