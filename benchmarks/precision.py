"""Time a run against the error of its final angles: 2 s of free fall, and ten with the two-way wall. CSV out.

python benchmarks/precision.py
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from ours import BUILD, FALLING, PUSHED, SOLVERS, Batch, from_poses, known, poses
from table import Racer, Runner, Table, installed, race

STEPS = [1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4]
TOLERANCES = np.geomspace(1e-5, 1e-13, 13).tolist()
EXACT = 1e-16  # the tolerance of the reference
MANY, SOME, FEW = 256, 64, 4  # runs a turn: they share what a call costs
SECONDS = 10.0  # a race


@dataclass
class Method:
    who: str
    build: str
    make: Callable[[np.ndarray, float], Runner] | None  # of poses and a setting
    knob: str = "tol"
    settings: Sequence[float] = tuple(TOLERANCES)
    runs: int = MANY

    def racers(self, q: np.ndarray, exact: np.ndarray) -> list[Racer]:
        if not self.make:
            return [Racer(self.who, self.build, None)]
        q = q[: self.runs]
        return [
            Racer(self.who, self.build, self.make(q, setting), len(q), f"{self.knob}={setting:.2g}", exact)
            for setting in self.settings
        ]


def ours(text: str) -> list[Method]:
    def method(name: str, lanes: int) -> Callable[[np.ndarray, float], Runner]:
        return lambda q, setting: Batch(text, from_poses(q), solver=SOLVERS[name](setting), lanes=lanes)

    methods = [
        Method("arm3r rk4", BUILD, method("rk4", 0), "step", STEPS, SOME),
        Method("arm3r dopri5", BUILD, method("dopri5", 0), "rtol"),
    ]
    if known("taylor"):
        methods += [
            Method("arm3r taylor", BUILD, method("taylor", 0)),
            Method("arm3r taylor, one by one", BUILD, method("taylor", 1)),
        ]
    return methods


def scipys(kind: str) -> Method:
    if not installed("scipy"):
        return Method("scipy DOP853", "not installed", None)
    import peer_scipy

    return Method("scipy DOP853", peer_scipy.BUILD, getattr(peer_scipy, kind), "rtol", TOLERANCES, FEW)


def main() -> None:
    table, q = Table(), poses(MANY)
    for job, text, kind in ("2 s of free fall", FALLING, "Falls"), ("10 s, pushed by the wall", PUSHED, "Pushes"):
        if not installed("heyoka"):
            table.row(job, "heyoka", "not installed; the errors of all are measured against it", "us", [])
            continue
        import peer_heyoka

        runs = getattr(peer_heyoka, kind)
        reference = runs(q, EXACT)
        reference.run()
        methods = [*ours(text), Method("heyoka, one by one", peer_heyoka.BUILD, runs), scipys(kind)]
        if kind == "Falls":
            methods.append(
                Method(f"heyoka, batch of {peer_heyoka.LANES}", peer_heyoka.BUILD, peer_heyoka.FallsTogether)
            )
        race(table, job, "us", [racer for m in methods for racer in m.racers(q, reference.q)], seconds=SECONDS)


main()
