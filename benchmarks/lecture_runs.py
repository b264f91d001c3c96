"""Many lecture runs: for ten seconds the moving wall pushes the compensated arm, whose pose is random. CSV out.

python benchmarks/lecture_runs.py

First the stiffness at random between 1e2 and 1e6 N/m, a million runs or as many as there is time for; then the same
stiffness for all, from 1e2 to 1e7 N/m.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from ours import BUILD, PUSHED, SOLVERS, Batch, from_poses, known, poses
from table import Racer, Runner, Table, installed, race

MOST, PROBED, SOME = 1_000_000, 2048, 64
LONG, ENOUGH = 12e9, 1.5e9  # ns: who takes longer for a million does as many as take this long
SETTINGS = {"taylor": 1e-8, "dopri5": 1e-9, "rk4": 1e-3}  # adaptive: for errors below 1e-8 rad
EXACT, LOOSE = 1e-16, 1e-7  # heyoka's tolerances: of the reference, and for such errors
STIFFNESSES = 1e2, 1e3, 1e4, 1e5, 1e6, 1e7  # N/m

Maker = Callable[[np.ndarray, np.ndarray], Runner]  # of poses and stiffness


def ours(q: np.ndarray, stiffness: np.ndarray, *, method: str, threads: int = 1) -> Batch:
    varied = from_poses(q) | {"wall.contact.stiffness": stiffness}
    return Batch(PUSHED, varied, solver=SOLVERS[method](SETTINGS[method]), threads=threads)


def heyoka(tolerance: float) -> tuple[str, Maker | None]:
    """Its build and what makes its runs."""
    if not installed("heyoka"):
        return "not installed; the errors of all are measured against it", None
    from peer_heyoka import BUILD as build
    from peer_heyoka import Pushes

    return build, lambda q, stiffness: Pushes(q, tolerance, stiffness=stiffness)


def exact(q: np.ndarray, stiffness: np.ndarray) -> np.ndarray | None:
    make = heyoka(EXACT)[1]
    if make is None:
        return None
    reference = make(q, stiffness)
    reference.run()
    return reference.q


def at_random(runs: int) -> tuple[np.ndarray, np.ndarray]:
    return poses(runs), 10 ** np.random.default_rng(2).uniform(2, 6, runs)


def affordable(make: Maker) -> int:
    each = Racer("", "", make(*at_random(PROBED)), PROBED).nanoseconds()
    return MOST if each * MOST < LONG else max(SOME, int(ENOUGH / each))


def many(table: Table, methods: list[str]) -> None:
    job, truth = "lecture run, stiffness at random", exact(*at_random(SOME))
    for method in methods:
        runs = affordable(partial(ours, method=method))
        for threads, note in (1, ""), (2, ", 2 threads"):
            batch = ours(*at_random(runs), method=method, threads=threads)
            for again in ("", ", again") if runs == MOST else ("",):  # the first time in new memory
                racer = Racer(f"arm3r {method}{note}{again}", BUILD, batch, runs, f"runs={runs}", truth)
                race(table, job, "us", [racer], seconds=0)
    build, make = heyoka(LOOSE)
    runs = affordable(make) if make else 0
    racer = Racer("heyoka, one by one", build, make and make(*at_random(runs)), runs, f"runs={runs}", truth)
    race(table, job, "us", [racer], seconds=0)


def by_stiffness(table: Table, methods: list[str]) -> None:
    makers: dict[tuple[str, str], Maker | None] = {
        (f"arm3r {method}", BUILD): partial(ours, method=method) for method in methods
    }
    build, make = heyoka(LOOSE)
    makers["heyoka, one by one", build] = make
    for k in STIFFNESSES:
        sample = poses(SOME), np.full(SOME, k)
        truth = exact(*sample)
        racers = [
            Racer(who, build, make and make(*sample), SOME, f"K={k:g}", truth) for (who, build), make in makers.items()
        ]
        race(table, "lecture run, by stiffness", "us", racers, seconds=1)


table = Table()
methods = [method for method in SETTINGS if known(method)]
many(table, methods)
by_stiffness(table, methods)
