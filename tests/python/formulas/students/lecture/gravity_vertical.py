import numpy as np

a2 = a3 = 1.0
m2 = m3 = 0.785
g = 9.80665


def tau_gravity(q):
    """Angles from the vertical by a shift of a quarter turn."""
    p2 = q[1] + np.pi/2
    p3 = p2 + q[2]
    t3 = -m3*g*a3/2*np.sin(p3)
    t2 = -m2*g*a2/2*np.sin(p2) - m3*g*a2*np.sin(p2) + t3
    return np.r_[0, t2, t3]
