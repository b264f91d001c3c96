"""One free fall of 2 s from Python with 201 rows, tolerances of 1e-9. CSV out.

python benchmarks/one_run.py
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

import arm3r_cpp as arm3r
import numpy as np
from ours import BUILD, SOLVERS, known
from peer_arms import joint_angles, link_angles
from table import Racer, Table, installed, race

START, TIMES, TOLERANCE = np.radians([0.0, -30.0, 60.0]), np.linspace(0, 2, 201), 1e-9
SECONDS = 2.0


class Rows:
    """A run with rows, by a function that returns their joint angles: (rows, 3)."""

    def __init__(self, function: Callable[[], np.ndarray]) -> None:
        self._function = function

    def run(self) -> None:
        self._rows = self._function()

    @property
    def q(self) -> np.ndarray:
        return self._rows[-1:]


def ours(method: str) -> Rows:
    scenario = arm3r.Scenario("format: 1\ntime: {stop: 2, log_every: 0.01}")
    scenario["solver"] = SOLVERS[method](TOLERANCE)

    def angles() -> np.ndarray:
        run = scenario.run()
        return np.stack([run["q1"], run["q2"], run["q3"]], axis=-1)

    return Rows(angles)


def heyoka(tolerance: float) -> Rows:
    from peer_heyoka import grid

    run = grid(START, tolerance, TIMES)
    return Rows(lambda: joint_angles(run()[:, :3]))


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
        Racer(f"arm3r {method}, Scenario.run()", BUILD, ours(method), exact=exact)
        for method in ("taylor", "dopri5")
        if known(method)
    ]
    for who, package, make in (
        ("heyoka, propagate_grid", "heyoka", lambda: heyoka(TOLERANCE)),
        ("scipy DOP853, t_eval", "scipy", scipy),
    ):
        there = installed(package)
        build = import_module(f"peer_{package}").BUILD if there else "not installed"
        racers.append(Racer(who, build, make() if there else None, exact=exact))
    return racers


table = Table()
race(table, "2 s of free fall from Python, 201 rows", "us", racers(), seconds=SECONDS)
