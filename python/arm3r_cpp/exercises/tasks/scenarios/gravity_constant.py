"""9.81 in the controller, 9.80665 in the plant."""

import numpy as np

from ...numbers import Numbers
from ...task import Condition, ScenarioTask


def task(_: Numbers) -> ScenarioTask:
    return ScenarioTask(
        name="gravity_constant",
        title="an arm that floats up, slowly",
        points=2,
        text="""\
Gravity compensation should hold the lecture's arm where it is. In this scenario the tip has risen by
more than 20 cm after ten seconds. Find out why, and hand in a scenario in which it stays, with gravity
compensation and nothing else. Only the section `controller` of your file counts.""",
        hints=(
            "`arm3r check gravity_constant.yaml` prints every value, also those that are not in the file, and warns.",
            "Plant and controller need the same g. Which one does the plant have?",
            "controller: {type: gravity_compensation, gravity: 9.80665}, or leave `gravity` out.",
        ),
        given="""\
format: 1
initial: {q: [0 deg, -30 deg, 60 deg]}
controller: {type: gravity_compensation, gravity: 9.81}
time: {stop: 10}
""",
        takes=("controller",),
        keys={"controller.type": ("gravity_compensation",)},
        conditions=(
            Condition(
                what="the height of the tip after 10 s",
                unit="m",
                measure=lambda run: float(run["tip_z"][-1]),
                due=0.0,
                threshold=1e-4,
            ),
            Condition(
                what="the largest displacement of a joint",
                unit="rad",
                measure=lambda run: float(max(np.ptp(run[name]) for name in ("q1", "q2", "q3"))),
                due=0.0,
                threshold=1e-4,
            ),
        ),
    )
