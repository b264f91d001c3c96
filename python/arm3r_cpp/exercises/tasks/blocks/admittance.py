"""Admittance: a point that yields to the measured force."""

from ...._native import Floats
from ...task import FunctionTask, Input, Mistake

M_A, B_A, K_A = 2.0, 40.0, 200.0


def acceleration(
    x_c: Floats, v_c: Floats, x_d: Floats, f_on_tip: Floats, *, push: float = 1, spring: float = 1, mass: float = M_A
) -> Floats:
    return (push * f_on_tip - B_A * v_c - spring * K_A * (x_c - x_d)) / mass


TASK = FunctionTask(
    name="admittance",
    title="a tip that should give way, and presses harder",
    text="""\
Admittance control moves a point x_c, which the tip follows. The point yields to the measured force on
the tip as a mass M = 2 kg with a damper B = 40 N s/m and a spring K = 200 N/m to the goal x_d would.
Write its acceleration, acceleration(x_c, v_c, x_d, f_on_tip), all vectors of three. With the listing the
tip presses harder and harder, once it touches.""",
    hints=(
        "The wall pushes the tip back, f_on_tip points away from it: which way should x_c go?",
        "Write the equation of a mass on a spring and a damper that the force f_on_tip pushes.",
        "M a = f_on_tip - B v_c - K (x_c - x_d).",
    ),
    given="""\
function a = acceleration(x_c, v_c, x_d, f_on_tip)
M = 2;
B = 40;
K = 200;
a = (-f_on_tip - B*v_c - K*(x_c - x_d))/M;
""",
    function="acceleration",
    inputs=(Input("x_c", -1, 1), Input("v_c", -1, 1), Input("x_d", -1, 1), Input("f_on_tip", -30, 30)),
    entries=("a_x", "a_y", "a_z"),
    right=acceleration,
    mistakes=(
        Mistake(
            "the force has the wrong sign: the point moves against it, into the wall",
            lambda **given: acceleration(**given, push=-1),
        ),
        Mistake("the spring has the wrong sign", lambda **given: acceleration(**given, spring=-1)),
        Mistake("the mass is missing", lambda **given: acceleration(**given, mass=1.0)),
    ),
)
