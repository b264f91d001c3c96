"""Parallel control, adaptive references, estimation of the wall, the energy tank: whole curves against linear loops and
the independent simulator."""

from __future__ import annotations

from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from force_control_oracles import SETTINGS, XA, Arm, estimation, linear, run_of
from force_scenarios import read

PARALLEL = {"f_d": 20.0, "m": 1.0, "K_D": 80.0, "K_P": 100.0, "K_F": 0.5, "K_I": 6.0}
SEEKING = {"f_d": 20.0, "M": 2.0, "B": 80.0, "K": 200.0}
SPEED = 0.05


# ---- parallel control -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("speed", [0.0, SPEED, -0.02])
def test_parallel_control_is_its_linear_loop(speed: float) -> None:
    run = read("parallel_moving_wall", {"wall.motion.velocity": speed, "time.stop": 2}).run()
    loop = linear.parallel_loop(**PARALLEL, k=5000, v=speed, u0=0.004, ahead=0.0)
    assert np.abs(run["force"] - loop.forces(run["t"])).max() < 1e-6
    aside = np.array([0.1, -0.05])[:, None] * (1 - second_order(run["t"], 100.0, 80.0))
    assert np.abs(run["tip"][:, 1:].T - aside).max() < 1e-8
    assert run.summary["energy_residual_max"] < 1e-7


def second_order(t: Any, K: float, D: float) -> Any:
    """What is left of 1 under e'' + D e' + K e = 0 from rest."""
    fast, slow = np.roots([1, D, K])
    return (fast * np.exp(slow * t) - slow * np.exp(fast * t)) / (fast - slow)


@pytest.mark.parametrize("share", [0.97, 1.03])
def test_parallel_control_is_stable_up_to_its_integral_gain(share: float) -> None:
    gain = share * 80 * (100 + 5000 * 0.5) / 5000
    changes = {"controller.force_integral_gain": gain, "wall.motion.velocity": 0.001, "time.stop": 3}
    run = read("parallel_moving_wall", changes).run()
    loop = linear.parallel_loop(**{**PARALLEL, "K_I": gain}, k=5000, v=0.001, u0=0.004, ahead=0.0)
    assert np.abs(run["force"] - loop.forces(run["t"])).max() < 1e-6
    error = np.abs(run["force"] - 20)
    early, late = (error[(run["t"] > start) & (run["t"] < start + 0.5)].max() for start in (0.5, 2.5))
    assert (late > early) == (share > 1)


# ---- adaptive references --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("speed", "gain"), [(SPEED, 0.02), (SPEED, 0.05), (-0.03, 0.02), (0.001, 0.212)])
def test_an_integrated_reference_is_its_linear_loop(speed: float, gain: float) -> None:
    changes = {"wall.motion.velocity": speed, "controller.reference_gain": gain, "time.stop": 2}
    run = read("adaptive_reference_moving_wall", changes).run()
    loop = linear.seeking_loop(k_r=gain, **SEEKING, k=5000, v=speed, u0=0.004, ahead=0.1)
    inside = run["t"] < (run.events[1].t if len(run.events) > 1 else np.inf)
    assert inside.sum() > 3
    assert np.abs(run["force"] - loop.forces(run["t"]))[inside].max() < 1e-6
    assert (loop.poles.real.max() > 0) == (gain > 0.208)


@pytest.mark.parametrize("assumed", [3000.0, 5000.0, 8000.0])
def test_a_computed_reference_is_as_good_as_the_stiffness(assumed: float) -> None:
    run = read("wall_stiffness_overestimated", {"controller.assumed_stiffness": assumed}).run()
    expected = estimation.force_of_wrong_stiffness(20, 5000, assumed, 500)
    assert run["force"][-1] == pytest.approx(expected, abs=1e-6)
    ahead = 20 / assumed + 20 / 500
    loop = linear.impedance_loop(2.0, 100.0, 500.0, k=5000, ahead=ahead)
    assert np.abs(run["force"] - loop.forces(run["t"])).max() < 1e-6


def test_an_estimate_takes_the_place_of_the_assumed_stiffness() -> None:
    changes = {"sampling.rate": 2000, "controller.switching": "always", "estimator.wall": "fixed"}
    run = read("wall_stiffness_overestimated", changes).run()
    told = run["identifiable"] == 1
    assert told[3:].all() and not told[0]
    assert run["stiffness_estimate"][told] == pytest.approx(np.full(told.sum(), 5000), abs=1e-5)
    assert run["force"][-1] == pytest.approx(20, abs=1e-5)


# ---- estimation -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("stiffness", "speed"), [(5000.0, SPEED), (2000.0, -0.03), (8000.0, 0.0)])
def test_stiffness_and_speed_of_a_wall(stiffness: float, speed: float) -> None:
    wall = {"contact.stiffness": stiffness, "motion.velocity": speed, "point": [XA[0] - 20 / stiffness, 0, 0]}
    changes = {f"wall.{key}": value for key, value in wall.items()}
    run = read("wall_stiffness_estimate", changes).run()
    assert run["identifiable"][-1] == 1
    assert run["stiffness_estimate"][-1] == pytest.approx(stiffness, abs=1e-6)
    assert run["wall_speed_estimate"][-1] == pytest.approx(speed, abs=1e-9)


def test_the_force_with_a_dither_is_that_of_the_simulator() -> None:
    run = read("wall_stiffness_estimate", {"time.stop": 1}).run()
    other = run_of(SETTINGS["wall stiffness estimate"], rtol=1e-9)
    assert np.abs(run["force"] - other.pressing(run["t"])).max() < 1e-5


def test_what_is_no_estimate_is_not_given() -> None:
    for changes in ({}, {"estimator.largest_condition": 1e4}, {"estimator.largest_condition": 1e9}):
        run = read("wall_stiffness_not_identifiable", changes).run()
        assert not run["stiffness_estimate"][run["t"] > 2].any()
        assert not run["identifiable"][run["t"] > 2].any()


def test_without_contact_nothing_is_estimated() -> None:
    changes = {"wall.point": [XA[0] + 1, 0, 0], "wall.motion.velocity": 0.0, "time.stop": 1.5}
    run = read("wall_stiffness_estimate", changes).run()
    assert not run["stiffness_estimate"].any() and not run["identifiable"].any()


# ---- energy tank ----------------------------------------------------------------------------------------------------


def test_a_tank_bounds_the_energy() -> None:
    run = read("variable_stiffness_tank").run()
    stored = energy(run)
    assert stored[0] == pytest.approx(0.0225, abs=1e-12)
    assert (stored + run["tank_energy"]).max() <= 0.0725 + 1e-9
    assert (np.diff(stored + run["tank_energy"]) < 1e-9).all()
    assert run["tank_energy"].min() > 0
    other = run_of(SETTINGS["variable stiffness tank"], rtol=1e-9, atol=1e-12)
    assert np.abs(run["tip"] - other.tips(run["t"])).max() < 1e-6
    assert np.abs(run["tank_energy"] - [other.state(t)[6] for t in run["t"]]).max() < 1e-7


def test_without_a_tank_it_grows_a_thousandfold() -> None:
    run = read("variable_stiffness_no_tank").run()
    assert energy(run)[-1] > 1000 * energy(run)[0]
    other = run_of(SETTINGS["variable stiffness no tank"], rtol=1e-9, atol=1e-12)
    assert np.abs(run["tip"] - other.tips(run["t"])).max() < 1e-5


def energy(run: arm3r.Run) -> Any:
    """Of the motion and of the spring K_0 between tip and reference, the motion by another model."""
    arm = Arm()
    motion = [0.5 * qd @ arm.at(q, qd).M @ qd for q, qd in zip(run["q"], run["qd"], strict=True)]
    return np.array(motion) + 100 * ((run["tip"] - XA) ** 2).sum(axis=1)
