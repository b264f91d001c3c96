import numpy as np

def wedge(x):
    return np.array([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])

def expm(A, terms=60):
    E, T = np.eye(len(A)), np.eye(len(A))
    for k in range(1, terms):
        T = T @ A / k
        E = E + T
    return E

def jacobian(q):
    axes = [[0, 0, 1], [0, 1, 0], [0, 1, 0]]
    points = [[0, 0, 0], [0, 0, 0.25], [0.8, 0, 0.25]]
    tip = np.array([1.35, 0, 0.25, 1])
    T, columns = np.eye(4), []
    twists = []
    for w, p in zip(axes, points):
        X = np.zeros((4, 4))
        X[:3, :3] = wedge(w)
        X[:3, 3] = -np.cross(w, p)
        twists.append(X)
    steps = [np.eye(4)]
    for X, t in zip(twists, q):
        steps.append(steps[-1] @ expm(X*t))
    end = steps[-1] @ tip
    for G, X in zip(steps, twists):
        columns.append((G @ X @ np.linalg.inv(G) @ end)[:3])
    return np.stack(columns, 1)
