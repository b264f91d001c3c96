import numpy as np
def trans(x=0, y=0, z=0):
    T = np.identity(4)
    T[:3, 3] = x, y, z
    return T
def rotz(t):
    T = np.identity(4)
    T[0, :2] = np.cos(t), -np.sin(t)
    T[1, :2] = np.sin(t), np.cos(t)
    return T
def roty(t):
    T = np.identity(4)
    T[0, [0, 2]] = np.cos(t), np.sin(t)
    T[2, [0, 2]] = -np.sin(t), np.cos(t)
    return T
def fkine(q):
    return np.linalg.multi_dot([trans(z=0.25), rotz(q[0]), roty(q[1]), trans(x=0.8), roty(q[2]), trans(0.55)])
