"""Exercises about scenarios: what is handed in is run, and what it shows is compared with the physics.

Each file holds one `TASK`. Only some keys are taken from the student's file; the rest is what was given.
"""
