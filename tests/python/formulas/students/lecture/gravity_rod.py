import numpy as np

RHO = 7850.0
AREA = 1e-4
a2, a3 = 1.0, 1.0
m2 = RHO*AREA*a2
m3 = RHO*AREA*a3
g = 9.80665


def tau_g(q):
    c2 = np.cos(q[1])
    c23 = np.cos(q[1:].sum())
    return -np.array([0, m2*g*a2/2*c2 + m3*g*(a2*c2 + a3/2*c23), m3*g*a3/2*c23])
