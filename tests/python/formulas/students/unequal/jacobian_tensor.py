"""Jacobian by differentiating the rotation product, tensors all the way."""
import numpy as np

EPS = np.zeros((3, 3, 3))
EPS[0, 1, 2] = EPS[1, 2, 0] = EPS[2, 0, 1] = 1
EPS[0, 2, 1] = EPS[2, 1, 0] = EPS[1, 0, 2] = -1


def rot(axis, t):
    k = np.eye(3)[axis]
    K = -np.tensordot(EPS, k, axes=(2, 0))
    return np.eye(3) + np.sin(t) * K + (1 - np.cos(t)) * K @ K


def jacobian(q):
    R1 = rot(2, q[0])
    R2 = R1 @ rot(1, q[1])
    R3 = R2 @ rot(1, q[2])
    p2 = R2 @ np.array([0.8, 0, 0])
    p3 = R3 @ np.array([0.55, 0, 0])
    z, y = np.array([0, 0, 1]), R1[:, 1]
    return np.einsum("ijk,aj,ak->ia", EPS, np.array([z, y, y]), np.array([p2 + p3, p2 + p3, p3]))
