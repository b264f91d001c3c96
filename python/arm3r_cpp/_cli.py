"""The command `arm3r`: the executable inside the package takes over this process."""

import os
import sys

import arm3r_cpp


def main() -> None:
    places = (os.path.join(place, "bin", "arm3r") for place in arm3r_cpp.__path__)
    os.execv(next(filter(os.path.isfile, places)), sys.argv)  # argv[0] stays: arm3r-plot is looked for beside it
