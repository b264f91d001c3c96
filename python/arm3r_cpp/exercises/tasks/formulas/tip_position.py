"""The tip's position: the sign of its height, and the angle of link 3."""

import numpy as np

from ...arms import arm_of
from ...numbers import Numbers
from ...task import FunctionTask, Input, Mistake


def task(numbers: Numbers) -> FunctionTask:
    lab = arm_of(numbers)
    return FunctionTask(
        name="tip_position",
        title="where is the tip?",
        points=2,
        text=f"""\
Write the position of the tip, x(q) = (x, y, z), as a function of q1, q2, q3.

{lab.text}
The origin lies on the axis of joint 1 at the height of joint 2.""",
        hints=(
            "Set all joint angles to zero, then change one after the other: where does the tip go?",
            "The angle of link 3 from the horizontal is q2 + q3, and a positive angle lowers the arm.",
            "r = a2 cos(q2) + a3 cos(q2+q3); x = r cos(q1), y = r sin(q1), z = -(a2 sin(q2) + a3 sin(q2+q3)).",
        ),
        kind="kinematics",
        function="tip_position",
        inputs=(Input("q", -3, 3),),
        entries=("x", "y", "z"),
        scenario=lab.scenario,
        right=lambda q: lab.arm.tip_position(q),
        mistakes=(
            Mistake(
                "z has the wrong sign: in this convention a positive angle lowers the arm",
                lambda q: lab.arm.tip_position(q) * [1, 1, -1],
            ),
            Mistake(
                "the angle of link 3 from the horizontal is q2 + q3, not q3",
                lambda q: lab.arm.tip_position(q - np.stack([0 * q[:, 1], 0 * q[:, 1], q[:, 1]], 1)),
            ),
        ),
    )
