"""The arm as C code by CasADi, its numbers those of the jobs: python peer_casadi.py OUT.c"""

from __future__ import annotations

import sys
from pathlib import Path

import casadi
from peer_arms import STIFFNESS, WALL_NEAR, WALL_SPEED, rate, reach


def derivative(y: casadi.SX, **forces: object) -> casadi.SX:
    """Rate of the joint angles and their rates, slide convention."""
    f = rate(casadi, links(y), **forces)
    return casadi.vertcat(f[0], f[1], f[2] - f[1], f[3], f[4], f[5] - f[4])


def links(y: casadi.SX) -> list[casadi.SX]:
    q1, q2, q3, qd1, qd2, qd3 = casadi.vertsplit(y)
    return [q1, q2, q2 + q3, qd1, qd2, qd2 + qd3]


def falling(t: casadi.SX, y: casadi.SX) -> casadi.SX:
    return derivative(y)


def pushed(t: casadi.SX, y: casadi.SX) -> casadi.SX:
    depth = reach(casadi, links(y)) - (WALL_NEAR - WALL_SPEED * t)
    return derivative(y, weight=0, push=-STIFFNESS * casadi.fmax(0, depth))


def rk4(name: str, f: object) -> casadi.Function:
    y, t, h = casadi.SX.sym("y", 6), casadi.SX.sym("t"), casadi.SX.sym("h")
    f1 = f(t, y)
    f2 = f(t + h / 2, y + h / 2 * f1)
    f3 = f(t + h / 2, y + h / 2 * f2)
    f4 = f(t + h, y + h * f3)
    return casadi.Function(name, [y, t, h], [y + h / 6 * (f1 + 2 * f2 + 2 * f3 + f4)], {"cse": True})


def forward_dynamics() -> casadi.Function:
    q, qd, tau = (casadi.SX.sym(name, 3) for name in ("q", "qd", "tau"))
    qdd = derivative(casadi.vertcat(q, qd), tau=casadi.vertsplit(tau))[3:]
    return casadi.Function("casadi_forward_dynamics", [q, qd, tau], [qdd], {"cse": True})


out = Path(sys.argv[1])
generator = casadi.CodeGenerator(out.name, {"with_header": True})
for function in (forward_dynamics(), rk4("casadi_falling_step", falling), rk4("casadi_pushed_step", pushed)):
    generator.add(function)
generator.generate(f"{out.parent}/")
