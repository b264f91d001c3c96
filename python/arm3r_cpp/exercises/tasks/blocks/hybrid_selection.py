"""Hybrid position and force control: which directions are controlled how."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...._native import Floats
from ....core.run import Run
from ....core.scenario import Scenario
from ...arms import LAB_ARM
from ...loop import RATE, Function, Goal, Loop, at_one_state
from ...numbers import Numbers, steps
from ...task import FunctionTask, Input, Mistake

FORCE, POSITION, ALL = np.array([1.0, 0, 0]), np.array([0, 1.0, 1.0]), np.ones(3)
LOOP = f"""\
{LAB_ARM.scenario}
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


@dataclass(frozen=True)
class Law:
    """A spring K and a damper D across the normal, a gain k of the force error along it."""

    k: float
    d: float
    k_f: float

    def command(
        self,
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
        push = (feedforward * f_d + sign * self.k_f * (f_d - f))[:, None] * FORCE
        return position * (self.k * (x_d - x) - self.d * v) + force * push

    def in_the_loop(self, function: Function) -> list[float]:
        """How far the largest force is off; and in the last half second the force, and the tip along the wall."""
        run = run_with(function)
        late, pressing = run.t >= 2.5, run["f_on_wall_x"]
        along = np.hypot(run["tip_y"] - GOAL[1], run["tip_z"] - GOAL[2])
        largest = pressing.max() - self._largest
        return [float(largest), float(np.abs(pressing[late] - 20).max()), float(along[late].max())]

    @cached_property
    def _largest(self) -> float:
        """It comes from the first contact."""
        return float(run_with(at_one_state(self.command))["f_on_wall_x"].max())


def run_with(function: Function) -> Run:
    """Three seconds, from just before the contact."""

    def law(t: float, state: Any) -> Floats:
        pressing = float(state.f_on_tip @ state.wall_normal)
        force = function(x=state.tip, v=state.tip_velocity, x_d=GOAL, f=pressing, f_d=20.0)
        torque: Floats = state.tau_g + state.jacobian.T @ force
        return torque

    return Scenario(LOOP).quiet().run(controller=law, rate=RATE)


def _given(law: Law) -> str:
    return f"""\
import numpy as np

K, D, k = {law.k}, {law.d}, {law.k_f}
p = np.array([1.0, 0.0, 0.0])
S_p = np.diag([1.0, 0.0, 0.0])
S_f = np.eye(3) - S_p


def command(x, v, x_d, f, f_d):
    return S_p @ (K * (x_d - x) - D * v) + S_f @ p * (f_d + k * (f_d - f))
"""


def task(numbers: Numbers) -> FunctionTask:
    law = Law(
        k=numbers.pick("hybrid K", 500.0, steps(400.0, 600.0, 10.0)),
        d=numbers.pick("hybrid D", 100.0, steps(81.0, 110.0, 1.0)),
        k_f=numbers.pick("hybrid k", 0.5, (0.4, 0.5, 0.6, 0.7)),
    )
    return FunctionTask(
        name="hybrid_selection",
        title="which direction for force, which for position?",
        points=5,
        text=f"""\
A hybrid law controls the pressing force along the wall's normal and the position along its face. The tip
presses in the direction p = (1, 0, 0); S_f selects the force, S_p = I - S_f the position:

    F = S_p (K (x_d - x) - D v) + S_f p (f_d + k (f_d - f))

with K = {law.k:g} N/m, D = {law.d:g} N s/m, k = {law.k_f}. x, v, x_d are vectors of three, the pressing force f and its
goal f_d are numbers. Write command(x, v, x_d, f, f_d), which returns F. With the listing nothing holds
the tip along the wall, and nothing controls the pressing force.""",
        hints=(
            "In which directions can the tip move freely, and in which does the wall hold it?",
            "Force along the normal: S_f = diag(1, 0, 0). Position along the face: S_p = diag(0, 1, 1).",
            "F = (f_d + k*(f_d - f), K*(x_d(2) - x(2)) - D*v(2), K*(x_d(3) - x(3)) - D*v(3)).",
        ),
        given=_given(law),
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
        right=law.command,
        loop=Loop(
            law.in_the_loop,
            (
                Goal("the largest force", "N", 0.0, 0.1),
                Goal("the force after 2.5 s", "N", 0.0, 0.05),
                Goal("the distance along the wall after 2.5 s", "m", 0.0, 1e-3),
            ),
        ),
        mistakes=(
            Mistake(
                "the selections are swapped: it should be force along the normal, position along the face",
                lambda **given: law.command(**given, position=FORCE, force=POSITION),
            ),
            Mistake(
                "position is controlled along the normal too: S_p is missing",
                lambda **given: law.command(**given, position=ALL),
            ),
            Mistake(
                "the force error, f_d - f, has the wrong sign",
                lambda **given: law.command(**given, sign=-1),
            ),
            Mistake("the feedforward of f_d is missing", lambda **given: law.command(**given, feedforward=0)),
        ),
    )
