"""The lecture's interaction model: on whom the force acts, when, and along what."""

from functools import partial

import numpy as np

from ...._native import Floats
from ...numbers import Numbers, steps
from ...task import FunctionTask, Input, Mistake


def force_and_flag(
    k_e: float, x: Floats, x_E: Floats, *, on_tip: float = -1, clipped: bool = True, along: int = 1
) -> Floats:
    """The force along so many of the axes, and the flag, which goes by the normal, x."""
    depth = x - x_E
    is_in = depth[:, :1] > 0
    force = on_tip * k_e * depth * (np.arange(3) < along)
    return np.concatenate([np.where(is_in, force, 0) if clipped else force, is_in], axis=1)


def enabled_by_any(k_e: float, x: Floats, x_E: Floats) -> Floats:
    """The block that any positive component of the vector enables."""
    depth = x - x_E
    is_on = (depth > 0).any(axis=1, keepdims=True)
    return np.concatenate([np.where(is_on, -k_e * depth * [1, 0, 0], 0), is_on], axis=1)


def as_in_the_lecture(k_e: float, x: Floats, x_E: Floats) -> Floats:
    depth = x - x_E
    is_on = (depth > 0).any(axis=1, keepdims=True)
    return np.concatenate([np.where(is_on, k_e * depth, 0), is_on], axis=1)


def task(numbers: Numbers) -> FunctionTask:
    k_e = numbers.pick("wall_force K_E", 1000.0, steps(600.0, 1900.0, 100.0))
    return FunctionTask(
        name="wall_force",
        title="the force of the wall on the tip",
        points=4,
        text=f"""\
The lecture computes f = K_E (x - x_E) when the tip x is in the wall, whose frame stands at x_E, and a
contact flag. Write it for the arm: wall_force(x, x_E), with two vectors of three, returns the force on
the tip and the flag, (f_x, f_y, f_z, contact). The wall is perpendicular to the x axis, the tip comes from
smaller x, K_E = {k_e:g} N/m; only the normal force acts. contact is 1 in the wall and 0 outside.""",
        hints=(
            "On which body does your force act, what is it outside of the wall, and in which directions does it act?",
            "The tip at x > x_E is pushed back, towards smaller x; the differences in y and z cause no force.",
            f"d = x(1) - x_E(1); with d > 0 the result is (-{k_e:g}*d, 0, 0, 1), otherwise (0, 0, 0, 0).",
        ),
        given=f"""\
def wall_force(x, x_E):
    f = [{k_e} * (x[i] - x_E[i]) for i in range(3)]
    contact = 1 if max(f) > 0 else 0
    return [f[i] * contact for i in range(3)] + [contact]
""",
        given_suffix=".py",
        function="wall_force",
        inputs=(Input("x", 1.8, 2.2), Input("x_E", 1.8, 2.2)),
        entries=("f_x", "f_y", "f_z", "contact"),
        right=partial(force_and_flag, k_e),
        mistakes=(
            Mistake(
                "this is the lecture's block: the force on the wall, along all axes, and any positive component "
                "enables it",
                partial(as_in_the_lecture, k_e),
            ),
            Mistake(
                "this is the force on the wall; the tip feels its opposite",
                lambda x, x_E: force_and_flag(k_e, x, x_E, on_tip=1),
            ),
            Mistake(
                "the wall pulls at a tip that does not touch it",
                lambda x, x_E: force_and_flag(k_e, x, x_E, clipped=False),
            ),
            Mistake(
                "the differences in y and z cause forces too; only the normal force acts",
                lambda x, x_E: force_and_flag(k_e, x, x_E, along=3),
            ),
            Mistake(
                "any positive component counts as contact; only the normal one is depth", partial(enabled_by_any, k_e)
            ),
        ),
    )
