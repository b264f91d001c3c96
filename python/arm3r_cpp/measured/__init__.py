"""Measurements beside runs: a CSV file with a column of time, and a figure of what it and the runs have in common.

In comes the file of a laboratory or of another program, or a map of columns; out go its columns, under the names that
columns of a run have. The figure knows panels and their look from `plot`. Nothing here runs a scenario.
"""
