"""GNU Octave, where it is installed, evaluates a MATLAB file that holds what `matlab` does not read.

In comes the text of a file; out come the numbers that its function returns, or what Octave says of it. `installation`
finds Octave, `source` finds the functions and the constants of a text that is not read. In the confined process
`interpreter` runs Octave as a library, so that no program has to be started there, and `program` calls the user's
function through it; `process` is the other end of that process.
"""
