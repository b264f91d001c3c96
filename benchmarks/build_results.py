"""Everything that a build of arm3r answers, as texts by name. `compare_builds.py` compares two such collections.

    python benchmarks/build_results.py    # prints the results of the build that this interpreter has, as JSON

Only public names are used, because builds of different ages are compared. An array stands as the hash of its bytes, all
else as its own text.
"""

from __future__ import annotations

import csv
import hashlib
import inspect
import json
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
from build_surface import Results, command, message, messages, pages, public_names, symbols

SCENARIOS = Path(__file__).parents[1] / "scenarios"
METHODS = ("dopri5", "rodas4", "auto", "rk4", "taylor")
STIFFNESSES = np.geomspace(500, 1e4, 11)  # more runs than there are lanes, and no multiple of them
BATCHES: dict[str, dict[str, Any]] = {
    "moving_wall.yaml": {"wall.contact.stiffness": STIFFNESSES, "wall.acts_on_arm": True},
    "force_control/hybrid_moving_wall.yaml": {"wall.contact.stiffness": STIFFNESSES},
    "sampled_control/sampled_with_sensors.yaml": {"wall.contact.stiffness": STIFFNESSES},
}
SWEEPS: dict[str, list[str]] = {
    "poses": ["--set", "time.log_every=0.1"],  # 1000 runs, each with rows for its statistics
    "stiffness": [],
    "stiffness_and_speed": [],
    "tolerance": [],
}

# These entries of a summary are no results: wall-clock time, the build's own name, and a hash over all columns and
# their list, which a new column changes.
NOT_RESULTS = {"elapsed_s", "version", "hash", "columns"}


def digest(array: np.ndarray) -> str:
    """A short hash of the bytes of an array."""
    return hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest()[:16]


def entries(name: str, value: Any) -> Results:
    """Every entry of nested dicts and lists of dicts, such as events and checks, by its path."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key not in NOT_RESULTS:
                yield from entries(f"{name}.{key}", inner)
    elif isinstance(value, list) and all(isinstance(item, dict) for item in value):
        yield f"{name}, how many", str(len(value))
        for index, item in enumerate(value):
            yield from entries(f"{name}[{index}]", item)
    else:
        yield name, repr(value)


def run_results(name: str, make: Callable[[], arm3r.Run]) -> Results:
    """Columns and summary of a run. If it fails, also its error; its rows so far are results too."""
    try:
        run = make()
    except arm3r.Arm3rError as error:
        yield f"{name}: error", message(error)
        run = error.run
    if run is not None:
        for column in run.columns:
            yield f"{name}: column {column}, {run.units[column]}", digest(run[column])
        yield from entries(f"{name}: summary", run.summary)


def by_method(path: Path, method: str) -> arm3r.Scenario:
    """A scenario by another method and without its checks, which are for the method that it names."""
    scenario = arm3r.Scenario.load(path)
    scenario["solver"] = {"method": method}
    scenario["checks"] = []
    return scenario


def scenario_results(path: Path, methods: tuple[str, ...] = METHODS) -> Results:
    """One scenario as it is, and by every method; where a method is refused, the refusal is the result."""
    name = str(path.relative_to(SCENARIOS))
    yield from run_results(f"{name} as it is", arm3r.Scenario.load(path).run)
    for method in methods:
        yield from run_results(f"{name} by {method}", by_method(path, method).run)


def scenarios() -> Results:
    for path in sorted(SCENARIOS.rglob("*.yaml")):
        if path.parent.name != "sweeps":
            yield from scenario_results(path)


def batches() -> Results:
    for file, values in BATCHES.items():
        for method in METHODS:
            name = f"batch of {file} by {method}"
            try:
                batch = by_method(SCENARIOS / file, method).batch(values)
            except arm3r.Arm3rError as error:
                yield f"{name}: error", message(error)
                continue
            for column in batch:
                yield f"{name}: column {column}", digest(batch[column])


def user_laws() -> Results:
    """Runs whose torque a Python function computes: called by the run, or passed to a simulation step by step."""
    for method in METHODS:
        scenario = by_method(SCENARIOS / "moving_wall.yaml", method)
        scenario["wall.acts_on_arm"] = True
        scenario["sampling"] = {"rate": 200}
        yield from run_results(f"user's law by {method}", partial(scenario.run, controller=damped))
        yield from run_results(f"user's law step by step, {method}", partial(stepped, scenario))


def damped(t: float, state: arm3r.LawState) -> np.ndarray:
    """A user's law: gravity compensation and damping."""
    return state.tau_g - 0.5 * state.qd


def stepped(scenario: arm3r.Scenario) -> arm3r.Run:
    simulation = arm3r.Simulation(scenario)
    while not simulation.is_over:
        simulation.step(damped(simulation.t, simulation.state))
    return simulation.run


def arm_functions() -> Results:
    """Every function of `Arm` that takes arrays, at random states and at points within reach of the unequal arm."""
    arm = arm3r.Scenario.load(SCENARIOS / "unequal_arm.yaml").arm
    for name, function in inspect.getmembers(arm, lambda member: getattr(member, "__self__", None) is arm):
        needed = [p for p in inspect.signature(function).parameters.values() if p.default is p.empty]
        if not name.startswith("_"):
            random = np.random.default_rng(1)  # the same states, whatever other functions there are
            answer = function(*(random.uniform(0.2, 0.6, (50, 3)) for _ in needed))
            parts = answer if isinstance(answer, tuple) else (answer,)
            yield f"Arm.{name}", digest(np.concatenate([np.ravel(part) for part in parts]))


def sweeps() -> Results:
    """The tables of the sweeps, column by column."""
    for name, options in SWEEPS.items():
        with tempfile.TemporaryDirectory() as folder:
            path = SCENARIOS / "sweeps" / f"{name}.yaml"
            done = command("arm3r-sweep", path, "-o", folder, "--jobs", "1", *options)
            yield f"sweep {name}: exit code", str(done.returncode)
            table = Path(folder) / "table.csv"
            for column in zip(*csv.reader(table.read_text().splitlines()), strict=True) if table.exists() else []:
                yield f"sweep {name}: column {column[0]}", digest(np.array(column))


def files() -> Results:
    """The table that the executable writes."""
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "wall.csv"
        command("arm3r", "run", SCENARIOS / "moving_wall.yaml", "-o", table)
        yield "file: moving_wall.csv", hashlib.sha256(table.read_bytes()).hexdigest()


def collect() -> dict[str, str]:
    """All results of the build that this interpreter has."""
    parts = (scenarios, batches, user_laws, arm_functions, sweeps, files, pages, messages, public_names, symbols)
    return {name: text for part in parts for name, text in part()}


if __name__ == "__main__":
    json.dump(collect(), sys.stdout)
