"""The lecture computes the force, and the arm does not feel it."""

import math
from functools import cache

from ....core.run import Run
from ....core.scenario import Scenario
from ...numbers import Numbers, steps
from ...task import Condition, ScenarioTask


def contact_time(run: Run) -> float:
    """From where contact begins to where it ends; NaN where there is none."""
    return sum(event.t * (1 if event.type == "break" else -1) for event in run.events) or math.nan


def task(numbers: Numbers) -> ScenarioTask:
    speed = numbers.pick("force_on_arm speed", 0.05, steps(0.041, 0.06, 0.001))
    stiffness = numbers.pick("force_on_arm stiffness", 1000, [*range(600, 2000, 100)])
    given = f"""\
format: 1
initial: {{q: [0 deg, -30 deg, 60 deg]}}
wall:
  motion: {{type: constant, velocity: {speed}}}
  contact: {{law: spring, stiffness: {stiffness}}}
controller: {{type: gravity_compensation}}
time: {{stop: 7, log_every: 0.001}}
"""

    @cache
    def right() -> Run:
        scenario = Scenario(given).quiet()
        scenario.update({"wall.acts_on_arm": True})
        return scenario.run()

    return ScenarioTask(
        name="force_on_arm",
        title="a wall that goes through the arm",
        points=3,
        text="""\
In the lecture the wall passes through the tip of an arm that does not move. Hand in a scenario in which
the arm feels the wall, with the same stiffness and speed. Before you run it: how does an arm move that
is pushed and has gravity compensation only? Only the section `wall` of your file counts.""",
        hints=(
            "`arm3r template` prints all keys of a scenario with what they mean; look at those of the wall.",
            "The force is computed, but not applied to the arm: there is a key for that.",
            "wall.acts_on_arm: true. The arm then bounces off, at twice the speed of the wall.",
        ),
        given=given,
        takes=("wall",),
        conditions=(
            Condition(
                what="the largest force",
                unit="N",
                measure=lambda run: run.summary["peak_force"] - right().summary["peak_force"],
                due=0.0,
                threshold=1e-3,
            ),
            Condition(
                what="the time in contact",
                unit="s",
                measure=lambda run: contact_time(run) - contact_time(right()),
                due=0.0,
                threshold=1e-4,
            ),
        ),
    )
