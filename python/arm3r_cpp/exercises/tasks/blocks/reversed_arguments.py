"""The lecture's order of arguments and outputs, 3, 2, 1: harmless with named ports, wrong by position."""

from functools import partial

import numpy as np

from ...._native import Floats
from ...arms import G, SlenderArm, arm_of
from ...numbers import Numbers
from ...task import FunctionTask, Input, Mistake


def gravity(lab: SlenderArm, q1: Floats, q2: Floats, q3: Floats) -> Floats:
    return lab.arm.gravity_torque(np.stack([q1, q2, q3], 1))


def task(numbers: Numbers) -> FunctionTask:
    lab = arm_of(numbers)
    return FunctionTask(
        name="reversed_arguments",
        title="from Simulink to Python, port by port",
        points=2,
        text=f"""\
The lecture's function block is `function [t3, t2, t1] = fcn(q3, q2, q1)`. In Simulink each port carries
its name. Here it was translated to Python in the same order, and is called as

    t1, t2, t3 = gravity(q1, q2, q3)

Hand in a function that is right when it is called in this way, by position.

{lab.text}""",
        hints=(
            "Call it with q1 = 0.1, q2 = 0.2, q3 = 0.3 and print what arrives under each name.",
            "Python goes by position: the first argument is the first name, the first result the first value.",
            "def gravity(q1, q2, q3): ... return t1, t2, t3",
        ),
        given=f"""\
from math import cos

a2, a3, m2, m3, g = {lab.a2}, {lab.a3}, {lab.m2}, {lab.m3}, {G}


def gravity(q3, q2, q1):
    t1 = 0.0
    t3 = -m3 * g * a3 / 2 * cos(q2 + q3)
    t2 = -(m2 / 2 + m3) * g * a2 * cos(q2) + t3
    return t3, t2, t1
""",
        given_suffix=".py",
        function="gravity",
        inputs=tuple(Input(name, -3, 3, size=1) for name in ("q1", "q2", "q3")),
        entries=("t1", "t2", "t3"),
        right=partial(gravity, lab),
        mistakes=(
            Mistake(
                "arguments and results are in the order 3, 2, 1; it should be 1, 2, 3",
                lambda q1, q2, q3: gravity(lab, q3, q2, q1)[:, ::-1],
            ),
            Mistake(
                "the arguments are in the order q3, q2, q1; it should be q1, q2, q3",
                lambda q1, q2, q3: gravity(lab, q3, q2, q1),
            ),
            Mistake(
                "the results are in the order t3, t2, t1; it should be t1, t2, t3",
                lambda q1, q2, q3: gravity(lab, q1, q2, q3)[:, ::-1],
            ),
        ),
    )
