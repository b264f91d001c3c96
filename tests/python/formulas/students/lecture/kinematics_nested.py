from functools import reduce
import numpy as np


def fk(*joints):
    def T(R=np.eye(3), p=(0, 0, 0)):
        return np.block([[np.asarray(R), np.reshape(p, (3, 1))], [np.zeros((1, 3)), np.ones((1, 1))]])
    Ry = lambda t: [[np.cos(t), 0, np.sin(t)], [0, 1, 0], [-np.sin(t), 0, np.cos(t)]]
    Rz = lambda t: [[np.cos(t), -np.sin(t), 0], [np.sin(t), np.cos(t), 0], [0, 0, 1]]
    a, b, c = joints
    return reduce(np.matmul, [T(Rz(a)), T(Ry(b)), T(p=(1, 0, 0)), T(Ry(c)), T(p=(1, 0, 0))])[:3, 3]
