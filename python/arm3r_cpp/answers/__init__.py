"""What the package says when something is not as its user thinks: wrong names, refused runs, figures never shown.

In come a name that is not there, scenarios that are not valid, the number of a figure.
Out goes a sentence for the user.
The modules here know neither scenarios nor figures, which call them.
"""
