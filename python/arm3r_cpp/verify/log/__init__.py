"""Logs of the numbers of a formula.

In comes a text file of named columns, and the truth; out goes a verdict on the entries that it has.
What follows none of the terms that such a formula is made of is noise.
"""
