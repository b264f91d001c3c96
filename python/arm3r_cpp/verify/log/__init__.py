"""Logs of the numbers of a formula: a verdict without the formula's text.

In comes a table of columns (logs/) that holds a formula's arguments and its numbers, and the truth.
Out goes a verdict on each entry that has a column: right, wrong and by which term, or not to be told.
What follows none of the terms that such a formula is made of is noise, and is told as noise.
It knows no file formats: logs/ reads them.
"""
