"""Exercises with marking: tasks, hints of three grades, and a table of marks for the teacher.

In comes a file that a student hands in: a function in Python or MATLAB, or a scenario. Out comes a `Mark`: right,
wrong or unclear, and a reason. `tasks` holds what is asked, a file for each exercise; `function_judge` and
`scenario_judge` compare what is handed in with what is right, `worker` does this in a process of its own for each
file, and `folder` goes through a folder of submissions. `table` writes the marks down.

>>> from arm3r_cpp.exercises.tasks import TASKS
>>> from arm3r_cpp.exercises.judge import judge_file
>>> judge_file(TASKS["first_joint"], "first_joint.m").word
"""
