import numpy as np
class Kin:
    @staticmethod
    def jac(q1, q2, q3):
        r = np.cos(q2) + np.cos(q2+q3); z = np.sin(q2) + np.sin(q2+q3)
        return np.array([[-np.sin(q1)*r, -np.cos(q1)*z, -np.cos(q1)*np.sin(q2+q3)],
                         [np.cos(q1)*r, -np.sin(q1)*z, -np.sin(q1)*np.sin(q2+q3)], [0, r, np.cos(q2+q3)]])
