import numpy as np
class Link:
    def __init__(self, mass, com, length):
        self.mass, self.com, self.length = mass, com, length

ARM = [Link(1.3, 0.37, 0.8), Link(2.1, 0.21, 0.55)]

def gravity_torque(q, g=9.80665):
    tau = np.zeros(3)
    for i, link in enumerate(ARM):
        for j in range(i + 1):
            # lever of the weight about joint j + 2
            lever = link.com*np.cos(q[1:i+2].sum())
            lever += sum(ARM[k].length*np.cos(q[1:k+2].sum()) for k in range(j, i))
            tau[j + 1] -= link.mass*g*lever
    return tau
