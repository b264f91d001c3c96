import numpy as np
def D(q):
    A, B, C = 0.071 + 1.3*0.37**2 + 2.1*0.8**2, 0.043 + 2.1*0.21**2, 2.1*0.8*0.21
    c2, c23, c3 = np.cos(q[1]), np.cos(q[1] + q[2]), np.cos(q[2])
    M = np.zeros((3, 3), dtype=np.asarray(q).dtype)
    M[0, 0] = 0.005 + (A - 0.002)*c2**2 + (B - 0.003)*c23**2 + 2*C*c2*c23
    M[1, 1] = A + B + 2*C*c3
    M[1, 2] = M[2, 1] = B + C*c3
    M[2, 2] = B
    return M
def coriolis(q, qdot):
    n, h = 3, 1e-20
    dM = [D(np.array(q, complex) + 1j*h*np.eye(n)[k]).imag/h for k in range(n)]
    out = np.zeros(n)
    for i in range(n):
        for j in range(n):
            for k in range(n):
                out[i] += 0.5*(dM[k][i, j] + dM[j][i, k] - dM[i][j, k])*qdot[j]*qdot[k]
    return out
