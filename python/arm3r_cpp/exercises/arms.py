"""The arm of the exercises: unequal links, so that no mistake hides behind equal numbers."""

from __future__ import annotations

from functools import cache
from types import SimpleNamespace

import numpy as np

from .._native import Floats
from ..arm import Arm
from ..scenario import Scenario

A2, A3, M2, M3, I1, G = 0.8, 0.6, 1.2, 0.7, 0.05, 9.80665
SCENARIO = f"""\
format: 1
arm:
  link1: {{inertia_axial: {I1}}}
  link2: {{shape: slender, length: {A2}, mass: {M2}}}
  link3: {{shape: slender, length: {A3}, mass: {M3}}}
"""
NUMBERS = f"""\
The arm: a2 = {A2} m, a3 = {A3} m, m2 = {M2} kg, m3 = {M3} kg, g = {G} m/s^2. Links 2 and 3 are
slender, with the centre of mass in the middle. Joint 1 turns about the vertical. Convention
simscape, as in the lecture's code: positive q2 and q3 lower the arm. Angles are in radians."""

JACOBIAN_LISTING = f"""\
a2 = {A2};
a3 = {A3};
r = a2*cos(q(2)) + a3*cos(q(2)+q(3));
h = a2*sin(q(2)) + a3*sin(q(2)+q(3));
s = a3*sin(q(2)+q(3));
J = [-sin(q(1))*r, -cos(q(1))*h, -cos(q(1))*s;
      cos(q(1))*r, -sin(q(1))*h, -sin(q(1))*s;
      0, -r, -a3*cos(q(2)+q(3))];
"""
"""What is given in MATLAB where the arm's Jacobian J of q is right."""


@cache
def lab_arm() -> Arm:
    return Scenario(SCENARIO).arm


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
