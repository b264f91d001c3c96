import numpy as np


def dh(theta, d, a, alpha):
    ct, st, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array([
        [ct, -st*ca, st*sa, a*ct],
        [st, ct*ca, -ct*sa, a*st],
        [0, sa, ca, d],
        [0, 0, 0, 1],
    ])


def forward_kinematics(q):
    rows = [(q[0], 0.25, 0, -np.pi/2), (q[1], 0, 0.8, 0), (q[2], 0, 0.55, 0)]
    T = np.eye(4)
    for row in rows:
        T = T.dot(dh(*row))
    return T
