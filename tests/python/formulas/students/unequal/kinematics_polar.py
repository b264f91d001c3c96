import cmath
def fk(theta1, theta2, theta3, base=0.25, upper=0.8, fore=0.55):
    w = upper*cmath.exp(1j*theta2) + fore*cmath.exp(1j*(theta2 + theta3))
    e = cmath.exp(1j*theta1)*w.real
    return e.real, e.imag, base - w.imag
