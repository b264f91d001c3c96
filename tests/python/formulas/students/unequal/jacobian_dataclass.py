"""Task 2: the Jacobian of the arm."""
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Robot:
    upper: float = 0.8
    fore: float = 0.55


ROBOT = Robot()


def jacobian(q):
    """J of the tip, 3x3."""
    s1, c1 = np.sin(q[0]), np.cos(q[0])
    reach = ROBOT.upper * np.cos(q[1]) + ROBOT.fore * np.cos(q[1] + q[2])
    drop = ROBOT.upper * np.sin(q[1]) + ROBOT.fore * np.sin(q[1] + q[2])
    J = np.zeros((3, 3))
    J[0] = [-s1 * reach, -c1 * drop, -c1 * ROBOT.fore * np.sin(q[1] + q[2])]
    J[1] = [c1 * reach, -s1 * drop, -s1 * ROBOT.fore * np.sin(q[1] + q[2])]
    J[2, 1] = -reach
    J[2, 2] = -ROBOT.fore * np.cos(q[1] + q[2])
    return J
