"""Changes of a scenario: keys are checked when they are put, values together, and likely mistakes are warned of."""

from __future__ import annotations

import inspect
import pickle
import random
import subprocess
import warnings
from typing import Any

import arm3r_cpp as arm3r
import pytest

TEXT = """
format: 1
initial: {q: [0.3, -0.4, 0.9]}
wall: {point: [1.72, 0.5, -0.1], motion: {type: fixed}, acts_on_arm: true}
controller: {type: joint_pd}
time: {stop: 0.05}
"""


@pytest.fixture
def scenario() -> arm3r.Scenario:
    return arm3r.Scenario(TEXT)


# ---- keys -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "value", "nearest"),
    [
        ("wal", {}, "wall"),
        ("wall.contact.stifness", 500, "stiffness"),
        ("wall", {"point": [2, 0, 0], "contact": {"stifness": 500}}, "stiffness"),
        ("inital.q[1]", 0.5, r"initial\.q"),
        ("solver", {"metod": "rk4"}, "method"),
    ],
)
def test_an_unknown_key_is_refused_at_once(scenario: arm3r.Scenario, path: str, value: Any, nearest: str) -> None:
    before = scenario.to_yaml()
    with pytest.raises(arm3r.ScenarioError, match=rf"no such (key|list).*did you mean .*{nearest}") as raised:
        scenario[path] = value
    assert {problem["code"] for problem in raised.value.problems} <= {"scenario.unknown_key", "path.unknown"}
    assert scenario.to_yaml() == before and scenario.run().outcome == "ok"


def test_all_unknown_keys_of_a_map_are_named(scenario: arm3r.Scenario) -> None:
    with pytest.raises(arm3r.ScenarioError) as raised:
        scenario["wall"] = {"pint": [2, 0, 0], "sise": [1, 1]}
    assert [problem["path"] for problem in raised.value.problems] == ["wall.pint", "wall.sise"]
    assert str(raised.value).count("\n") == 1


def test_every_key_of_the_schema_can_be_put(scenario: arm3r.Scenario) -> None:
    for index in range(arm3r.param_count()):
        path = arm3r.param_key(index).path
        scenario.copy()[path] = {} if arm3r.param_key(index).kind == "section" else 1


def test_every_key_that_is_mistyped_is_refused_at_once(scenario: arm3r.Scenario) -> None:
    paths = {arm3r.param_key(index).path for index in range(arm3r.param_count())}
    before, seed = scenario.to_yaml(), random.randrange(2**32)
    rng = random.Random(seed)
    for path in sorted(paths):
        place = rng.randrange(len(path))
        wrong = path[:place] + rng.choice([letter for letter in "bxz_" if letter != path[place]]) + path[place + 1 :]
        if wrong in paths:  # reference.x and reference.y are both keys
            continue
        with pytest.raises(arm3r.ScenarioError, match="no such key"):
            scenario[wrong] = 1
            pytest.fail(f"{wrong} was taken, seed {seed}")
    assert scenario.to_yaml() == before


def test_keys_of_another_choice_are_judged_when_the_scenario_is_used(scenario: arm3r.Scenario) -> None:
    scenario["solver.step"] = 0.001
    with pytest.raises(arm3r.ScenarioError, match="step"):
        scenario.validate()
    scenario["solver.method"] = "rk4"
    scenario["solver.step"] = 0.001
    scenario.validate()


def test_an_unknown_key_that_was_there_before_does_not_matter() -> None:
    scenario = arm3r.Scenario("{format: 1, wal: {}, tme: {stop: 1}}")
    scenario["wal"] = None
    scenario["wall"] = {}
    with pytest.raises(arm3r.ScenarioError, match="tme") as raised:
        scenario.validate()
    assert len(raised.value.problems) == 1


# ---- several values -------------------------------------------------------------------------------------------------


def test_values_that_belong_together_are_put_together(scenario: arm3r.Scenario) -> None:
    scenario.update(
        {
            "controller": {"type": "admittance"},
            "reference": {"force": {"value": 5}},
            "sampling": {"rate": 500, "delay": 0.002},
            "time.stop": 0.07,
        }
    )
    assert scenario["controller.type"] == "admittance" and scenario["sampling.delay"] == 0.002
    assert scenario.run()["t"][-1] == 0.07


@pytest.mark.parametrize(
    ("values", "error"),
    [
        ({"time.stop": 0.07, "wal": {}}, arm3r.ScenarioError),
        ({"time.stop": 0.07, "wall.contact.stiffness": -5}, arm3r.ScenarioError),
        ({"time.stop": 0.07, "solver.step": 0.001}, arm3r.ScenarioError),
        ({"time.stop": 0.07, "initial.q": {1, 2}}, TypeError),
        ({"time.stop": 0.07, 3: 3}, TypeError),
        ([("time.stop", 0.07)], TypeError),
    ],
)
def test_all_of_them_or_none(scenario: arm3r.Scenario, values: Any, error: type[Exception]) -> None:
    before = scenario.to_yaml()
    with pytest.raises(error):
        scenario.update(values)
    assert scenario.to_yaml() == before


def test_a_scenario_that_is_not_valid_can_be_completed() -> None:
    scenario = arm3r.Scenario(TEXT)
    scenario["solver.step"] = 0.001
    scenario.update({"solver.method": "rk4", "solver.step": 0.002})
    assert scenario["solver.step"] == 0.002


# ---- warnings -------------------------------------------------------------------------------------------------------


def issued(act: Any) -> list[warnings.WarningMessage]:
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        act()
    return [warning for warning in found if warning.category is arm3r.ScenarioWarning]


def test_degrees_taken_for_radians_are_warned_of(scenario: arm3r.Scenario) -> None:
    scenario["initial.q"] = [0, -30, 60]
    found = issued(scenario.run)
    assert len(found) == 2 and all("scenario.yaml: initial.q[" in str(warning.message) for warning in found)
    assert "write `-30 deg` if degrees were meant" in str(found[0].message)
    assert issubclass(arm3r.ScenarioWarning, UserWarning)


USES = {
    "run": lambda scenario: scenario.run(),
    "run with a law": lambda scenario: scenario.run(controller=lambda t, state: state.tau_g),
    "validate": lambda scenario: scenario.validate(),
    "batch": lambda scenario: scenario.batch({}),
    "simulation": lambda scenario: arm3r.Simulation(scenario),
}


@pytest.mark.parametrize("use", USES.values(), ids=USES)
def test_once_for_each_state_and_at_the_users_line(scenario: arm3r.Scenario, use: Any) -> None:
    scenario["initial.q"] = [0, -30, 1]
    found = issued(lambda: use(scenario))
    assert [warning.filename for warning in found] == [__file__]
    lines, first = inspect.getsourcelines(use)
    assert first <= found[0].lineno < first + len(lines)
    assert issued(lambda: use(scenario)) == issued(scenario.validate) == issued(scenario.copy().validate) == []
    scenario["time.stop"] = 0.04
    assert len(issued(lambda: use(scenario))) == 1


def test_what_only_the_run_shows_is_warned_of_too() -> None:
    scenario = arm3r.Scenario(
        "{format: 1, wall: {point: [1.7, 0, 0], motion: {type: fixed}}, time: {stop: 0.5},"
        " initial: {q: [0, -30 deg, 60 deg]}}"
    )
    run: list[arm3r.Run] = []
    found = issued(lambda: run.append(scenario.run()))
    assert [str(warning.message) for warning in found] == [f"scenario.yaml: {text}" for text in run[0].warnings]
    assert "behind the wall" in run[0].warnings[0]


def test_a_scenario_that_is_as_it_should_be_warns_of_nothing(lecture: arm3r.Scenario) -> None:
    assert issued(lecture.run) == issued(lambda: lecture.batch({"time.stop": [1.0, 2.0]})) == []


def test_the_executable_and_python_warn_of_the_same(cli: Any, tmp_path: Any) -> None:
    file = tmp_path / "s.yaml"
    file.write_text("{format: 1, initial: {q: [0.1, -30, 60]}, arm: {link2: {length: 100}}}\n")
    told = [line for line in cli("check", file).stderr.splitlines() if ": warning: " in line]
    found = issued(arm3r.Scenario.load(file).validate)
    assert [str(warning.message) for warning in found] == [line.replace("warning: ", "", 1) for line in told]
    assert len(told) >= 3


def test_a_warning_that_is_made_an_error_is_raised_each_time(scenario: arm3r.Scenario) -> None:
    scenario["initial.q"] = [0, -30, 1]
    with warnings.catch_warnings():
        warnings.simplefilter("error", arm3r.ScenarioWarning)
        for _ in range(2):
            with pytest.raises(arm3r.ScenarioWarning, match="full turn"):
                scenario.run()


def test_a_pickled_scenario_warns_anew(scenario: arm3r.Scenario) -> None:
    scenario["initial.q"] = [0, -30, 1]
    assert len(issued(pickle.loads(pickle.dumps(scenario)).validate)) == 1


@pytest.mark.gate
def test_commands_print_warnings_without_a_line_of_code(tmp_path: Any, scripts: Any, cli: Any) -> None:
    (tmp_path / "s.yaml").write_text("{format: 1, initial: {q: [0, -30, 1]}, time: {stop: 0.02}}\n")
    call = [scripts / "arm3r-plot", "s.yaml", "-o", "s.png"]
    done = subprocess.run(call, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0 and done.stderr.startswith("warning: s.yaml: initial.q[1] is more than a full turn")
    assert done.stderr.count("\n") == 1
