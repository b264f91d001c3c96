"""Walls that follow a table: with velocities and accelerations, or by the smoothest curve through positions alone."""

from __future__ import annotations

import arm3r_cpp as arm3r
import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.interpolate import make_interp_spline

T = [0.1, 0.3, 0.55, 0.6, 1.1]
S = [0.0, 0.07, -0.02, -0.03, 0.11]
AT_REST = ([(1, 0.0), (2, 0.0)], [(1, 0.0), (2, 0.0)])


def scenario(**motion: object) -> arm3r.Scenario:
    wall = {"point": [2.5, 0, 0], "normal": [-1, 0, 0], "motion": {"type": "table", **motion}}
    made = arm3r.Scenario("{format: 1, controller: {type: gravity_compensation}, time: {stop: 1.3, log_every: 0.005}}")
    made["wall"] = wall
    return made


def test_positions_alone_give_the_smoothest_curve_from_rest_to_rest() -> None:
    run = scenario(t=T, s=S).run()
    curve = make_interp_spline(T, S, k=5, bc_type=AT_REST)
    along = curve(np.clip(run.t, T[0], T[-1]))  # the wall stands still before and after it
    assert_allclose(run["wall_x"], 2.5 - along, rtol=0, atol=1e-14)


def test_the_velocities_and_accelerations_of_that_curve_give_the_same_motion() -> None:
    curve = make_interp_spline(T, S, k=5, bc_type=AT_REST)
    v, a = curve.derivative(1)(T), curve.derivative(2)(T)
    told = scenario(t=T, s=S, v=v.tolist(), a=a.tolist()).run()
    assert_allclose(told["wall_x"], scenario(t=T, s=S).run()["wall_x"], rtol=0, atol=1e-14)


def test_a_ramp_is_a_table_of_two_points() -> None:
    ramp = scenario(t=T, s=S)
    ramp["wall.motion"] = {"type": "ramp", "distance": 0.2, "start": 0.2, "duration": 0.7}
    table = scenario(t=[0.2, 0.9], s=[0.0, 0.2])
    assert_allclose(table.run()["wall_x"], ramp.run()["wall_x"], rtol=0, atol=1e-15)


@pytest.mark.parametrize("given", ["v", "a"])
def test_one_of_velocity_and_acceleration_is_not_enough(given: str) -> None:
    other = {"v": "a", "a": "v"}[given]
    with pytest.raises(arm3r.ScenarioError, match=rf"wall\.motion\.{other}: not as long .* or the position alone"):
        scenario(t=T, s=S, **{given: [0.0] * len(T)}).run()


def test_all_values_written_out_are_the_same_scenario() -> None:
    first = scenario(t=T, s=S)
    again = arm3r.Scenario(first.to_yaml())
    assert again.run().summary["hash"] == first.run().summary["hash"]


def test_a_batch_varies_the_points() -> None:
    moved = [0.05, 0.07, 0.09]
    batch = scenario(t=T, s=S).batch({"wall.motion.s[1]": moved}, columns=["wall_x"])
    for number, value in enumerate(moved):
        alone = scenario(t=T, s=[S[0], value, *S[2:]]).run()
        assert np.array_equal(batch.rows["wall_x"][number], alone["wall_x"])
