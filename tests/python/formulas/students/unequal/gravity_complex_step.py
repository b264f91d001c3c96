import numpy as np

m = np.array([1.3, 2.1])
g0 = 9.80665


def potential(q):
    z2 = -0.37*np.sin(q[1])
    z3 = -0.8*np.sin(q[1]) - 0.21*np.sin(q[1] + q[2])
    return g0*(m[0]*z2 + m[1]*z3)


def gravity(q):
    h = 1e-30
    steps = np.eye(3)*1j*h
    return np.array([potential(q + e).imag/h for e in steps])
