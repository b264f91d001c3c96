import numpy as np

m2, m3 = 1.3, 2.1
lc2, lc3, a2 = 0.37, 0.21, 0.8
Ix2, Ix3 = 0.002, 0.003
I2, I3 = 0.071, 0.043


def mass_matrix(q):
    q1, q2, q3 = q
    M = np.zeros((3, 3))
    for m, Ix, I, arms, pitch in (
        (m2, Ix2, I2, [(lc2, q2)], q2),
        (m3, Ix3, I3, [(a2, q2), (lc3, q2 + q3)], q2 + q3),
    ):
        Jv = np.zeros((2, 3))
        reach = 0.0
        for k, (length, angle) in enumerate(arms):
            reach += length*np.cos(angle)
            for j in range(1, 2 + k):
                Jv[0, j] += -length*np.sin(angle)
                Jv[1, j] += -length*np.cos(angle)
        Jw = np.array([0, 1, 1 if len(arms) == 2 else 0])
        M += m*Jv.T @ Jv + I*np.outer(Jw, Jw)
        M[0, 0] += m*reach**2 + Ix*np.sin(pitch)**2 + I*np.cos(pitch)**2
    M[0, 0] += LINK1
    return M


LINK1 = 1.3083333333333334e-05
