"""A chain of homogeneous transforms, arguments in the lecture's order, as a 4x4 matrix."""

import numpy as np


def turn(axis, angle):
    c, s = np.cos(angle), np.sin(angle)
    matrix = np.eye(4)
    matrix[:3, :3] = {"z": [[c, -s, 0], [s, c, 0], [0, 0, 1]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]]}[axis]
    return matrix


def along(x):
    matrix = np.eye(4)
    matrix[0, 3] = x
    return matrix


def tip_position(q3, q2, q1, a3, a2):
    return turn("z", q1) @ turn("y", q2) @ along(a2) @ turn("y", q3) @ along(a3)
