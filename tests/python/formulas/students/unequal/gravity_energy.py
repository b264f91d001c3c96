import numpy as np

g0 = 9.80665
masses = np.array([1.3, 2.1])


def potential_derivative(q, i):
    """dU/dq_i with U = sum m g z, z positive up."""
    l2, lc2, lc3 = 0.8, 0.37, 0.21
    z2 = {1: -lc2*np.cos(q[1]), 2: 0.0}
    z3 = {1: -l2*np.cos(q[1]) - lc3*np.cos(q[1] + q[2]), 2: -lc3*np.cos(q[1] + q[2])}
    return g0 * masses @ np.array([z2[i], z3[i]])


def gravity_torque(q):
    return np.array([0.0, *(potential_derivative(q, i) for i in (1, 2))])
