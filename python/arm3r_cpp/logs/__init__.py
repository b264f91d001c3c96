"""Logs of laboratories and of other programs.

In comes a text file of named columns, however it is parted, encoded and named.
Out go columns under the names that a run has, in SI units and radians, and what each of them was called.
It knows neither runs nor formulas.
"""
