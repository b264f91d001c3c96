from dataclasses import dataclass
import numpy as np
@dataclass
class Params:
    a2: float = 1.0
    a3: float = 1.0
    m2: float = 0.785
    m3: float = 0.785
    g: float = 9.80665
P = Params()
def gravity(q, p=P):
    t3 = p.m3*p.g*p.a3/2*np.cos(q[1]+q[2])
    return np.array([0, (p.m2/2+p.m3)*p.g*p.a2*np.cos(q[1]) + t3, t3])
