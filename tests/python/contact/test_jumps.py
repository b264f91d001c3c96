"""Jumps in time: a push, the ends of a line, a step of the wanted force; docs/model.md (5.8)."""

from __future__ import annotations

import warnings
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from random_scenarios import sample_seed

HELD = """
format: 1
arm: {convention: slide, link2: {length: 0.9, mass: 1.2}, link3: {length: 0.7, mass: 0.8}, damping: [0.1, 0.2, 0.15]}
initial: {q: [0.2, 0.5, -1.1]}
controller: {type: gravity_compensation}
"""
ON_A_LINE = """
format: 1
arm: {convention: slide, link2: {length: 0.9, mass: 1.2}, link3: {length: 0.7, mass: 0.8}}
initial: {q: [0.2, 0.5, -1.1]}
controller: {type: impedance, damping: 20}
reference: {type: line, tip: [1.0, 0.3, 0.2], start: 0.1, duration: 0.2}
"""
PRESSING = """
format: 1
arm: {convention: slide, link2: {length: 0.9, mass: 1.2}, link3: {length: 0.7, mass: 0.8}}
initial: {q: [0.2, 0.5, -1.1]}
wall: {point: [1.315, 0, 0], size: infinite, motion: {type: fixed}, acts_on_arm: true}
controller: {type: hybrid, switching: always}
reference: {force: {type: step, initial: 5, value: 9, start: 0.1}}
"""
PUSHES: dict[str, dict[str, Any]] = {
    "a push that starts at once": {"force": [9, -4, 6], "start": 0.1},
    "a push that grows": {"force": [9, -4, 6], "start": 0.1, "rise": 0.06},
    "a push that ends": {"force": [9, -4, 6], "start": 0.1, "duration": 0.05},
}
SHARP = [
    *(pytest.param(HELD, {"push": push}, id=name) for name, push in PUSHES.items()),
    pytest.param(ON_A_LINE, {}, id="a line"),
    pytest.param(PRESSING, {}, id="a step of the force"),
]
SMALLEST = {
    "default": {}, "1000 N": {"push": {"force": [1000, 0, 0], "start": 2, "duration": 0.1}, "time.stop": 2.5},
    "tight": {"push": {"force": [10, 0, 0], "start": 2, "duration": 0.1}, "solver": {"rtol": 1e-11, "atol": 1e-14}},
}  # fmt: skip


def scenario(text: str, changes: dict[str, Any]) -> arm3r.Scenario:
    made = arm3r.Scenario(text)
    for path, value in changes.items():
        made[path] = value
    return made


def end_of(text: str, changes: dict[str, Any]) -> np.ndarray:
    run = scenario(text, {"time": {"stop": 0.5, "log_every": 0.5}, **changes}).run()
    return np.array([run[name][-1] for name in ("q1", "q2", "q3", "qd1", "qd2", "qd3")])


def rejected(made: arm3r.Scenario) -> int:
    return int(made.run().summary["steps"]["rejected"])


@pytest.mark.parametrize("case", SMALLEST)
def test_a_push_late_in_a_run_is_no_collapse_and_costs_what_it_costs_at_the_start(case: str) -> None:
    text = "format: 1\ncontroller: {type: gravity_compensation}\npush: {force: [50, 0, 0], start: 50.3, duration: 0.1}"
    late = scenario(text, {"time.stop": 51, **SMALLEST[case]})
    late["time.stop"] = late["push.start"] + 0.2
    early = late.copy()
    early["push.start"], early["time.stop"] = 0, 0.2
    counts = rejected(late), rejected(early)
    print("rejected steps:", counts)
    assert counts[0] <= counts[1] + 2


@pytest.mark.parametrize("method", ["dopri5", "rodas4", "auto"])
def test_a_line_may_end_anywhere(method: str) -> None:
    text = "format: 1\ncontroller: {type: impedance}\nreference: {type: line, tip: [1.2, 0, 0], start: 1, duration: 1}"
    run = scenario(text, {"solver": {"method": method}, "time.stop": 3}).run()
    still = run.t < 1
    assert np.ptp(run["q2"][still]) < 1e-12
    at_once = scenario(text, {"solver": {"method": method}, "time.stop": 2, "reference.start": 0})
    assert run.summary["steps"]["rejected"] <= rejected(at_once) + 3, run.summary["steps"]


def test_a_push_on_a_sampled_loop_is_no_collapse_of_a_stiff_method() -> None:
    text = "format: 1\ncontroller: {type: joint_pd}\nsampling: {rate: 1000}\npush: {force: [300, 0, 0], start: 2}"
    run = scenario(text, {"solver": {"method": "rodas4"}, "time.stop": 2.2}).run()
    pushed = scenario(text, {"solver": {"method": "dopri5"}, "time.stop": 2.2}).run()
    assert np.allclose(run["q1"], pushed["q1"], rtol=0, atol=1e-7)


def test_a_push_on_the_grid_costs_rk4_nothing() -> None:
    text = "format: 1\ncontroller: {type: gravity_compensation}\npush: {force: [10, 0, 0], start: 0.1, duration: 0.05}"
    exact = scenario(text, {"solver": {"rtol": 1e-12, "atol": 1e-15}, "time.stop": 0.5}).run()
    fixed = scenario(text, {"solver": {"method": "rk4", "step": 1e-3}, "time.stop": 0.5}).run()
    for name in ("q1", "q2", "q3"):
        assert np.abs(fixed[name] - exact[name]).max() < 1e-8, name
    assert fixed.summary["energy_residual_max"] < 1e-8


@pytest.mark.parametrize(("text", "changes"), SHARP)
def test_keeps_order_four_where_the_jump_lies_on_the_grid(text: str, changes: dict[str, Any]) -> None:
    steps = [0.01, 0.005, 0.0025]
    coarse, half, quarter = (end_of(text, {**changes, "solver": {"method": "rk4", "step": h}}) for h in steps)
    ratio = np.linalg.norm(coarse - half) / np.linalg.norm(half - quarter)
    print(f"the error falls by {ratio:.3g} as the step is halved")
    assert 10 < ratio < 30


@pytest.mark.parametrize("late", [0.0, 0.01234567, 0.033])
@pytest.mark.parametrize("method", ["dopri5", "rodas4", "auto"])
@pytest.mark.parametrize(("text", "changes"), SHARP)
def test_adaptive_methods_meet_their_tolerance_wherever_the_jump_lies(
    text: str, changes: dict[str, Any], method: str, late: float
) -> None:
    start = "push.start" if "push" in changes else "reference.start" if text == ON_A_LINE else "reference.force.start"

    def at(instant: float, **solver: Any) -> dict[str, Any]:
        return {**changes, start: instant, "solver": solver}

    exact = end_of(text, at(0.1 + late, rtol=1e-12, atol=1e-14))
    found = end_of(text, at(0.1 + late, method=method, rtol=1e-8, atol=1e-10))
    assert np.abs(found - exact).max() < 3e-6
    counts = [
        rejected(scenario(text, {**at(instant, method=method, rtol=1e-8, atol=1e-10), "time.stop": 0.4 + instant}))
        for instant in (0.1 + late, 0.0)
    ]
    print("rejected steps, late and at once:", counts)
    assert counts[0] <= counts[1] + 4


@pytest.mark.parametrize(("text", "changes"), SHARP)
def test_rows_see_the_step_that_they_lie_in(text: str, changes: dict[str, Any]) -> None:
    rows = {"time": {"stop": 0.5, "log_every": 0.0005}}
    exact = scenario(text, {**rows, **changes, "solver": {"rtol": 1e-12, "atol": 1e-14}}).run()
    fixed = scenario(text, {**rows, **changes, "solver": {"method": "rk4", "step": 1e-3}}).run()
    for name in ("qd1", "qd2", "qd3", "tau1", "tau2", "tau3", "qdd1", "qdd2", "qdd3"):
        size = 1 + np.abs(exact[name]).max()
        assert np.abs(fixed[name] - exact[name]).max() < 5e-5 * size, name


# ---- rows at instants where something changes -----------------------------------------------------------------------

SAMPLED = """
format: 1
initial: {q: [0.1, -0.6, 1.2]}
controller: {type: joint_pd}
reference: {type: point, q: [0, -0.5, 1.0]}
sampling: {rate: 1000}
observer: {}
"""


def test_rows_of_rk4_at_a_sample_show_what_the_sample_put_out() -> None:
    changes = {"time": {"stop": 2, "log_every": 0.01}}
    exact = scenario(SAMPLED, changes).run()
    for step in (1e-3, 5e-4, 1e-4):
        fixed = scenario(SAMPLED, {**changes, "solver": {"method": "rk4", "step": step}}).run()
        for name in ("tau1", "tau2", "tau3", "residual1", "residual2", "f_estimate_x"):
            assert np.abs(fixed[name] - exact[name]).max() < 1e-6, (step, name)


@pytest.mark.parametrize("method", ["dopri5", "rodas4", "taylor", "auto", "rk4"])
@pytest.mark.parametrize(("rate", "delay"), [(1000, 0.4), (500, 1.4), (1000, 0), (1000, 3)])
def test_a_row_where_a_torque_changes_shows_the_new_one(method: str, rate: float, delay: float) -> None:
    changes = {"sampling": {"rate": rate, "delay": delay}, "time": {"stop": 0.5, "log_every": 0.0002}}
    solver = {"method": method, "step": 2e-4} if method == "rk4" else {"method": method}
    run = scenario(SAMPLED, {**changes, "solver": solver}).run()
    row = np.arange(len(run.t) - 1)
    per_sample = round(1 / rate / 0.0002)
    first = (np.floor(np.round(row - delay * per_sample, 6) / per_sample) * per_sample + delay * per_sample).round()
    same = np.flatnonzero(first >= 0)
    stale = [int(i) for i in same if run["tau2"][i] != run["tau2"][int(first[i])]]
    assert not stale, (len(stale), stale[:5])


@pytest.mark.parametrize("method", ["dopri5", "rodas4", "auto", "taylor"])
@pytest.mark.parametrize(
    ("rate", "delay", "start", "stop"),
    [(500, 1.4, 0, 0.7848), (200, 1.4, -0.25, 0.057), (500, 2, 2.3, 2.466), (500, 0.4, 0.1, 0.6808)],
)
def test_the_last_step_is_longer_than_the_rounding_errors_of_the_clock(
    method: str, rate: float, delay: float, start: float, stop: float
) -> None:
    """Where a torque comes to act at the end of the run but for rounding: the tip is differentiated over that step."""
    changes = {"sampling": {"rate": rate, "delay": delay}, "time": {"start": start, "stop": stop, "log_every": 0.01}}
    run = scenario(SAMPLED, {**changes, "solver": {"method": method}}).run()
    for axis in "xyz":
        assert run[f"tip_dv{axis}"][-1] == pytest.approx(run[f"tip_v{axis}"][-1], abs=1e-7)


def test_a_jump_within_a_fixed_step_is_warned_of() -> None:
    def warnings(start: float, method: str) -> list[str]:
        changes = {"push": {"force": [9, -4, 6], "start": start}, "time.stop": 0.5, "solver": {"method": method}}
        return [text for text in scenario(HELD, changes).run().summary["warnings"] if "first order" in text]

    assert "t = 0.1004 s" in warnings(0.1004, "rk4")[0]
    assert warnings(0.1, "rk4") == warnings(0.1004, "dopri5") == []


# ---- a row at a jump -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", ["dopri5", "rodas4", "auto", "rk4"])
@pytest.mark.parametrize("rate", [None, 487])
def test_a_row_at_a_jump_shows_what_holds_after_it(method: str, rate: float | None) -> None:
    """The instants of rows are products, that of a push is a decimal number: they may differ in the last bit."""
    seed = sample_seed()
    rng = np.random.default_rng([seed, 7])
    for number in range(12):
        every, row = float(f"{rng.uniform(0.003, 0.02):.4g}"), int(rng.integers(3, 30))
        start = float(rng.choice([0, -0.2, 3.7]))
        jump = float(f"{start + row * every:.10g}")
        step = (
            ", step: 0.00013"
            if method == "rk4" and not rate
            else ", step: " + repr(1 / 4870)
            if method == "rk4"
            else ""
        )
        scenario = arm3r.Scenario(
            "format: 1\ncontroller: {type: computed_torque}\n"
            + (f"sampling: {{rate: {rate}}}\n" if rate else "")
            + f"push: {{force: [50, 20, 30], start: {jump!r}}}\nsolver: {{method: {method}{step}}}\n"
            + f"time: {{start: {start!r}, stop: {jump + 0.01!r}, log_every: {every!r}}}\n"
        )
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", arm3r.ScenarioWarning)
            run = scenario.run()
        where = f"seed {seed}, {number}: {scenario.to_yaml()}"
        assert abs(run.t[row] - jump) < 1e-12, where
        assert abs(run["qdd"][row]).max() > 1, where
        assert abs(run["qdd"][row - 1]).max() < 1e-6, where


@pytest.mark.parametrize("method", ["dopri5", "rodas4", "auto"])
@pytest.mark.parametrize("rate", [None, 100])
def test_knots_that_differ_by_rounding_are_one_instant(method: str, rate: float | None) -> None:
    """The end of a path is its start and its duration, beside the last knot of its table: one bit apart, often."""
    seed = sample_seed()
    rng = np.random.default_rng([seed, 8])
    apart = 0
    for _ in range(60):
        begin, end = round(rng.uniform(0.01, 0.3), 3), round(rng.uniform(0.35, 0.7), 3)
        apart += begin + (end - begin) != end
        changes = {
            "controller": {"type": "impedance", "damping": 20},
            "reference": {"type": "table", "t": [begin, end], "x": [1.0, 1.1], "y": [0.3, 0.2], "z": [0.2, 0.1]},
            "solver": {"method": method},
            "time": {"stop": 0.75, "log_every": 0.001},
            **({"sampling": {"rate": rate}} if rate else {}),
        }
        run = scenario(HELD, changes).run()
        row = round(end / 0.001)
        for axis in "xyz":
            assert run[f"tip_dv{axis}"][row] == pytest.approx(run[f"tip_v{axis}"][row], abs=1e-6), (seed, begin, end)
    assert apart
