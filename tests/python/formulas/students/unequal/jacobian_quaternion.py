import numpy as np


def qmul(a, b):
    w1, v1, w2, v2 = a[0], a[1:], b[0], b[1:]
    return np.array([w1*w2 - v1 @ v2, *(w1*v2 + w2*v1 + np.cross(v1, v2))])


def rot(p, v):
    conj = p*np.array([1, -1, -1, -1])
    return qmul(qmul(p, np.array([0, *v])), conj)[1:]


def about(axis, angle):
    return np.array([np.cos(angle/2), *(np.sin(angle/2)*np.array(axis))])


def jacobian(q):
    p1 = about([0, 0, 1], q[0])
    p2 = qmul(p1, about([0, 1, 0], q[1]))
    p3 = qmul(p2, about([0, 1, 0], q[2]))
    l2, l3 = rot(p2, [0.8, 0, 0]), rot(p3, [0.55, 0, 0])
    y = rot(p1, [0, 1, 0])
    return np.array([np.cross([0, 0, 1], l2 + l3), np.cross(y, l2 + l3), np.cross(y, l3)]).transpose()
