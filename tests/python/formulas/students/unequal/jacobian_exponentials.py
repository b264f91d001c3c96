import numpy as np


def hat(w):
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])


def twist(w, p, t):
    """exp of a screw through p."""
    W = hat(w)
    R = np.eye(3) + np.sin(t)*W + (1 - np.cos(t))*W @ W
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = (np.eye(3) - R) @ p
    return T


def jacobian(q):
    screws = [([0, 0, 1], [0, 0, 0]), ([0, 1, 0], [0, 0, 0.25]), ([0, 1, 0], [0.8, 0, 0.25])]
    G = np.eye(4)
    frames = []
    for (w, p), t in zip(screws, q):
        frames.append((G[:3, :3] @ np.array(w), (G @ np.array([*p, 1]))[:3]))
        G = G @ twist(np.array(w), np.array(p), t)
    tip = (G @ np.array([1.35, 0, 0.25, 1]))[:3]
    return np.stack([hat(z) @ (tip - o) for z, o in frames], axis=1)
