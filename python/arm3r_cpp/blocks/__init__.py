"""A function from a user's file as the controller of a run, beside the scenario's own controller.

In comes FILE.m or FILE.py with a function of angles, rates, forces and numbers of the arm. Out goes a law as
`Scenario.run` takes it, or two runs with their differences. `block` reads the file, `inputs` knows what an argument is
given by its name, `law` calls the function at each sample, `beside` runs both controllers,
and `report` and `figure` show it. The user's code runs in this process, in the user's own trust.
These modules must not know command lines, and they never judge a formula: `verify` does.
"""
