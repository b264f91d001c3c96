"""Measurements beside runs: a CSV file with a column of time, and a figure of what it and the runs have in common.

In comes the file of a laboratory or of another program, or a map of columns.
Out go its columns, under the names that columns of a run have, and the figure.
It knows panels and their look from `plot`, and never runs a scenario.
"""
