"""MuJoCo's rollout: many runs over threads, in free fall."""

from __future__ import annotations

from importlib.metadata import version

import mujoco
import mujoco.rollout
import numpy as np
from peer_arms import mujoco_model

BUILD = f"MuJoCo {version('mujoco')}, its own wheel, its clock off"


class Rollout:
    """RK4 steps of 1 ms of many arms, from rest in the poses q: (n, 3), rad."""

    def __init__(self, q: np.ndarray, *, steps: int, threads: int) -> None:
        self._model = mujoco_model()
        self._data = [mujoco.MjData(self._model) for _ in range(threads)]
        self._pool = mujoco.rollout.Rollout(nthread=threads)
        self._start = np.concatenate([np.zeros((len(q), 1)), q, np.zeros_like(q)], axis=-1)
        self._steps = steps

    def run(self) -> None:
        self._states, _ = self._pool.rollout(self._model, self._data, self._start, nstep=self._steps)

    @property
    def q(self) -> np.ndarray:
        """Final joint angles: (n, 3), rad."""
        return self._states[:, -1, 1:4]
