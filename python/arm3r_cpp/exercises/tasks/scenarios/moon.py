"""The lecture's moon: compensation with a sixth of g is no moon."""

import numpy as np

from ...task import Condition, ScenarioTask

TASK = ScenarioTask(
    name="moon",
    title="on the moon, or held by a sixth?",
    text="""\
The lecture puts 9.81/6 into its gravity compensation and calls it the moon. Hand in a scenario in which
the lecture's arm falls freely on the moon, where g = 1.62 m/s^2, with no control at all. `arm.gravity`
and `controller` of your file count.""",
    hints=(
        "What does the plant feel in the given scenario, and what does the motor do about it?",
        "On the moon the plant itself is lighter, and nothing compensates.",
        "arm: {gravity: [0, 0, -1.62]} and controller: {type: none}.",
    ),
    given="""\
format: 1
initial: {q: [0 deg, -30 deg, 60 deg]}
controller: {type: gravity_compensation, gravity: 1.635}
time: {stop: 2}
""",
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
            measure=lambda run: float(np.interp(0.5, run.t, run["tip_z"])),
            due=-0.2546941903632,
            threshold=1e-4,
        ),
    ),
)
