"""The sum of m J^T J and J_w^T I J_w over the links, with axes turned into the base."""

import numpy as np


def mass_matrix(q):
    c1, s1 = np.cos(q[0]), np.sin(q[0])
    up, across = np.array([0, 0, 1.0]), np.array([-s1, c1, 0])
    axis2, axis3 = (np.array([c1 * np.cos(angle), s1 * np.cos(angle), -np.sin(angle)]) for angle in (q[1], q[1] + q[2]))
    matrix = np.diag([0.05, 0, 0])
    for mass, length, start, axis, moves in (
        (1.2, 0.8, 0 * axis2, axis2, (1, 0)),
        (0.7, 0.6, 0.8 * axis2, axis3, (1, 1)),
    ):
        centre = start + length / 2 * axis
        linear = np.stack(
            [np.cross(up, centre), np.cross(across, centre), moves[1] * np.cross(across, centre - start)], 1
        )
        angular = np.stack([up, across, moves[1] * across], 1)
        inertia = mass * length**2 / 12 * (np.eye(3) - np.outer(axis, axis))
        matrix = matrix + mass * linear.T @ linear + angular.T @ inertia @ angular
    return matrix
