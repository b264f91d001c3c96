import numpy as np

a = np.array([0.25, 0.8, 0.55])


def Jacobian(q):
    """Geometric Jacobian, linear part first."""
    c, s = np.cos(q), np.sin(q)
    s23, c23 = np.sin(q[1] + q[2]), np.cos(q[1] + q[2])
    e = np.array([c[0], s[0], 0])
    n = np.array([-s[0], c[0], 0])
    k = np.array([0, 0, 1])
    d3 = -a[2] * s23 * e - a[2] * c23 * k
    d2 = -a[1] * s[1] * e - a[1] * c[1] * k + d3
    d1 = (a[1] * c[1] + a[2] * c23) * n
    Jv = np.vstack((d1, d2, d3)).T
    Jw = np.vstack((k, n, n)).T
    return np.concatenate((Jv, Jw))
