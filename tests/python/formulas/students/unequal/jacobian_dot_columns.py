import numpy as np


def jacobian_dot(q, qd):
    """The rate of each column; l2 = 0.8, l3 = 0.55."""
    c1, s1 = np.cos(q[0]), np.sin(q[0])
    pitch, rate = q[1] + q[2], qd[1] + qd[2]
    r2, z2, r3, z3 = 0.8*np.cos(q[1]), 0.8*np.sin(q[1]), 0.55*np.cos(pitch), 0.55*np.sin(pitch)
    r, z = r2 + r3, z2 + z3
    dr, dz = -z2*qd[1] - z3*rate, r2*qd[1] + r3*rate
    dr3, dz3 = -z3*rate, r3*rate
    return np.array([[-c1*qd[0]*r - s1*dr, s1*qd[0]*z - c1*dz, s1*qd[0]*z3 - c1*dz3],
                     [-s1*qd[0]*r + c1*dr, -c1*qd[0]*z - s1*dz, -c1*qd[0]*z3 - s1*dz3],
                     [0, -dr, -dr3]])
