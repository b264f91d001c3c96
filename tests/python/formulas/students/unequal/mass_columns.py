import numpy as np

m2, m3, a2, l2, l3 = 1.3, 2.1, 0.8, 0.37, 0.21
I2, I3 = np.diag([0.002, 0.071, 0.071]), np.diag([0.003, 0.043, 0.043])


def axes(q1, pitch):
    x = np.array([np.cos(q1)*np.cos(pitch), np.sin(q1)*np.cos(pitch), -np.sin(pitch)])
    y = np.array([-np.sin(q1), np.cos(q1), 0])
    return np.column_stack([x, y, np.cross(x, y)])


def mass(q):
    z, E2, E3 = np.array([0, 0, 1]), axes(q[0], q[1]), axes(q[0], q[1] + q[2])
    y, o = E2[:, 1], np.zeros(3)
    r2, r3 = l2*E2[:, 0], a2*E2[:, 0] + l3*E3[:, 0]
    Jv2 = np.array([np.cross(z, r2), np.cross(y, r2), o]).T
    Jv3 = np.array([np.cross(z, r3), np.cross(y, r3), np.cross(y, l3*E3[:, 0])]).T
    Jw2, Jw3 = np.array([z, y, o]).T, np.array([z, y, y]).T
    M = m2*Jv2.T @ Jv2 + m3*Jv3.T @ Jv3
    M = M + Jw2.T @ E2 @ I2 @ E2.T @ Jw2 + Jw3.T @ E3 @ I3 @ E3.T @ Jw3
    M[0, 0] += 1.3083333333333334e-05
    return M
