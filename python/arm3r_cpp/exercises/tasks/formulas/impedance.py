"""A spring and a damper at the tip, with the error the wrong way round."""

from dataclasses import dataclass

import numpy as np

from ...._native import Floats
from ....core.scenario import Scenario
from ...arms import G, SlenderArm, arm_of, times, transposed
from ...loop import RATE, Function, Goal, Loop
from ...numbers import Numbers, steps
from ...task import FunctionTask, Input, Mistake


@dataclass(frozen=True)
class Law:
    """A spring K and a damper D between the tip of an arm and x_d."""

    lab: SlenderArm
    k: float
    d: float
    x_d: tuple[float, float, float]

    @property
    def scenario(self) -> str:
        return f"""\
{self.lab.scenario}controller: {{type: stiffness, stiffness: {self.k}, damping: {self.d}}}
reference: {{type: point, tip: {list(self.x_d)}}}
"""

    def torque(self, q: Floats, qd: Floats, *, spring: float = 1, damper: float = 1, weight: float = 1) -> Floats:
        """The law (7.9), with a factor before each of its parts."""
        arm = self.lab.arm
        jacobian = arm.jacobian(q)
        force = spring * self.k * (self.x_d - arm.tip_position(q)) - damper * self.d * times(jacobian, qd)
        return weight * arm.gravity_torque(q) + times(transposed(jacobian), force)

    def in_the_loop(self, function: Function) -> list[float]:
        """The largest distance from x_d in the last half second of three."""
        text = f"{self.lab.scenario}initial: {{q: [0.3, -0.6, 1.0]}}\ntime: {{stop: 3, log_every: 0.01}}\n"
        run = Scenario(text).quiet().run(controller=lambda t, state: function(q=state.q, qd=state.qd), rate=RATE)
        tip = np.stack([run[f"tip_{axis}"] for axis in "xyz"], axis=1)
        return [float(np.linalg.norm(tip - self.x_d, axis=1)[run.t >= 2.5].max())]


def _given(law: Law) -> str:
    return f"""\
import numpy as np

a2, a3, m2, m3, g = {law.lab.a2}, {law.lab.a3}, {law.lab.m2}, {law.lab.m3}, {G}
K, D = {law.k}, {law.d}
x_d = np.array({list(law.x_d)})


def controller(q, qd):
    c1, s1 = np.cos(q[0]), np.sin(q[0])
    c2, s2, c23, s23 = np.cos(q[1]), np.sin(q[1]), np.cos(q[1] + q[2]), np.sin(q[1] + q[2])
    r, h = a2 * c2 + a3 * c23, a2 * s2 + a3 * s23
    x = np.array([c1 * r, s1 * r, -h])
    J = np.array([[-s1 * r, -c1 * h, -c1 * a3 * s23], [c1 * r, -s1 * h, -s1 * a3 * s23], [0, -r, -a3 * c23]])
    t3 = -m3 * g * a3 / 2 * c23
    tau_g = np.array([0, -(m2 / 2 + m3) * g * a2 * c2 + t3, t3])
    force = K * (x - x_d) - D * (J @ qd)
    return tau_g + J.T @ force
"""


def task(numbers: Numbers) -> FunctionTask:
    lab = arm_of(numbers)
    law = Law(
        lab,
        k=numbers.pick("impedance K", 300.0, steps(250.0, 400.0, 10.0)),
        d=numbers.pick("impedance D", 40.0, steps(31.0, 49.0, 1.0)),
        x_d=(
            numbers.pick("impedance x", 0.9, steps(0.75, 0.95, 0.01)),
            numbers.pick("impedance y", 0.2, steps(0.1, 0.25, 0.01)),
            numbers.pick("impedance z", 0.3, steps(0.15, 0.35, 0.01)),
        ),
    )
    return FunctionTask(
        name="impedance",
        title="a spring that pushes the tip away",
        points=4,
        text=f"""\
This control law is meant to hold the tip at x_d as a spring of K = {law.k:g} N/m and a damper of
D = {law.d:g} N s/m would, on an arm whose weight is compensated:

    tau = tau_g + J^T (K (x_d - x) - D J qd),   x_d = ({", ".join(map(str, law.x_d))}) m

In the simulation the tip runs away. Find out why, and hand in the right law, tau(q, qd).

{lab.text}""",
        hints=(
            "Put the tip a little beside x_d, at rest: which way does the force of your law point?",
            "A spring pulls towards x_d: the error is x_d - x, and the force K times the error.",
            "force = K*(x_d - x) - D*(J @ qd); torque = tau_g + J.T @ force.",
        ),
        given=_given(law),
        given_suffix=".py",
        kind="controller",
        function="controller",
        scenario=law.scenario,
        inputs=(Input("q", -3, 3), Input("qd", -2, 2)),
        entries=("t1", "t2", "t3"),
        right=law.torque,
        loop=Loop(law.in_the_loop, (Goal("the distance of the tip from x_d after 2.5 s", "m", 0.0, 1e-3),)),
        mistakes=(
            Mistake(
                "the error has the wrong sign: the spring pushes away from x_d",
                lambda q, qd: law.torque(q, qd, spring=-1),
            ),
            Mistake("the damper has the wrong sign: it feeds energy in", lambda q, qd: law.torque(q, qd, damper=-1)),
            Mistake("the damper is missing", lambda q, qd: law.torque(q, qd, damper=0)),
            Mistake("the gravity torque is missing", lambda q, qd: law.torque(q, qd, weight=0)),
            Mistake("the gravity torque has the wrong sign", lambda q, qd: law.torque(q, qd, weight=-1)),
        ),
    )
