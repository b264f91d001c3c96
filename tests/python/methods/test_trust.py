"""Closed forms beside a run's numbers, and the time up to which a run is right; docs/model.md, section 9."""

from __future__ import annotations

import json
import subprocess
from itertools import pairwise
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.core.scenario import flow
from conftest import Cli
from exact_fall import exact_angles
from random_scenarios import sample_seed, yaml_of

CONTACT_NUMBERS = {"peak_force", "contact_time", "impulse"}


def form(run: arm3r.Run, name: str) -> arm3r.ClosedForm:
    (found,) = [one for one in run.closed_forms if one.name == name]
    return found


def share(one: arm3r.ClosedForm) -> float:
    """Of what is allowed."""
    return abs(one.own - one.closed_form) / one.allowed


# ---- contacts


def random_contact(rng: np.random.Generator) -> dict[str, Any]:
    """An arm with gravity in any direction, in motion, met by a wall in any direction a moment later."""
    law, method = (
        ("kelvin_voigt", "dopri5") if rng.random() < 0.5 else ("spring", str(rng.choice(["dopri5", "taylor"])))
    )
    arm = {
        "convention": str(rng.choice(["slide", "simscape"])),
        "gravity": rng.uniform([-3, -3, -11], [3, 3, -8]),
        "link2": {"length": rng.uniform(0.5, 1.5)},
        "link3": {"length": rng.uniform(0.5, 1.5), "mass": rng.uniform(0.5, 3)},
        "armature": rng.uniform(0, [0.2, 0.2, 0.1]),
        "payload": {"mass": rng.uniform(0, 1)},
        "damping": rng.uniform(0, 0.5, 3),
    }
    q, qd = rng.uniform(-2.5, 2.5, 3), rng.uniform(-0.3, 0.3, 3)
    normal = rng.normal(size=3)
    normal /= np.linalg.norm(normal)
    model = arm3r.Scenario(yaml_of({"format": 1, "arm": arm})).arm
    velocity = model.jacobian(q) @ qd + rng.uniform(0.05, 1) * normal
    controller: dict[str, Any] = {"type": str(rng.choice(["none", "constant", "gravity_compensation"]))}
    if controller["type"] == "constant":
        controller["torque"] = rng.uniform(-5, 5, 3)
    restitution = {"restitution": rng.uniform(0.2, 0.95)} if law == "kelvin_voigt" else {}
    return {
        "format": 1,
        "arm": arm,
        "initial": {"q": q, "qd": qd},
        "wall": {
            "point": model.tip_position(q) - rng.uniform(1e-5, 2e-3) * normal,
            "normal": normal,
            "size": [3.0, 3.0],
            "motion": {"type": "constant", "velocity": velocity},
            "contact": {"law": law, "stiffness": 10 ** rng.uniform(4, 7.5), **restitution},
            "acts_on_arm": True,
        },
        "controller": controller,
        "solver": {"method": method},
        "time": {"stop": 0.1, "log_every": 0.1},
    }


def run_of_one_contact(scenario: arm3r.Scenario) -> arm3r.Run | None:
    """Cut between the first contact and the next, if there is one."""
    run = scenario.quiet().run()
    if len(run.events) > 2:
        scenario["time.stop"] = (run.events[1].t + run.events[2].t) / 2
        run = scenario.run()
    return run if [event.type for event in run.events] == ["make", "break"] else None


def test_no_contact_departs_from_theory_further_than_is_derived() -> None:
    """On 300 random contacts; and the bounds say something."""
    rng = np.random.default_rng(sample_seed())
    found: dict[str, list[arm3r.ClosedForm]] = {}
    while len(found.get("impulse", [])) < 300:
        drawn = random_contact(rng)
        run = run_of_one_contact(arm3r.Scenario(yaml_of(drawn)))
        for one in run.closed_forms if run else []:
            assert share(one) <= 1, f"seed {sample_seed()}: {one} in\n{yaml_of(drawn)}"
            found.setdefault(one.name, []).append(one)
    assert set(found) >= CONTACT_NUMBERS
    for name, forms in found.items():
        shares, widths = [share(one) for one in forms], [one.allowed / one.closed_form for one in forms]
        print(f"{name}: {max(shares):.3f} of what is allowed at most; allowed: {np.median(widths):.2%} in the middle")
        assert np.median(widths) < 0.1


def test_the_bounds_shrink_as_the_wall_gets_stiffer(lecture: arm3r.Scenario) -> None:
    lecture.update({"checks": [], "wall.acts_on_arm": True, "solver": {"method": "taylor", "tol": 1e-12}})
    widths = []
    for stiffness in (1e4, 1e6, 1e8):
        lecture["wall.contact.stiffness"] = stiffness
        peak = form(lecture.run(), "peak_force")
        assert abs(peak.closed_form - 0.05 * np.sqrt(stiffness * 0.5535415)) < 1e-6 * peak.closed_form
        widths.append(peak.allowed / peak.closed_form)
    assert 5 < widths[0] / widths[1] < 20
    assert 5 < widths[1] / widths[2] < 20


def test_the_closed_forms_of_the_lectures_wall(lecture: arm3r.Scenario) -> None:
    lecture.update({"checks": [], "wall.acts_on_arm": True})
    run = lecture.run()
    m, k, v = 0.55354150774, 1000.0, 0.05
    assert [one.name for one in run.closed_forms] == ["first_contact", "peak_force", "contact_time", "impulse"]
    due = [(2 - np.sqrt(3)) / v, v * np.sqrt(k * m), np.pi * np.sqrt(m / k), 2 * m * v]
    np.testing.assert_allclose([one.closed_form for one in run.closed_forms], due, rtol=1e-7)
    own = [run.summary["metrics"][one.name] for one in run.closed_forms]
    assert [one.own for one in run.closed_forms] == own
    assert run.summary["closed_forms"]["effective_mass"] == pytest.approx(m)
    assert run.summary["closed_forms"]["approach_speed"] == pytest.approx(v)


@pytest.mark.parametrize("restitution", [0.3, 0.8])
def test_a_damped_contact_has_the_impulse_of_its_restitution(lecture: arm3r.Scenario, restitution: float) -> None:
    contact = {"law": "kelvin_voigt", "stiffness": 1e6, "restitution": restitution}
    lecture.update({"checks": [], "wall.acts_on_arm": True, "wall.contact": contact})
    impulse = form(lecture.run(), "impulse").closed_form
    assert impulse == pytest.approx(0.5535415 * (1 + restitution) * 0.05, rel=1e-6)


def test_a_contact_that_is_computed_badly_departs_further_than_theory_allows(lecture: arm3r.Scenario, cli: Cli) -> None:
    lecture.update({"checks": [], "wall.acts_on_arm": True, "wall.contact.stiffness": 1e6})
    lecture["solver"] = {"method": "rk4", "step": 1e-3}
    assert share(form(lecture.quiet().run(), "peak_force")) > 1
    text = cli("run", "-", input=lecture.to_yaml()).stdout
    assert "more than allowed" in text


def test_a_wall_that_the_arm_does_not_feel_has_the_force_of_its_way(lecture_run: arm3r.Run) -> None:
    force = form(lecture_run, "final_force")
    assert force.closed_form == pytest.approx(50 * (10 - (2 - np.sqrt(3)) / 0.05), rel=1e-12)
    assert share(force) < 1e-3


def test_a_steady_force_follows_from_statics() -> None:
    run = arm3r.Scenario.example("impedance/stiffness_fixed_wall").run()
    force = form(run, "final_force")
    assert force.closed_form == pytest.approx(22.7272727273, rel=1e-9)
    assert share(force) <= 1


@pytest.mark.parametrize(
    "change",
    [
        {"wall.rotation": {"type": "constant", "axis": [0, 0, 1], "rate": 0.01}},
        {"wall.contact": {"law": "hunt_crossley", "stiffness": 1e6, "dissipation": 1}},
        {"wall.contact.friction": {"coefficient": 0.3}},
        {"push": {"force": [0, 0.01, 0], "start": 1.0}},
        {"controller": {"type": "impedance"}},
        {"wall.size": [1.0, 0.001], "wall.motion": {"type": "constant", "velocity": [-0.05, 0, 0.01]}},
    ],
    ids=["turning", "hunt_crossley", "friction", "push", "law", "edge"],
)  # fmt: skip
def test_what_has_no_closed_form_is_given_none(lecture: arm3r.Scenario, change: dict[str, Any]) -> None:
    lecture.update({"checks": [], "wall.acts_on_arm": True, "wall.contact.stiffness": 1e5, "time.stop": 5.5})
    lecture.update({"time.log_every": 0.01, **change})
    assert not CONTACT_NUMBERS & {one.name for one in lecture.quiet().run().closed_forms}


def test_a_run_without_contact_has_no_closed_forms() -> None:
    run = arm3r.Scenario("format: 1\ntime: {stop: 0.1}\n").run()
    assert run.closed_forms == []
    assert "closed forms" not in run.report()


# ---- the horizon


def random_fall(rng: np.random.Generator) -> arm3r.Scenario:
    method = str(rng.choice(["dopri5", "taylor", "rk4", "rodas4", "auto"]))
    tolerance = 10 ** rng.uniform(-12, -7)
    solver: dict[str, Any] = {"rtol": tolerance, "atol": tolerance / 1000}
    solver = {"taylor": {"tol": tolerance}, "rk4": {"step": 10 ** rng.uniform(-3.3, -2.3)}}.get(method, solver)
    arm = {
        "convention": str(rng.choice(["slide", "simscape"])),
        "link2": {"length": rng.uniform(0.5, 1.5)},
        "link3": {"length": rng.uniform(0.5, 1.5), "mass": rng.uniform(0.5, 3)},
        "armature": rng.uniform(0, [0.05, 0.05, 0.02]),
        "payload": {"mass": rng.uniform(0, 1)},
    }
    initial = {"q": rng.uniform(-3, 3, 3), "qd": rng.uniform(-2, 2, 3)}
    return arm3r.Scenario(
        f"format: 1\narm: {flow(arm, 'arm')}\ninitial: {flow(initial, 'initial')}\n"
        f"solver: {flow({'method': method, **solver}, 'solver')}\ntime: {{stop: 8, log_every: 0.02}}\n"
    ).quiet()


@pytest.mark.parametrize("falls", [3, pytest.param(30, marks=pytest.mark.gate)])
def test_the_horizon_of_a_free_fall_is_near_that_of_a_run_in_extended_precision(falls: int) -> None:
    rng = np.random.default_rng(sample_seed())
    for fall in range(falls):
        scenario = random_fall(rng)
        run = scenario.run(trust=True)
        assert run.trust is not None
        rows = len(run.t) if run.trust.to_the_end else min(len(run.t), int(1.3 * run.trust.horizon / 0.02) + 5)
        error = np.abs(run["q"][:rows] - exact_angles(scenario, run.t[:rows])).max(axis=1)
        wrong = np.flatnonzero(error > 1e-6)
        truth = run.t[wrong[0] - 1] if wrong.size else run.t[rows - 1]
        place = f"seed {sample_seed()}, fall {fall}: {run.trust}, truth {truth} s, of\n{scenario.to_yaml()}"
        assert wrong.size or run.trust.to_the_end or truth <= 1.2 * run.trust.horizon, place
        assert abs(run.trust.horizon - truth) <= 0.2 * truth, place


def test_the_reference_is_the_arms_own_equation() -> None:
    rng = np.random.default_rng(sample_seed())
    scenario = random_fall(rng)
    scenario.update({"solver": {"method": "taylor", "tol": 1e-14}, "time.stop": 0.2})
    run = scenario.run()
    assert np.abs(run["q"] - exact_angles(scenario, run.t)).max() < 1e-12


def test_a_loose_tolerance_is_seen_and_a_tight_one_lasts() -> None:
    scenario = arm3r.Scenario.example("lecture/05_free_fall")
    scenario["checks"] = []
    horizons = []
    for rtol in (1e-4, 1e-6, 1e-8):
        scenario["solver"] = {"method": "dopri5", "rtol": rtol, "atol": rtol / 1000}
        trust = scenario.quiet().run(trust=True).trust
        assert trust is not None
        horizons.append(trust.horizon)
    assert horizons[0] < horizons[1] < horizons[2]


def test_a_run_is_the_same_whether_its_horizon_is_asked_for_or_not(lecture: arm3r.Scenario) -> None:
    plain, asked = lecture.run(), lecture.run(trust=True)
    assert plain.trust is None
    assert "trust" not in plain.summary
    assert plain.summary["hash"] == asked.summary["hash"]
    assert plain.summary["steps"] == asked.summary["steps"]
    assert asked.trust is not None
    assert asked.trust.to_the_end
    assert asked.trust.horizon == 10


@pytest.mark.parametrize("solver", [
    {"method": "dopri5", "rtol": 2.3e-14, "atol": 1e-20}, {"method": "taylor", "tol": 1e-15},
    {"method": "rodas4", "rtol": 1e-13}, {"method": "rk4", "step": 1e-3},
], ids=lambda solver: solver["method"])  # fmt: skip
def test_the_least_tolerances_have_a_horizon_too(solver: dict[str, Any]) -> None:
    scenario = arm3r.Scenario("format: 1\ninitial: {q: [0.3, -0.5, 0.8]}\ntime: {stop: 0.5, log_every: 0.1}\n")
    scenario["solver"] = solver
    trust = scenario.run(trust=True).trust
    assert trust is not None
    assert trust.to_the_end
    assert 0 < trust.end_error < 1e-7
    assert trust.growth > 0.5


def test_the_command_says_up_to_when(cli: Cli, tmp_path: Path, root: Path) -> None:
    file = root / "scenarios/lecture/05_free_fall.yaml"
    loose = ["--set", "solver={method: dopri5, rtol: 1e-5}", "--no-checks", "--set", "time.log_every=0.01"]
    done = cli("run", file, "--trust", *loose, "-o", tmp_path / "fall.csv")
    assert done.returncode == 0, done.stderr
    (line,) = [line for line in done.stdout.splitlines() if line.startswith("  trust")]
    trust = arm3r.Run.load(tmp_path / "fall.csv").trust
    assert trust is not None
    assert trust.horizon < 10
    assert f"until {trust.horizon:g} s" in line
    found = json.loads(cli("run", file, "--trust", "--json", *loose).stdout)["trust"]
    assert arm3r.Trust(**found) == trust
    assert "--trust" in cli("run", "--help").stdout


def test_runs_that_are_cut_short_tell_no_horizon() -> None:
    scenario = arm3r.Scenario("format: 1\nsolver: {method: dopri5, max_steps: 300}\ntime: {stop: 1}\n")
    steps = scenario.run().summary["steps"]["accepted"]
    scenario["solver.max_steps"] = steps + scenario.run().summary["steps"]["rejected"]
    assert scenario.run(trust=True).trust is not None
    calls = []

    def stop_the_second_run(t: float, stop: float, steps: int) -> bool:
        calls.append(t)
        return any(later < earlier for earlier, later in pairwise(calls))

    scenario.update({"solver": {"method": "rk4", "step": 2e-6}, "time.stop": 1.0})
    run = scenario.run(trust=True, progress=stop_the_second_run)
    assert run.trust is None
    assert "is not known" in run.warnings[-1]


def test_a_run_that_fails_has_a_horizon_too() -> None:
    scenario = arm3r.Scenario("format: 1\nsolver: {method: rk4, step: 0.05}\ntime: {stop: 20, log_every: 0.0125}\n")
    scenario.update({"arm.link1.inertia_axial": 1e-6, "initial": {"q": [0.1, 0.2, 0.3], "qd": [40, 1, 2]}})
    with pytest.raises(arm3r.NumericalError) as caught:
        scenario.run(trust=True)
    assert caught.value.run is not None
    assert caught.value.run.trust is not None
    assert caught.value.run.trust.horizon < caught.value.run.t[-1]


def test_a_law_of_your_own_has_no_horizon(lecture: arm3r.Scenario) -> None:
    with pytest.raises(arm3r.UsageError, match="trust"):
        lecture.run(trust=True, controller=lambda t, state: state.tau_g)


def test_figures_grey_out_what_is_beyond_the_horizon() -> None:
    scenario = arm3r.Scenario.example("lecture/05_free_fall")
    scenario.update({"checks": [], "solver": {"method": "dopri5", "rtol": 1e-5}})
    plain, run = scenario.quiet().run(), scenario.run(trust=True)
    assert run.trust is not None
    labels = [text.get_text() for text in arm3r.plot.overview(run).axes[0].get_legend().get_texts()]
    assert any("1e-06 rad" in label for label in labels)
    for figure in (arm3r.plot.overview(run), *arm3r.plot.lecture(run, panels=["tip", "energies"]).values()):
        for axes in figure.axes:
            starts = [patch.get_x() for patch in axes.patches if patch.get_zorder() == 4]
            assert starts == [run.trust.horizon]
    assert not any(patch.get_zorder() == 4 for axes in arm3r.plot.overview(plain).axes for patch in axes.patches)
    walled = arm3r.Scenario.example("moving_wall")
    walled.update({"checks": [], "solver": {"method": "dopri5", "rtol": 1e-5}, "controller": {"type": "none"}})
    one, other = walled.quiet().run(trust=True), walled.run()
    figure = arm3r.plot.compare({"one": one, "other": other}, panels=["force", "torques"])
    assert one.trust is not None
    assert [patch.get_x() for patch in figure.axes[0].patches if patch.get_zorder() == 4] == [one.trust.horizon]
    early = arm3r.plot.overview(run, end=run.trust.horizon)
    assert not any(patch.get_zorder() == 4 for axes in early.axes for patch in axes.patches)


# ---- the observed order

FALL = "format: 1\ninitial: {q: [0.3, -0.5, 0.8], qd: [0.2, 0.1, -0.3]}\ntime: {stop: 1, log_every: 0.1}\n"


@pytest.mark.parametrize(("solver", "order", "within"), [
    ({"method": "rk4", "step": 0.0025}, 4, 0.3), ({"method": "dopri5", "rtol": 1e-7, "atol": 1e-10}, 5, 0.6),
    ({"method": "rodas4", "rtol": 1e-7, "atol": 1e-10}, 4, 0.6), ({"method": "taylor", "tol": 1e-6}, 20, 15),
], ids=lambda value: value["method"] if isinstance(value, dict) else None)  # fmt: skip
def test_the_observed_order_is_that_of_the_method(solver: dict[str, Any], order: float, within: float) -> None:
    scenario = arm3r.Scenario(FALL)
    scenario["solver"] = solver
    found = arm3r.converge(scenario)
    assert found.order == pytest.approx(order, abs=within)
    assert [level.error for level in found.levels] == sorted((level.error for level in found.levels), reverse=True)


def test_a_jump_within_steps_costs_rk4_its_order() -> None:
    scenario = arm3r.Scenario(FALL)
    scenario.update({"solver": {"method": "rk4", "step": 0.01}, "push": {"force": [5, 3, 2], "start": 0.3333}})
    order = arm3r.converge(scenario).order
    assert order is not None
    assert order < 2.5


def test_a_run_without_errors_shows_no_order(lecture: arm3r.Scenario) -> None:
    at_rest = arm3r.converge(lecture)
    assert at_rest.order is None
    assert "equally many steps" in str(at_rest)
    lecture.update({"solver": {"method": "rk4", "step": 0.01}, "checks": []})
    assert "mere rounding" in str(arm3r.converge(lecture))


@pytest.mark.parametrize("solver", [{"method": "dopri5", "rtol": 1e-12}, {"method": "taylor", "tol": 1e-14}])
def test_no_run_is_more_exact_than_a_scenario_may_ask_for(solver: dict[str, Any]) -> None:
    """The reference is as exact as the schema allows, and 1 % more is refused."""
    scenario = arm3r.Scenario(FALL)
    scenario["solver"] = solver
    found = arm3r.converge(scenario)
    scenario[found.key] = 0.99 * found.reference
    with pytest.raises(arm3r.ScenarioError, match="out of range"):
        scenario.validate()


def test_the_command_prints_the_order(scripts: Path, written: Any) -> None:
    file = written("fall.yaml", FALL)
    call = [scripts / "arm3r", "converge", file, "--set", "solver={method: rk4, step: 0.00125}"]
    done = subprocess.run(call, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "observed order 4.0" in done.stdout or "observed order 3.9" in done.stdout
    assert len(done.stdout.splitlines()) == 7
    bad = subprocess.run([scripts / "arm3r-converge", "missing.yaml"], capture_output=True, text=True)
    assert (bad.returncode, "missing.yaml" in bad.stderr) == (2, True)
