import numpy as np

eps = np.zeros((3, 3, 3))
eps[0, 1, 2] = eps[1, 2, 0] = eps[2, 0, 1] = 1
eps[0, 2, 1] = eps[2, 1, 0] = eps[1, 0, 2] = -1


def jacobian(q):
    e = np.array([np.cos(q[0]), np.sin(q[0]), 0])
    n = np.array([-np.sin(q[0]), np.cos(q[0]), 0])
    k = np.array([0, 0, 1.0])
    dirs = np.array([np.cos(t)*e - np.sin(t)*k for t in (q[1], q[1] + q[2])])
    axes = np.array([k, n, n])
    arms = np.array([0.8*dirs[0] + 0.55*dirs[1], 0.8*dirs[0] + 0.55*dirs[1], 0.55*dirs[1]])
    return np.einsum('ijk,aj,ak->ia', eps, axes, arms)
