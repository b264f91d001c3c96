import numpy as np
def jacobian(q):
    q1, q2, q3 = q[0], q[1], q[2]
    R = np.matrix([[np.cos(q1), -np.sin(q1), 0], [np.sin(q1), np.cos(q1), 0], [0, 0, 1]])
    r = np.cos(q2) + np.cos(q2+q3)
    planar = np.matrix([[0, -np.sin(q2)-np.sin(q2+q3), -np.sin(q2+q3)], [r, 0, 0], [0, r, np.cos(q2+q3)]])
    return R*planar
