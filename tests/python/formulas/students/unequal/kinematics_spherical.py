import numpy as np


def fk(q):
    base = 0.25
    phi = np.array([q[1], q[1] + q[2]])
    l = np.array([0.8, 0.55])
    rho = (l * np.cos(phi)).sum()
    z = base + (l * np.sin(phi)).sum()
    return np.array([rho * np.cos(q[0]), rho * np.sin(q[0]), z])
