from __future__ import annotations
from functools import singledispatch, cached_property
from dataclasses import dataclass, asdict, replace
import numpy as np
@dataclass(frozen=True, slots=True)
class P:
    m2: float = 0.785
    m3: float = 0.785
    a2: float = 1.0
    a3: float = 1.0
    g: float = 9.80665

def _g(q, m2, m3, a2, a3, g):
    t3 = -m3*g*a3/2*np.cos(q[1]+q[2])
    return np.array([0.0, -(m2/2+m3)*g*a2*np.cos(q[1])+t3, t3])

@singledispatch
def torque(p, q): raise NotImplementedError
@torque.register
def _(p: P, q): return _g(q, **asdict(p))
def gravity(q): return torque(replace(P(), m2=0.785), q)
