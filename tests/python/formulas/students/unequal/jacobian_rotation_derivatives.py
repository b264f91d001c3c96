import numpy as np


def Rz(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def Ry(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def dRz(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[-s, -c, 0], [c, -s, 0], [0, 0, 0]])


def dRy(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[-s, 0, c], [0, 0, 0], [-c, 0, -s]])


def jacobian(q):
    l2, l3 = np.array([0.8, 0, 0]), np.array([0.55, 0, 0])
    R1, R2, R3 = Rz(q[0]), Ry(q[1]), Ry(q[2])
    col1 = dRz(q[0]) @ R2 @ (l2 + R3 @ l3)
    col2 = R1 @ dRy(q[1]) @ (l2 + R3 @ l3)
    col3 = R1 @ R2 @ dRy(q[2]) @ l3
    return np.vstack([col1, col2, col3]).T
