import numpy as np
from numpy import cos as c, sin as s

a2, a3, d1 = 0.8, 0.55, 0.25


def fk(q):
    T01 = np.array([[c(q[0]), 0, -s(q[0]), 0], [s(q[0]), 0, c(q[0]), 0], [0, -1, 0, d1], [0, 0, 0, 1]])
    T12 = np.array([[c(q[1]), -s(q[1]), 0, a2*c(q[1])], [s(q[1]), c(q[1]), 0, a2*s(q[1])], [0, 0, 1, 0], [0, 0, 0, 1]])
    T23 = np.array([[c(q[2]), -s(q[2]), 0, a3*c(q[2])], [s(q[2]), c(q[2]), 0, a3*s(q[2])], [0, 0, 1, 0], [0, 0, 0, 1]])
    return T01.dot(T12).dot(T23)
