"""Time has no origin: a scenario that is moved in time, with everything that has a time, gives the same run later."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.core.scenario import Scenario
from conftest import scenario_files
from elbow_arms import random_elbow_scenario
from force_scenarios import D
from random_scenarios import Keys, random_scenario, sample_seed, yaml_of

SHIFTS = [0.7, 37.0]
NUDGE = 1e-7  # rad: a perturbation of the start, by which the growth of an error over the run is measured
_TWO = np.array([[1, 1, 1], [0.3, 1, 0.6]])
"""Ways of nudges: where one happens to move a run along itself, the other one does not."""
_MORE = np.random.default_rng(5).uniform(-1, 1, (12, 3))
_MORE_THAN_NUDGES = 3  # times the largest change by nudges: what a run may differ by that is the same but for rounding
MOMENTS = ("t_end", "first_contact", "first_release", "peak_force_time", "first_contact_peak_time")
"""The numbers of the summary that are instants; all others do not change with time."""
OWN_ERRORS = ("ledger_residual",)
"""The numbers that are the errors of the run itself, which no other run shares."""
COLUMNS = "q1 q2 q3 qd1 qd2 qd3 tau1 tau2 tau3 tip_x tip_y tip_z f_on_tip_x f_on_tip_y f_on_tip_z depth work_actuators"
COLUMNS += " force_measured stiffness_estimate identifiable"


def get(scenario: Scenario, path: str, default: Any = None) -> Any:
    return scenario[path] if path in scenario else default  # noqa: SIM401


def listed(values: Any) -> list[float]:
    return [float(value) for value in np.atleast_1d(values)]


def prepare(scenario: Scenario, by: float) -> Scenario:
    """The scenario where what cannot be moved can: swings without a phase come back after `by`, plates turn about z.

    A reading on a grid is left out: the last bit of a state may turn it by a whole step.
    """
    ready = scenario.copy()
    ready["checks"] = []
    for path in ("reference.force.frequency", "controller.stiffness_frequency"):
        if frequency := get(ready, path):
            ready[path] = max(1, round(frequency * abs(by))) / abs(by)
    for path in ("sensors.encoder.counts", "sensors.force.resolution"):
        if get(ready, path):
            ready[path] = 0
    if get(ready, "wall.rotation.type", "none") != "none":
        ready["wall.rotation.axis"] = [0, 0, 1]
        if get(ready, "reference.type") == "circle":
            ready["wall.rotation"] = {"type": "none"}
    if "wall" in ready:
        give_direction(ready)
    return ready


def give_direction(scenario: Scenario) -> None:
    """Writes the direction of the wall's course, which is else that of its normal."""
    normal = np.array(scenario["wall.normal"])
    kind = scenario["wall.motion.type"]
    if kind == "constant":
        velocity = np.array(listed(scenario["wall.motion.velocity"]))
        along = velocity if len(velocity) == 3 and not np.isnan(velocity).any() else velocity[0] * normal / norm(normal)
        scenario["wall.motion.velocity"] = listed(along)
    elif kind != "fixed" and "wall.motion.direction" not in scenario:
        scenario["wall.motion.direction"] = listed(normal)


def with_rows_at_samples(scenario: Scenario) -> Scenario:
    """An unstable sampled loop makes the most of a nudge between rows that are far apart: here they are at its rate."""
    if "sampling" in scenario:
        every = scenario["time.log_every"]
        scenario["time.log_every"] = every / math.ceil(every * scenario["sampling.rate"])
    return scenario


def norm(v: np.ndarray) -> float:
    return float(np.linalg.norm(v))


def moved(scenario: Scenario, by: float) -> Scenario:
    """The same, `by` seconds later."""
    later = scenario.copy()
    later["time.start"], later["time.stop"] = scenario["time.start"] + by, scenario["time.stop"] + by
    for path in ("push.start", "reference.start", "reference.force.start", "estimator.start", "wall.motion.start"):
        if path in scenario:
            later[path] = scenario[path] + by
    for path in ("reference.t", "wall.motion.t"):
        if path in scenario:
            later[path] = [t + by for t in scenario[path]]
    if "wall" in scenario:
        move_wall(scenario, later, by)
    return later


def swing_back(scenario: Scenario, later: Scenario, section: str, by: float) -> float:
    """Moves a swing's phase; returns how far it is ahead of its old course after that."""
    phase = scenario[f"{section}.phase"]
    earlier = math.remainder(phase - 2 * math.pi * scenario[f"{section}.frequency"] * by, 2 * math.pi)
    later[f"{section}.phase"] = earlier
    return float(scenario[f"{section}.amplitude"] * (math.sin(phase) - math.sin(earlier)))


def move_wall(scenario: Scenario, later: Scenario, by: float) -> None:
    back = np.zeros(3)
    kind = scenario["wall.motion.type"]
    if kind == "constant":
        back = by * np.array(scenario["wall.motion.velocity"])
    if kind == "sinusoid":
        direction = np.array(scenario["wall.motion.direction"])
        back = swing_back(scenario, later, "wall.motion", by) * direction / norm(direction)
    later["wall.point"] = listed(np.array(scenario["wall.point"]) - back)
    turning = get(scenario, "wall.rotation.type", "none")
    if turning == "none":
        return
    ahead = (
        by * scenario["wall.rotation.rate"]
        if turning == "constant"
        else swing_back(scenario, later, "wall.rotation", by)
    )
    c, s = math.cos(ahead), math.sin(ahead)
    x, y, z = scenario["wall.normal"]
    later["wall.normal"] = [c * x + s * y, c * y - s * x, z]


def with_method(scenario: Scenario, method: str) -> Scenario:
    """The scenario by this method, or as it is where the method cannot run it."""
    other = scenario.copy()
    other["solver"] = {"method": method, "max_steps": 20000, **({"step": 1e-3} if method == "rk4" else {})}
    try:
        other.validate()
    except arm3r.ScenarioError:
        return scenario
    return other


def run_of(scenario: Scenario) -> arm3r.Run:
    try:
        return scenario.run()
    except arm3r.Arm3rError as error:
        if getattr(error, "run", None) is None:
            raise
        return error.run


def nudged(scenario: Scenario, ways: np.ndarray) -> list[arm3r.Run]:
    """Runs from other poses, the same ones in both conventions: some scenarios begin where the tip just touches."""
    runs = []
    signs = D if scenario["arm.convention"] == "simscape" else np.ones(3)
    for way in ways:
        other = scenario.copy()
        other["initial.q"] = np.add(scenario["initial.q"], NUDGE * signs * way)
        runs.append(run_of(other))
    return runs


def with_a_tenth_of_the_tolerance(scenario: Scenario) -> Scenario:
    other = scenario.copy()
    for path in ("solver.rtol", "solver.atol", "solver.tol"):
        if path in scenario:
            other[path] = scenario[path] / 10
    return other


def same_course(a: arm3r.Run, b: arm3r.Run) -> bool:
    return a.outcome == b.outcome and len(a.t) == len(b.t) and [e.type for e in a.events] == [e.type for e in b.events]


def is_near(a: arm3r.Run, b: arm3r.Run) -> bool:
    """Whether a motion is near the other one. At 1000 rad/s, what a nudge changes by a tenth is another motion."""
    fastest = np.abs(a["qd"]).max()
    return bool(fastest < 1e3 or np.abs(a["qd"] - b["qd"]).max() < 0.1 * fastest)


def rejected(run: arm3r.Run) -> int:
    return int(run.summary["steps"]["rejected"])


def hold_together(scenario: Scenario, by: float) -> tuple[int, int] | None:
    """Asserts that the run moved in time is the run; None where a nudge already changes the course of events, or much.

    None too where the motion is so rough that its steps are used up, or fall below what a later clock resolves.

    Returns:
        How many steps were rejected before the move and after it. A nudge alone changes this number by a quarter.
    """
    scenario = with_rows_at_samples(prepare(scenario, by))
    run, others = run_of(scenario), nudged(scenario, _TWO)
    if run.outcome == "budget" or not all(same_course(run, other) and is_near(run, other) for other in others):
        return None
    later = run_of(moved(scenario, by))
    if later.outcome == "step_collapse" and "faster than the clock resolves" in later.summary["message"]:
        return None
    try:
        hold_as_near(run, later, others, by)
    except AssertionError:  # two nudges tell how far a rough motion comes from itself, but not the most
        others += [*nudged(scenario, _MORE), run_of(with_a_tenth_of_the_tolerance(scenario))]
        if not all(same_course(run, other) and is_near(run, other) for other in others):
            return None
        hold_as_near(run, later, others, by)
    return rejected(run), rejected(later)


def hold_as_near(run: arm3r.Run, later: arm3r.Run, others: list[arm3r.Run], by: float) -> None:
    """A shift weighs no more than a nudge: it begins as rounding, and grows to what all steps are allowed."""
    assert same_course(run, later), (run.outcome, later.outcome, later.summary["message"])
    assert np.abs(later.t - run.t - by).max() < 1e-12
    for a, c, *nudges in zip(run.events, later.events, *(other.events for other in others), strict=True):
        assert abs(c.t - by - a.t) < 1e-8 + _MORE_THAN_NUDGES * max(abs(b.t - a.t) for b in nudges), (a, c)
    for name in COLUMNS.split():
        if name in run.columns:
            size, nudge = np.abs(run[name]).max(), np.max([np.abs(other[name] - run[name]) for other in others], axis=0)
            off, growth = np.abs(later[name] - run[name]), nudge.max()
            off[nudge > 0.5 * size] = 0  # a row on a jump: a nudge decides on which side of it
            limit = 1e-6 * (1 + size) + _MORE_THAN_NUDGES * growth
            assert off.max() < limit, (name, off.max(), run.t[off.argmax()], growth)
    assert not (wrong := changed_numbers(run, others, later, by)), wrong
    assert rejected(later) <= 5 + 1.4 * max(map(rejected, (run, *others)))


def changed_numbers(run: arm3r.Run, others: list[arm3r.Run], later: arm3r.Run, by: float) -> list[str]:
    """The numbers of the summary that differ by more than nudges change them, with what they are.

    When the force is largest is compared where the largest force is told from the others: a nudge moves it by little.
    A force that settles with the end of the run has settled or not by rounding.
    """
    wrong = []
    for name, value in run.summary["metrics"].items():
        there, *nudges = (one.summary["metrics"][name] for one in (later, *others))
        if name in OWN_ERRORS or name.startswith("steps") or isinstance(value, str):
            continue
        if name == "settling_time" and None in (value, there) and ends_with(run if there is None else later):
            continue
        if value is None or None in nudges:
            if all((value is None) == (nudge is None) for nudge in nudges) and (value is None) != (there is None):
                wrong.append(f"{name}: {value}, moved in time {there}")
            continue
        growth = max(abs(nudge - value) for nudge in nudges)
        if name in ("peak_force_time", "first_contact_peak_time") and growth > 1e-3:
            continue
        moved_by = by if name in MOMENTS else 0.0
        if there is None or abs(there - moved_by - value) > 1e-6 * (1 + abs(value)) + _MORE_THAN_NUDGES * growth:
            wrong.append(f"{name}: {value}, moved in time {there}, growth {growth}")
    return wrong


def ends_with(run: arm3r.Run) -> bool:
    """Whether the force of the run settles with its end."""
    told = run.summary["metrics"]
    return bool(
        told["settling_time"] is None or abs(told["first_contact"] + told["settling_time"] - told["t_end"]) < 1e-9
    )


def hold_random(count: int, draw: Callable[..., Keys] = random_scenario) -> None:
    seed = sample_seed()
    rng = np.random.default_rng(seed)
    counts: list[tuple[int, int]] = []
    for i in range(count):
        keys = draw(rng, longest=0.8)
        method = ["dopri5", "rodas4", "auto", "rk4", "taylor"][i % 5]
        by = SHIFTS[int(rng.integers(2))]
        scenario = with_method(Scenario(yaml_of(keys)), method)
        try:
            if steps := hold_together(scenario, by):
                counts.append(steps)
        except AssertionError as error:
            text = scenario.to_yaml()
            raise AssertionError(f"seed {seed}, scenario {i}, {method}, moved by {by} s: {error}\n{text}") from error
    before, after = (sum(column) for column in zip(*counts, strict=True))
    print(f"seed {seed}: {len(counts)} of {count} compared with their shift; rejected steps {before}, after it {after}")
    assert len(counts) > 0.8 * count
    assert after <= 1.05 * before + 20


def test_random_scenarios_do_not_know_what_time_it_is() -> None:
    hold_random(30)


@pytest.mark.gate
@pytest.mark.random
def test_many_random_scenarios_do_not_know_what_time_it_is() -> None:
    hold_random(300)


def test_random_elbow_arms_do_not_know_what_time_it_is() -> None:
    hold_random(10, random_elbow_scenario)


@pytest.mark.gate
@pytest.mark.random
def test_many_random_elbow_arms_do_not_know_what_time_it_is() -> None:
    hold_random(100, random_elbow_scenario)


@pytest.mark.parametrize("path", scenario_files(), ids=lambda path: path.stem)
def test_shipped_scenarios_do_not_know_what_time_it_is(path: Any) -> None:
    scenario = Scenario.load(path)
    scenario["time.stop"] = min(scenario["time.stop"], 0.5)
    assert hold_together(scenario, 0.7) is not None


@pytest.mark.gate
@pytest.mark.parametrize("by", SHIFTS)
@pytest.mark.parametrize("path", scenario_files(), ids=lambda path: path.stem)
def test_whole_shipped_scenarios_do_not_know_what_time_it_is(path: Any, by: float) -> None:
    assert hold_together(Scenario.load(path), by) is not None


@pytest.mark.parametrize("sensor", ["noise: 0", "delay: 0.0071", "analog_cutoff: 79.67", "cutoff: 60"])
@pytest.mark.parametrize("x", [1.57, 1.61], ids=["from_the_start", "later"])
def test_an_estimator_does_not_know_what_time_it_is(x: float, sensor: str) -> None:
    """The first samples behind a low-pass or a delay are told from others by how long the contact has lasted."""
    wall = (
        f"{{point: [{x}, 0, 0], size: infinite, motion: {{type: constant, velocity: 0.2}}, contact: {{stiffness: 330}}"
    )
    scenario = Scenario(
        f"format: 1\narm: {{link3: {{length: 0.8}}}}\ninitial: {{q: [0.1, 0.5, -0.9]}}\nwall: {wall}}}\n"
        "controller: {type: gravity_compensation}\nsampling: {rate: 333}\nestimator: {rate: 370}\n"
        f"sensors: {{force: {{{sensor}}}}}\ntime: {{stop: 0.2, log_every: 0.01}}\n"
    )
    scenario["wall.acts_on_arm"] = True
    assert 0 < scenario.run()["identifiable"].mean() < 1
    for rate in range(300, 1000, 70):
        scenario["sampling.rate"] = rate
        for by in SHIFTS:
            assert hold_together(scenario, by) is not None


# ---- where something changes -----------------------------------------------------------------------------------------

LATER = {
    "push.start": ("push.rise", "push.duration"),
    "reference.start": ("reference.duration",),
    "reference.force.start": ("reference.force.duration",),
    "wall.motion.start": ("wall.motion.duration",),
}


def knots_of(scenario: Scenario) -> list[float]:
    """The instants within the run at which a formula of time changes, s."""
    found = []
    for path, durations in LATER.items():
        if path in scenario:
            found += [scenario[path], *(scenario[path] + get(scenario, later, 0.0) for later in durations)]
    for path in ("reference.t", "wall.motion.t"):
        found += listed(get(scenario, path, []))
    if get(scenario, "sampling.delay"):
        found.append(scenario["time.start"] + scenario["sampling.delay"] / scenario["sampling.rate"])
    return sorted({t for t in found if scenario["time.start"] + 0.02 < t < scenario["time.stop"] - 1e-3})


def on_knot(scenario: Scenario, knot: float, place: str) -> Scenario:
    """The scenario with a row, a sample or its end at the knot."""
    other, since = scenario.copy(), knot - scenario["time.start"]
    if place == "row":
        other["time.log_every"] = since / max(1, round(since / scenario["time.log_every"]))
    if place == "sample":
        other["sampling.rate"] = max(1, round(since * scenario["sampling.rate"])) / since
    if place == "stop":
        other["time.stop"] = knot
    return other


def hold_at_knots(count: int) -> None:
    """A knot of each scenario lies on a row, on a sample or at the end, and then at zero too."""
    seed, compared = sample_seed(), 0
    rng = np.random.default_rng([seed, 5])
    for i in range(count):
        keys = random_scenario(rng, longest=0.8)
        method = ["dopri5", "rodas4", "auto", "rk4", "taylor"][i % 5]
        scenario = with_method(Scenario(yaml_of(keys)), method)
        knots = knots_of(scenario)
        if not knots:
            continue
        knot = knots[int(rng.integers(len(knots)))]
        for place in ("row", "stop", *(["sample"] if "sampling" in scenario and method != "rk4" else [])):
            there = on_knot(scenario, knot, place)
            try:
                there.validate()
                compared += hold_together(there, -knot) is not None
            except arm3r.ScenarioError:
                continue  # a rate or an end that the scenario cannot have
            except AssertionError as error:
                text = f"seed {seed}, scenario {i}, {method}, {place} at the knot {knot} s: {error}"
                raise AssertionError(f"{text}\n{there.to_yaml()}") from error
    print(f"seed {seed}: {compared} compared")
    assert compared > 0.5 * count


def test_random_knots_may_lie_anywhere() -> None:
    hold_at_knots(20)


@pytest.mark.gate
def test_many_random_knots_may_lie_anywhere() -> None:
    hold_at_knots(400)


JUMPS_AT_ZERO = {
    "push": """
format: 1
initial: {qd: [0.3, -0.4, 0.5]}
controller: {type: resolved_acceleration}
push: {force: [10, 10, 10], start: 0}
time: {start: -0.5, stop: 0.2}
""",
    "force": """
format: 1
initial: {q: [0, -0.5, 1.07]}
wall: {point: [1.7, 0, 0], size: infinite, acts_on_arm: true, motion: {type: fixed}}
controller: {type: hybrid}
reference: {force: {type: step, value: 30, initial: 5, start: 0}}
time: {start: -0.5, stop: 0.2}
""",
}


@pytest.mark.parametrize("method", ["dopri5", "rodas4", "auto", "rk4"])
@pytest.mark.parametrize("jump", JUMPS_AT_ZERO)
def test_a_jump_at_zero_counts_after_zero_in_every_number(jump: str, method: str) -> None:
    scenario = with_method(Scenario(JUMPS_AT_ZERO[jump]), method)
    metrics = scenario.run().summary["metrics"]
    assert abs(sum(metrics[f"work_{i}"] for i in (1, 2, 3)) - metrics["work_actuators"]) < 1e-8
    batch = scenario.batch({"arm.base_height": [0.0]})
    assert all(batch[name][0] == metrics[name] for name in ("work_1", "work_2", "work_3"))
    assert hold_together(scenario, 0.5) is not None
    if jump == "force" and method != "rk4":  # of first order where the contact begins within a step
        assert abs(metrics["force_error_rms"] - 7.85972) < 1e-4


# ---- what counts from the start -------------------------------------------------------------------------------------

PLAIN = "format: 1\ncontroller: {type: gravity_compensation}\n"


def test_rows_count_from_the_start() -> None:
    run = Scenario(PLAIN + "time: {start: 0.3, stop: 1.05, log_every: 0.1}").run()
    assert list(run.t) == [*(0.3 + k * 0.1 for k in range(8)), 1.05]
    assert list(Scenario(PLAIN + "time: {start: -2, stop: -2}").run().t) == [-2]


def test_a_run_must_not_end_before_it_starts() -> None:
    with pytest.raises(arm3r.ScenarioError, match=r"time\.stop.*before it starts"):
        Scenario(PLAIN + "time: {start: 3, stop: 2}").validate()


def test_samples_count_from_the_start() -> None:
    seen: list[float] = []

    def law(t: float, state: Any) -> np.ndarray:
        seen.append(t)
        return state.tau_g

    scenario = Scenario("format: 1\ncontroller: {type: user}\nsampling: {rate: 100}\ntime: {start: 0.7, stop: 0.75}")
    scenario.run(controller=law)
    assert seen == [0.7 + k * (1 / 100) for k in range(len(seen))]
    assert len(seen) == 6


def test_a_law_that_fails_names_its_sample() -> None:
    def law(t: float, state: Any) -> Any:
        return state.tau_g if t < 0.73 else "no torque"

    scenario = Scenario("format: 1\ncontroller: {type: user}\nsampling: {rate: 100}\ntime: {start: 0.7, stop: 0.75}")
    with pytest.raises(arm3r.ControllerError, match=r"at tick 3, t = 0\.73 s"):
        scenario.run(controller=law)


def test_the_wall_stands_at_its_point_at_zero() -> None:
    text = PLAIN + "wall: {motion: {type: constant, velocity: 0.05}}\ntime: {start: 2, stop: 3}"
    run = Scenario(text).run()
    assert np.allclose(run["wall_x"], 2 - 0.05 * run.t, rtol=0, atol=1e-15)


CHANGING = """
format: 1
initial: {q: [0.1, -0.5, 1.1]}
controller: {type: hybrid}
push: {force: [2, 3, -1], start: 0.21, rise: 0.05}
sampling: {rate: 500}
time: {stop: 0.5}
wall: {point: [1.64, 0.2, 0], size: infinite, acts_on_arm: true,
"""
COURSES = {
    "ramp": """
       motion: {type: ramp, distance: 0.04, start: 0.05, duration: 0.3}}
reference: {type: line, tip: [1.66, 0.2, 0.03], start: 0.1, duration: 0.2, force: {type: step, value: 15, start: 0.32}}
estimator: {start: 0.12}
""",
    "table": """
       motion: {type: table, t: [0.03, 0.2, 0.4], s: [0, 0.01, 0.02], v: [0, 0.05, 0], a: [0, 0.2, 0]}}
reference: {type: table, t: [0.05, 0.3], x: [1.63, 1.66], y: [0.16, 0.2], z: [0.03, 0.05], force: {value: 15}}
""",
}


@pytest.mark.parametrize("course", COURSES)
def test_what_changes_may_change_before_zero(course: str) -> None:
    scenario = Scenario(CHANGING + COURSES[course])
    assert scenario.run().events
    assert hold_together(scenario, -0.3) is not None
    assert hold_together(scenario, -40) is not None


@pytest.mark.parametrize(
    ("start", "told"), [("", "  0.1 s in 2 rows"), ("start: -0.3, ", "  from -0.3 to 0.1 s in 5 rows")]
)
def test_the_report_says_from_when_to_when(cli: Any, tmp_path: Any, start: str, told: str) -> None:
    (tmp_path / "s.yaml").write_text(PLAIN + f"time: {{{start}stop: 0.1, log_every: 0.1}}")
    lines = cli("run", tmp_path / "s.yaml").stdout.splitlines()
    assert next(line for line in lines if "simulated" in line).endswith(told)


def test_lanes_of_a_batch_may_start_at_different_times() -> None:
    text = (
        PLAIN
        + "wall: {acts_on_arm: true}\npush: {force: [9, 0, 0], start: 2.1}\nsolver: {method: rk4}\ntime: {stop: 4}"
    )
    starts = np.array([0.0, 1.3, 2.0, 2.05, 2.7, -1.0, 3.2])
    batch = Scenario(text).batch({"time.start": starts})
    for i, start in enumerate(starts):
        alone = Scenario(text)
        alone["time.start"] = float(start)
        run = alone.run()
        for name in ("t_end", "peak_force", "q2", "contact_time", "first_contact"):
            assert np.array_equal(batch[name][i], run.summary.get(name, batch[name][i]), equal_nan=True), (start, name)
        assert batch["q2"][i] == run["q2"][-1]
