"""Where GNU Octave is installed on this computer."""

from __future__ import annotations

import os
import re
import shutil
import sys
from pathlib import Path
from typing import NamedTuple

PROGRAM = "ARM3R_OCTAVE"
"""The variable of the environment that names another program than the one on the path; empty: no Octave is used."""
_PROGRAMS = ("octave-cli", "octave")
_LIBRARY = "liboctinterp.so.*"
_PLACES = ("lib*/octave/*", "lib/*/octave/*", "lib*", "lib/*")  # below the prefix


class Installation(NamedTuple):
    """The library that is Octave's interpreter, and the folders that it reads."""

    library: str
    folders: list[str]

    @property
    def name(self) -> str:
        """With the version, which its folder is named by."""
        version = re.search(r"/octave/(\d[\d.]*)/", self.library)
        return f"GNU Octave {version[1]}" if version else "GNU Octave"


def installed() -> Installation | None:
    """The Octave that a shell would start, or that `PROGRAM` names; None where there is none with such a library.

    Only on Linux, which confines its process and where the library's place is known.
    """
    if sys.platform != "linux":
        return None
    named = os.environ.get(PROGRAM)
    names = _PROGRAMS if named is None else (named,) if named else ()
    programs = [Path(found).resolve() for name in names if (found := shutil.which(name))]
    # Beside any program of the system the library may lie: the program itself must be an Octave.
    for prefix in dict.fromkeys(one.parent.parent for one in programs if one.name.startswith("octave")):
        libraries = [path for place in _PLACES for path in sorted(prefix.glob(f"{place}/{_LIBRARY}"))]
        if libraries:
            return Installation(str(libraries[0].resolve()), [f"{prefix}/share/octave", f"{prefix}/lib"])
    return None
