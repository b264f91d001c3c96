import numpy as np


def mass_matrix(q):
    """As if the links did not know each other."""
    c2, c23 = np.cos(q[1]), np.cos(q[1] + q[2])
    A, B, C = 1.2 * 0.64 / 3 + 0.7 * 0.64, 0.7 * 0.8 * 0.3, 0.7 * 0.36 / 3
    m11 = 0.05 + A * c2**2 + C * c23**2 + 2 * B * c2 * c23
    return np.array([[m11, 0, 0], [0, A + C, C], [0, C, C]])
