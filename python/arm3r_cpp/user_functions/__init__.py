"""The user's program: how a formula is read and how it is evaluated.

In come a Python file or function, a MATLAB function file, a symbol of a shared library, or sympy expressions. Out come
the numbers that the formula returns, a row for each state, and the text with the places of its parts, so that single
edits of it can be evaluated too. `documents` takes the code out of notebooks and live scripts, and `nodes` is what both
languages have in common. `python_program` runs Python, by `python_process` and `child` in a process of its own, which
`start` makes by the `fork_server` and which is barred from the rest, or by `python_in_memory` in this process, and with
edits in a copy of it; `c_symbol` calls C functions in the confined process. `matlab` reads and evaluates MATLAB without
running any foreign program, and `octave` has Octave evaluate, in the confined process, what that does not read.
This room must not know what is right.
"""
