"""x_E at the face of the plate, where the lecture's sensor gives its frame, in the middle."""

import math

from ...numbers import Numbers, steps
from ...task import Condition, ScenarioTask

GAP = 2 - math.sqrt(3)  # between the tip and the frame of the wall


def task(numbers: Numbers) -> ScenarioTask:
    speed = numbers.pick("plate_face speed", 0.05, steps(0.041, 0.06, 0.001))
    stiffness = numbers.pick("plate_face stiffness", 1000, [*range(600, 2000, 100)])
    contact, force = GAP / speed, stiffness * (10 * speed - GAP)
    begins, presses, sooner = f"{contact:.3f}", f"{force:.2f}", f"{0.0025 / speed:.2g}"
    return ScenarioTask(
        name="plate_face",
        title="contact that begins too early",
        points=3,
        text=f"""\
The lecture compares the tip with the frame of the wall, which lies in the middle of a plate 5 mm thick
and starts at x = 2 m. The arm does not feel the force. Computed by hand, contact begins at
(2 - 2 cos 30 deg)/{speed} s = {begins} s, and the force after 10 s is {presses} N with
K_E = {stiffness} N/m. In this scenario contact begins {sooner} s earlier.
Find out why, and hand in one that agrees with the lecture. Only the section `wall` of your file counts.""",
        hints=(
            f"How far does the wall move in {sooner} s? Which length of the plate is that?",
            "Half of 5 mm: what is compared with the tip here is the face of the plate, not its frame.",
            "wall.face_offset is 0 in the lecture; the frame itself stays at x = 2 m.",
        ),
        given=f"""\
format: 1
initial: {{q: [0 deg, -30 deg, 60 deg]}}
wall:
  point: [2, 0, 0]
  face_offset: 0.0025
  motion: {{type: constant, velocity: {speed}}}
  contact: {{law: spring, stiffness: {stiffness}}}
controller: {{type: gravity_compensation}}
time: {{stop: 10}}
""",
        takes=("wall",),
        conditions=(
            Condition(
                what="the instant of contact",
                unit="s",
                measure=lambda run: next((event.t for event in run.events if event.type == "make"), math.nan),
                due=contact,
                threshold=1e-3,
            ),
            Condition(
                what="the force on the wall after 10 s",
                unit="N",
                measure=lambda run: float(run["f_on_wall_x"][-1]),
                due=force,
                threshold=0.05,
            ),
            Condition(
                what="the place of the wall's frame at the start",
                unit="m",
                measure=lambda run: float(run["wall_x"][0]),
                due=2.0,
                threshold=1e-4,
            ),
        ),
    )
