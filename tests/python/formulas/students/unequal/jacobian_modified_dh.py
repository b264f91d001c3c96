"""Modified DH (Craig)."""
import numpy as np
DH = [dict(a=0, alpha=0, d=0.25), dict(a=0, alpha=-np.pi/2, d=0), dict(a=0.8, alpha=0, d=0), dict(a=0.55, alpha=0, d=0)]
def link(a, alpha, d, theta):
    ct, st, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array([[ct, -st, 0, a], [st*ca, ct*ca, -sa, -sa*d], [st*sa, ct*sa, ca, ca*d], [0, 0, 0, 1]])
def jacobian(q):
    T, frames = np.eye(4), []
    for row, theta in zip(DH, [*q, 0]):
        T = T @ link(**row, theta=theta)
        frames.append(T)
    p = T[:3, 3]
    return np.array([np.cross(F[:3, 2], p - F[:3, 3]) for F in frames[:3]]).T
