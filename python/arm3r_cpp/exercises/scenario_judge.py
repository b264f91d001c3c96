"""Judges a scenario that a student hands in: what it shows when it is run."""

from __future__ import annotations

import math
from pathlib import Path

from ..core.run import Run
from ..core.scenario import Scenario
from ..errors import BudgetError, NumericalError, ScenarioError
from .mark import RIGHT, UNCLEAR, WRONG, Mark, one_line, two_digits, word_of, worst
from .task import Condition, ScenarioTask


def judge_scenario(task: ScenarioTask, path: Path) -> Mark:
    """The mark of a file."""
    try:
        student = Scenario(path.read_text(encoding="utf-8"), file=path.name).quiet()
        student.validate()
    except UnicodeDecodeError:
        return Mark(WRONG, "is not UTF-8 text")
    except ScenarioError as error:
        return Mark(WRONG, one_line(f"is not a valid scenario: {_problem(error)}"), message=one_line(str(error), 400))
    try:
        return _judge_run(task, judged(task, student))
    except ScenarioError as error:
        return Mark(WRONG, one_line(f"does not go with what is given: {_problem(error)}"))
    except BudgetError as error:
        return Mark(UNCLEAR, "the run takes too long", message=one_line(str(error), 400))
    except NumericalError as error:
        outcome = error.run.outcome if error.run else "an error"
        return Mark(WRONG, f"the run ends as {outcome}", message=one_line(str(error), 400))


def judged(task: ScenarioTask, student: Scenario) -> Scenario:
    """The scenario that is run: what is given, with the parts that the task takes from the student's."""
    scenario = Scenario(task.given, file=task.name).quiet()
    scenario.update({path: student[path] for path in task.takes})
    return scenario


def _problem(error: ScenarioError) -> str:
    """The first one, without its place."""
    if not error.problems:
        return "it cannot be read"
    first = error.problems[0]
    return f"{first['path']}: {first['message']}" if first["path"] else str(first["message"])


def _judge_run(task: ScenarioTask, scenario: Scenario) -> Mark:
    for key, allowed in task.keys.items():
        if scenario[key] not in allowed:
            return Mark(WRONG, one_line(f"{key} is {scenario[key]}; it should be {' or '.join(map(str, allowed))}"))
    run = scenario.run()
    errors = [_error(condition, run) for condition in task.conditions]
    words = [_word(error, condition) for error, condition in zip(errors, task.conditions, strict=True)]
    word = worst(words)
    if word == RIGHT:
        return Mark(RIGHT)
    parts = list(zip(task.conditions, errors, words, strict=True))
    off = [_off(condition, error) for condition, error, one in parts if one != RIGHT]
    right = [f"{condition.what} is right" for condition, _, one in parts if one == RIGHT]
    return Mark(word, one_line("; ".join([*off, *right])))


def _error(condition: Condition, run: Run) -> float:
    """How far a number of the run is off; NaN where the run does not have it."""
    try:
        return condition.measure(run) - condition.due
    except KeyError:  # no such column: no wall
        return math.nan


def _word(error: float, condition: Condition) -> str:
    return WRONG if math.isnan(error) else word_of(abs(error), condition.threshold)


def _off(condition: Condition, error: float) -> str:
    if math.isnan(error):
        return f"{condition.what}: there is none"
    return f"{condition.what} is off by {two_digits(error)} {condition.unit}".rstrip()
