"""Exercises about the blocks around the arm: contact, torques of a force, selection, observer, admittance.

Each file holds one `TASK`, with a right function and those of its known mistakes. The arguments are taken by position,
as one vector each or number by number.
"""
