import numpy as np


def command(x, v, x_d, f, f_d):
    S_p = np.diag([0, 1, 1])
    return S_p @ (500 * (x_d - x) - 100 * v) + np.array([f_d + 0.5 * (f_d - f), 0, 0])
