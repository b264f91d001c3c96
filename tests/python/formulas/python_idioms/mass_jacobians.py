import numpy as np

m, a = 0.785, 1.0
axial = m*(0.01**2 + 0.01**2)/12
across = m*(a**2 + 0.01**2)/12

def mass(q):
    c2, c23 = np.cos(q[1]), np.cos(q[1] + q[2])
    s = np.sin
    M = np.diag([axial, 0.0, 0.0])  # link 1 turns about its length
    for k, (x, dx2, dz2, dx3, dz3) in enumerate([
        (0.5*c2, -0.5*s(q[1]), -0.5*c2, 0.0, 0.0),
        (c2 + 0.5*c23, -s(q[1]) - 0.5*s(q[1]+q[2]), -c2 - 0.5*c23, -0.5*s(q[1]+q[2]), -0.5*c23),
    ]):
        J = np.array([[0.0, dx2, dx3], [x, 0, 0], [0, dz2, dz3]])
        angle = q[1] + (q[2] if k else 0)
        w = np.array([[-s(angle), 0, 0], [0, 1.0, float(k)], [np.cos(angle), 0, 0]])
        M += m*J.T @ J + w.T @ np.diag([axial, across, across]) @ w
    return M
