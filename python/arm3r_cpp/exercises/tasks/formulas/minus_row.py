"""The lecture's Jacobian without the minus of its third row, which the slide does not have and the code needs."""

import numpy as np

from ...arms import arm_of, transposed
from ...numbers import Numbers
from ...task import FunctionTask, Input, Mistake

_ROW_3 = np.array([[1.0], [1.0], [-1.0]])


def task(numbers: Numbers) -> FunctionTask:
    lab = arm_of(numbers)
    return FunctionTask(
        name="minus_row",
        title="a Jacobian that was copied from the slide",
        points=2,
        text=f"""\
This Jacobian of the tip's position was copied from the lecture's slide. The arm that it is meant for
follows the lecture's code. Find out what is wrong with it, and hand in the right one.

{lab.text}""",
        hints=(
            "Compare J with finite differences of x(q) at a pose in which no angle is zero: which row does not fit?",
            "On the slide a positive angle raises the arm, in the code it lowers it. What changes in dz/dq?",
            "The third row is 0, -(a2 cos(q2) + a3 cos(q2+q3)), -a3 cos(q2+q3).",
        ),
        given=f"""\
function J = fcn(q3, q2, q1)
a2 = {lab.a2};
a3 = {lab.a3};
j11 = -sin(q1)*(a3*cos(q2+q3)+a2*cos(q2));
j12 = -cos(q1)*(a3*sin(q2+q3)+a2*sin(q2));
j13 = -a3*sin(q2+q3)*cos(q1);
j21 = cos(q1)*(a3*cos(q2+q3)+a2*cos(q2));
j22 = -sin(q1)*(a3*sin(q2+q3)+a2*sin(q2));
j23 = -a3*sin(q2+q3)*sin(q1);
j31 = 0;
j32 = a3*cos(q2+q3)+a2*cos(q2);
j33 = a3*cos(q2+q3);
J = [j11 j12 j13; j21 j22 j23; j31 j32 j33];
""",
        kind="jacobian",
        function="jacobian",
        inputs=(Input("q", -3, 3),),
        entries=tuple(f"J({row},{column})" for row in (1, 2, 3) for column in (1, 2, 3)),
        scenario=lab.scenario,
        right=lambda q: lab.arm.jacobian(q),
        mistakes=(
            Mistake(
                "row 3 lacks its minus: it is that of the slide, where a positive angle raises the arm",
                lambda q: lab.arm.jacobian(q) * _ROW_3,
            ),
            Mistake("J is transposed", lambda q: transposed(lab.arm.jacobian(q))),
        ),
    )
