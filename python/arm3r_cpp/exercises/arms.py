"""The arms of the exercises: unequal links, so that no mistake hides behind equal numbers."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from types import SimpleNamespace

import numpy as np

from .._native import Floats
from ..core.arm import Arm
from ..core.scenario import Scenario
from .numbers import LAB, Numbers, steps

G = 9.80665


@dataclass(frozen=True)
class SlenderArm:
    """An arm of slender links, its numbers as a task states them."""

    a2: float
    a3: float
    m2: float
    m3: float
    i1: float

    @property
    def scenario(self) -> str:
        return f"""\
format: 1
arm:
  link1: {{inertia_axial: {self.i1}}}
  link2: {{shape: slender, length: {self.a2}, mass: {self.m2}}}
  link3: {{shape: slender, length: {self.a3}, mass: {self.m3}}}
"""

    @property
    def text(self) -> str:
        return f"""\
The arm: a2 = {self.a2} m, a3 = {self.a3} m, m2 = {self.m2} kg, m3 = {self.m3} kg, g = {G} m/s^2. Links 2 and 3 are
slender, with the centre of mass in the middle. Joint 1 turns about the vertical. Convention
simscape, as in the lecture's code: positive q2 and q3 lower the arm. Angles are in radians."""

    @property
    def weight_listing(self) -> str:
        """The numbers of a listing of the gravity torque in MATLAB."""
        return f"m2 = {self.m2};\nm3 = {self.m3};\ng = {G};\na2 = {self.a2};\na3 = {self.a3};\n"

    @property
    def jacobian_listing(self) -> str:
        """What is given in MATLAB where the arm's Jacobian J of q is right."""
        return f"""\
a2 = {self.a2};
a3 = {self.a3};
r = a2*cos(q(2)) + a3*cos(q(2)+q(3));
h = a2*sin(q(2)) + a3*sin(q(2)+q(3));
s = a3*sin(q(2)+q(3));
J = [-sin(q(1))*r, -cos(q(1))*h, -cos(q(1))*s;
      cos(q(1))*r, -sin(q(1))*h, -sin(q(1))*s;
      0, -r, -a3*cos(q(2)+q(3))];
"""

    @cached_property
    def arm(self) -> Arm:
        return Scenario(self.scenario).arm


def arm_of(numbers: Numbers) -> SlenderArm:
    """All tasks of a student are about one arm. No length or mass, and no half of one, is equal to another."""
    return SlenderArm(
        a2=numbers.pick("a2", 0.8, steps(0.7, 0.95, 0.01)),
        a3=numbers.pick("a3", 0.6, steps(0.5, 0.65, 0.01)),
        m2=numbers.pick("m2", 1.2, steps(1.1, 1.9, 0.1)),
        m3=numbers.pick("m3", 0.7, steps(0.52, 0.87, 0.05)),
        i1=numbers.pick("i1", 0.05, steps(0.03, 0.09, 0.01)),
    )


LAB_ARM = arm_of(LAB)


def angles(q: Floats) -> SimpleNamespace:
    """c1, s1, c2, s2, c3, c23, s23 of joint angles (N, 3), each (N,)."""
    q1, q2, q3 = q.T
    sines = {"s1": np.sin(q1), "s2": np.sin(q2), "s23": np.sin(q2 + q3)}
    return SimpleNamespace(c1=np.cos(q1), c2=np.cos(q2), c3=np.cos(q3), c23=np.cos(q2 + q3), **sines)


def times(matrices: Floats, vectors: Floats) -> Floats:
    """(N, 3, 3) times (N, 3)."""
    product: Floats = np.einsum("nij,nj->ni", matrices, vectors)
    return product


def transposed(matrices: Floats) -> Floats:
    return np.swapaxes(matrices, 1, 2)
