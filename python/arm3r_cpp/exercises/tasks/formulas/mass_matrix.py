"""The mass matrix: how the two links are coupled."""

import numpy as np

from ...._native import Floats
from ...arms import SlenderArm, angles, arm_of
from ...numbers import Numbers
from ...task import FunctionTask, Input, Mistake


def mass_matrix(lab: SlenderArm, q: Floats, own: float, shared: float) -> Floats:
    """M with the coupling m3 a2 a3/2 cos(q3) so many times in M22, and in M23."""
    a = angles(q)
    link2, link3, both = (
        lab.m2 * lab.a2**2 / 3 + lab.m3 * lab.a2**2,
        lab.m3 * lab.a3**2 / 3,
        lab.m3 * lab.a2 * lab.a3 / 2,
    )
    matrix = np.zeros((len(q), 3, 3))
    matrix[:, 0, 0] = lab.i1 + link2 * a.c2**2 + link3 * a.c23**2 + 2 * both * a.c2 * a.c23
    matrix[:, 1, 1] = link2 + link3 + own * both * a.c3
    matrix[:, 1, 2] = matrix[:, 2, 1] = link3 + shared * both * a.c3
    matrix[:, 2, 2] = link3
    return matrix


def task(numbers: Numbers) -> FunctionTask:
    lab = arm_of(numbers)
    return FunctionTask(
        name="mass_matrix",
        title="a mass matrix with too little coupling",
        points=4,
        text=f"""\
The kinetic energy of the arm is T = qd' M(q) qd / 2. In this listing one term of M is wrong. Find it,
and hand in the right mass matrix.

{lab.text}
Link 1 has the moment of inertia I1 = {lab.i1} kg m^2 about its axis.""",
        hints=(
            "Move joint 2 alone: the kinetic energy is M22 qd2^2 / 2. Compute it at q3 = 0 and at q3 = 180 degrees.",
            "The centre of link 3 is at a distance d from joint 2, with d^2 = a2^2 + (a3/2)^2 + a2 a3 cos(q3).",
            "In M22 the coupling stands twice, 2*B*cos(q3) with B = m3*a2*a3/2, and in M23 once.",
        ),
        given=f"""\
function M = fcn(q1, q2, q3)
a2 = {lab.a2};  a3 = {lab.a3};
m2 = {lab.m2};  m3 = {lab.m3};
I1 = {lab.i1};
A = m2*a2^2/3 + m3*a2^2;
B = m3*a2*a3/2;
C = m3*a3^2/3;
m11 = I1 + A*cos(q2)^2 + C*cos(q2+q3)^2 + 2*B*cos(q2)*cos(q2+q3);
m22 = A + C + B*cos(q3);
m23 = C + B*cos(q3);
M = [m11 0 0; 0 m22 m23; 0 m23 C];
""",
        kind="mass",
        function="mass_matrix",
        inputs=(Input("q", -3, 3),),
        entries=tuple(f"M({row},{column})" for row in (1, 2, 3) for column in (1, 2, 3)),
        scenario=lab.scenario,
        right=lambda q: lab.arm.mass_matrix(q),
        mistakes=(
            Mistake(
                "M(2,2) has the coupling of the links once, not twice",
                lambda q: mass_matrix(lab, q, 1, 1),
            ),
            Mistake(
                "the coupling of the links is missing in M(2,2), M(2,3), M(3,2)", lambda q: mass_matrix(lab, q, 0, 0)
            ),
            Mistake(
                "M(2,3), M(3,2) have the coupling of the links twice, not once",
                lambda q: mass_matrix(lab, q, 2, 2),
            ),
        ),
    )
