"""Print what the build needs from the package index, one requirement a line: pyproject.toml's own list.

python tools/build_requires.py [PACKAGE]: or what the tests ask of one package of theirs.
"""

import sys
from pathlib import Path

if sys.version_info >= (3, 11):
    import tomllib
else:
    from pip._vendor import tomli as tomllib

project = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text())
if sys.argv[1:]:
    tests = project["project"]["optional-dependencies"]["test"]
    print(next(one for one in tests if one.startswith(sys.argv[1])))
else:
    print(*project["build-system"]["requires"], sep="\n")
