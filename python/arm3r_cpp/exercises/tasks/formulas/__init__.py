"""Exercises about formulas of the arm: position, Jacobian, mass matrix, gravity torque.

Each file holds one `TASK`. What is right comes from `Arm`; the mistakes are those of the lecture and of its students.
A formula may name its arguments and order them as it likes, as for `arm3r verify`, which reads it back.
"""
