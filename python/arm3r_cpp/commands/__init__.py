"""The commands `arm3r-plot`, `arm3r-sweep` and `arm3r-animate`: one module for each command line program.

In come the words of a command line. Out go files, lines on standard output, and one of the exit codes of `arm3r`.
The installed scripts start in `entry_points`, `exit_codes` turns errors and signals into the end of a process, and
`progress_bar` shows how far a long command is. These modules compute nothing themselves: they call the other rooms, and
no other room knows them. They import numpy and matplotlib when the work begins, so that `--help` answers at once.
"""
