"""Right programs of the arm in several styles, mutants of them, and what is known about both without the package.

In come a seed and a number. Out come texts of Python and MATLAB programs with the entries that are wrong in them,
computed by running them as they are. `programs` has the right ones, `mutants` plants mistakes, `rewriting` changes
programs without changing their values, and `reading` evaluates what a verdict says. Nothing here knows how the package
finds mistakes.
"""
