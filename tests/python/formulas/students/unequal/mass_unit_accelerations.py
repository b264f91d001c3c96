import numpy as np


def torque(q, qdd):
    """Newton-Euler at rest, without gravity."""
    c1, s1 = np.cos(q[0]), np.sin(q[0])
    k, n = np.array([0, 0, 1.0]), np.array([-s1, c1, 0])
    f, t = np.zeros(3), np.zeros(3)
    al2 = qdd[0]*k + qdd[1]*n
    al3 = al2 + qdd[2]*n
    u2, u3 = (np.array([np.cos(p)*c1, np.cos(p)*s1, -np.sin(p)]) for p in (q[1], q[1] + q[2]))
    f3 = 2.1*(np.cross(al2, 0.8*u2) + np.cross(al3, 0.21*u3))
    f2 = 1.3*np.cross(al2, 0.37*u2)
    n3 = np.cross(0.21*u3, f3) + 0.043*al3 + (0.003 - 0.043)*u3*(u3 @ al3)
    n2 = n3 + np.cross(0.37*u2, f2) + np.cross(0.8*u2, f3) + 0.071*al2 + (0.002 - 0.071)*u2*(u2 @ al2)
    return [k @ n2 + 1.3083333333333334e-05*qdd[0], n @ n2, n @ n3]


def mass_matrix(q):
    return np.array([torque(q, e) for e in np.eye(3)]).T
