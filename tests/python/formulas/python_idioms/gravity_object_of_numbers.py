import numpy as np
class Arm:
    def __init__(self, params):
        self.params = params
    def gravity(self, q):
        p = self.params
        t3 = p["m"]*p["g"]/2*np.cos(q[1]+q[2])
        return np.array([0, 1.5*p["m"]*p["g"]*np.cos(q[1]) + t3, t3])
arm = Arm({"m": 0.785, "g": 9.80665})
