import numpy as np

length = np.array([0.8, 0.55])


def jacobian(q):
    pitch = np.cumsum(q[1:])
    planar = length*np.array([np.cos(pitch), -np.sin(pitch)])
    slope = length*np.array([-np.sin(pitch), -np.cos(pitch)])
    reach = planar[0].sum()
    tail = np.cumsum(slope[:, ::-1], axis=1)[:, ::-1]
    heading = np.array([np.cos(q[0]), np.sin(q[0])])
    J = np.zeros((3, 3))
    J[:2, 1:] = heading[:, None]*tail[0]
    J[2, 1:] = tail[1]
    J[0, 0], J[1, 0] = -reach*heading[1], reach*heading[0]
    return J
