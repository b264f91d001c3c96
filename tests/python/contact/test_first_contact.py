"""The peak of the first contact beside the largest one, compared with dense rows, across methods, in batches."""

from __future__ import annotations

import random
import re

import arm3r_cpp as arm3r
import numpy as np
import pytest
from random_scenarios import sample_seed

PRESSES = """format: 1
arm: {convention: slide, damping: [0.2, 0.1, 0.3]}
initial: {q: [0.1, 0.5, -1.1], qd: [0, 0.1, 0.1]}
wall: {point: [1.72, 0, 0], normal: [-1, 0.1, 0], acts_on_arm: true, size: infinite, motion: {type: fixed},
  contact: {law: LAW}}
controller: {type: hybrid, switching: always}
reference: {type: hold, force: {type: step, initial: 10, value: 80, start: 1.3}}
time: {stop: 1.8, log_every: 1.0e-4}
"""
CONTACTS = (
    "spring, stiffness: 4000",
    "kelvin_voigt, stiffness: 3000, damping: 15",
    "hunt_crossley, stiffness: 40000, dissipation: 0.5",
)
TRANSIENT = 0.5  # s, ISO/TS 15066


def due(run: arm3r.Run) -> tuple[float, float, float]:
    """The largest force in the rows of the first contact while it is transient, when that was, its growth in a row."""
    told = run.summary["metrics"]
    end = min(told["first_contact"] + TRANSIENT, told["first_release"] or np.inf)
    here = (run.t >= told["first_contact"]) & (run.t <= end + 1e-4)
    force = np.linalg.norm(run["f_on_wall"], axis=1)[here]
    return float(force.max()), float(run.t[here][force.argmax()]), float(np.abs(np.diff(force))[-3:].max())


def is_right(run: arm3r.Run, rel: float) -> bool:
    force, t, slope = due(run)
    told = run.summary["metrics"]
    return bool(
        abs(told["first_contact_peak"] - force) <= rel * force + slope
        and abs(told["first_contact_peak_time"] - t) <= 2e-3
        and told["first_contact_peak"] <= told["peak_force"]
    )


@pytest.mark.parametrize("method", ["dopri5", "rodas4", "rk4"])
@pytest.mark.parametrize("law", CONTACTS)
def test_a_later_press_does_not_hide_the_first_impact(law: str, method: str) -> None:
    run = arm3r.Scenario(PRESSES.replace("LAW", law) + f"solver: {{method: {method}}}\n").run()
    told = run.summary["metrics"]
    assert is_right(run, 1e-4), (due(run), told)
    assert told["first_contact_peak_time"] < 0.9 < 1.3 < told["peak_force_time"]
    assert told["first_contact_peak"] < 0.9 * told["peak_force"]
    assert re.search(r"force on wall .* peak \S+ N \(quasi-static, at 1\.\d+ s\)\n", run.report())
    assert re.search(r"first contact   peak \S+ N \(transient, at 0\.\d+ s\)\n", run.report())


def drawn(chance: random.Random) -> dict[str, object]:
    return {
        "initial.qd": [0, chance.uniform(0.1, 1), chance.uniform(-0.5, 0.5)],
        "wall.contact.stiffness": 10 ** chance.uniform(3, 4),
        "wall.point": [chance.uniform(1.70, 1.78), 0, 0],
        "reference.force.start": chance.uniform(0.1, 1.5),
    }


@pytest.mark.parametrize("count", [10, pytest.param(300, marks=[pytest.mark.gate, pytest.mark.random])])
def test_every_method_finds_the_peak_of_the_first_contact(count: int) -> None:
    chance = random.Random(sample_seed())
    for n in range(count):
        scenario = arm3r.Scenario(PRESSES.replace("LAW", chance.choice(CONTACTS[:2])))
        scenario.update(drawn(chance))
        for method in ("dopri5", "rodas4", "rk4"):
            scenario["solver.method"] = method
            run = scenario.quiet().run()
            if run.summary["contacts"]:
                assert is_right(run, 1e-3), (sample_seed(), n, method, due(run), run.summary["metrics"])


@pytest.mark.parametrize("method", ["dopri5", "rk4", "taylor"])
def test_a_batch_has_the_peak_of_single_runs(method: str) -> None:
    """Contacts that end, that last, that begin late: side by side in the lanes of one batch."""
    falls = re.sub(r"controller:.*\nreference:.*\n", "controller: {type: gravity_compensation}\n", PRESSES)
    text = falls if method == "taylor" else PRESSES
    scenario = arm3r.Scenario(text.replace("LAW", CONTACTS[0]) + f"solver: {{method: {method}}}\n")
    chance = random.Random(sample_seed())
    speeds = [[0, chance.uniform(-0.2, 1), chance.uniform(-0.5, 0.5)] for _ in range(19)]
    many = scenario.batch({"initial.qd": speeds})
    for k in range(len(speeds)):
        told = many.run(k).summary["metrics"]
        for name in ("first_contact_peak", "first_contact_peak_time"):
            one, other = many[name][k], np.nan if told[name] is None else told[name]
            assert one == other or (np.isnan(one) and np.isnan(other)), (sample_seed(), k, name, one, other)


@pytest.mark.parametrize("method", ["rk4", "taylor", "dopri5", "rodas4"])
def test_a_force_that_still_grows_after_half_a_second_is_no_transient_peak(method: str) -> None:
    """A soft wall, and rows so far apart that rk4 takes many steps between two of them."""
    soft = PRESSES.replace("LAW", "spring, stiffness: 3").replace("log_every: 1.0e-4", "log_every: 0.4")
    falls = re.sub(r"controller:.*\nreference:.*\n", "controller: {type: gravity_compensation}\n", soft)
    falls = falls.replace("{type: fixed}", "{type: constant, velocity: 0.1}").replace(
        "qd: [0, 0.1, 0.1]", "qd: [0, 0, 0]"
    )
    falls = falls.replace(", damping: [0.2, 0.1, 0.3]", "")
    scenario = arm3r.Scenario(falls + f"solver: {{method: {method}}}\n")
    told = scenario.run().summary["metrics"]
    until = told["first_contact"] + TRANSIENT
    assert told["contacts"] == 1 and told["contact_time"] > 0.6
    assert told["peak_force_time"] > until + 0.05
    assert told["first_contact_peak_time"] == pytest.approx(until, abs=1e-9)
    scenario["time.stop"] = until
    assert scenario.run().summary["final_force"] == pytest.approx(told["first_contact_peak"], rel=1e-6)
    many = scenario.batch({"time.stop": [1.8] * 9})
    assert set(many["first_contact_peak"]) == {told["first_contact_peak"]}


def test_a_contact_that_has_not_ended_has_the_peak_so_far() -> None:
    scenario = arm3r.Scenario(PRESSES.replace("LAW", CONTACTS[0]))
    scenario["time.stop"] = 0.75
    told = scenario.run().summary["metrics"]
    assert told["first_contact_peak"] == told["peak_force"] > 0


def test_without_contact_there_is_no_peak_of_it() -> None:
    told = arm3r.Scenario("format: 1\ntime: {stop: 0.1}\n").run().summary["metrics"]
    assert told["first_contact_peak"] is None and told["first_contact_peak_time"] is None
