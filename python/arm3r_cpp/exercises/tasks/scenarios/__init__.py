"""Exercises about scenarios: what is handed in is run, and what it shows is compared with the physics.

In comes a scenario, of which some keys are taken; the rest is what was given. Each file makes one task, with the
numbers of the run that are due.

An error of a tenth of a number's threshold is none; what is right comes from docs/model.md and the lecture.
"""
