import cmath


def tip_position(q1, q2, q3):
    w = 0.8*cmath.exp(-1j*q2) + 0.55*cmath.exp(-1j*(q2 + q3))
    v = w.real*cmath.exp(1j*q1)
    return v.real, v.imag, 0.25 + w.imag
