"""The commands that take arms from other programs and hand them to others: `arm3r-import`, `arm3r-export`.

In come the words of a command line. Out go scenarios or files of other programs, and warnings of what these cannot
have. These modules compute nothing themselves: they call the rooms `robots` and `interchange`, and no other room knows
them. As in `commands`, the work is imported when it begins.
"""
