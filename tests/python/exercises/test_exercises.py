"""The exercises: each marks a right, a wrong and a tricky solution as it should, and names the given mistake."""

from __future__ import annotations

import os
import re
import secrets
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arm3r_cpp import Scenario
from arm3r_cpp.exercises import function_judge
from arm3r_cpp.exercises.function_judge import THRESHOLD
from arm3r_cpp.exercises.judge import judge_file
from arm3r_cpp.exercises.loop import at_one_state
from arm3r_cpp.exercises.mark import RIGHT, UNCLEAR, WRONG, two_digits, word_of
from arm3r_cpp.exercises.task import FunctionTask, ScenarioTask
from arm3r_cpp.exercises.tasks import TASKS
from arm3r_cpp.verify.kinds import KINDS
from arm3r_cpp.verify.truth.three_r import ThreeR

SUBMISSIONS = Path(__file__).parents[1] / "submissions"
SOLUTIONS = sorted(path for path in SUBMISSIONS.rglob("*.*") if path.suffix != ".pyc")
FUNCTIONS = [task for task in TASKS.values() if isinstance(task, FunctionTask)]
SCENARIOS = [task for task in TASKS.values() if isinstance(task, ScenarioTask)]


def test_each_exercise_has_a_right_a_wrong_and_a_tricky_solution() -> None:
    assert len(TASKS) >= 14
    for name in TASKS:
        stems = sorted(path.stem for path in SOLUTIONS if path.parent.name == name)
        assert len(stems) == 3 and stems[0] == "right" and stems[1].startswith("tricky_") and stems[2] == "wrong", name
    assert {path.parent.name for path in SOLUTIONS} == set(TASKS)


@pytest.mark.sample(6)
@pytest.mark.parametrize("path", SOLUTIONS, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_a_solution_gets_its_mark(path: Path, tmp_path: Path, monkeypatch: Any) -> None:
    task, due = TASKS[path.parent.name], path.stem.rpartition("_")[2]
    file = tmp_path / f"{task.name}{path.suffix}"
    shutil.copy(path, file)
    mark = judge_file(task, file)
    assert mark.word == due, mark
    assert bool(mark.reason) == (due != RIGHT)
    assert len(mark.reason) <= 200 and mark.reason.isprintable()
    if isinstance(task, FunctionTask):
        assert bool(mark.cause) == (path.stem == "wrong") or path.stem == "tricky_wrong"
        monkeypatch.setattr(function_judge, "THRESHOLD", THRESHOLD * (1e-3 if due == RIGHT else 10))
        assert judge_file(task, file).word == due  # far from the threshold


SLIPS = (
    ("sin", "cos"), ("cos", "sin"), (" + ", " - "), (" - ", " + "), (" * ", " / "), ("a2", "a3"), ("a3", "a2"),
    ("[1]", "[2]"), ("[0]", "[1]"), ("2", "3"), (".T", ""), ("-", ""),
)  # fmt: skip


def with_a_slip(text: str, random: np.random.Generator) -> str:
    """The text with one slip behind its first function's head."""
    places = [(found.start(), old, new) for old, new in SLIPS for found in re.finditer(re.escape(old), text)]
    places = [place for place in places if place[0] > text.index(":", text.index("def "))]
    at, old, new = places[random.integers(len(places))]
    return text[:at] + new + text[at + len(old) :]


def values_of(text: str, task: FunctionTask) -> np.ndarray:
    """What the function of a text returns at states that the judge does not know; NaN where it fails."""
    names: dict[str, Any] = {"__name__": "solution"}
    random = np.random.default_rng(987)
    results = []
    try:
        exec(text, names)
        for _ in range(30):
            states = [random.uniform(one.low, one.high, one.size) for one in task.inputs]
            given = [
                float(state[0]) if one.size == 1 else state for one, state in zip(task.inputs, states, strict=True)
            ]
            results.append(np.asarray(names[task.function](*given), float).ravel())
        return np.array(results)
    except Exception:
        return np.full((1, 1), np.nan)


@pytest.mark.parametrize("count", [pytest.param(12, id="sample"), pytest.param(400, marks=pytest.mark.gate)])
def test_a_slip_is_wrong_where_it_changes_a_value(count: int, tmp_path: Path) -> None:
    seed = int(os.environ.get("ARM3R_SEED", secrets.randbits(32)))
    print(f"ARM3R_SEED={seed}")
    random = np.random.default_rng(seed)
    names = ("degrees", "hybrid_selection", "impedance", "mass_matrix", "observer", "reversed_arguments", "wall_torque")
    solutions = [
        path for path in SOLUTIONS if path.parent.name in names and path.suffix == ".py" and "right" in path.stem
    ]
    judged = {RIGHT: 0, WRONG: 0}
    for _ in range(count):
        path = solutions[random.integers(len(solutions))]
        task, text = TASKS[path.parent.name], path.read_text()
        assert isinstance(task, FunctionTask)
        changed = with_a_slip(text, random)
        values, due = values_of(changed, task), values_of(text, task)
        error = np.abs(values - due).max() / np.abs(due).max() if values.shape == due.shape else np.nan
        if 1e-9 < error < 1e-3:
            continue
        file = tmp_path / f"{task.name}.py"
        file.write_text(changed)
        word = RIGHT if error <= 1e-9 else WRONG
        mark = judge_file(task, file)
        assert mark.word == word, f"{mark}\n{changed}"
        judged[word] += 1
    assert judged[WRONG] > count / 2, judged


@pytest.mark.parametrize("task", [task for task in TASKS.values() if task.given], ids=lambda task: task.name)
def test_what_is_given_is_wrong_and_its_mistake_is_named(task: FunctionTask | ScenarioTask, tmp_path: Path) -> None:
    file = tmp_path / f"{task.name}{task.given_suffix}"
    file.write_text(task.given)
    mark = judge_file(task, file)
    assert mark.word == WRONG
    if isinstance(task, FunctionTask):
        assert mark.cause in [mistake.sentence for mistake in task.mistakes]
    else:
        assert mark.found.startswith(tuple(condition.what for condition in task.conditions))


@pytest.mark.parametrize("task", FUNCTIONS, ids=lambda task: task.name)
def test_mistakes_differ_clearly_from_what_is_right_and_from_each_other(task: FunctionTask) -> None:
    """No two of them are within a factor of a hundred of the threshold."""
    states = task.samples()
    count = len(next(iter(states.values())))
    all_values = [
        one(**states).reshape(count, -1) for one in (task.right, *(mistake.values for mistake in task.mistakes))
    ]
    assert all_values[0].shape[1] == len(task.entries)
    scale = np.abs(all_values[0]).max()
    for number, one in enumerate(all_values):
        for other in all_values[:number]:
            assert np.abs(one - other).max() > 1e4 * THRESHOLD * scale


@pytest.mark.parametrize("task", [task for task in FUNCTIONS if task.loop], ids=lambda task: task.name)
def test_the_loop_tells_what_is_right_from_each_mistake(task: FunctionTask) -> None:
    """No word hangs on a number near its threshold: right is right, and no mistake is unclear."""
    assert task.loop
    assert task.loop.judged(at_one_state(task.right)) == (RIGHT, "")
    for mistake in task.mistakes:
        word, off = task.loop.judged(at_one_state(mistake.values))
        assert word == WRONG and off.startswith("in the loop "), mistake.sentence


def test_a_law_that_is_right_at_the_compared_states_alone_is_wrong_in_the_loop(tmp_path: Path) -> None:
    file = tmp_path / "observer.py"
    file.write_text(
        "import numpy as np\n\n\ndef momentum_rate(tau, c, g, r):\n    return np.clip(tau, -10, 10) + c - g + r\n"
    )
    mark = judge_file(TASKS["observer"], file)
    assert (mark.word, mark.found) == (WRONG, "right at single states, and not in the loop")
    assert mark.message.startswith("in the loop the output while nothing pushes is off by")


@pytest.mark.parametrize("task", [task for task in FUNCTIONS if task.kind], ids=lambda task: task.name)
def test_what_is_right_is_what_verify_takes_for_right(task: FunctionTask) -> None:
    states = task.samples()
    truth = ThreeR(Scenario(task.scenario))
    due = truth.values(KINDS[task.kind], "simscape", {"qd": np.zeros_like(states["q"])} | states, {})
    assert np.abs(task.right(**states) - due).max() < 1e-12 * np.abs(due).max()
    places = list(np.ndindex(due.shape[1:]))
    if len(places[0]) == 2:
        assert list(task.entries) == [KINDS[task.kind].entry_name([row + 1, column + 1]) for row, column in places]


@pytest.mark.parametrize("task", SCENARIOS, ids=lambda task: task.name)
def test_the_right_scenario_is_far_from_every_threshold(task: ScenarioTask, tmp_path: Path) -> None:
    """A hundredth of the threshold is left, so that no machine sees another mark."""
    from arm3r_cpp.exercises.scenario_judge import judged

    run = judged(task, Scenario.load(SUBMISSIONS / task.name / "right.yaml")).run()
    for condition in task.conditions:
        assert abs(condition.measure(run) - condition.due) <= condition.threshold / 100, condition.what


def test_no_mark_hangs_on_a_number_near_its_threshold() -> None:
    assert [word_of(error, 4.0) for error in (0, 0.4, 0.41, 4, 39.9, 40, 1e9)] == [
        RIGHT, RIGHT, UNCLEAR, UNCLEAR, UNCLEAR, WRONG, WRONG,
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("plate_face", "format: 1\n", "the instant of contact: there is none"),
        ("moon", "", "is not a valid scenario: the scenario is empty"),
        ("gravity_constant", "format: 1\ncontroller: {type: joint_pd}\n", "controller.type is joint_pd; it should be"),
        ("steady_force", "format: 1\ncontroller: {type: user}\n", "does not go with what is given: reference.type"),
        (
            "steady_force",
            "format: 1\nwall: {acts_on_arm: true}\ncontroller: {type: hybrid, force_integral_gain: 500}\n",
            "is off by",
        ),
    ],
)
def test_what_a_scenario_is_told(name: str, text: str, words: str, tmp_path: Path) -> None:
    file = tmp_path / f"{name}.yaml"
    file.write_text(text)
    mark = judge_file(TASKS[name], file)
    assert mark.word == WRONG and words in mark.found, mark


def test_numbers_have_two_digits() -> None:
    numbers = (232.05, 81.4, 5.36, -0.00983, 0.0, 1.27e-9, 99.6)
    assert [two_digits(number) for number in numbers] == ["230", "81", "5.4", "-0.0098", "0", "1.3e-09", "100"]


@pytest.mark.parametrize("task", TASKS.values(), ids=lambda task: task.name)
def test_a_task_can_be_read(task: FunctionTask | ScenarioTask) -> None:
    assert task.title and not task.title.endswith(".") and len(set(task.hints)) == 3
    assert all(len(line) <= 110 for line in task.text.splitlines())
    assert all(len(hint) <= 130 for hint in task.hints)


def test_what_the_matlab_reader_does_not_take_is_no_mistake(tmp_path: Path) -> None:
    path = tmp_path / "half_link.m"
    path.write_text("function tau = half_link(q)\n[a, b] = max(q);\ntau = [0; a; b];\nend\n")
    mark = judge_file(TASKS["half_link"], path)
    assert mark.word == UNCLEAR and "line 2" in mark.reason and "several outputs" in mark.message, mark
