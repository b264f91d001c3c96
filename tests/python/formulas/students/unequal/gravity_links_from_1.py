import numpy as np
g0 = 9.80665
m1, m2 = 1.3, 2.1
lc1, lc2 = 0.37, 0.21
l1 = 0.8
def G(th1, th2, th3):
    """z up, angles counted upwards"""
    g2 = m2*lc2*g0*np.cos(th2 + th3)
    g1 = (m1*lc1 + m2*l1)*g0*np.cos(th2) + g2
    return np.r_[0, g1, g2]
