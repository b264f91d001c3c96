"""Angles and rates that arrive in degrees."""

import numpy as np

from ...._native import Floats
from ...arms import SlenderArm, arm_of, times
from ...numbers import Numbers
from ...task import FunctionTask, Input, Mistake


def velocity(lab: SlenderArm, q: Floats, qd: Floats) -> Floats:
    return times(lab.arm.jacobian(q), qd)


def task(numbers: Numbers) -> FunctionTask:
    lab = arm_of(numbers)
    return FunctionTask(
        name="degrees",
        title="sensors that measure in degrees",
        points=3,
        text=f"""\
The joint sensors give angles in degrees and rates in degrees per second. Write the velocity of the tip
in m/s, J qd, as tip_velocity(q_deg, qd_deg), each a vector of three. The listing returns a velocity
that is far too large.

{lab.text.replace(" Angles are in radians.", "")}""",
        hints=(
            f"How fast can the tip be, {lab.a2 + lab.a3:g} m from joint 1, at 90 degrees per second?",
            "cosd takes the angle in degrees. What unit does J*qd have, if qd is in degrees per second?",
            "Convert both: q = q_deg*pi/180 and qd = qd_deg*pi/180.",
        ),
        given=f"""\
function v = tip_velocity(q, qd)
a2 = {lab.a2};
a3 = {lab.a3};
r = a2*cosd(q(2)) + a3*cosd(q(2)+q(3));
h = a2*sind(q(2)) + a3*sind(q(2)+q(3));
s = a3*sind(q(2)+q(3));
J = [-sind(q(1))*r, -cosd(q(1))*h, -cosd(q(1))*s;
      cosd(q(1))*r, -sind(q(1))*h, -sind(q(1))*s;
      0, -r, -a3*cosd(q(2)+q(3))];
v = J*qd;
""",
        function="tip_velocity",
        inputs=(Input("q_deg", -170, 170), Input("qd_deg", -100, 100)),
        entries=("v_x", "v_y", "v_z"),
        right=lambda q_deg, qd_deg: velocity(lab, np.deg2rad(q_deg), np.deg2rad(qd_deg)),
        mistakes=(
            Mistake(
                "the rates stay in degrees per second", lambda q_deg, qd_deg: velocity(lab, np.deg2rad(q_deg), qd_deg)
            ),
            Mistake("the angles stay in degrees", lambda q_deg, qd_deg: velocity(lab, q_deg, np.deg2rad(qd_deg))),
            Mistake("angles and rates stay in degrees", lambda q_deg, qd_deg: velocity(lab, q_deg, qd_deg)),
        ),
    )
