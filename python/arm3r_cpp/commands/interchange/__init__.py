"""The commands that hand arms to other programs: `arm3r-export`.

In come the words of a command line. Out go files of other programs and warnings of what these cannot have. These
modules compute nothing themselves: they call the room `interchange`, and no other room knows them.
As in `commands`, the work is imported when it begins.
"""
