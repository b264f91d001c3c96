"""Admittance: a point that yields to the measured force."""

from dataclasses import dataclass

from ...._native import Floats
from ...numbers import Numbers, steps
from ...task import FunctionTask, Input, Mistake


@dataclass(frozen=True)
class Point:
    """A mass M with a damper B and a spring K to the goal."""

    m: float
    b: float
    k: float

    def acceleration(
        self, x_c: Floats, v_c: Floats, x_d: Floats, f_on_tip: Floats, *, push: float = 1, spring: float = 1
    ) -> Floats:
        return (push * f_on_tip - self.b * v_c - spring * self.k * (x_c - x_d)) / self.m


def task(numbers: Numbers) -> FunctionTask:
    point = Point(
        m=numbers.pick("admittance M", 2.0, steps(1.5, 4.0, 0.1)),
        b=numbers.pick("admittance B", 40.0, steps(25.0, 60.0, 1.0)),
        k=numbers.pick("admittance K", 200.0, steps(110.0, 390.0, 10.0)),
    )
    m, b, k = f"{point.m:g}", f"{point.b:g}", f"{point.k:g}"
    return FunctionTask(
        name="admittance",
        title="a tip that should yield, but presses harder",
        points=3,
        text=f"""\
Admittance control moves a point x_c, which the tip follows. The point yields to the measured force on
the tip like a mass M = {m} kg with a damper B = {b} N s/m, and a spring K = {k} N/m to the goal x_d.
Write its acceleration, acceleration(x_c, v_c, x_d, f_on_tip), all vectors of three. With the listing the
tip presses harder and harder once it touches the wall.""",
        hints=(
            "The wall pushes the tip back, so f_on_tip points away from the wall: which way should x_c go?",
            "Write the equation of motion of a mass on a spring and a damper, on which f_on_tip acts.",
            "M a = f_on_tip - B v_c - K (x_c - x_d).",
        ),
        given=f"""\
function a = acceleration(x_c, v_c, x_d, f_on_tip)
M = {m};
B = {b};
K = {k};
a = (-f_on_tip - B*v_c - K*(x_c - x_d))/M;
""",
        function="acceleration",
        inputs=(Input("x_c", -1, 1), Input("v_c", -1, 1), Input("x_d", -1, 1), Input("f_on_tip", -30, 30)),
        entries=("a_x", "a_y", "a_z"),
        right=point.acceleration,
        mistakes=(
            Mistake(
                "the force has the wrong sign: the point moves against it, into the wall",
                lambda **given: point.acceleration(**given, push=-1),
            ),
            Mistake("the spring has the wrong sign", lambda **given: point.acceleration(**given, spring=-1)),
            Mistake("the mass is missing", lambda **given: point.m * point.acceleration(**given)),
        ),
    )
