import cmath
import numpy as np

def planar(q2, q3):
    return cmath.exp(-1j*q2) + cmath.exp(-1j*(q2 + q3))

def jacobian(q):
    q1, q2, q3 = (float(x) for x in q)
    w = planar(q2, q3)
    d2, d3 = -1j*w, -1j*cmath.exp(-1j*(q2 + q3))
    turn = cmath.exp(1j*q1)
    columns = []
    for horizontal, vertical in ((1j*turn*w.real, 0.0), (turn*d2.real, d2.imag), (turn*d3.real, d3.imag)):
        columns.append([horizontal.real, horizontal.imag, vertical])
    return np.array(columns).T
