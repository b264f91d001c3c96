import numpy as np

I_axial, I_across = 1.3083333333333334e-05, 0.06542320833333333
m, a, half = 0.785, 1.0, 0.5


def spatial_inertia(c, R):
    I = R @ np.diag([I_axial, I_across, I_across]) @ R.T
    C = np.array([[0, -c[2], c[1]], [c[2], 0, -c[0]], [-c[1], c[0], 0]])
    return np.block([[I + m*C @ C.T, m*C], [m*C.T, m*np.eye(3)]])


def mass_matrix(q):
    c1, s1 = np.cos(q[0]), np.sin(q[0])
    frames, start, spatial = [], np.zeros(3), []
    for pitch in (q[1], q[1] + q[2]):
        c, s = np.cos(pitch), np.sin(pitch)
        R = np.array([[c1*c, -s1, c1*s], [s1*c, c1, s1*s], [-s, 0, c]])
        spatial.append(spatial_inertia(start + half*R[:, 0], R))
        frames.append(start)
        start = start + a*R[:, 0]
    n = np.array([-s1, c1, 0])
    S = np.array([[0, 0, 1, 0, 0, 0], [*n, *np.cross(frames[0], n)], [*n, *np.cross(frames[1], n)]]).T
    both = spatial[0] + spatial[1]
    M = S.T @ both @ S
    M[2, :] = M[:, 2] = S[:, 2] @ spatial[1] @ S
    M[0, 0] += I_axial
    return M
