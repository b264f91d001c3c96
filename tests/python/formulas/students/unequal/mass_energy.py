import numpy as np
def T(q, v):
    """kinetic energy"""
    m, lc, a = [1.3, 2.1], [0.37, 0.21], 0.8
    wy = np.array([v[1], v[1] + v[2]])
    t = np.array([q[1], q[1] + q[2]])
    x = np.array([lc[0]*np.cos(t[0]), a*np.cos(t[0]) + lc[1]*np.cos(t[1])])
    xd = np.array([-lc[0]*np.sin(t[0])*wy[0], -a*np.sin(t[0])*wy[0] - lc[1]*np.sin(t[1])*wy[1]])
    zd = np.array([-lc[0]*np.cos(t[0])*wy[0], -a*np.cos(t[0])*wy[0] - lc[1]*np.cos(t[1])*wy[1]])
    spin = np.array([0.002, 0.003])*np.sin(t)**2 + np.array([0.071, 0.043])*np.cos(t)**2
    lin = m @ (xd**2 + zd**2 + (x*v[0])**2)
    rot = spin.sum()*v[0]**2 + np.array([0.071, 0.043]) @ wy**2
    return (lin + rot + 1.3083333333333334e-05*v[0]**2)/2
def mass(q):
    e = np.eye(3)
    return [[T(q, e[i] + e[j]) - T(q, e[i]) - T(q, e[j]) for j in range(3)] for i in range(3)]
