"""The commands `arm3r-plot`, `-sweep`, `-animate`, `-examples`, `-live`, `-verify`, `-run`: a module for each program.

In come the words of a command line. Out go files, lines on standard output, and one of the exit codes of `arm3r`.
The installed scripts start in `entry_points`, and `exit_codes` turns errors and signals into the end of a process.
`run_source` reads the run that is drawn, and `interchange` has the commands that read and write files of other
programs. These modules compute nothing themselves: they call the other rooms, and no other room knows them. They
import numpy and matplotlib when the work begins, so that `--help` answers at once.
"""
