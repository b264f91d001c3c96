import numpy as np


def jacobian(q_deg):
    # angles in degrees
    a2, a3 = 0.8, 0.55
    q1, q2, q3 = np.deg2rad(q_deg)
    r, h = a2*np.cos(q2) + a3*np.cos(q2+q3), a2*np.sin(q2) + a3*np.sin(q2+q3)
    return np.array([
        [-np.sin(q1)*r, -np.cos(q1)*h, -np.cos(q1)*a3*np.sin(q2+q3)],
        [np.cos(q1)*r, -np.sin(q1)*h, -np.sin(q1)*a3*np.sin(q2+q3)],
        [0, -r, -a3*np.cos(q2+q3)]])
