"""The instructions that a build takes for the jobs of the benchmarks, a unit of work each.

    python benchmarks/instruction_jobs.py    # prints the counts of the build that this interpreter has, as JSON

Every job is counted for two lengths and the difference is taken, so that everything but the work cancels. Only public
names are used, because builds of different ages are compared.
"""

from __future__ import annotations

import gc
import json
import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import arm3r_cpp as arm3r
import numpy as np
from callgrind import counts

WALL = Path(__file__).parents[1] / "scenarios" / "moving_wall.yaml"
NEAR_WALL = {"wall.acts_on_arm": True, "wall.point": [1.735, 0, 0]}  # 3 mm from the tip
HYBRID = {"controller": {"type": "hybrid"}, "sampling": {"rate": 1000}, "reference": {"force": {"value": 20}}}
SAMPLED = {"sampling": {"rate": 1000}}
RK4, DOPRI5, TAYLOR = {"method": "rk4", "step": 1e-3}, {"method": "dopri5"}, {"method": "taylor"}
STIFFNESSES = 10 ** np.random.default_rng(1).uniform(2, 6, 1000)  # N/m
STATES = np.random.default_rng(1).uniform(-1, 1, (3, 100_000, 3))


class Job(NamedTuple):
    """`do(n)` does n units of work; it is counted for `few` and for three times as many."""

    unit: str
    few: int
    do: Callable[[int], object]

    @property
    def many(self) -> int:
        return 3 * self.few


def scenario(solver: dict[str, Any], *changes: dict[str, Any], stop: float = 1.0) -> arm3r.Scenario:
    """The wall pushes the tip of the arm; only the last row is kept."""
    made = arm3r.Scenario.load(WALL)
    everything = {"checks": [], "solver": solver, "time": {"stop": stop, "log_every": stop}} | NEAR_WALL
    for change in (everything, *changes):
        for key, value in change.items():
            made[key] = value
    return made


def runs(method: str) -> Callable[[int], object]:
    pushed = scenario({"method": method})
    return lambda n: [pushed.run() for _ in range(n)]


def batch(solver: dict[str, Any], *changes: dict[str, Any]) -> Callable[[int], object]:
    pushed = scenario(solver, *changes)
    return lambda n: pushed.batch({"wall.contact.stiffness": STIFFNESSES[:n]}, threads=1)


def steps(solver: dict[str, Any], *changes: dict[str, Any], rows: bool = False) -> Callable[[int], object]:
    """One run over n milliseconds."""

    def do(n: int) -> None:
        stop = n / 1000
        scenario(solver, *changes, {"time": {"stop": stop, "log_every": 1e-3 if rows else stop}}).run()

    return do


def by_function(n: int) -> None:
    scenario(RK4, SAMPLED, stop=n / 1000).run(controller=lambda t, state: state.tau_g)


def by_simulation(n: int) -> None:
    simulation = arm3r.Simulation(scenario(DOPRI5, SAMPLED, stop=n / 1000))
    while not simulation.is_over:
        simulation.step(simulation.state.tau_g)


def forward_dynamics(n: int) -> None:
    arm3r.Scenario.load(WALL).arm.forward_dynamics(*STATES[:, :n])


JOBS = {
    "RK4 step, free fall": Job("step", 2000, steps(RK4, {"wall": None, "controller": {"type": "none"}})),
    "RK4 step, compensation and two-way wall": Job("step", 2000, steps(RK4)),
    "RK4 step, hybrid controller at 1 kHz": Job("step", 1000, steps(RK4, HYBRID)),
    "a row by dopri5, one-way wall": Job("row", 500, steps(DOPRI5, {"wall.acts_on_arm": False}, rows=True)),
    "a row by dopri5, hybrid controller at 1 kHz": Job("row", 200, steps(DOPRI5, HYBRID, rows=True)),
    "a run of 1 s by dopri5": Job("run", 3, runs("dopri5")),
    "a run of 1 s by rodas4": Job("run", 2, runs("rodas4")),
    "a run of 1 s by auto": Job("run", 2, runs("auto")),
    "a run of 1 s by taylor": Job("run", 5, runs("taylor")),
    "a batch by RK4": Job("run", 8, batch(RK4)),
    "a batch by taylor": Job("run", 40, batch(TAYLOR)),
    "a batch by RK4, hybrid controller at 1 kHz": Job("run", 8, batch(RK4, HYBRID)),
    "a batch by dopri5": Job("run", 8, batch(DOPRI5)),
    "a tick of a law in Python": Job("tick", 200, by_function),
    "a tick of Simulation.step": Job("tick", 200, by_simulation),
    "forward dynamics of many states": Job("state", 10_000, forward_dynamics),
    "a scenario, read and checked": Job("scenario", 5, lambda n: [scenario(RK4).validate() for _ in range(n)]),
}


def do_jobs() -> None:
    """Run by valgrind: a mark stands after the warm-up, the few and the many of every job."""
    gc.disable()
    for job in JOBS.values():
        for times in (job.few, job.few, job.many):
            job.do(times)
            os.getppid()


def collect() -> dict[str, float]:
    """Instructions a unit, by job."""
    parts = counts([sys.executable, __file__, "--jobs"])
    if len(parts) != 3 * len(JOBS) + 1:
        raise SystemExit(f"valgrind saw {len(parts)} parts instead of {3 * len(JOBS) + 1}: a job calls getppid")
    counted = {}
    for index, (name, job) in enumerate(JOBS.items()):
        few, many = parts[3 * index + 1 : 3 * index + 3]
        counted[f"{name}, each {job.unit}"] = (many - few) / (job.many - job.few)
    return counted | executable()


def executable() -> dict[str, float]:
    """The executable: what it costs to start, and a row with its line of CSV."""
    program, few, many = Path(arm3r.__file__).parent / "bin" / "arm3r", 500, 1500
    with tempfile.TemporaryDirectory() as folder:
        words = [program, "run", WALL, "-o", Path(folder) / "wall.csv", "--set", "checks=[]", "--set"]
        whole = {rows: counts([*words, f"time.stop={rows / 1000}"])[0] for rows in (few, many)}
    each = (whole[many] - whole[few]) / (many - few)
    return {"a row with its line of CSV": each, "start and end of the executable": whole[few] - few * each}


if __name__ == "__main__":
    if sys.argv[1:] == ["--jobs"]:
        do_jobs()
    else:
        json.dump(collect(), sys.stdout)
