"""The numbers that a run is judged by: what they mean, and that a dense log has the same (8.10)."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from force_scenarios import read
from random_scenarios import random_scenario, sample_seed, yaml_of
from scipy.interpolate import make_interp_spline


@pytest.mark.parametrize("solver", ["{}", "{method: rk4}", "{method: rodas4}"])
def test_the_path_error_of_a_law_in_joints_is_that_of_the_true_arm(solver: str) -> None:
    """At rest with q = q_ref to the bit, the controller's wrong length moves no tip."""
    scenario = arm3r.Scenario(
        "{format: 1, arm: {gravity: [0, 0, 0]}, initial: {q: [0.1, -0.5, 1.1]},"
        " controller: {type: joint_pd, gravity: [0, 0, 0], model: {link2: {length: 0.8}}},"
        f" reference: {{type: point, q: [0.1, -0.5, 1.1]}}, time: {{stop: 0.1}}, solver: {solver}}}"
    )
    assert scenario.run().summary["metrics"]["tip_path_error_max"] == pytest.approx(0, abs=1e-15)
    assert scenario.batch({})["tip_path_error_rms"] == pytest.approx(0, abs=1e-15)


# ---- the numbers of a summary against a dense log -------------------------------------------------------------------

SCORED = ["b9a_hybrid", "b9d_hybrid_transpose", "b10a_parallel_moving_wall", "b10b_adaptive_reference", "b7a_stiffness",
          "b8a_shaped_impedance", "b8c_admittance"]  # fmt: skip
METHODS: dict[str, dict[str, Any]] = {
    "dopri5": {"method": "dopri5", "rtol": 1e-10, "atol": 1e-13},
    "rodas4": {"method": "rodas4", "rtol": 1e-10, "atol": 1e-13},
    "rk4": {"method": "rk4", "step": 1e-4},
}
STOP, ROWS = 0.6, 24000


class DenseLog:
    """The same numbers from the rows alone: splines of degree five between contact's changes, parabolas at peaks."""

    def __init__(self, run: arm3r.Run) -> None:
        self.run, self.t = run, np.asarray(run.t)
        ends = [0.0, *(event.t for event in run.events), float(run.t[-1])]
        self.pieces = [(a, b) for a, b in pairwise(ends) if b - a > 8 * self.t[1]]
        self.in_contact = [(a, b) for a, b in self.pieces if run["contact"][np.searchsorted(self.t, 0.5 * (a + b))] > 0]

    def integral(self, values: Any, pieces: list[tuple[float, float]]) -> float:
        total = 0.0
        for a, b in pieces:
            inside = (self.t >= a) & (self.t <= b)
            total += make_interp_spline(self.t[inside], values[inside], k=5).integrate(a, b)
        return float(total)

    def peak(self, values: Any) -> tuple[float, float]:
        """Place and height of the parabola through the highest row and its neighbours, or the row at an end."""
        i = int(np.argmax(values))
        if i in (0, len(values) - 1):
            return float(self.t[i]), float(values[i])
        (before, here, after), spacing = values[i - 1 : i + 2], self.t[1]
        share = 0.5 * (before - after) / (before - 2 * here + after)
        return float(self.t[i] + share * spacing), float(here - 0.25 * (before - after) * share)


def numbers_of(run: arm3r.Run) -> dict[str, float]:
    log, numbers = DenseLog(run), {}
    for i in range(3):
        numbers[f"work_{i + 1}"] = log.integral(run["tau"][:, i] * run["qd"][:, i], log.pieces)
    numbers["impulse"] = log.integral(run["force"], log.in_contact)
    numbers["contact_time"] = sum(b - a for a, b in log.in_contact)
    numbers["peak_force_time"], numbers["peak_force"] = log.peak(run["force"])
    if "force_ref" in run:
        miss = run["force_ref"] - run["force"]
        numbers["force_error_rms"] = np.sqrt(log.integral(miss**2, log.in_contact) / numbers["contact_time"])
        numbers["overshoot"] = max(0.0, log.peak(-miss)[1])
    if "tip_ref" in run:
        away = run["tip"] - run["tip_ref"]
        across = away @ np.array(arm3r.Scenario(run.summary["scenario"])["wall.normal"])
        error_2 = np.sum(away**2, axis=1) - (run["force_phase"] * across) ** 2 if "force_phase" in run else None
        error_2 = np.sum(away**2, axis=1) if error_2 is None else error_2
        numbers["tip_path_error_rms"] = np.sqrt(log.integral(error_2, log.pieces) / log.t[-1])
        numbers["tip_path_error_max"] = np.sqrt(log.peak(error_2)[1])
    return numbers


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", SCORED)
def test_a_dense_log_has_the_numbers_of_the_summary(name: str, method: str) -> None:
    run = read(name, {"solver": METHODS[method], "time.stop": STOP, "time.log_every": STOP / ROWS}).run()
    told = {**run.summary["metrics"], **{key: run.summary[key] for key in ("peak_force", "impulse", "contact_time")}}
    for key, due in numbers_of(run).items():
        scale = max(abs(due), 1e-3)
        assert told[key] == pytest.approx(due, abs=1e-8 * scale if "time" not in key else 1e-6), key
    if "force_ref" in run:
        assert told["overshoot"] == max(0.0, told["peak_force"] - run["force_ref"][0]), "a constant reference"


@pytest.mark.parametrize("method", [*METHODS, "taylor"])
def test_numbers_of_a_sampled_run_are_those_of_its_rows(method: str) -> None:
    """P14: a circle on a moving wall at 50 Hz; steps may be as long as a sample."""
    solver = {"method": "taylor", "tol": 1e-12} if method == "taylor" else METHODS[method]
    changes = {
        "sampling.rate": 50, "wall.motion": {"type": "constant", "velocity": 0.05}, "solver": solver,
        "reference": {"type": "circle", "radius": 0.1, "period": 1, "force": {"value": 20}},
        "time.stop": 1.0, "time.log_every": 1e-4,
    }  # fmt: skip
    run = read("b9a_hybrid", changes).run()
    told, log = run.summary["metrics"], DenseLog(run)
    held = run["tau"][:-1] * np.diff(run["q"], axis=0)
    assert [told[f"work_{i}"] for i in (1, 2, 3)] == pytest.approx(held.sum(axis=0).tolist(), abs=1e-9)
    miss = run["force_ref"] - run["force"]
    assert told["force_error_rms"] == pytest.approx(
        np.sqrt(log.integral(miss**2, log.in_contact) / run.summary["contact_time"]), rel=1e-5
    )
    assert told["overshoot"] == pytest.approx(log.peak(-miss)[1], rel=1e-6)


# ---- random scenarios -----------------------------------------------------------------------------------------------


def check_against_rows(run: arm3r.Run) -> None:
    """What holds whatever jumps: works add up, peaks are those of rows and what may lie between, means agree."""
    told, log = {**run.summary["metrics"], "peak_force": run.summary["peak_force"]}, DenseLog(run)
    works = [told[f"work_{i}"] for i in (1, 2, 3)]
    scale = max(1e-3, *np.abs(works), *np.abs(run["work_actuators"]))
    assert sum(works) == pytest.approx(told["work_actuators"], abs=1e-7 * scale)

    def check_peak(name: str, values: Any) -> None:
        i, highest, top = int(np.argmax(values)), float(np.max(values)), log.peak(values)[1]
        due = max(0.0, highest)
        slack = 3 * abs(top - highest)
        if 0 < i < len(values) - 1:  # a damped force is largest where contact begins, between two rows
            slack += 2 * min(abs(values[i] - values[i - 1]), abs(values[i] - values[i + 1]))
        assert told[name] >= due - 1e-9 * max(1.0, due), name
        assert told[name] <= due + slack + 1e-4 * max(1.0, due), name

    if run.events:
        check_peak("peak_force", run["force"])
    if "force_ref" in run and run.events:
        touching = run["contact"] > 0
        check_peak("overshoot", np.where(touching, run["force"] - run["force_ref"], 0.0))
        miss_2 = np.where(touching, run["force_ref"] - run["force"], 0.0) ** 2
        due = np.sqrt(np.trapezoid(miss_2, run.t) / run.summary["contact_time"])
        assert told["force_error_rms"] == pytest.approx(due, rel=1e-2, abs=1e-3)
    if "tip_ref" in run and "force_phase" not in run:
        away = np.linalg.norm(run["tip"] - run["tip_ref"], axis=1)
        check_peak("tip_path_error_max", away)
        due = np.sqrt(np.trapezoid(away**2, run.t) / (run.t[-1] - run.t[0]))
        assert told["tip_path_error_rms"] == pytest.approx(due, rel=1e-4, abs=1e-9)


def check_random_scenarios(count: int) -> None:
    seed = sample_seed()
    print("seed", seed)
    rng = np.random.default_rng(seed)
    for number in range(count):
        keys = random_scenario(rng, longest=0.5)
        keys["solver"] = {"method": "dopri5", "rtol": 1e-10, "atol": 1e-13}
        keys["time"]["log_every"] = keys["time"]["stop"] / 4000
        try:
            run = arm3r.Scenario(yaml_of(keys)).run(time_limit=20)
        except (arm3r.NumericalError, arm3r.BudgetError):
            continue
        try:
            check_against_rows(run)
        except AssertionError as error:
            raise AssertionError(f"scenario {number} of seed {seed}:\n{yaml_of(keys)}") from error


def test_numbers_of_random_runs_are_those_of_their_rows() -> None:
    check_random_scenarios(20)


@pytest.mark.gate
def test_numbers_of_many_random_runs_are_those_of_their_rows() -> None:
    check_random_scenarios(300)


# ---- numbers without end --------------------------------------------------------------------------------------------


def test_an_infinite_number_is_the_same_in_a_run_and_in_a_batch() -> None:
    scenario = arm3r.Scenario(
        "{format: 1, wall: {acts_on_arm: true, contact: {stiffness: 1.0e+9}},"
        " initial: {q: [0.1, -0.5, 1.1], qd: [0, 3, -5]}, controller: {type: gravity_compensation},"
        " solver: {method: rk4, step: 1}, time: {stop: 200}}"
    )
    with pytest.raises(arm3r.NumericalError) as failed:
        scenario.run()
    told, batch = failed.value.run.summary, scenario.batch({})
    assert told["metrics"]["ledger_residual"] == told["ledger_residual"] == batch["ledger_residual"] == np.inf
