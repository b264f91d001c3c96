import numpy as np


def jacobian(q):
    e = lambda t: np.array([np.cos(t), -np.sin(t)])
    d = lambda t: np.array([-np.sin(t), -np.cos(t)])
    r, z = e(q[1]) + e(q[1] + q[2])
    (r2, z2), (r3, z3) = d(q[1]) + d(q[1] + q[2]), d(q[1] + q[2])
    c, s = np.cos(q[0]), np.sin(q[0])
    return np.array([[-r*s, r2*c, r3*c], [r*c, r2*s, r3*s], [0, z2, z3]])
