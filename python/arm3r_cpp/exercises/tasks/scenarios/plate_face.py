"""x_E at the face of the plate, where the lecture's sensor gives its frame, in the middle."""

import math

from ...task import Condition, ScenarioTask

TASK = ScenarioTask(
    name="plate_face",
    title="contact that begins too early",
    text="""\
The lecture compares the tip with the frame of the wall, which lies in the middle of a plate 5 mm thick
and starts at x = 2 m. The arm does not feel the force. By hand: contact at (2 - 2 cos 30 deg)/0.05
= 5.359 s, and 232.05 N after 10 s with K_E = 1000 N/m. In this scenario contact begins 0.05 s earlier.
Find out why, and hand in one that replays the lecture. Only the section `wall` of your file counts.""",
    hints=(
        "How far does the wall move in 0.05 s? Which length of the plate is that?",
        "Half of 5 mm: what is compared with the tip here is the face of the plate, not its frame.",
        "wall.face_offset is 0 in the lecture; the frame itself stays at x = 2 m.",
    ),
    given="""\
format: 1
initial: {q: [0 deg, -30 deg, 60 deg]}
wall:
  point: [2, 0, 0]
  face_offset: 0.0025
  motion: {type: constant, velocity: 0.05}
  contact: {law: spring, stiffness: 1000}
controller: {type: gravity_compensation}
time: {stop: 10}
""",
    takes=("wall",),
    conditions=(
        Condition(
            what="the instant of contact",
            unit="s",
            measure=lambda run: next((event.t for event in run.events if event.type == "make"), math.nan),
            due=5.358983848622454,
            threshold=1e-3,
        ),
        Condition(
            what="the force on the wall after 10 s",
            unit="N",
            measure=lambda run: float(run["f_on_wall_x"][-1]),
            due=232.0508075689,
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
