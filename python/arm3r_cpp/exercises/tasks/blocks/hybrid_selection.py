"""Hybrid position and force control: which directions are controlled how."""

import numpy as np

from ...._native import Floats
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
    mistakes=(
        Mistake(
            "the selections are swapped: due is force along the normal, position across it",
            lambda **given: command(**given, position=FORCE, force=POSITION),
        ),
        Mistake(
            "position is controlled along the normal, too: S_p is missing",
            lambda **given: command(**given, position=ALL),
        ),
        Mistake("the force error has the wrong sign: due is f_d - f", lambda **given: command(**given, sign=-1)),
        Mistake("the goal f_d itself is missing", lambda **given: command(**given, feedforward=0)),
    ),
)
