import numpy as np

a2 = 0.8
m2, m3 = 1.3, 2.1
g = 9.80665


def skew(w):
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])


def inverse_dynamics(q, qd, qdd):
    """Recursive Newton-Euler in the base frame; slide convention."""
    c1, s1 = np.cos(q[0]), np.sin(q[0])
    k, n = np.array([0, 0, 1.0]), np.array([s1, -c1, 0])
    w1, al1 = qd[0]*k, qdd[0]*k
    nd = qd[0]*np.cross(k, n)
    pitches = [q[1], q[1] + q[2]]
    rates = [qd[1], qd[1] + qd[2]]
    accs = [qdd[1], qdd[1] + qdd[2]]
    u = [np.array([np.cos(p)*c1, np.cos(p)*s1, np.sin(p)]) for p in pitches]
    v = [np.cross(n, x) for x in u]
    w = [w1 + r*n for r in rates]
    al = [al1 + a*n + r*nd for a, r in zip(accs, rates)]

    def acc(i, length):
        p = length*u[i]
        return np.cross(al[i], p) + np.cross(w[i], np.cross(w[i], p))

    up = np.array([0, 0, g])
    F3 = m3*(acc(0, a2) + acc(1, 0.21) + up)
    F2 = m2*(acc(0, 0.37) + up)
    inertia = []
    for i, (Ix, I) in enumerate([(0.002, 0.071), (0.003, 0.043)]):
        R = np.column_stack([u[i], v[i], n])
        inertia.append(R @ np.diag([Ix, I, I]) @ R.T)
    N3 = inertia[1] @ al[1] + skew(w[1]) @ inertia[1] @ w[1] + np.cross(0.21*u[1], F3)
    N2 = inertia[0] @ al[0] + skew(w[0]) @ inertia[0] @ w[0] + np.cross(0.37*u[0], F2) + np.cross(a2*u[0], F3) + N3
    return np.array([N2 @ k + 1.3083333333333334e-05*qdd[0], N2 @ n, N3 @ n])
