from functools import reduce
import numpy as np
G = np.array([0, 0, -9.80665])
def skew(v): return np.cross(np.eye(3), v)
def gravity(q):
    c, s = np.cos(q[0]), np.sin(q[0])
    u = lambda t: np.array([c*np.cos(t), s*np.cos(t), -np.sin(t)])
    k, n = np.array([0, 0, 1.]), np.array([-s, c, 0])
    p2, p3 = 0.37*u(q[1]), 0.8*u(q[1]) + 0.21*u(q[1]+q[2])
    J2 = np.column_stack([np.cross(k, p2), np.cross(n, p2), np.zeros(3)])
    J3 = np.column_stack([np.cross(k, p3), np.cross(n, p3), np.cross(n, p3 - 0.8*u(q[1]))])
    return -reduce(np.add, [m*J.T @ G for m, J in ((1.3, J2), (2.1, J3))])
