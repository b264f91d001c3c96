import numpy as np

g = 9.80665
L = [0.8, 0.55]
LC = [0.37, 0.21]
M = [1.3, 2.1]


def rot(t):
    return np.array([[np.cos(t), np.sin(t)], [-np.sin(t), np.cos(t)]])


def gravity_torque(q):
    f, n, taus = np.zeros(2), 0.0, []
    pitch = [q[1], q[1] + q[2]]
    for i in (1, 0):
        u = np.array([np.cos(pitch[i]), -np.sin(pitch[i])])
        w = np.array([0, -M[i]*g])
        n = n + LC[i]*(u[0]*w[1] - u[1]*w[0]) + L[i]*(u[0]*f[1] - u[1]*f[0])
        f = f + w
        taus.insert(0, n)
    return np.array([0.0, *taus])
