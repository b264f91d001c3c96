from itertools import accumulate
import numpy as np

PI = np.pi
# a, alpha, d
TABLE = [(0, -PI/2, 0.25), (0.8, 0, 0), (0.55, 0, 0)]


def A(a, alpha, d, th):
    return np.array([
        [np.cos(th), -np.sin(th)*np.cos(alpha), np.sin(th)*np.sin(alpha), a*np.cos(th)],
        [np.sin(th), np.cos(th)*np.cos(alpha), -np.cos(th)*np.sin(alpha), a*np.sin(th)],
        [0, np.sin(alpha), np.cos(alpha), d],
        [0, 0, 0, 1]])


def jacobian(q):
    T = list(accumulate([np.eye(4)] + [A(*row, qi) for row, qi in zip(TABLE, q)], np.matmul))
    pe = T[-1][:3, 3]
    return np.column_stack([np.cross(Ti[:3, 2], pe - Ti[:3, 3]) for Ti in T[:3]])
