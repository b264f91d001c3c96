import numpy as np
def mul(p, q):
    w, x, y, z = p
    a, b, c, d = q
    return np.array([w*a - x*b - y*c - z*d, w*b + x*a + y*d - z*c, w*c - x*d + y*a + z*b, w*d + x*c - y*b + z*a])
def turn(axis, t):
    return np.r_[np.cos(t/2), np.sin(t/2)*np.eye(3)[axis]]
def rotate(q, v):
    return mul(mul(q, np.r_[0, v]), q*[1, -1, -1, -1])[1:]
def forward_kinematics(q):
    a = turn(2, q[0])
    b = mul(a, turn(1, q[1]))
    c = mul(b, turn(1, q[2]))
    return np.array([0, 0, 0.25]) + rotate(b, [0.8, 0, 0]) + rotate(c, [0.55, 0, 0])
