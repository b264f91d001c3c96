"""The lecture's moon: compensation with a sixth of g is no moon."""

from functools import cache

import numpy as np

from ....core.run import Run
from ....core.scenario import Scenario
from ...numbers import Numbers
from ...task import Condition, ScenarioTask

MOONS = (("Io", 1.8), ("Ganymede", 1.43), ("Titan", 1.35), ("Europa", 1.31), ("Callisto", 1.24), ("Triton", 0.78))
"""A name, and g on its surface in m/s^2."""
GIVEN = """\
format: 1
initial: {q: [0 deg, -30 deg, 60 deg]}
controller: {type: gravity_compensation, gravity: 1.635}
time: {stop: 2}
"""


def height(run: Run) -> float:
    return float(np.interp(0.5, run.t, run["tip_z"]))


def task(numbers: Numbers) -> ScenarioTask:
    moon, gravity = numbers.pick("moon", ("the moon", 1.62), MOONS)

    @cache
    def right() -> Run:
        scenario = Scenario(GIVEN).quiet()
        scenario.update({"arm.gravity": [0, 0, -gravity], "controller": {"type": "none"}})
        return scenario.run()

    return ScenarioTask(
        name="moon",
        title="on the moon, or compensated by a sixth?",
        points=3,
        text=f"""\
The lecture puts 9.81/6 into its gravity compensation and calls it the moon. Hand in a scenario in which
the lecture's arm falls freely on {moon}, where g = {gravity} m/s^2, with no control at all. `arm.gravity`
and `controller` of your file count.""",
        hints=(
            "Which gravity acts on the arm in the given scenario, and what do the motors do?",
            f"On {moon} the gravity of the plant itself is smaller, and nothing compensates it.",
            f"arm: {{gravity: [0, 0, -{gravity}]}} and controller: {{type: none}}.",
        ),
        given=GIVEN,
        takes=("arm.gravity", "controller"),
        conditions=(
            Condition(
                what="the largest torque",
                unit="N m",
                measure=lambda run: float(max(np.abs(run[name]).max() for name in ("tau1", "tau2", "tau3"))),
                due=0.0,
                threshold=1e-6,
            ),
            Condition(
                what="the height of the tip after 0.5 s",
                unit="m",
                measure=lambda run: height(run) - height(right()),
                due=0.0,
                threshold=1e-4,
            ),
        ),
    )
