"""MATLAB function files: read by a grammar of our own, and evaluated for many states at once, in numpy.

In comes the text of a file; out come its functions, the places of their parts, and the numbers that they return.
`tokens` cuts the text into words, `reader` is the grammar that makes the statements of `syntax` of them, `program`
evaluates these, `script` those of a symbolic script, with derivatives by `symbols`, `indexing` takes and sets parts of
arrays, and `functions` are those of MATLAB that are known. No foreign program runs, and no file is read but functions
in files beside the one that is given.
"""
