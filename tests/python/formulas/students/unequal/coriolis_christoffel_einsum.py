import numpy as np


def dM(q):
    s2, c2, s23, c23 = np.sin(q[1]), np.cos(q[1]), np.sin(q[1] + q[2]), np.cos(q[1] + q[2])
    A, B, C = 0.069 + 1.3*0.37**2 + 2.1*0.8**2, 0.040 + 2.1*0.21**2, 2.1*0.8*0.21
    D = np.zeros((3, 3, 3))
    D[0, 0, 1] = -2*A*s2*c2 - 2*B*s23*c23 - 2*C*np.sin(2*q[1] + q[2])
    D[0, 0, 2] = -2*B*s23*c23 - 2*C*c2*s23
    D[1, 1, 2] = -2*C*np.sin(q[2])
    D[1, 2, 2] = D[2, 1, 2] = -C*np.sin(q[2])
    return D


def coriolis_matrix(q, qd):
    D = dM(q)
    G = (D + np.einsum('ijk->ikj', D) - np.einsum('jki->ijk', D))/2
    return np.einsum('ijk,k->ij', G, qd)
