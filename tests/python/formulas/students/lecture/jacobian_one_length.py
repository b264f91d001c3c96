import numpy as np

L = 1.0


def jacobian(q):
    q1, q2, q3 = q
    u = np.cos(q2) + np.cos(q2 + q3)
    v = np.sin(q2) + np.sin(q2 + q3)
    return L*np.array([
        [-np.sin(q1)*u, -np.cos(q1)*v, -np.cos(q1)*np.sin(q2 + q3)],
        [np.cos(q1)*u, -np.sin(q1)*v, -np.sin(q1)*np.sin(q2 + q3)],
        [0, -u, -np.cos(q2 + q3)],
    ])
