import numpy as np


def gravity(q):
    m = (1.3, 2.1)
    gvec = np.array([0, 0, -9.80665])
    c1, s1 = np.cos(q[0]), np.sin(q[0])

    def point(lengths, pitches):
        J = np.zeros((3, 3))
        for length, pitch, last in zip(lengths, pitches, (1, 2)):
            J[:, 0] += length * np.cos(pitch) * np.array([-s1, c1, 0])
            for joint in range(1, last + 1):
                J[:, joint] += -length * np.array([np.sin(pitch) * c1, np.sin(pitch) * s1, np.cos(pitch)])
        return J

    J2 = point([0.37], [q[1]])
    J3 = point([0.8, 0.21], [q[1], q[1] + q[2]])
    return -(m[0] * J2.T @ gvec + m[1] * J3.T @ gvec)
