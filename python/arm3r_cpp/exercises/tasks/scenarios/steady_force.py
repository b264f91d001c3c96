"""A wall that comes closer, and a force controller without memory."""

import numpy as np

from ...task import Condition, ScenarioTask

TASK = ScenarioTask(
    name="steady_force",
    title="20 newtons on a wall that moves",
    text="""\
The tip should press on a wall with 20 N, while the wall moves towards the arm at 0.05 m/s. In this
scenario it presses with 27 N. Find out why, and hand in one in which the force settles at 20 N within
three seconds, and the tip never leaves the wall. Only the section `controller` of your file counts.""",
    hints=(
        "The wall moves at constant speed: what must the force error be, so that the tip moves at that speed?",
        "Without memory the law needs an error of b v/k to keep moving. What makes an error vanish that lasts?",
        "An integral: controller.force_integral_gain, with k_I below b k_P/m_f so that the loop is stable.",
    ),
    given="""\
format: 1
initial: {q: [0 deg, -30 deg, 60 deg]}
wall:
  point: [1.7280508075688772, 0, 0]
  size: infinite
  motion: {type: constant, velocity: 0.05}
  contact: {stiffness: 5000}
  acts_on_arm: true
controller:
  type: hybrid
  force_mass: 1
  force_damping: 70
  force_gain: 0.5
  force_integral_gain: 0
reference: {type: hold, force: {value: 20}}
time: {stop: 3, log_every: 0.001}
""",
    takes=("controller",),
    conditions=(
        Condition(
            what="the force in the last half second",
            unit="N",
            measure=lambda run: 20 + float(np.abs(run["f_on_wall_x"][run.t >= 2.5] - 20).max()),
            due=20.0,
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
