import cmath

lengths = {"upper": 0.8, "lower": 0.55}


def jacobian(q1, q2, q3):
    upper = lengths["upper"] * cmath.exp(1j * q2)
    lower = lengths["lower"] * cmath.exp(1j * (q2 + q3))
    whole = upper + lower
    turn = cmath.exp(1j * q1)
    first = 1j * turn * whole.real
    second = -turn * whole.imag
    third = -turn * lower.imag
    return [
        [first.real, second.real, third.real],
        [first.imag, second.imag, third.imag],
        [0.0, whole.real, lower.real],
    ]
