import numpy as np

def _g(q, m2, m3, a2, a3, g):
    t3 = -m3*g*a3/2*np.cos(q[1]+q[2])
    return np.array([0.0, -(m2/2+m3)*g*a2*np.cos(q[1])+t3, t3])

def gravity(q):
    t = _g(q, 0.785, 0.785, 1, 1, 9.80665)
    return {"joint1": t[0], "joint2": t[1], "joint3": t[2]}
