import numpy as np


class Arm:
    def __init__(self):
        self.a2 = 0.8
        self.a3 = 0.55

    def jac(self, q):
        q1, q2, q3 = q
        q23 = q2 + q3
        r = self.a2 * np.cos(q2) + self.a3 * np.cos(q23)
        J = np.empty((3, 3))
        J[:, 0] = -np.sin(q1) * r, np.cos(q1) * r, 0
        J[:, 2] = -self.a3 * np.array([np.cos(q1) * np.sin(q23), np.sin(q1) * np.sin(q23), np.cos(q23)])
        J[:, 1] = J[:, 2] - self.a2 * np.array([np.cos(q1) * np.sin(q2), np.sin(q1) * np.sin(q2), np.cos(q2)])
        return J


arm = Arm()


def jacobian(q):
    return arm.jac(q)
