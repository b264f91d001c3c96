import numpy as np


def M(q):
    c2, c23, c3 = np.cos(q[1]), np.cos(q[1] + q[2]), np.cos(q[2])
    A, B, C = 0.071 + 1.3*0.37**2 + 2.1*0.8**2, 0.043 + 2.1*0.21**2, 2.1*0.8*0.21
    m11 = (A - 0.002)*c2**2 + (B - 0.003)*c23**2 + 2*C*c2*c23
    return np.array([[m11, 0, 0], [0, A + B + 2*C*c3, B + C*c3], [0, B + C*c3, B]])


def coriolis(q, dq):
    h = 1e-5
    dM = [(M(q + h*e) - M(q - h*e))/(2*h) for e in np.eye(3)]
    Mdot = sum(d*w for d, w in zip(dM, dq))
    return Mdot @ dq - np.array([dq @ d @ dq for d in dM])/2
