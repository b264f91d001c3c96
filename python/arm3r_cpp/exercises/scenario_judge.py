"""Judges a scenario that a student hands in: what it shows when it is run."""

from __future__ import annotations

import math
from pathlib import Path

from ..errors import Arm3rError, BudgetError, ScenarioError
from ..run import Run
from ..scenario import Scenario
from .mark import RIGHT, UNCLEAR, WRONG, Mark, one_line, word_of, worst
from .task import Condition, ScenarioTask


def judge_scenario(task: ScenarioTask, path: Path) -> Mark:
    """The mark of a file."""
    try:
        scenario = judged(task, Scenario(path.read_text(encoding="utf-8"), file=path.name)._quiet())
        for key, allowed in task.keys.items():
            if scenario[key] not in allowed:
                return Mark(WRONG, one_line(f"{key} is {scenario[key]}; due is {' or '.join(map(str, allowed))}"))
        return _judge_run(task, scenario.run())
    except UnicodeDecodeError:
        return Mark(WRONG, "is no text in UTF-8")
    except BudgetError as error:
        return Mark(UNCLEAR, "the run takes too many steps", message=one_line(str(error), 400))
    except ScenarioError as error:
        problem = error.problems[0] if error.problems else {"path": "", "message": "it cannot be read"}
        what = f"{problem['path']}: {problem['message']}" if problem["path"] else problem["message"]
        return Mark(WRONG, one_line(f"is no valid scenario: {what}"), message=one_line(str(error), 400))
    except Arm3rError as error:
        outcome = error.run.outcome if error.run else "an error"
        return Mark(WRONG, f"the run ends as {outcome}", message=one_line(str(error), 400))


def judged(task: ScenarioTask, student: Scenario) -> Scenario:
    """The scenario that is run: what is given, with the parts that the task takes from the student's."""
    student.validate()
    scenario = Scenario(task.given, file=task.name)._quiet()
    scenario.update({path: student[path] for path in task.takes})
    return scenario


def _judge_run(task: ScenarioTask, run: Run) -> Mark:
    words = [_word(condition, run) for condition in task.conditions]
    word = worst(words)
    if word == RIGHT:
        return Mark(RIGHT)
    off = [_off(condition, run) for condition, one in zip(task.conditions, words, strict=True) if one != RIGHT]
    right = [condition.what for condition, one in zip(task.conditions, words, strict=True) if one == RIGHT]
    return Mark(word, "; ".join([*off, *(f"{what} is right" for what in right)]))


def _off(condition: Condition, run: Run) -> str:
    measured = condition.measure(run)
    if math.isnan(measured):
        return f"{condition.what}: there is none"
    return f"{condition.what} is off by {measured - condition.due:.2g} {condition.unit}".rstrip()


def _word(condition: Condition, run: Run) -> str:
    error = abs(condition.measure(run) - condition.due)
    return WRONG if math.isnan(error) else word_of(error, condition.threshold)
