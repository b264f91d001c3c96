"""A run is one and the same, however it is asked for: alone or in a batch, in a stride or step by step, with many rows
or few. Random scenarios by every method, to the bit.

A failure prints the seed of its scenario and its YAML; ARM3R_SEED sets another seed, the gates that of the day.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from agreement import ADAPTIVE, rk4, run_of
from arm3r_cpp import _native
from arm3r_cpp._native import ffi, lib
from random_scenarios import Keys, random_scenario, sample_seed, yaml_of

SEED = sample_seed()
TIP = ("tip_x", "tip_y", "tip_z")  # a batch has them from the kinematics, a run's rows from the recursion
ANYWHERE = "q1", "qd2", "tau3", "tip_x", "f_on_tip_z", "energy_kinetic", "energy_residual", "work_wall"  # in every run
LOOSE = {
    name: {key: 1e-6 if key in ("rtol", "tol") else value for key, value in solver.items() if key != "atol"}
    for name, solver in ADAPTIVE.items()
}
TO_EVENTS: Keys = {"method": "rk4", "step": 1e-3, "events": "located"}

check_all = Callable[[Keys, np.random.Generator], list[str]]


def found_in(numbers: range, check: check_all, **options: Any) -> str:
    """What a check finds wrong in scenarios of these numbers, with their YAML."""
    texts = []
    for number in numbers:
        rng = np.random.default_rng([SEED, number])
        scenario = random_scenario(rng, **options)
        texts += [f"# seed {SEED}, scenario {number}: {text}\n{yaml_of(scenario)}" for text in check(scenario, rng)]
    return "\n".join(texts[:10])


def solvers_of(scenario: Keys) -> Iterator[tuple[str, Keys]]:
    yield from LOOSE.items()
    yield "rk4", rk4(scenario, 1e-3)
    yield "rk4 to events", TO_EVENTS


# ---- a batch is its runs ---------------------------------------------------------------------------------------------


def leaves(scenario: Any, path: str = "") -> Iterator[tuple[str, float]]:
    """The numbers with a point in a scenario, by the paths that a batch takes."""
    items = scenario.items() if isinstance(scenario, dict) else enumerate(scenario)
    for key, value in items:
        place = f"{path}[{key}]" if isinstance(scenario, list) else f"{path}.{key}".strip(".")
        is_long = isinstance(value, list) and len(value) > 16  # whose numbers cannot be varied one by one
        if isinstance(value, (dict, list)) and not is_long:
            yield from leaves(value, place)
        elif isinstance(value, float):
            yield place, value


def variation(scenario: Keys, rng: np.random.Generator, runs: int) -> dict[str, np.ndarray]:
    """Other poses at the start, and other values of one more number."""
    fixed = ("initial.q", "time", "sampling", "solver")
    others = [(path, value) for path, value in leaves(scenario) if not path.startswith(fixed)]
    path, value = others[int(rng.integers(len(others)))]
    q = scenario["initial"]["q"] + rng.uniform(-0.01, 0.01, (runs, 3))
    return {"initial.q": q, path: value * rng.uniform(0.95, 1.05, runs)}


def in_lanes(
    scenario: arm3r.Scenario, values: dict[str, np.ndarray], lanes: int, columns: Sequence[str] = (), room: int = 0
) -> tuple[np.ndarray, np.ndarray] | None:
    """The table of a batch with so many runs side by side, and their rows; None where the processor has no such
    instructions.
    """
    batch = scenario.batch({key: value[:0] for key, value in values.items()})
    varied = [index for axis in batch.varied for index in axis.indices]
    numbers = np.ascontiguousarray(np.column_stack(list(values.values())).T)
    options = ffi.new("arm3r_batch_options *", {"struct_size": ffi.sizeof("arm3r_batch_options"), "lanes": lanes})
    table = np.empty((lib.arm3r_summary_count(), numbers.shape[1]))
    block = np.empty((numbers.shape[1], len(columns), room))
    if columns:
        memory, _kept = _native.batch_rows(columns, block)
        options.rows = memory
    params, places = scenario.params, ffi.new("size_t[]", varied)
    arrays = _native.readable(params), params.size, places, len(varied), _native.readable(numbers), numbers.shape[1]
    try:
        _native.call(lib.arm3r_batch_run, *arrays, options, _native.writable(table))
    except arm3r.Arm3rError as error:
        assert "lanes" in str(error)
        return None
    return table, block


def wrong_in_batch(keys: Keys, rng: np.random.Generator) -> list[str]:
    """Columns of a batch of five that are not those of the runs alone, by method and number of lanes."""
    found, values = [], variation(keys, rng, 5)
    for method, solver in solvers_of(keys):
        scenario = arm3r.Scenario(yaml_of({**keys, "solver": {**solver, "max_steps": 20000}}))
        try:
            batch = scenario.batch(values, threads=1)
        except (arm3r.ScenarioError, arm3r.BudgetError):
            continue  # the method does not take it
        table = np.array([batch[name] for name in batch])
        for run in np.flatnonzero(batch.outcomes != "invalid"):
            alone = numbers_of(batch, int(run))
            wrong = [name for name in batch if name not in TIP and not same(batch[name][run], alone[name])]
            if wrong:
                found.append(f"{method}, run {run} of {list(values)}: {wrong}")
        for lanes in (1, 2, 4, 8):
            other = in_lanes(scenario, values, lanes)
            if other is not None and not same(other[0], table):
                found.append(f"{method} in {lanes} lanes")
        columns = [str(one) for one in rng.choice(ANYWHERE, 3, replace=False)]
        if "ok" in batch.outcomes:
            found += [f"{method} {text}" for text in wrong_in_rows_of(scenario, values, columns, table)]
        metrics = [str(one) for one in rng.choice(batch.names, int(rng.integers(0, 6)), replace=False)]
        chosen = scenario.batch(values, threads=1, metrics=metrics)
        if wrong := [name for name in chosen if not same(chosen[name], batch[name])]:
            found.append(f"{method} with the metrics {metrics}: {wrong}")
    return found


def wrong_in_rows_of(
    scenario: arm3r.Scenario, values: dict[str, np.ndarray], columns: list[str], table: np.ndarray
) -> list[str]:
    """What a batch that returns rows does not have as the runs alone; table: of the batch without rows."""
    found, batch = [], scenario.batch(values, threads=1, columns=columns)
    if not same(np.array([batch[name] for name in batch]), table):
        found.append(f"with rows of {columns}")
    for run in np.flatnonzero(batch.outcomes != "invalid"):
        alone, count = ended(lambda run=run: batch.run(int(run))), batch.rows.counts[run]
        found += [f"{name} of run {run}" for name in columns if not same(batch.rows[name][run][:count], alone[name])]
    rows = np.stack([batch.rows[name] for name in columns], axis=1)
    for lanes in (1, 2, 4, 8):
        other = in_lanes(scenario, values, lanes, columns, rows.shape[2])
        if other is not None and not (same(other[0], table) and same(other[1], rows)):
            found.append(f"in {lanes} lanes with rows of {columns}")
    return found


def same(a: Any, b: Any) -> bool:
    return np.array_equal(a, b, equal_nan=True)


def numbers_of(batch: arm3r.Batch, index: int) -> dict[str, float]:
    """The summary of one run of a batch, made alone."""
    try:
        run = batch.run(index)
    except arm3r.Arm3rError as error:
        assert error.run is not None
        run = error.run
    numbers = {name: np.nan if value is None else float(value) for name, value in run.summary["metrics"].items()}
    return numbers | {"outcome": batch["outcome"][index]}


def test_a_batch_is_its_runs() -> None:
    assert not (text := found_in(range(30), wrong_in_batch, longest=0.25)), text


@pytest.mark.gate
@pytest.mark.random
@pytest.mark.parametrize("part", range(2))
def test_many_batches_are_their_runs(part: int) -> None:
    assert not (text := found_in(range(1000 + 200 * part, 1200 + 200 * part), wrong_in_batch)), text


# ---- rows ------------------------------------------------------------------------------------------------------------


def wrong_in_rows(keys: Keys, _: np.random.Generator) -> list[str]:
    """Rows that change where others are asked for as well, and rows that hold no number."""
    found = []
    every = keys["time"]["log_every"]
    for method, solver in solvers_of(keys):
        run = run_of(keys, solver)
        if run is None:
            continue
        dense = run_of({**keys, "time": {**keys["time"], "log_every": every / 2}}, solver)
        assert dense is not None
        rows = np.searchsorted(dense.t, run.t)
        if not same(dense.t[np.minimum(rows, len(dense.t) - 1)], run.t):
            found.append(f"{method}: rows at {every} s are none of those at {every / 2} s")
            continue
        if wrong := [name for name in run.columns if not same(dense[name][rows], run[name])]:
            found.append(f"{method}: {wrong} depend on log_every")
        if wrong := [name for name in run.columns if not np.isfinite(run[name]).all()]:
            found.append(f"{method}: {wrong} hold what is no number")
    return found


def test_rows_do_not_depend_on_the_others() -> None:
    assert not (text := found_in(range(80), wrong_in_rows, longest=0.3)), text


@pytest.mark.parametrize("sampled", [False, True])
def test_a_force_that_no_place_changes_has_no_speed_of_a_wall(sampled: bool) -> None:
    """The estimator sees a push, which is as large wherever the tip is: it must not divide by a stiffness of 0.

    By the sensor alone, with `switching: always`, it is a contact; beside a continuous controller it is none.
    """
    scenario = arm3r.Scenario("""
format: 1
initial: {q: [-1.8331, 1.1495, -1.2306]}
wall: {}
controller: {type: shaped_impedance}
estimator: {wall: fixed}
push: {force: [-4.613, 5.1737, -1.9032]}
solver: {rtol: 1.0e-10, atol: 1.0e-13}
time: {stop: 0.094751}
""")
    if sampled:
        scenario["controller"] = {"type": "hybrid", "switching": "always"}
        scenario["sampling"] = {"rate": 500}
    run = scenario.run()
    assert all(np.isfinite(run[name]).all() for name in run.columns)


@pytest.mark.gate
@pytest.mark.random
def test_many_rows_do_not_depend_on_the_others() -> None:
    assert not (text := found_in(range(1000, 2000), wrong_in_rows)), text


# ---- step by step ----------------------------------------------------------------------------------------------------


def law(t: float, state: arm3r.LawState) -> np.ndarray:
    """Some torque that depends on all that a user's law gets."""
    return state.tau_g - 3 * state.qd + 0.05 * np.sin(7 * t + state.q) + 0.01 * state.f_on_tip


def wrong_in_steps(keys: Keys, rng: np.random.Generator) -> list[str]:
    """Methods by which a run made sample by sample, left and taken up again, is not the run in one stride."""
    found = []
    own = {key: value for key, value in keys.items() if key != "reference"} | {"controller": {"type": "user"}}
    for method, solver in solvers_of(own):
        scenario = arm3r.Scenario(yaml_of({**own, "solver": solver}))
        leave = int(rng.integers(1, 40))
        try:
            whole = ended(lambda scenario=scenario: scenario.run(controller=law))
            run = ended(lambda scenario=scenario, leave=leave: stepped(scenario, leave))
        except (arm3r.ScenarioError, arm3r.ControllerError):
            continue  # the method does not take it, or the loop is unstable, and the law has no torque any more
        if wrong := [name for name in whole.columns if not same(run[name], whole[name])]:
            found.append(f"{method}: {wrong} differ step by step")
        if wrong := [name for name, value in whole.summary["metrics"].items() if run.summary["metrics"][name] != value]:
            found.append(f"{method}: the metrics {wrong} differ step by step")
        if run.outcome != whole.outcome or run.summary["solver"] != whole.summary["solver"]:
            found.append(f"{method}: {run.summary['solver']} step by step, {whole.summary['solver']} in one stride")
    return found


def ended(run: Callable[[], arm3r.Run]) -> arm3r.Run:
    """A run, also where it does not come to its end."""
    try:
        return run()
    except arm3r.Arm3rError as error:
        if error.run is None:
            raise
        return error.run


def stepped(scenario: arm3r.Scenario, leave: int = -1) -> arm3r.Run:
    """Sample by sample; left at one of them and taken up again."""
    simulation = arm3r.Simulation(scenario)
    while not simulation.is_over:
        if simulation.state.tick == leave:
            simulation = taken_up_again(simulation)
        simulation.step(law(simulation.t, simulation.state))
    return simulation.run


@pytest.mark.parametrize("method", ["dopri5", "rodas4", "auto"])
def test_a_budget_ends_a_run_step_by_step_where_it_ends_it_in_one_stride(method: str) -> None:
    own = {"format": 1, "controller": {"type": "user"}, "sampling": {"rate": 500}, "time": {"stop": 0.02}}
    for most in range(1, 30):
        scenario = arm3r.Scenario(yaml_of({**own, "solver": {**LOOSE[method], "max_steps": most}}))
        whole = ended(lambda scenario=scenario: scenario.run(controller=law))
        run = ended(lambda scenario=scenario: stepped(scenario))
        told = [(one.outcome, one.t[-1], one.summary["solver"]) for one in (whole, run)]
        assert told[0] == told[1], most


def taken_up_again(simulation: arm3r.Simulation) -> arm3r.Simulation:
    """A copy that has gone astray and come back."""
    other = simulation.copy()
    snapshot = other.snapshot()
    for _ in range(3):
        if not other.is_over:
            other.step([1.0, -2.0, 0.5])
    other.restore(snapshot)
    return other


def test_a_run_step_by_step_is_the_run() -> None:
    text = found_in(range(40), wrong_in_steps, law="gravity_compensation", sampled=True, longest=0.3)
    assert not text, text


@pytest.mark.gate
@pytest.mark.random
def test_many_runs_step_by_step_are_the_run() -> None:
    text = found_in(range(1000, 1500), wrong_in_steps, law="gravity_compensation", sampled=True)
    assert not text, text
