"""Exercises about formulas of the arm: position, Jacobian, mass matrix, gravity torque.

In comes a function of the joints; the mistakes are those of the lecture and of its students. Each file makes one
task, whose right values come from `Arm`.

A formula may name its arguments and order them as it likes, as for `arm3r verify`, which reads it back.
"""
