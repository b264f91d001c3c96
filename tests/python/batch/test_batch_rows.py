"""The rows of a batch: chosen columns of every run, to the bit those of the run alone.

Random tests print their seed; ARM3R_SEED sets another one.
"""

from __future__ import annotations

import math
import pickle
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from agreement import rk4
from arm3r_cpp import _native
from arm3r_cpp._native import ffi, lib
from random_scenarios import LAWS, random_scenario, sample_seed, yaml_of
from test_rows_and_batches import LOOSE, variation

pytestmark = pytest.mark.filterwarnings("ignore::arm3r_cpp.ScenarioWarning")

FALL = "format: 1\narm: {convention: slide}\ninitial: {q: [0.2, -0.5, 1.1]}\ntime: {stop: 0.2, log_every: 0.01}\n"


def alone(batch: arm3r.Batch, index: Any) -> arm3r.Run:
    """A run of the batch by itself, as far as it came."""
    try:
        return batch.run(index)
    except arm3r.Arm3rError as error:
        assert error.run is not None
        return error.run


def check_rows(batch: arm3r.Batch, index: Any) -> None:
    """The rows of one run are those of its own log, and NaN stands after them."""
    run, rows = alone(batch, index), batch.rows
    assert rows.counts[index] == len(run)
    for name in rows:
        column = rows[name][index]
        if name in run:
            assert np.array_equal(column[: len(run)].view(np.uint64), run[name].view(np.uint64)), (index, name)
            assert np.isnan(column[len(run) :]).all(), (index, name)
        else:
            assert np.isnan(column).all(), (index, name)


def check_every_run(batch: arm3r.Batch) -> None:
    for index in np.ndindex(*batch.shape):
        if batch.outcomes[index] == "invalid":
            assert batch.rows.counts[index] == 0 and np.isnan(batch.rows.t[index]).all()
        else:
            check_rows(batch, index)


def same_tables(one: arm3r.Batch, other: arm3r.Batch) -> bool:
    return all(np.array_equal(one[name], other[name], equal_nan=True) for name in one)


@pytest.mark.sample(8)
@pytest.mark.parametrize("law", LAWS)
def test_rows_have_the_bits_of_the_runs_alone(law: str) -> None:
    """Random scenarios, continuous and sampled, by every method, on one thread and on three."""
    seed = sample_seed()
    print(f"ARM3R_SEED={seed}")
    rng = np.random.default_rng([seed, LAWS.index(law), 9])
    for sampled in (False, True):
        keys = random_scenario(rng, law=law, sampled=sampled, longest=0.3)
        for solver in (*LOOSE.values(), rk4(keys, 1e-3)):
            scenario = arm3r.Scenario(yaml_of({**keys, "solver": {**solver, "max_steps": 20000}}))
            try:
                there = scenario.run().columns
            except arm3r.ScenarioError:
                continue  # the method does not take it
            except arm3r.Arm3rError as error:
                assert error.run is not None
                there = error.run.columns
            columns = [str(name) for name in rng.permutation(there)[: int(rng.integers(1, 8))]]
            values = variation(keys, rng, 4)
            batch = scenario.batch(values, columns=columns, threads=1)
            assert set(batch.rows) == {"t", *columns}
            check_every_run(batch)
            assert same_tables(batch, scenario.batch(values))
            other = scenario.batch(values, columns=columns, threads=3)
            assert np.array_equal(other.rows._block.view(np.uint64), batch.rows._block.view(np.uint64))


def test_the_log_of_the_scenario_chooses_no_columns_of_a_batch() -> None:
    scenario = arm3r.Scenario(FALL)
    values = {"initial.q[0]": [0.1, 0.2]}
    batch = scenario.batch(values, columns=["tau_g", "q2"])
    assert batch.rows.columns == ["t", "q2", "tau_g1", "tau_g2", "tau_g3"]
    scenario["time.log_columns"] = ["qd1"]
    other = scenario.batch(values, columns=["q2", "tau_g"])
    assert other.run(0).columns == ["t", "qd1"]
    assert np.array_equal(other.rows._block, batch.rows._block)


def test_three_columns_at_once_and_the_shape_of_a_grid() -> None:
    batch = arm3r.Scenario(FALL).batch(
        {"initial.q[0]": [0.1, 0.2, 0.3], "initial.qd": [[0.1, 0.2, 0.3], [0.3, 0.2, 0.1]]}, grid=True, columns=["q"]
    )
    rows = batch.rows
    assert rows["q"].shape == (3, 2, 21, 3) and rows.t.shape == (3, 2, 21) and rows.counts.shape == (3, 2)
    assert np.array_equal(rows["q"][..., 1], rows["q2"], equal_nan=True)
    assert "q" in rows and "q3" in rows and "tip" not in rows and rows.nbytes == 8 * 6 * 4 * 21
    with pytest.raises(ValueError, match="read-only"):
        rows["q1"][0, 0, 0] = 1
    with pytest.raises(arm3r.ColumnError, match="no column 'q4'; did you mean q1"):
        rows["q4"]
    with pytest.raises(arm3r.ColumnError, match=r"not asked for 'tip': add it to columns; there are t, q1, q2, q3$"):
        rows["tip"]
    with pytest.raises(TypeError, match="a column's name is needed"):
        rows[0]  # type: ignore[index]
    check_every_run(batch)
    one = arm3r.Scenario(FALL).batch({}, columns=["q1"])
    assert one.shape == () and one.rows["q1"].shape == (21,) and one.rows.counts == 21
    none = arm3r.Scenario(FALL).batch({"initial.q[0]": []}, columns=["q1"])
    assert none.rows["q1"].shape[0] == 0
    again = pickle.loads(pickle.dumps(batch))
    assert np.array_equal(again.rows["q"], rows["q"]) and repr(again.rows) == repr(rows)


def test_runs_that_end_early_or_never_begin() -> None:
    """Another end of time, numbers that are not valid, and rates too high for the step, all in one batch."""
    scenario = arm3r.Scenario(FALL + "solver: {method: rk4, step: 0.01}\n")
    stop = np.array([0.2, 0.05, 0.31, 0.2, 0.2])
    values = {"time.stop": stop, "arm.link2.length": [1, 1, 1, -1, 1], "initial.qd[1]": [0, 0, 0, 0, 500.0]}
    batch = scenario.batch(values, columns=["q1", "energy_residual"])
    assert batch.outcomes.tolist() == ["ok", "ok", "ok", "invalid", "diverged"]
    assert batch.rows.counts.tolist()[:4] == [21, 6, 32, 0] and 0 < batch.rows.counts[4] < 21
    check_every_run(batch)
    stopped = arm3r.Scenario(FALL + "solver: {rtol: 1.0e-13, atol: 1.0e-16}\n")
    stopped["time"] = {"stop": 100, "log_every": 0.01}
    batch = stopped.batch({"initial.q[0]": np.linspace(0, 1, 40)}, columns=["q1"], progress=lambda done, runs: True)
    ended = batch.rows.counts[batch.outcomes == "stopped"]
    assert len(ended) > 1 and (ended < 10001).all() and (ended == 0).any()


def test_words_vary_and_a_column_of_some_runs_is_nan_in_the_others() -> None:
    scenario = arm3r.Scenario(FALL + "wall: {point: [1.75, 0, 0], acts_on_arm: true}\n")
    batch = scenario.batch(
        {"controller.type": ["gravity_compensation", "hybrid", "none"], "initial.q[0]": [0.1, 0.2]},
        grid=True,
        columns=["force_ref", "q1"],
    )
    assert np.isfinite(batch.rows["force_ref"]).all(axis=-1).tolist() == [[False] * 2, [True] * 2, [False] * 2]
    assert np.isfinite(batch.rows["q1"]).all()
    check_every_run(batch)
    check_every_run(scenario.batch({"solver.method": ["rk4", "taylor", "dopri5", "rodas4"]}, columns=["tip", "qdd2"]))
    damped = arm3r.Scenario(FALL).batch({"arm.damping[0]": [0.0, 0.1, 0.0]}, columns=["energy_dissipated_joints"])
    assert np.isnan(damped.rows["energy_dissipated_joints"]).all(axis=1).tolist() == [True, False, True]
    check_every_run(damped)
    with pytest.raises(arm3r.ScenarioError, match=r"columns: this run has no such column.*got tank_energy"):
        scenario.batch({"controller.type": ["hybrid", "none"]}, columns=["force_ref", "tank_energy"])


def test_laws_of_your_own_have_rows() -> None:
    scenario = arm3r.Scenario(FALL)
    values = {"initial.q[0]": [0.1, 0.2, 0.3]}

    def make(index: int) -> Any:
        return lambda t, state: state.tau_g - (1 + index) * state.qd

    for method in ("dopri5", "rk4"):
        scenario["solver"] = {"method": method}
        check_every_run(scenario.batch(values, make_controller=make, columns=["tau", "q"], rate=200))
        check_every_run(scenario.batch(values, controller=make(0), columns=["tau"], rate=200))

    def bad(t: float, state: arm3r.LawState) -> list[float]:
        return [math.nan] * 3 if t > 0.1 and state.q[0] > 0.15 else [0, 0, 0]

    batch = scenario.batch(values, controller=bad, columns=["q1"])
    assert batch.outcomes.tolist() == ["ok", "controller", "controller"]
    assert batch.rows.counts[0] == 21 > batch.rows.counts[1] > 9
    check_every_run(batch)


@pytest.mark.parametrize(
    ("columns", "error", "words"),
    [
        (["forc"], arm3r.UsageError, r"columns\[0\]: there is no column 'forc'; did you mean force\?"),
        (["q1", "zzzzzzzz"], arm3r.UsageError, r"columns\[1\]: .* `arm3r columns` lists them"),
        ("q1", TypeError, "columns: a list of names is needed, such as .*, got 'q1'"),
        ([3], TypeError, r"columns\[0\]: a column's name is needed, got 3"),
        (
            ["depth"],
            arm3r.ScenarioError,
            "columns: .*only with a wall, got depth; add `wall: {}`, or",
        ),
    ],
)
def test_columns_that_there_are_not(columns: Any, error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        arm3r.Scenario(FALL).batch({"initial.q[0]": [0.1]}, columns=columns)


def test_too_much_memory_and_no_rows_at_all() -> None:
    scenario = arm3r.Scenario(FALL)
    scenario["time"] = {"stop": 100, "log_every": 1e-4}
    with pytest.raises(arm3r.BudgetError, match=r"2 columns of 1000001 rows for 1000000 runs are 1\.6e\+04 GB"):
        scenario.batch({"initial.q[0]": np.zeros(1000000)}, columns=["q1"])
    with pytest.raises(arm3r.BudgetError, match=r"too many rows.*log less often"):
        scenario.batch({"time.log_every": [1e-4, 1e-8]}, columns=["q1"])
    with pytest.raises(arm3r.UsageError, match=r"no rows; ask for them: scenario\.batch\(\.\.\., columns="):
        _ = arm3r.Scenario(FALL).batch({"initial.q[0]": [0.1]}).rows


# ---- in C ------------------------------------------------------------------------------------------------------------


class InC:
    """A batch of three falls through the C interface."""

    def __init__(self) -> None:
        self.params = arm3r.Scenario(FALL).params
        self.values = np.array([[0.1, 0.2, 0.3]])
        varied = ffi.new("size_t[]", [arm3r.param_index("initial.q[0]")])
        self.given = [_native.readable(self.params), self.params.size, varied, 1, _native.readable(self.values), 3]
        self.block = np.zeros((3, 2, 21))
        self.columns = ffi.new("size_t[]", [2, 5])  # q2, qd2
        self.rows = ffi.new("arm3r_batch_rows *", {"struct_size": ffi.sizeof("arm3r_batch_rows")})
        self.rows.columns, self.rows.column_count, self.rows.row_count = self.columns, 2, 21
        self.rows.data = _native.writable(self.block)
        self.options = ffi.new("arm3r_batch_options *", {"struct_size": ffi.sizeof("arm3r_batch_options")})
        self.options.rows = self.rows

    def run(self) -> int:
        table = np.empty((lib.arm3r_summary_count(), 3))
        return lib.arm3r_batch_run(*self.given, self.options, _native.writable(table))

    def row_count(self, *columns: int) -> tuple[int, int]:
        count = ffi.new("size_t *")
        status = lib.arm3r_batch_row_count(*self.given, ffi.new("size_t[]", columns), len(columns), count)
        return status, count[0]


@pytest.mark.parametrize("lanes", [0, 1, 2, 4, 8])
def test_the_width_of_the_batch_changes_no_bit(lanes: int) -> None:
    c = InC()
    c.options.lanes = lanes
    if c.run():
        assert "lanes" in ffi.string(lib.arm3r_error_message()).decode()  # the processor does not have them
        return
    batch = arm3r.Scenario(FALL).batch({"initial.q[0]": c.values[0]}, columns=["q2", "qd2"])
    assert np.array_equal(c.block, np.stack([batch.rows["q2"], batch.rows["qd2"]], axis=1))


def test_the_struct_for_rows_is_checked() -> None:
    c = InC()
    assert c.row_count(2, 5) == (lib.ARM3R_OK, 21) and c.row_count() == (lib.ARM3R_OK, 21)
    assert c.row_count(10**6)[0] == lib.ARM3R_E_INDEX
    depth = _native.column_places()["depth"]
    assert c.row_count(depth)[0] == lib.ARM3R_E_SCENARIO
    c.columns[1] = depth  # a column that no run has
    assert c.run() == lib.ARM3R_OK and np.isnan(c.block[:, 1]).all() and np.isfinite(c.block[:, 0]).all()
    for name, value, status in [
        ("row_count", 20, lib.ARM3R_E_SIZE),
        ("column_count", 2**63, lib.ARM3R_E_SIZE),
        ("columns", ffi.NULL, lib.ARM3R_E_NULL),
        ("data", ffi.NULL, lib.ARM3R_E_NULL),
        ("struct_size", 0, lib.ARM3R_E_ABI),
        ("reserved", [0, 1, 0, 0], lib.ARM3R_E_ABI),
    ]:
        c = InC()
        setattr(c.rows, name, value)
        assert c.run() == status, name
    c = InC()
    c.columns[0] = 10**6
    assert c.run() == lib.ARM3R_E_INDEX
    c = InC()
    c.rows.row_count = 20
    c.run()
    assert "run 0 has 21 rows, and row_count is 20" in ffi.string(lib.arm3r_error_message()).decode()
