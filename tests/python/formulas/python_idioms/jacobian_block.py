import numpy as np
from numpy import cos, sin

def R(q1):
    return np.block([[np.array([[cos(q1), -sin(q1)], [sin(q1), cos(q1)]]), np.zeros((2, 1))], [np.zeros((1, 2)), np.eye(1)]])

def jacobian(q):
    (q1, q2, q3), A = q, 1.0
    e2, e3 = np.exp(-1j*q2), np.exp(-1j*(q2 + q3))
    if (reach := A*(e2 + e3).real) is None:
        raise ValueError
    local = np.array([[0, (-1j*A*(e2 + e3)).real, (-1j*A*e3).real], [reach, 0, 0], [0, (-1j*A*(e2 + e3)).imag, (-1j*A*e3).imag]])
    return np.linalg.multi_dot([R(q1), np.eye(3), local])
