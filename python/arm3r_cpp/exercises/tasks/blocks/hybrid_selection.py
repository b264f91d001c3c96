"""Hybrid position and force control: which directions are controlled how."""

from typing import Any

import numpy as np

from ...._native import Floats
from ....scenario import Scenario
from ...arms import SCENARIO
from ...loop import RATE, Function, Goal, Loop
from ...task import FunctionTask, Input, Mistake

K, D, K_F = 500.0, 100.0, 0.5
FORCE, POSITION, ALL = np.array([1.0, 0, 0]), np.array([0, 1.0, 1.0]), np.ones(3)


def command(
    x: Floats,
    v: Floats,
    x_d: Floats,
    f: Floats,
    f_d: Floats,
    *,
    position: Floats = POSITION,
    force: Floats = FORCE,
    sign: float = 1,
    feedforward: float = 1,
) -> Floats:
    """The diagonals of the selections, and factors."""
    push = (feedforward * f_d + sign * K_F * (f_d - f))[:, None] * FORCE
    return position * (K * (x_d - x) - D * v) + force * push


LARGEST = 24.4889  # N, of the right law: it comes from the first contact
LOOP = f"""\
{SCENARIO}
initial: {{q: [0, -0.6, 1.0]}}
wall:
  point: [1.2149, 0, 0]
  size: infinite
  motion: {{type: fixed}}
  contact: {{law: kelvin_voigt, stiffness: 2000, damping: 60}}
  acts_on_arm: true
time: {{stop: 3, log_every: 0.01}}
"""
GOAL = np.array([1.25, 0.1, 0.25])  # beyond the wall


def in_the_loop(function: Function) -> list[float]:
    """The largest force; in the last half second of three its error, and the distance from the goal along the wall."""

    def law(t: float, state: Any) -> Floats:
        pressing = float(state.f_on_tip @ state.wall_normal)
        force = function(x=state.tip, v=state.tip_velocity, x_d=GOAL, f=pressing, f_d=20.0)
        torque: Floats = state.tau_g + state.jacobian.T @ force
        return torque

    run = Scenario(LOOP)._quiet().run(controller=law, rate=RATE)
    late, pressing = run.t >= 2.5, run["f_on_wall_x"]
    along = np.hypot(run["tip_y"] - GOAL[1], run["tip_z"] - GOAL[2])
    return [float(pressing.max()), float(np.abs(pressing[late] - 20).max()), float(along[late].max())]


TASK = FunctionTask(
    name="hybrid_selection",
    title="which direction is controlled how?",
    text="""\
A hybrid law controls the pressing force along the wall's normal and the position across it. The tip
presses in the direction p = (1, 0, 0); S_f selects the force, S_p = I - S_f the position:

    F = S_p (K (x_d - x) - D v) + S_f p (f_d + k (f_d - f))

with K = 500 N/m, D = 100 N s/m, k = 0.5. x, v, x_d are vectors of three, the pressing force f and its
goal f_d are numbers. Write command(x, v, x_d, f, f_d), which returns F. With the listing nothing holds
the tip along the wall, and the force goes where it likes.""",
    hints=(
        "In which directions can the tip move freely, and in which does the wall hold it?",
        "Force along the normal: S_f = diag(1, 0, 0). Position across it: S_p = diag(0, 1, 1).",
        "F = (f_d + k*(f_d - f), K*(x_d(2) - x(2)) - D*v(2), K*(x_d(3) - x(3)) - D*v(3)).",
    ),
    given="""\
import numpy as np

K, D, k = 500.0, 100.0, 0.5
p = np.array([1.0, 0.0, 0.0])
S_p = np.diag([1.0, 0.0, 0.0])
S_f = np.eye(3) - S_p


def command(x, v, x_d, f, f_d):
    return S_p @ (K * (x_d - x) - D * v) + S_f @ p * (f_d + k * (f_d - f))
""",
    given_suffix=".py",
    function="command",
    inputs=(
        Input("x", -1, 1),
        Input("v", -0.5, 0.5),
        Input("x_d", -1, 1),
        Input("f", 0, 40, size=1),
        Input("f_d", 5, 30, size=1),
    ),
    entries=("F_x", "F_y", "F_z"),
    right=command,
    loop=Loop(
        in_the_loop,
        (
            Goal("the largest force", "N", LARGEST, 0.1),
            Goal("the force after 2.5 s", "N", 0.0, 0.05),
            Goal("the distance along the wall after 2.5 s", "m", 0.0, 1e-3),
        ),
    ),
    mistakes=(
        Mistake(
            "the selections are swapped: it should be force along the normal, position across it",
            lambda **given: command(**given, position=FORCE, force=POSITION),
        ),
        Mistake(
            "position is controlled along the normal, too: S_p is missing",
            lambda **given: command(**given, position=ALL),
        ),
        Mistake("the force error has the wrong sign: it should be f_d - f", lambda **given: command(**given, sign=-1)),
        Mistake("the goal f_d itself is missing", lambda **given: command(**given, feedforward=0)),
    ),
)
