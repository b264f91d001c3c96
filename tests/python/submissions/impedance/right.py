import numpy as np

a2, a3, m2, m3, g = 0.8, 0.6, 1.2, 0.7, 9.80665


def jacobian(q):
    c1, s1 = np.cos(q[0]), np.sin(q[0])
    c2, s2, c23, s23 = np.cos(q[1]), np.sin(q[1]), np.cos(q[1] + q[2]), np.sin(q[1] + q[2])
    r, h = a2 * c2 + a3 * c23, a2 * s2 + a3 * s23
    return np.array([[-s1 * r, -c1 * h, -c1 * a3 * s23], [c1 * r, -s1 * h, -s1 * a3 * s23], [0, -r, -a3 * c23]])


def tip(q):
    r, h = (a2 * f(q[1]) + a3 * f(q[1] + q[2]) for f in (np.cos, np.sin))
    return np.array([np.cos(q[0]) * r, np.sin(q[0]) * r, -h])


def gravity(q):
    t3 = -m3 * g * a3 / 2 * np.cos(q[1] + q[2])
    return np.array([0, -(m2 / 2 + m3) * g * a2 * np.cos(q[1]) + t3, t3])


def controller(q, qd):
    J = jacobian(q)
    return gravity(q) + J.T @ (300 * (np.array([0.9, 0.2, 0.3]) - tip(q)) - 40 * J @ qd)
