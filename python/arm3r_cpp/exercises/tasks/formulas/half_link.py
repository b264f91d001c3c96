"""The lecture's reprints of the gravity torque: a1/2, and a2/2, in the place of a3/2."""

import numpy as np

from ...._native import Floats
from ...arms import G, SlenderArm, angles, arm_of
from ...numbers import Numbers
from ...task import FunctionTask, Input, Mistake


def gravity(lab: SlenderArm, q: Floats, half2: float, half3: float) -> Floats:
    """The gravity torque with other distances to the centre of link 3, in t2 and in t3."""
    a = angles(q)
    t2 = -lab.m2 * G * lab.a2 / 2 * a.c2 - lab.m3 * G * (lab.a2 * a.c2 + half2 * a.c23)
    return np.stack([0 * t2, t2, -lab.m3 * G * half3 * a.c23], 1)


def task(numbers: Numbers) -> FunctionTask:
    lab = arm_of(numbers)
    return FunctionTask(
        name="half_link",
        title="half of which link?",
        points=3,
        text=f"""\
The lecture prints the gravity torque several times, and not always with the same letters. This listing
follows one of the reprints. With equal links it gives the right numbers, with these it does not. Find
out why, and hand in the right one.

{lab.text}""",
        hints=(
            "With equal links a2 = a3. Which letters could then be exchanged without changing a number?",
            "The weight of link 3 acts at its centre of mass: how far is that from joint 3?",
            "It is a3/2, in t2 and in t3; a2/2 belongs to m2 only.",
        ),
        given=f"""\
function [t3, t2, t1] = fcn(q3, q2, q1)
{lab.weight_listing}t1 = q1*0;
t2 = -m2*g*(a2/2)*cos(q2) - m3*g*(a2*cos(q2) + (a2/2)*cos(q2+q3));
t3 = -m3*g*(a2/2)*cos(q2+q3);
""",
        kind="gravity",
        function="gravity",
        inputs=(Input("q", -3, 3),),
        entries=("t1", "t2", "t3"),
        scenario=lab.scenario,
        right=lambda q: lab.arm.gravity_torque(q),
        mistakes=(
            Mistake(
                "t2, t3 have a2/2 where a3/2 should be, in the term of m3",
                lambda q: gravity(lab, q, lab.a2 / 2, lab.a2 / 2),
            ),
            Mistake(
                "t2 has a2/2 where a3/2 should be, in the term of m3", lambda q: gravity(lab, q, lab.a2 / 2, lab.a3 / 2)
            ),
            Mistake("t3 has a2/2 where a3/2 should be", lambda q: gravity(lab, q, lab.a3 / 2, lab.a2 / 2)),
            Mistake("t2, t3 have a3 where a3/2 should be", lambda q: gravity(lab, q, lab.a3, lab.a3)),
        ),
    )
