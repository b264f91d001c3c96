import numpy as np
class Arm:
    g = 9.80665
    m = (0.785, 0.785)
    @property
    def weights(self):
        return [m*self.g for m in self.m]
    @staticmethod
    def cosines(q):
        return np.cos(q[1]), np.cos(q[1]+q[2])
    def gravity(self, q):
        w2, w3 = self.weights
        c2, c23 = self.cosines(q)
        return np.array([0, w2*c2/2 + w3*c2 + w3*c23/2, w3*c23/2])
