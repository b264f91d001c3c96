"""Free falls of 2 s from Python with 201 rows, tolerances of 1e-9: one, and many in a batch. CSV out.

python benchmarks/one_run.py
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

import arm3r_cpp as arm3r
import numpy as np
from ours import BUILD, SOLVERS, known, poses
from peer_arms import joint_angles, link_angles
from table import Racer, Table, installed, race

START, TIMES, TOLERANCE = np.radians([0.0, -30.0, 60.0]), np.linspace(0, 2, 201), 1e-9
STATES = ["q1", "q2", "q3", "qd1", "qd2", "qd3"]
MANY, SECONDS = 256, 2.0
TIMES_A_TURN = 20  # of one run: the first one after another contender is slower


class Rows:
    """A run with rows, by a function that returns their joint angles: (rows, 3)."""

    def __init__(self, function: Callable[[], np.ndarray], times: int = 1) -> None:
        self._function, self.times = function, times

    def run(self) -> None:
        for _ in range(self.times):
            self._rows = self._function()

    @property
    def q(self) -> np.ndarray:
        return self._rows[-1:]


class LastRows(Rows):
    """Many runs, by a function that returns their last joint angles: (runs, 3)."""

    @property
    def q(self) -> np.ndarray:
        return self._rows


def falling(method: str, columns: list[str] | None = None) -> arm3r.Scenario:
    scenario = arm3r.Scenario("format: 1\ntime: {stop: 2, log_every: 0.01}")
    scenario["solver"] = SOLVERS[method](TOLERANCE)
    scenario["time.log_columns"] = columns
    return scenario


def ours(method: str, columns: list[str] | None) -> Rows:
    scenario = falling(method, columns)
    return Rows(lambda: scenario.run()["q"], TIMES_A_TURN)


def ours_in_a_batch(method: str, q: np.ndarray, threads: int) -> LastRows:
    scenario = falling(method)
    return LastRows(lambda: scenario.batch({"initial.q": q}, columns=STATES, threads=threads).rows["q"][:, -1])


def heyoka(tolerance: float) -> Rows:
    from peer_heyoka import grid

    run = grid(START, tolerance, TIMES)
    return Rows(lambda: joint_angles(run()[:, :3]), TIMES_A_TURN)


def heyoka_one_by_one(tolerance: float, q: np.ndarray) -> LastRows:
    from peer_heyoka import grids

    run = grids(q, tolerance, TIMES)
    return LastRows(lambda: joint_angles(run()[:, -1, :3]))


def scipy() -> Rows:
    from peer_scipy import solve

    return Rows(lambda: joint_angles(solve(link_angles(START), TOLERANCE, TIMES).y[:3].T))


def racers() -> list[Racer]:
    exact = None
    if installed("heyoka"):
        reference = heyoka(1e-16)
        reference.run()
        exact = reference.q
    racers = [
        Racer(f"arm3r {method}, {what}", BUILD, ours(method, columns), TIMES_A_TURN, exact=exact)
        for method in ("taylor", "dopri5")
        if known(method)
        for what, columns in (("states", STATES), ("all columns", None))
    ]
    for who, package, make in (
        ("heyoka, propagate_grid", "heyoka", lambda: heyoka(TOLERANCE)),
        ("scipy DOP853, t_eval", "scipy", scipy),
    ):
        there = installed(package)
        build = import_module(f"peer_{package}").BUILD if there else "not installed"
        runner = make() if there else None
        racers.append(Racer(who, build, runner, runner.times if runner else 1, exact=exact))
    return racers


def racers_of_many() -> list[Racer]:
    q, there = poses(MANY), installed("heyoka")
    reference = heyoka_one_by_one(1e-16, q) if there else None
    if reference:
        reference.run()
    exact = reference.q if reference else None
    racers = [
        Racer(f"arm3r taylor, Scenario.batch(){note}", BUILD, ours_in_a_batch("taylor", q, threads), MANY, exact=exact)
        for threads, note in ((1, ""), (2, ", 2 threads"))
        if known("taylor")
    ]
    build = import_module("peer_heyoka").BUILD if there else "not installed"
    runner = heyoka_one_by_one(TOLERANCE, q) if there else None
    return [*racers, Racer("heyoka, propagate_grid, one by one", build, runner, MANY, exact=exact)]


table = Table()
race(table, "2 s of free fall from Python, 201 rows", "us", racers(), seconds=SECONDS)
race(table, f"{MANY} of them, 201 rows of states each", "us", racers_of_many(), seconds=SECONDS)
