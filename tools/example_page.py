"""Writes docs/examples.md: the programs of examples/, and what they print.

python tools/example_page.py build/examples     where the programs in C and C++ are built
"""

from __future__ import annotations

import re
import subprocess
import sys
import textwrap
from collections.abc import Mapping
from pathlib import Path

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "examples.md"
FOLDERS = {"python": "Python", "cpp": "C++", "c": "C"}
HEAD = """\
# Small programs

Eleven programs in Python, C++ and C, each complete. They lie in `examples`; the tests build and run
them, and compare what they print with this page. The C++ ones use `arm3r/arm3r.hpp`: objects that
free themselves and exceptions around the C interface of `arm3r/arm3r.h`. CMake finds the installed
library:

```sh
cmake -S examples -B build/examples -Darm3r_DIR="$(arm3r --cmake-dir)"
cmake --build build/examples
build/examples/contact
```
"""


def programs() -> list[Path]:
    """Their files, by language and name."""
    return [path for folder in FOLDERS for path in sorted((ROOT / "examples" / folder).iterdir())]


def command(program: Path, built: Path) -> list[str]:
    """What runs a program."""
    return [sys.executable, str(program)] if program.suffix == ".py" else [str(built / program.stem)]


def parts(program: Path) -> tuple[str, str]:
    """What a program shows, as the comment at its head says, and the rest of its text."""
    found = re.match(r"(?:\"\"\"(.*?)\"\"\"|/\* (.*?) \*/|((?://[^\n]*\n)+))\n*", program.read_text(), re.S)
    assert found, program
    said = next(one for one in found.groups() if one)
    return " ".join(said.replace("//", "").split()), program.read_text()[found.end() :]


def page(printed: Mapping[Path, str]) -> str:
    """The page, of what each program prints."""
    text = HEAD
    for folder, language in FOLDERS.items():
        text += f"\n## {language}\n"
        for program in (one for one in programs() if one.parent.name == folder):
            shows, code = parts(program)
            shows = textwrap.fill(shows, 100, break_on_hyphens=False)
            text += f"\n### {program.name}\n\n{shows}\n\n```{folder}\n{code}```\n\nIt prints:\n\n"
            text += f"```text\n{printed[program]}```\n"
    return text


if __name__ == "__main__":
    out = {one: subprocess.run(command(one, Path(sys.argv[1])), capture_output=True, text=True, check=True).stdout
           for one in programs()}  # fmt: skip
    PAGE.write_text(page(out))
