import numpy as np


def gravity(q1_deg, q2_deg, q3_deg):
    """Angles in degrees."""
    cosd = lambda x: np.cos(np.pi/180*x)
    m2, m3, g = 1.3, 2.1, 9.80665
    t3 = -m3*g*0.21*cosd(q2_deg + q3_deg)
    t2 = t3 - (m2*0.37 + m3*0.8)*g*cosd(q2_deg)
    return np.array([0, t2, t3])
