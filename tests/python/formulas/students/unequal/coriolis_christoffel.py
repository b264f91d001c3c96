import numpy as np

h = 1e-20
A2 = 1.3*0.37**2 + 2.1*0.8**2 + 0.071 - 0.002
A3 = 2.1*0.21**2 + 0.043 - 0.003
B = 2.1*0.8*0.21


def mass(q):
    c2, c23, c3 = np.cos(q[1]), np.cos(q[1] + q[2]), np.cos(q[2])
    M = np.zeros((3, 3), complex)
    M[0, 0] = A2*c2**2 + A3*c23**2 + 2*B*c2*c23
    M[1, 1] = 2*B*c3
    M[1, 2] = M[2, 1] = B*c3
    return M


def coriolis(q, qd):
    """The Coriolis matrix by Christoffel symbols, with complex steps."""
    D = []
    for k in range(3):
        step = np.zeros(3, complex)
        step[k] = 1j*h
        D.append(mass(q + step).imag/h)
    C = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for k in range(3):
                C[i, j] += 0.5*(D[k][i, j] + D[j][i, k] - D[i][j, k])*qd[k]
    return C
