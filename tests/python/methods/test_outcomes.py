"""A run ends with the outcome that is due, and its message names the cause: with the instant and with a number."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from random_scenarios import Keys, random_scenario, sample_seed, yaml_of

ADAPTIVE = ("dopri5", "rodas4", "auto")
METHODS = (*ADAPTIVE, "taylor", "rk4")


def _run(text: str, **solver: Any) -> arm3r.Run:
    """The run, whatever its outcome."""
    scenario = arm3r.Scenario(text)
    if solver:
        scenario["solver"] = solver
    try:
        return scenario.run()
    except (arm3r.NumericalError, arm3r.BudgetError) as error:
        return error.run


def _is_finite(run: arm3r.Run) -> bool:
    return all(np.isfinite(run[name]).all() for name in run)


# ---- a target out of reach ------------------------------------------------------------------------------------------

STRETCHED = """
format: 1
wall: {point: [1.5, 0, -5], acts_on_arm: true, motion: {type: fixed}}
controller: {type: admittance, inner: joint_pd}
reference: {type: minimum_jerk, tip: [2.3, 0.1, 0.05], duration: 1}
time: {stop: 1}
"""


def test_a_target_out_of_reach_is_followed_as_far_as_the_arm_is_long() -> None:
    runs = {method: _run(STRETCHED, method=method, rtol=1e-8) for method in ADAPTIVE}
    for run in runs.values():
        assert run.outcome == "ok", run.summary["message"]
        for joint in ("q1", "q2", "q3"):
            assert run[joint][-1] == pytest.approx(runs["dopri5"][joint][-1], abs=1e-5)


@pytest.mark.parametrize("sampling", ["", "sampling: {rate: 500}\n"])
def test_a_target_out_of_reach_is_a_warning_with_instant_and_distance(sampling: str) -> None:
    [warning] = [text for text in _run(STRETCHED + sampling).warnings if "out of the arm's reach" in text]
    since, most = map(float, re.findall(r"from t = (\S+) s on, by at most (\S+) m", warning)[0])
    assert 0.3 < since < 1 and since == pytest.approx(round(since, 2))  # a row's instant
    assert 0.01 < most < 0.35
    assert not _run(STRETCHED.replace("2.3, 0.1", "1.6, 0.1") + sampling).warnings


# ---- no row with a number that is not finite ------------------------------------------------------------------------

INDIRECT = """
format: 1
wall: {point: [1.7320508075688772, 0, 0], motion: {type: fixed}, acts_on_arm: true}
controller: {type: adaptive_reference, adaptation: indirect, assumed_stiffness: 6000, stiffness: [0, 50, 50]}
time: {stop: 0.1}
"""


def test_an_indirect_reference_needs_a_spring_that_presses() -> None:
    with pytest.raises(arm3r.ScenarioError, match=r"controller.stiffness: .* along x there is no spring"):
        arm3r.Scenario(INDIRECT).run()
    turned = INDIRECT.replace("fixed}", "fixed}, rotation: {type: constant, axis: [0, 0, 1], rate: 0.1}")
    with pytest.raises(arm3r.ScenarioError, match="along y there is no spring"):
        arm3r.Scenario(turned.replace("[0, 50, 50]", "[50, 0, 50]")).run()
    across = _run(INDIRECT.replace("[0, 50, 50]", "[50, 0, 0]"))
    assert across.outcome == "ok" and _is_finite(across)


def _ends(part: dict[str, Any], sections: dict[str, Any], path: str = "") -> Iterator[tuple[str, float]]:
    """Every number of the schema at the ends of its range."""
    if "$ref" in part:
        part = sections[part["$ref"].removeprefix("#/definitions/")]
    for choice in part.get("anyOf", [part]):
        if choice.get("type") == "number":
            yield from ((path, choice[end]) for end in ("minimum", "maximum") if end in choice)
        for key, inner in choice.get("properties", {}).items():
            yield from _ends(inner, sections, f"{path}.{key}" if path else key)


def _extremes(root: Path) -> list[tuple[str, float]]:
    schema = json.loads((root / "docs/scenario.schema.json").read_text())
    ends = _ends(schema, schema["definitions"])
    return [(path, end) for path, end in ends if not path.startswith(("time", "checks", "format"))]


def _check_extreme(scenario: Keys, path: str, value: float) -> bool:
    """Whether the scenario takes the value; then each row is finite, or it is not there and the outcome says why."""
    scenario = json.loads(json.dumps(scenario))
    *sections, key = path.split(".")
    part = scenario
    for section in sections:
        part = part.get(section)
        if not isinstance(part, dict):
            return False
    part[key] = value
    scenario["time"] = {"stop": 0.05, "log_every": 0.01}
    scenario["solver"] = scenario.get("solver", {}) | {"max_steps": 2000}
    try:
        run = _run(yaml_of(scenario))
    except (arm3r.ScenarioError, arm3r.Arm3rError):
        return False
    assert _is_finite(run), (path, value, yaml_of(scenario))
    assert run.outcome == "ok" or run.summary["message"]
    return True


def _hold_extremes(root: Path, scenarios: int, each: int | None) -> None:
    rng = np.random.default_rng(sample_seed())
    print("ARM3R_SEED =", sample_seed())
    extremes, taken = _extremes(root), 0
    for _ in range(scenarios):
        scenario = random_scenario(rng, longest=0.4)
        chosen = extremes if each is None else [extremes[i] for i in rng.choice(len(extremes), each, replace=False)]
        taken += sum(_check_extreme(scenario, path, value) for path, value in chosen)
    assert taken > scenarios


def test_no_extreme_of_a_key_puts_what_is_no_number_into_a_row(root: Path) -> None:
    _hold_extremes(root, scenarios=25, each=20)


@pytest.mark.gate
@pytest.mark.random
def test_no_extreme_of_any_key_puts_what_is_no_number_into_a_row(root: Path) -> None:
    _hold_extremes(root, scenarios=200, each=None)


# ---- the work of a wall on an arm that stands still -----------------------------------------------------------------

CANCELLED = """
format: 1
wall: {point: [1.74, 0, 0], motion: {type: sinusoid, amplitude: 0.02, frequency: 1}, acts_on_arm: true}
controller: {type: resolved_acceleration}
time: {stop: 2}
"""


@pytest.mark.parametrize("method", ADAPTIVE)
@pytest.mark.parametrize("rtol", [1e-6, 1e-9, 1e-12])
def test_a_law_that_cancels_the_force_of_a_moving_wall_ends_ok(method: str, rtol: float) -> None:
    run = _run(CANCELLED, method=method, rtol=rtol, atol=rtol * 1e-3)
    assert run.outcome == "ok", run.summary["message"]
    assert np.max(np.abs(run["q2"] - run["q2"][0])) < 1e-9
    largest = np.max(np.abs(run["work_wall"]))
    assert largest > 0.05 and run.summary["ledger_residual"] < 10 * rtol * largest + 1e-13


@pytest.mark.parametrize("method", (*ADAPTIVE, "taylor"))
@pytest.mark.parametrize("stiffness", [1e3, 1e6])
@pytest.mark.parametrize("speed", [1e-5, 4.5e-4])
def test_a_bounce_of_next_to_no_energy_ends_ok(method: str, stiffness: float, speed: float) -> None:
    """1e-10 and 2e-7 J without gravity: the rounding of the tip's place is all that is left over."""
    scenario = arm3r.Scenario(f"""
format: 1
arm: {{gravity: [0, 0, 0]}}
initial: {{q: [0.1, 0.5, -1.1]}}
wall:
  size: infinite
  motion: {{type: constant, velocity: {speed}}}
  contact: {{law: spring, stiffness: {stiffness}}}
  acts_on_arm: true
controller: {{type: gravity_compensation, gravity: 0}}
time: {{stop: 3}}
""")
    x, y, z = map(float, scenario.arm.tip_position([0.1, 0.5, -1.1]))
    scenario["wall.point"] = [x + 0.5 * speed, y, z]
    scenario["solver"] = {"method": method} | ({"tol": 1e-12} if method == "taylor" else {"rtol": 1e-12, "atol": 1e-15})
    run = scenario.run()
    assert run.summary["contacts"] == 1 and run.summary["peak_force"] > 0


BROKEN = """
format: 1
arm: {{gravity: [0, 0, 0], link2: {{length: 0.83}}, link3: {{length: 0.57}}}}
initial: {{q: [0.2, 0.5, -1.1], qd: [0.1, -0.05, 0.08]}}
wall:
  point: [1.185, 0.2, 0]
  size: infinite
  motion: {{type: constant, velocity: {speed}}}
  contact: {{law: hunt_crossley, stiffness: 2e4, exponent: {exponent}, dissipation: {dissipation}}}
  acts_on_arm: true
time: {{stop: 0.4}}
"""


def _left_over(run: arm3r.Run, tolerance: float) -> float:
    """The largest residual of the energy balance, in units of the tolerance and the largest energy."""
    return float(run.summary["ledger_residual"] / (tolerance * _largest_energy(run)))


def _largest_energy(run: arm3r.Run) -> float:
    return float(max(np.max(np.abs(run[name]), initial=0) for name in run if name.startswith(("energy_", "work_"))))


def test_the_energy_balance_closes_where_a_contact_of_unbounded_derivatives_ends() -> None:
    rng = np.random.default_rng(sample_seed())
    print("ARM3R_SEED =", sample_seed())
    for _ in range(40):
        numbers = {"exponent": rng.uniform(1.02, 2.5), "dissipation": rng.uniform(0, 1.5)}
        text, tolerance = BROKEN.format(speed=rng.uniform(0.1, 0.5), **numbers), 10 ** rng.uniform(-11, -5)
        run = _run(text, method="dopri5", rtol=tolerance, atol=tolerance * 1e-3)
        assert run.summary["contacts"] == 1 and run.events[-1].type == "break"
        assert _left_over(run, tolerance) < 3, (text, tolerance)


CHATTER = """
format: 1
initial: {q: [0.2, 0.5, -1.1], qd: [0.1, -0.05, 0.08]}
wall:
  point: [1.672, 0.3, 0]
  size: infinite
  motion: {type: sinusoid, amplitude: 0.02, frequency: 1.4}
  contact: {law: spring, stiffness: 10000}
  acts_on_arm: true
controller: {type: operational_space, position_gain: 700, switching: in_contact}
reference: {type: hold, force: {type: constant, value: 0}}
time: {stop: 2}
"""


@pytest.mark.parametrize("tolerance", [1e-6, 1e-7, 1e-8])
def test_the_works_of_a_stiff_step_that_an_event_cuts_have_the_order_of_the_method(tolerance: float) -> None:
    run = _run(CHATTER, method="rodas4", rtol=tolerance, atol=tolerance * 1e-3)
    assert run.summary["contacts"] > 20 and _left_over(run, tolerance) < 0.1


AT_REST = """
format: 1
arm: {gravity: [0, 0, 0], friction: [0.12, 0.04, 0.4], friction_velocity: 0.1}
initial: {q: [0.79738, -2.8884, 0.7617]}
controller: {type: joint_pd, compensate_gravity: false, joint_stiffness: [200, 200, 100], joint_damping: [30, 30, 10]}
reference: {type: hold}
observer: {gain: 50, threshold: 0.5}
time: {stop: 2}
"""


@pytest.mark.parametrize("method", ADAPTIVE)
def test_rounding_errors_of_an_arm_at_rest_are_no_energy(method: str) -> None:
    """rodas4 finds the slopes of an observer by differences, and so the arm turns by 1e-24 rad/s."""
    run = _run(AT_REST, method=method, rtol=5e-11, atol=5e-14)
    assert run.outcome == "ok" and run.summary["ledger_residual"] < 1e-40


CHATTERING = """
format: 1
arm: {torque_limit: [60, 60, 60], link2: {length: 0.83}, link3: {length: 0.57}}
initial: {q: [0.2, 0.5, -1.1]}
controller: {type: joint_pd, joint_stiffness: [2000, 2000, 2000], joint_damping: [200, 200, 200]}
reference: {type: hold}
sampling: {rate: 200}
time: {stop: 20}
"""


def test_errors_that_add_up_over_thousands_of_steps_end_ok() -> None:
    """Torques change their sign at each sample, and each step gives and takes more energy than the run has."""
    run = _run(CHATTERING, method="dopri5", rtol=1e-8, atol=1e-11)
    assert run.outcome == "ok", run.summary["message"]
    assert _left_over(run, 1e-8) > 200


def _balance(rng: np.random.Generator) -> tuple[str, float]:
    """The outcome of a random scenario, and the residual of its energy balance."""
    scenario, tolerance = random_scenario(rng, longest=3), 10 ** rng.uniform(-11, -5)
    methods = [{"method": method, "rtol": tolerance, "atol": tolerance * 1e-3} for method in ADAPTIVE]
    solver = [*methods, {"method": "taylor", "tol": tolerance}][rng.integers(4)]
    try:
        arm3r.Scenario(yaml_of(scenario | {"solver": solver})).validate()
    except arm3r.ScenarioError:  # there is no series
        solver = methods[0]
    built = arm3r.Scenario(yaml_of(scenario | {"solver": solver}))
    try:
        run = built.run(time_limit=5)
    except (arm3r.NumericalError, arm3r.BudgetError) as error:
        run = error.run
    assert run.outcome != "energy", (run.summary["message"], built.to_yaml())
    judged = run.outcome == "ok" and 0 < _largest_energy(run) < 500  # J: an unstable loop grows without bound
    return run.outcome, _left_over(run, tolerance) if judged else 0.0


def _hold_balance(scenarios: int, limits: dict[float, float]) -> None:
    """The limits: to each share of the scenarios, the largest residual of its balances."""
    rng = np.random.default_rng(sample_seed())
    print("ARM3R_SEED =", sample_seed())
    runs = [_balance(rng) for _ in range(scenarios)]
    left_over = sorted(left for _, left in runs)
    for share, most in limits.items():
        assert left_over[int(share * scenarios)] <= most, share
    assert sum(outcome == "ok" for outcome, _ in runs) > 0.95 * scenarios


def test_the_energy_balance_of_random_scenarios_closes() -> None:
    _hold_balance(scenarios=30, limits={0.95: 5, 0.999: 10})


@pytest.mark.gate
@pytest.mark.random
def test_the_energy_balance_of_many_random_scenarios_closes() -> None:
    _hold_balance(scenarios=5000, limits={0.999: 10})


# ---- a compensated arm at rest --------------------------------------------------------------------------------------


def _resting(rng: np.random.Generator) -> str:
    lengths, angles = rng.uniform(0.6, 1.3, 2), rng.uniform(-1.2, 1.2, 3)
    convention, gravity = (
        rng.choice(["slide", "simscape"]),
        rng.uniform(-10, -4) * np.array([*rng.uniform(-1, 1, 2), 1]),
    )
    weight = np.array2string(gravity, separator=", ") if rng.random() < 0.5 else "[0, 0, -9.80665]"
    return f"""
format: 1
arm:
  convention: {convention}
  gravity: {weight}
  link2: {{length: {lengths[0]}, density: 5100}}
  link3: {{length: {lengths[1]}, section: [0.012, 0.009]}}
  payload: {{mass: {rng.uniform(0, 0.5)}}}
initial: {{q: {np.array2string(angles, separator=", ")}}}
controller: {{type: gravity_compensation, gravity: {weight}}}
time: {{stop: 100, log_every: 10}}
"""


@pytest.mark.parametrize("method", METHODS)
def test_a_compensated_arm_rests_to_the_bit(method: str) -> None:
    rng = np.random.default_rng(sample_seed())
    print("ARM3R_SEED =", sample_seed())
    for _ in range(8):
        text = _resting(rng)
        run = _run(text, method=method, **({"step": 0.02} if method == "rk4" else {}))
        for joint in ("q1", "q2", "q3"):
            assert np.all(run[joint] == run[joint][0]), text
            assert not np.any(run["qd" + joint[1]])
        assert run.outcome == "ok" and run["tau2"][-1] == run["tau_g2"][-1]


@pytest.mark.parametrize("method", METHODS)
def test_the_work_of_a_compensation_is_that_of_its_torque(method: str) -> None:
    """On the way, and with a wrong model, the balance closes: the power is that of the whole torque."""
    for model in ("", ", model: {link3: {mass: 0.9, com: 0.4}}"):
        text = f"""
format: 1
initial: {{q: [0.3, -0.4, 0.9], qd: [0.5, -0.3, 0.4]}}
controller: {{type: gravity_compensation{model}}}
time: {{stop: 1}}
"""
        run = _run(text, method=method, **({"step": 1e-3} if method == "rk4" else {}))
        assert run.outcome == "ok" and abs(run["work_actuators"][-1]) > 0.1
        assert np.max(np.abs(run["energy_residual"])) < 1e-8
        power = sum(run[f"tau{i}"] * run[f"qd{i}"] for i in (1, 2, 3))
        work = np.concatenate([[0], np.cumsum(0.5 * np.diff(run.t) * (power[1:] + power[:-1]))])
        assert np.max(np.abs(work - run["work_actuators"])) < 1e-3


# ---- what a bad end is laid to --------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", METHODS)
def test_an_unstable_sampled_loop_is_named(method: str) -> None:
    text = """
format: 1
initial: {q: [0.2, -0.5, 1.1]}
controller: {type: joint_pd, joint_stiffness: [60, 60, 60], joint_damping: [50, 50, 50]}
reference: {type: point, q: [0.25, -0.4, 1.0]}
sampling: {rate: 100}
time: {stop: 20}
"""
    run = _run(text, method=method, max_steps=20000, **({"step": 1e-3} if method == "rk4" else {}))
    assert run.outcome in ("diverged", "energy", "step_collapse", "budget"), run.outcome
    message = run.summary["message"]
    since, growth = map(float, re.findall(r"unstable: from t = (\S+) s on .* by a factor of (\S+) per", message)[0])
    assert 0 <= since < 1 and 1.02 < growth < 10
    assert "sampling.rate" in message and "tighten" not in message


def test_a_run_through_a_singular_pose_warns() -> None:
    """Torques at their limits turn to and fro there within microseconds, which steps may pass over."""
    text = """
format: 1
arm: {convention: slide, torque_limit: [5, 5, 5]}
initial: {q: [0.3, 0.4, -0.5], qd: [0.2, 0.1, 6]}
controller: {type: resolved_acceleration}
time: {stop: 0.3}
"""
    run = _run(text)
    assert run.outcome == "ok"
    (warning,) = run.summary["warnings"]
    told = re.findall(r"passed a singular pose at t = (\S+) s, q = \((\S+), (\S+), (\S+)\) rad; keep", warning)
    when, *pose = map(float, told[0])
    after = np.searchsorted(run.t, when)
    assert run["q"][after - 1, 2] * run["q"][after, 2] <= 0 and "solver.max_step" not in warning
    assert "compare with a small solver.max_step" in _run(text, method="rk4").summary["warnings"][-1]
    assert pose[2] == pytest.approx(0, abs=1e-6), "the pose of the crossing, not of a row"
    assert min(run["q"][after - 1, 0], run["q"][after, 0]) <= pose[0] <= max(run["q"][after - 1, 0], run["q"][after, 0])
    assert not _run(text + "sampling: {rate: 1000}").summary["warnings"], "a torque that is held has no such pulse"


@pytest.mark.parametrize("method", ["dopri5", "rodas4"])
def test_a_singular_pose_is_named(method: str) -> None:
    text = """
format: 1
arm: {convention: slide}
initial: {q: [0.2, -0.5, 1.1]}
controller: {type: resolved_acceleration, position_gain: 400, velocity_gain: 40}
reference: {type: minimum_jerk, tip: [2.2, 0.1, 0.1], duration: 0.5}
time: {stop: 3}
"""
    run = _run(text, method=method)
    assert run.outcome not in ("ok", "stopped")
    message = run.summary["message"]
    t, determinant = map(float, re.findall(r"singular pose at t = (\S+) s, where det J = (\S+) m\^3", message)[0])
    assert 0 < t <= run.t[-1] + 0.01 and abs(determinant) < 0.1 and "tighten" not in message
