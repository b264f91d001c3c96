import numpy as np

m = [0.785, 0.785]
L = [1.0, 1.0]
grav = 9.80665


def U(q):
    z2 = -L[0]/2*np.sin(q[1])
    z3 = -L[0]*np.sin(q[1]) - L[1]/2*np.sin(q[1] + q[2])
    return grav*(m[0]*z2 + m[1]*z3)


def gravity(q):
    e = 1e-5
    G = []
    for i in range(3):
        d = np.zeros(3)
        d[i] = e
        G.append((U(q + d) - U(q - d))/(2*e))
    return np.array(G)
