"""The lecture's first listing of the gravity torque: t1 = q1."""

import numpy as np

from ...arms import arm_of
from ...numbers import Numbers
from ...task import FunctionTask, Input, Mistake


def task(numbers: Numbers) -> FunctionTask:
    lab = arm_of(numbers)
    return FunctionTask(
        name="first_joint",
        title="an arm that holds still at q1 = 0 only",
        points=2,
        text=f"""\
This is the lecture's first listing of the gravity torque, with the numbers of this arm. In the lecture
the arm holds still with it. At q1 = 20 degrees it does not. Find out why, and hand in the right one.

{lab.text}""",
        hints=(
            "What does the listing return for joint 1, and what happens once q1 is not exactly zero?",
            "Joint 1 turns about the vertical: does gravity have a moment about it?",
            "t1 = 0. As it stands, t1 = q1 drives joint 1 away from zero, with 1 N m/rad.",
        ),
        given=f"""\
function [t3, t2, t1] = fcn(q3, q2, q1)
{lab.weight_listing}t1 = q1;
t2 = -m2*g*(a2/2)*cos(q2) - m3*g*(a2*cos(q2) + (a3/2)*cos(q2+q3));
t3 = -m3*g*(a3/2)*cos(q2+q3);
""",
        kind="gravity",
        function="gravity",
        inputs=(Input("q", -3, 3),),
        entries=("t1", "t2", "t3"),
        scenario=lab.scenario,
        right=lambda q: lab.arm.gravity_torque(q),
        mistakes=(
            Mistake(
                "t1 reads q1; gravity has no moment about the vertical axis of joint 1",
                lambda q: lab.arm.gravity_torque(q) + q * np.array([1.0, 0.0, 0.0]),
            ),
        ),
    )
