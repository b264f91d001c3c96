import numpy as np

links = [(0.55, 2), (0.8, 1)]


def jacobian(q):
    J = np.zeros((3, 3))
    c1, s1 = np.cos(q[0]), np.sin(q[0])
    r = 0
    z = 0
    for a, i in links:
        phi = sum(q[1:i + 1])
        r = r + a*np.cos(phi)
        z = z + a*np.sin(phi)
        J[:, i] = -z*c1, -z*s1, -r
    J[0, 0] = -s1*r
    J[1, 0] = c1*r
    return J
