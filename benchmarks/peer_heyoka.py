"""heyoka's Taylor integrators of the arm, tuned: link angles as state, not compact, fast_math, no extra accuracy."""

from __future__ import annotations

import os
import time
from importlib.metadata import version
from typing import Any

import heyoka
import numpy as np
from peer_arms import STIFFNESS, WALL_FAR, WALL_SPEED, joint_angles, link_angles, rate, reach

BUILD = f"heyoka {version('heyoka')}, its own wheel; compact_mode=False, fast_math=True"
TUNED = {"compact_mode": False, "high_accuracy": False, "fast_math": True}
LANES = int(os.environ.get("HEYOKA_LANES", 8))

Y = heyoka.make_vars("q1", "p2", "p3", "w1", "w2", "w3")
DEPTH = reach(heyoka, Y) - (WALL_FAR - WALL_SPEED * heyoka.time)
TOUCHES, HARDNESS = heyoka.par[0], heyoka.par[1]
FALLING = list(zip(Y, rate(heyoka, Y), strict=True))
PUSHED = list(zip(Y, rate(heyoka, Y, weight=0, push=-TOUCHES * HARDNESS * DEPTH), strict=True))


def at_rest(q: np.ndarray) -> np.ndarray:
    return np.concatenate([link_angles(q), np.zeros_like(q)], axis=-1)


class Falls:
    """Free falls of 2 s, one after the other, from rest in the poses q: (runs, 3), rad."""

    END = 2.0

    def __init__(self, q: np.ndarray, tol: float) -> None:
        self._starts = self._arranged(at_rest(q))
        self._ends = np.empty_like(self._starts)
        self._integrator = self._made(tol)

    def _arranged(self, starts: np.ndarray) -> np.ndarray:
        return starts

    def _made(self, tol: float) -> Any:
        return heyoka.taylor_adaptive(FALLING, self._starts[0].copy(), tol=tol, **TUNED)

    def _rewind(self, index: int) -> None:
        self._integrator.time = 0.0

    def run(self) -> float:
        """The nanoseconds that heyoka had: calling it from Python is counted, setting the start is not."""
        spent = 0
        for index, (start, end) in enumerate(zip(self._starts, self._ends, strict=True)):
            self._rewind(index)
            self._integrator.state[:] = start
            begun = time.perf_counter_ns()
            self._integrator.propagate_until(self.END)
            spent += time.perf_counter_ns() - begun
            end[:] = self._integrator.state
        return spent

    @property
    def q(self) -> np.ndarray:
        """Final joint angles: (runs, 3), rad."""
        return joint_angles(self._ends[:, :3])


class FallsTogether(Falls):
    """The same, LANES side by side; their number is a multiple of it."""

    def _arranged(self, starts: np.ndarray) -> np.ndarray:
        return starts.reshape(-1, LANES, 6).swapaxes(1, 2).copy()

    def _made(self, tol: float) -> Any:
        return heyoka.taylor_adaptive_batch(FALLING, self._starts[0].copy(), tol=tol, **TUNED)

    def _rewind(self, index: int) -> None:
        self._integrator.set_time(0.0)

    @property
    def q(self) -> np.ndarray:
        return joint_angles(self._ends.swapaxes(1, 2).reshape(-1, 6)[:, :3])


def _switch(integrator: Any, direction: int) -> bool:
    integrator.pars[0] = 1 - integrator.pars[0]
    return True


class Pushes(Falls):
    """Ten seconds of the lecture's wall pushing the compensated arm; make and break are located as events."""

    END = 10.0

    def __init__(self, q: np.ndarray, tol: float, *, stiffness: np.ndarray | float = STIFFNESS) -> None:
        super().__init__(q, tol)
        self._stiffness = np.broadcast_to(stiffness, len(q))

    def _made(self, tol: float) -> Any:
        return heyoka.taylor_adaptive(
            PUSHED,
            self._starts[0].copy(),
            pars=[0.0, STIFFNESS],
            t_events=[heyoka.t_event(DEPTH, callback=_switch)],
            tol=tol,
            **TUNED,
        )

    def _rewind(self, index: int) -> None:
        super()._rewind(index)
        self._integrator.reset_cooldowns()
        self._integrator.pars[:] = 0.0, self._stiffness[index]


def grid(q: np.ndarray, tol: float, times: np.ndarray) -> Any:
    """What runs one fall from q, (3,), and returns its states at `times`: (times, 6)."""
    run = grids(q[np.newaxis], tol, times)
    return lambda: run()[0]


def grids(q: np.ndarray, tol: float, times: np.ndarray) -> Any:
    """What runs falls from q, (runs, 3), one by one, and returns their states at `times`: (runs, times, 6)."""
    starts = at_rest(q)
    integrator = heyoka.taylor_adaptive(FALLING, starts[0].copy(), tol=tol, **TUNED)
    states = np.empty((len(q), len(times), 6))

    def run() -> np.ndarray:
        for start, own in zip(starts, states, strict=True):
            integrator.time, integrator.state[:] = 0.0, start
            own[...] = integrator.propagate_grid(times)[-1]
        return states

    return run
