"""The momentum observer: what changes the momentum of the arm."""

from typing import Any

import numpy as np

from ...._native import Floats
from ....core.scenario import Scenario
from ...arms import LAB_ARM
from ...loop import Function, Goal, Loop
from ...numbers import Numbers
from ...task import FunctionTask, Input, Mistake


def rate(tau: Floats, c: Floats, g: Floats, r: Floats, *, of_c: float = 1, of_g: float = -1, of_r: float = 1) -> Floats:
    return tau + of_c * c + of_g * g + of_r * r


K_O, RATE, FORCE = 20.0, 1000.0, np.array([3.0, -5.0, 4.0])
LOOP = f"""\
{LAB_ARM.scenario}
initial: {{q: [0.3, -0.6, 1.0], qd: [2, 1, -2]}}
push: {{force: {FORCE.tolist()}, start: 1}}
time: {{stop: 2, log_every: 0.01}}
"""


def in_the_loop(function: Function) -> list[float]:
    """The largest output while nothing pushes the swinging arm; how far it is from J^T f after a second of pushing."""
    arm, total, free, error = LAB_ARM.arm, None, 0.0, 0.0

    def law(t: float, state: Any) -> Floats:
        nonlocal total, free, error
        momentum = arm.mass_matrix(state.q) @ state.qd
        total = momentum if total is None else total
        output = K_O * (momentum - total)
        torque: Floats = state.tau_g - (20 * state.qd if t > 1 else 0.0)
        of_rates = arm.coriolis_matrix(state.q, state.qd).T @ state.qd
        total = total + function(tau=torque, c=of_rates, g=state.tau_g, r=output) / RATE
        free = max(free, float(np.abs(output).max())) if t <= 1 else free
        error = float(np.abs(output - state.jacobian.T @ FORCE).max())
        return torque

    Scenario(LOOP).quiet().run(controller=law, rate=RATE)
    return [free, error]


def task(_: Numbers) -> FunctionTask:
    return FunctionTask(
        name="observer",
        title="an observer that takes the weight for a collision",
        points=5,
        text="""\
A momentum observer detects forces on the arm without a force sensor. It compares the momentum p = M qd
with the momentum s that it expects, and returns

    r = K_O (p - s),    ds/dt = the known terms of dp/dt, plus r

so that r follows the torque J^T f of an unknown force f. The equation of motion is
M qdd + C qd + tau_g = tau + J^T f, and dM/dt = C + C^T. Write momentum_rate(tau, c, g, r), which returns
ds/dt: tau is the motors' torque, c = C^T qd, g = tau_g the torque that holds the arm, r the output; each
is a vector of three. With the listing the observer reports a collision of an arm that stands still.""",
        hints=(
            "The arm stands still, held by tau = tau_g: what must ds/dt be for r to stay zero?",
            "Differentiate p = M qd and put in the equation of motion: dp/dt = tau + C^T qd - tau_g + J^T f.",
            "ds/dt = tau + c - g + r.",
        ),
        given="""\
function s_dot = momentum_rate(tau, c, g, r)
s_dot = tau + c + r;
""",
        function="momentum_rate",
        inputs=tuple(Input(name, -10, 10) for name in ("tau", "c", "g", "r")),
        entries=("s1", "s2", "s3"),
        right=rate,
        loop=Loop(
            in_the_loop,
            (
                Goal("the output while nothing pushes", "N m", 0.0, 0.05),
                Goal("the error of the output under a push", "N m", 0.0, 2.0),
            ),
        ),
        mistakes=(
            Mistake("the gravity torque is missing", lambda **given: rate(**given, of_g=0)),
            Mistake(
                "the gravity torque has the wrong sign: it takes momentum away", lambda **given: rate(**given, of_g=1)
            ),
            Mistake("C^T qd has the wrong sign", lambda **given: rate(**given, of_c=-1)),
            Mistake("C^T qd is missing", lambda **given: rate(**given, of_c=0)),
            Mistake("r is missing: the output never follows", lambda **given: rate(**given, of_r=0)),
            Mistake("r has the wrong sign: the output grows without end", lambda **given: rate(**given, of_r=-1)),
        ),
    )
