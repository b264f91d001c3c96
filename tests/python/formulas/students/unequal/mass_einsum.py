import numpy as np

masses = np.array([1.3, 2.1])
axial, across = np.array([0.002, 0.003]), np.array([0.071, 0.043])


def mass_matrix(q):
    pitch = np.cumsum(q[1:])
    lever = np.array([[0.37, 0], [0.8, 0.21]])
    radius = lever @ np.cos(pitch)
    C, S = np.cos(pitch), np.sin(pitch)
    mask = np.tril(np.ones((2, 2)))
    # planar Jacobians, (body, joint, xz)
    J = np.einsum('bk,kj,kx->bjx', lever, mask, np.stack([-S, -C], axis=1))
    M = np.zeros((3, 3))
    M[1:, 1:] = np.einsum('b,bjx,bkx->jk', masses, J, J) + np.einsum('b,bj,bk->jk', across, mask, mask)
    M[0, 0] = masses @ radius**2 + axial @ S**2 + across @ C**2 + 1.3083333333333334e-05
    return M
