import numpy as np
g = 9.80665
a2 = 1.0
a3 = 1.0
lc = 0.5
m2 = m3 = 0.785

def gravity(q):
    c2 = np.cos(q[1]); c23 = np.cos(q[1]+q[2])
    return np.array([0, m2*g*lc*c2 + m3*g*(a2*c2 + lc*c23), m3*g*lc*c23])
