import numpy as np

a2, a3, m2, m3, g = 0.8, 0.6, 1.2, 0.7, 9.80665


def jacobian(q):
    c1, s1 = np.cos(q[0]), np.sin(q[0])
    c2, s2, c23, s23 = np.cos(q[1]), np.sin(q[1]), np.cos(q[1] + q[2]), np.sin(q[1] + q[2])
    r, h = a2 * c2 + a3 * c23, a2 * s2 + a3 * s23
    return np.array([[-s1 * r, -c1 * h, -c1 * a3 * s23], [c1 * r, -s1 * h, -s1 * a3 * s23], [0, -r, -a3 * c23]])


def torque(q, f):
    return -jacobian(q) @ f
