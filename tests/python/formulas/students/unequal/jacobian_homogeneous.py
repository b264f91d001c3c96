import numpy as np

# lengths of the links
L1 = 0.25
L2 = 0.8
L3 = 0.55


def rot_z(t):
    T = np.eye(4)
    T[:2, :2] = [[np.cos(t), -np.sin(t)], [np.sin(t), np.cos(t)]]
    return T


def rot_y(t):
    T = np.eye(4)
    T[0, 0] = T[2, 2] = np.cos(t)
    T[0, 2], T[2, 0] = np.sin(t), -np.sin(t)
    return T


def trans(x=0, y=0, z=0):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


def jacobian(theta):
    frames = [trans(z=L1) @ rot_z(theta[0])]
    frames.append(frames[-1] @ rot_y(theta[1]))
    frames.append(frames[-1] @ trans(L2) @ rot_y(theta[2]))
    p = (frames[-1] @ trans(L3))[:3, 3]
    axes = [frames[0][:3, 2], frames[1][:3, 1], frames[2][:3, 1]]
    return np.column_stack([np.cross(z, p - T[:3, 3]) for z, T in zip(axes, frames)])
