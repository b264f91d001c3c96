import numpy as np

G, M, L = 9.80665, np.array([0.785, 0.785]), np.array([1.0, 1.0])
UPPER = np.triu(np.ones((2, 2)))
SHARE = np.tril(np.ones((2, 2)), -1) + 0.5*np.eye(2)

def gravity(q):
    x = L*np.cos(np.cumsum(np.asarray(q, float)[1:]))
    return np.concatenate([[0.0], -G*np.einsum("i,ij,j,kj->k", M, SHARE, x, UPPER)])
