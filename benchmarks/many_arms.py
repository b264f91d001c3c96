"""RK4 steps of n arms at once, n from 1 to a million, ours through the C interface beside the peers. CSV out.

python benchmarks/many_arms.py PROGRAM    # arm3r_benchmarks: peer_loop's library lies beside it
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from ours import BUILD, Batch, from_poses, poses
from peer_arms import WALL_NEAR
from peer_loop import Loop
from table import Racer, Runner, Table, installed, race

STEP, STEPS = 1e-3, 500
COUNTS = 1, 8, 64, 512, 4096, 32_768, 1_000_000
LONGEST = 25.0  # s: who would take longer for one turn sits out
SECONDS = 1.0  # a race

FALLING = f"format: 1\ntime: {{stop: {STEP * STEPS}, log_every: {STEP * STEPS}}}\n"
SAMPLED = f"{FALLING}wall: {{acts_on_arm: true, point: [{WALL_NEAR}, 0, 0]}}\nsampling: {{rate: {1 / STEP}}}\n"
HYBRID = f"{SAMPLED}controller: {{type: hybrid}}"
FORCE_FEEDBACK = f"{SAMPLED}controller: {{type: hybrid, variant: jacobian_transpose}}"
END = ["outcome", "q1", "q2", "q3"]
PEAK, ERROR = [*END, "peak_force"], [*END, "force_error_rms"]
PUSHED = f"{FALLING}wall: {{acts_on_arm: true, point: [{WALL_NEAR}, 0, 0]}}\ncontroller: {{type: gravity_compensation}}"


@dataclass
class Entry:
    """One who takes part at every n, unless that would take too long."""

    who: str
    build: str
    make: Callable[[np.ndarray], Runner] | None
    each: float = 0.0  # ns an arm and step, of many arms

    def racer(self, q: np.ndarray) -> Racer | None:
        steps = len(q) * STEPS
        if steps * self.each > LONGEST * 1e9:
            message = f"skipped: {self.who} with n={len(q)} takes {steps * self.each * 1e-9:.0f} s"
            print(message, file=sys.stderr)
            return None
        racer = Racer(self.who, self.build, self.make and self.make(q), steps, f"n={len(q)}")
        if racer.runner and len(q) in COUNTS[2:5]:
            self.each = racer.nanoseconds()
        return racer


def ours(q: np.ndarray, text: str, threads: int, metrics: Sequence[str] | None = None) -> Batch:
    return Batch(text, from_poses(q), solver={"method": "rk4", "step": STEP}, threads=threads, metrics=metrics)


def rollouts() -> list[Entry]:
    names = {1: "MuJoCo rollout", 2: "MuJoCo rollout, 2 threads"}
    if not installed("mujoco"):
        return [Entry(who, "not installed", None) for who in names.values()]
    from peer_rollout import BUILD as build
    from peer_rollout import Rollout

    return [Entry(who, build, partial(Rollout, steps=STEPS, threads=threads)) for threads, who in names.items()]


def check(entries: list[Entry], q: np.ndarray) -> None:
    """All come to the same angles."""
    runners = [entry.make(q) for entry in entries if entry.make]
    for runner in runners:
        runner.run()
        np.testing.assert_allclose(runner.q, runners[0].q, rtol=0, atol=1e-9)


def compare(table: Table, job: str, entries: list[Entry], spread: list[float]) -> None:
    check(entries, poses(64, spread=spread))
    for n in COUNTS:
        q = poses(n, spread=spread)
        race(table, job, "ns", [racer for entry in entries if (racer := entry.racer(q))], seconds=SECONDS)


def main() -> None:
    library = Path(sys.argv[1]).with_name("libarm3r_peer_loop.so")
    table = Table()
    for job, text, pushed, more, spread in (
        ("free fall", FALLING, False, rollouts(), [5, 5, 5]),
        ("compensation and two-way wall", PUSHED, True, [], [1, 0, 0]),  # no farther out: all are pushed
    ):
        loop = partial(Loop, library, pushed=pushed, step=STEP, steps=STEPS)
        entries = [
            Entry("arm3r batch", BUILD, partial(ours, text=text, threads=1)),
            Entry("arm3r batch, 2 threads", BUILD, partial(ours, text=text, threads=2)),
            Entry("C loop, omp simd", loop(poses(1)).build, loop)
            if library.exists()
            else Entry("C loop, omp simd", "not found when this was built", None),
            *more,
        ]
        compare(table, f"RK4 step of many arms, {job}", entries, spread)
    for job, text in (("hybrid controller at 1 kHz", HYBRID), ("force feedback at 1 kHz", FORCE_FEEDBACK)):
        entries = [
            Entry("arm3r batch", BUILD, partial(ours, text=text, threads=1)),
            Entry("arm3r batch, 2 threads", BUILD, partial(ours, text=text, threads=2)),
            Entry("arm3r batch, peak force alone", BUILD, partial(ours, text=text, threads=1, metrics=PEAK)),
            Entry("arm3r batch, force error alone", BUILD, partial(ours, text=text, threads=1, metrics=ERROR)),
        ]
        compare(table, f"RK4 step of many arms, {job}", entries, [1, 0, 0])


main()
