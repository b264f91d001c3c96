"""Exercises about the blocks around the arm: contact, torques of a force, selection, observer, admittance.

In comes a function of what a block of a Simulink model would be given. Each file makes one task, with the right
function and those of its known mistakes.

The arguments are taken by position, as one vector each or number by number.
"""
