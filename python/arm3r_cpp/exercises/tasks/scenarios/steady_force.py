"""A wall that comes closer, and a force controller without memory."""

import math

import numpy as np

from ...numbers import Numbers, steps
from ...task import Condition, ScenarioTask


def task(numbers: Numbers) -> ScenarioTask:
    speed = numbers.pick("steady_force speed", 0.05, steps(0.04, 0.06, 0.005))
    force = numbers.pick("steady_force force", 20, range(15, 26))
    damping, gain, stiffness = 70, 0.5, 5000
    pressing = f"{force + damping * speed / gain:.3g}"
    return ScenarioTask(
        name="steady_force",
        title=f"{force} newtons on a wall that moves",
        points=4,
        text=f"""\
The tip should press on a wall with {force} N, while the wall moves towards the arm at {speed} m/s. In this
scenario it presses with {pressing} N. Find out why, and hand in one in which the force settles at {force} N within
2.5 seconds, and the tip never leaves the wall. Only the section `controller` of your file counts.""",
        hints=(
            "The wall moves at constant speed: what must the force error be, so that the tip moves at this speed?",
            "Without memory the law needs the error b v/k_P to keep moving. What removes a steady-state error?",
            "An integral: controller.force_integral_gain, with k_I below b k_P/m_f so that the loop is stable.",
        ),
        given=f"""\
format: 1
initial: {{q: [0 deg, -30 deg, 60 deg]}}
wall:
  point: [{math.sqrt(3) - force / stiffness}, 0, 0]
  size: infinite
  motion: {{type: constant, velocity: {speed}}}
  contact: {{stiffness: {stiffness}}}
  acts_on_arm: true
controller:
  type: hybrid
  force_mass: 1
  force_damping: {damping}
  force_gain: {gain}
  force_integral_gain: 0
reference: {{type: hold, force: {{value: {force}}}}}
time: {{stop: 3, log_every: 0.001}}
""",
        takes=("controller",),
        conditions=(
            Condition(
                what="the force in the last half second",
                unit="N",
                measure=lambda run: force + float(np.abs(run["f_on_wall_x"][run.t >= 2.5] - force).max()),
                due=force,
                threshold=0.3,
            ),
            Condition(
                what="the number of times that contact ends",
                unit="",
                measure=lambda run: float(sum(event.type == "break" for event in run.events)),
                due=0.0,
                threshold=0.1,
            ),
        ),
    )
