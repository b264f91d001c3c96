"""A Jacobian with a mistake: which entry is wrong, and what should stand there."""

import arm3r_cpp as arm3r
import numpy as np


def jacobian(q):
    s1, c1 = np.sin(q[0]), np.cos(q[0])
    s2, c2 = np.sin(q[1]), np.cos(q[1])
    s23, c23 = np.sin(q[1] + q[2]), np.cos(q[1] + q[2])
    return np.array(
        [
            [-s1 * (c2 + c23), -c1 * (s2 + s23), -c1 * s23],
            [c1 * (c2 + c23), -s1 * (s2 + s23), s1 * s23],
            [0, c2 + c23, c23],
        ]
    )


print(arm3r.verify.jacobian(jacobian, arm3r.Scenario("{format: 1, arm: {convention: slide}}")))
