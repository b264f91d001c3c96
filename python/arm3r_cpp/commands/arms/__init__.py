"""Commands about files that describe an arm.

In come words of the command line, out goes text: `import_urdf` prints the scenario that the room `robots` makes of a
URDF. As with every command, what is wrong goes to stderr in one line, and the exit code is one of those of `arm3r`.
Nothing here knows what an elbow arm is.
"""
