import numpy as np
class Robot:
    def __init__(self, l2, l3):
        self.l2 = l2
        self.l3 = l3
    def fk(self, q):
        r = self.l2*np.cos(q[1]) + self.l3*np.cos(q[1]+q[2])
        return np.array([np.cos(q[0])*r, np.sin(q[0])*r, self.l2*np.sin(q[1]) + self.l3*np.sin(q[1]+q[2])])
    def jacobian(self, q):
        q1, q2, q3 = q
        r = self.l2*np.cos(q2) + self.l3*np.cos(q2+q3)
        z = self.l2*np.sin(q2) + self.l3*np.sin(q2+q3)
        c, s = np.cos(q1), np.sin(q1)
        return np.array([[-s*r, -c*z, -c*self.l3*np.sin(q2+q3)],
                         [c*r, -s*z, -s*self.l3*np.sin(q2+q3)],
                         [0, r, self.l3*np.cos(q2+q3)]])

robot = Robot(l2=1.0, l3=1.0)
