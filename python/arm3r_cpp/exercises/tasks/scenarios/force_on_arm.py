"""The lecture computes the force, and the arm does not feel it."""

import math

from ...task import Condition, ScenarioTask

TASK = ScenarioTask(
    name="force_on_arm",
    title="a wall that goes through the arm",
    text="""\
In the lecture the wall pushes through the tip of an arm that does not move. Hand in a scenario in which
the arm feels the wall, with the lecture's stiffness and speed. Before you run it: what does an arm do
that is pushed and has nothing but gravity compensation? Only the section `wall` of your file counts.""",
    hints=(
        "`arm3r template` prints all keys of a scenario with what they mean; look at those of the wall.",
        "The force is computed, but not applied: there is a key for that.",
        "wall.acts_on_arm: true. The arm then bounces off, at twice the speed of the wall.",
    ),
    given="""\
format: 1
initial: {q: [0 deg, -30 deg, 60 deg]}
wall:
  motion: {type: constant, velocity: 0.05}
  contact: {law: spring, stiffness: 1000}
controller: {type: gravity_compensation}
time: {stop: 7, log_every: 0.001}
""",
    takes=("wall",),
    conditions=(
        Condition(
            what="the largest force",
            unit="N",
            measure=lambda run: float(run.summary["peak_force"]),
            due=1.176036954945614,
            threshold=1e-3,
        ),
        Condition(
            what="the time in contact",
            unit="s",
            measure=lambda run: sum(event.t * (1 if event.type == "break" else -1) for event in run.events) or math.nan,
            due=5.432744273189813 - 5.358983848622454,
            threshold=1e-4,
        ),
    ),
)
