"""The metrics of a batch that are asked for: to the bit those of the whole table, and nothing else.

That random ones of random scenarios are so, by every method, says test_rows_and_batches.py.
"""

from __future__ import annotations

import pickle

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp import _native
from arm3r_cpp._native import ffi, lib
from arm3r_cpp.notebook import pages

HYBRID = """
format: 1
wall: {acts_on_arm: true, point: [1.735, 0, 0]}
sampling: {rate: 1000}
arm: {torque_limit: [40, 40, 20]}
controller: {type: hybrid}
reference: {force: FORCE}
solver: SOLVER
time: {stop: 0.5}
"""
PROFILES = "{value: 10}", "{type: ramp, initial: 2, value: 12, start: 0.1, duration: 0.2}"
SOLVERS = "{method: rk4, step: 0.001}", "{method: taylor}", "{method: dopri5}"
STIFFNESS = {"wall.contact.stiffness": [300.0, 1e3, 3e3]}


def hybrid(profile: str = PROFILES[0], solver: str = SOLVERS[0]) -> arm3r.Scenario:
    return arm3r.Scenario(HYBRID.replace("FORCE", profile).replace("SOLVER", solver))


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("profile", PROFILES)
def test_each_metric_alone_is_that_of_the_whole_table(profile: str, solver: str) -> None:
    scenario = hybrid(profile, solver)
    whole = scenario.batch(STIFFNESS)
    assert np.isfinite(whole["force_error_rms"]).all() and (whole["work_2"] != 0).all()
    for name in whole:
        alone = scenario.batch(STIFFNESS, metrics=[name])
        assert alone.names == (["outcome"] if name == "outcome" else ["outcome", name])
        assert np.array_equal(alone[name], whole[name], equal_nan=True), name


@pytest.mark.parametrize("solver", [SOLVERS[0], SOLVERS[2]])  # taylor has no series of a plate that turns
def test_the_path_error_alone_knows_how_the_plate_has_turned(solver: str) -> None:
    """Along its normal a force law has none, at the middle of a step either."""
    scenario = hybrid(PROFILES[1], solver)
    scenario["wall.rotation"] = {"type": "sinusoid", "axis": [0.2, 1, 0.4], "amplitude": 0.3, "frequency": 2}
    whole = scenario.batch(STIFFNESS)
    assert (whole["tip_path_error_rms"] > 1e-6).all()
    for name in ("tip_path_error_rms", "tip_path_error_max"):
        assert np.array_equal(scenario.batch(STIFFNESS, metrics=[name])[name], whole[name]), name


def test_the_columns_stand_in_the_order_of_the_table_with_the_outcome() -> None:
    batch = hybrid().batch(STIFFNESS, metrics=("work_1", "peak_force", "peak_force"))
    assert batch.names == list(batch.units) == ["outcome", "peak_force", "work_1"]
    assert batch.ok.all() and "peak_force" in pages.of_batch(batch)
    assert "work_1" in pickle.loads(pickle.dumps(batch)).names
    assert hybrid().batch(STIFFNESS, metrics=[]).names == ["outcome"]


def test_rows_and_invalid_runs_and_words_go_with_them() -> None:
    values = {"wall.contact.stiffness": [-1.0, 1e3], "controller.variant": ["dynamic", "jacobian_transpose"]}
    scenario = hybrid()
    whole = scenario.batch(values, grid=True)
    batch = scenario.batch(values, grid=True, metrics=["settling_time"], columns=["q"])
    assert batch.outcomes.tolist() == whole.outcomes.tolist() == [["invalid"] * 2, ["ok"] * 2]
    assert np.array_equal(batch["settling_time"], whole["settling_time"], equal_nan=True)
    assert batch.rows.counts[1].min() > 1


def test_a_law_of_your_own_has_them_too() -> None:
    scenario = arm3r.Scenario("format: 1\ntime: {stop: 0.2}\n")
    given = {"values": {"initial.q[1]": [0.1, 0.2]}, "controller": lambda t, state: state.tau_g, "rate": 100}
    assert np.array_equal(scenario.batch(**given, metrics=["work_2"])["work_2"], scenario.batch(**given)["work_2"])


def test_wrong_names_are_told() -> None:
    batch = hybrid().batch(STIFFNESS, metrics=["peak_force"])
    with pytest.raises(KeyError, match="no column 'overshoot': this batch was asked for others; name it in metrics"):
        batch["overshoot"]
    with pytest.raises(KeyError, match=r"no column 'peek_force'; did you mean peak_force\?"):
        batch["peek_force"]
    with pytest.raises(
        arm3r.UsageError, match=r"metrics\[1\]: there is no metric 'setling_time'; did you mean settling_time\?"
    ):
        hybrid().batch(STIFFNESS, metrics=["peak_force", "setling_time"])
    with pytest.raises(TypeError, match="metrics: a list of names is needed"):
        hybrid().batch(STIFFNESS, metrics="peak_force")
    with pytest.raises(TypeError, match=r"metrics\[0\]: a metric's name is needed, got 3"):
        hybrid().batch(STIFFNESS, metrics=[3])


def test_in_c_a_place_beyond_the_table_is_refused_and_none_means_all() -> None:
    scenario = hybrid()
    whole = scenario.batch(STIFFNESS)
    params, values = scenario.params, np.array([STIFFNESS["wall.contact.stiffness"]])
    varied = ffi.new("size_t[]", [arm3r.param_index("wall.contact.stiffness[0]")])
    given = _native.readable(params), params.size, varied, 1, _native.readable(values), 3
    options = ffi.new("arm3r_batch_options *", {"struct_size": ffi.sizeof("arm3r_batch_options")})
    options.summary_size = 7  # not read
    table = np.empty((lib.arm3r_summary_count(), 3))
    assert lib.arm3r_batch_run(*given, options, _native.writable(table)) == lib.ARM3R_OK
    assert np.array_equal(table, np.array([whole[name] for name in whole]), equal_nan=True)

    twice = ffi.new("size_t[]", [6, 6])
    options.summary, options.summary_size = twice, 2
    table.fill(-1)
    assert lib.arm3r_batch_run(*given, options, _native.writable(table)) == lib.ARM3R_OK
    assert np.array_equal(table[:2], [whole["peak_force"]] * 2) and (table[2:] == -1).all()

    beyond = ffi.new("size_t[]", [lib.arm3r_summary_count()])
    options.summary, options.summary_size = beyond, 1
    assert lib.arm3r_batch_run(*given, options, _native.writable(table)) == lib.ARM3R_E_INDEX
