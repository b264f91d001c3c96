"""The lecture's reprints of the gravity torque: a1/2, and a2/2, in the place of a3/2."""

import numpy as np

from ...._native import Floats
from ...arms import A2, A3, M2, M3, NUMBERS, G, angles, lab_arm
from ...task import FunctionTask, Input, Mistake


def gravity(q: Floats, half2: float, half3: float) -> Floats:
    """The gravity torque with other distances to the centre of link 3, in t2 and in t3."""
    a = angles(q)
    t2 = -M2 * G * A2 / 2 * a.c2 - M3 * G * (A2 * a.c2 + half2 * a.c23)
    return np.stack([0 * t2, t2, -M3 * G * half3 * a.c23], 1)


TASK = FunctionTask(
    name="half_link",
    title="half of which link?",
    text=f"""\
The lecture prints the gravity torque several times, and not always with the same letters. This listing
follows one of the reprints. With equal links it gives the right numbers, with these it does not. Find
out why, and hand in the right one.

{NUMBERS}""",
    hints=(
        "With equal links a2 = a3. Which letters could then be exchanged without a trace?",
        "m3 hangs at the centre of link 3: how far is that from joint 3?",
        "It is a3/2, in t2 and in t3; a2/2 belongs to m2 only.",
    ),
    given="""\
function [t3, t2, t1] = fcn(q3, q2, q1)
m2 = 1.2;
m3 = 0.7;
g = 9.80665;
a2 = 0.8;
a3 = 0.6;
t1 = q1*0;
t2 = -m2*g*(a2/2)*cos(q2) - m3*g*(a2*cos(q2) + (a2/2)*cos(q2+q3));
t3 = -m3*g*(a2/2)*cos(q2+q3);
""",
    kind="gravity",
    function="gravity",
    inputs=(Input("q", -3, 3),),
    entries=("t1", "t2", "t3"),
    right=lambda q: lab_arm().gravity_torque(q),
    mistakes=(
        Mistake("t2, t3 have a2/2 where a3/2 should be, in the term of m3", lambda q: gravity(q, A2 / 2, A2 / 2)),
        Mistake("t2 has a2/2 where a3/2 should be, in the term of m3", lambda q: gravity(q, A2 / 2, A3 / 2)),
        Mistake("t3 has a2/2 where a3/2 should be", lambda q: gravity(q, A3 / 2, A2 / 2)),
        Mistake("t2, t3 have a3 where a3/2 should be", lambda q: gravity(q, A3, A3)),
    ),
)
