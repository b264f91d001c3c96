from __future__ import annotations
from enum import Enum
from typing import NamedTuple
import numpy as np
class Link(NamedTuple):
    mass: float
    length: float
class Axis(Enum):
    Z = 2
LINKS = [Link(0.785, 1.0), Link(0.785, 1.0)]
GRAVITY = 9.80665
def com_jacobian(q, k):
    J = np.zeros((3, 3))
    x = [LINKS[i].length*np.cos(sum(q[1:i+2]))*(0.5 if i == k else 1) for i in range(k+1)]
    for j in range(1, k+2):
        J[Axis.Z.value, j] = sum(x[j-1:])
    return J
def gravity(q):
    return sum(l.mass*GRAVITY*com_jacobian(q, k)[2] for k, l in enumerate(LINKS))
