"""What users of a build see beside results, as texts by name: pages, messages, names and symbols.

`build_results.py` collects them; only public names are used, because builds of different ages are compared.
"""

from __future__ import annotations

import inspect
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from importlib import import_module
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r

Results = Iterator[tuple[str, str]]  # of names and texts

PACKAGE = Path(arm3r.__file__).parent
PAGES = {
    "arm3r": ["--help", "run --help", "check --help", "schema --help", "columns --help", "template --help",
              "schema", "schema --format md", "columns", "columns --format md", "template"],
    "arm3r-plot": ["--help", "sweep --help"],
    "arm3r-sweep": ["--help"],
    "arm3r-animate": ["--help"],
}  # fmt: skip
BROKEN = {
    "an unknown key": "format: 1\nwal: {}\n",
    "an unknown word": "format: 1\ncontroller: {type: hibrid}\n",
    "a number out of range": "format: 1\nwall: {contact: {stiffness: -5}}\n",
    "a wrong unit": "format: 1\narm: {link2: {mass: 3 lb}}\n",
    "a bracket that is not closed": "format: 1\ninitial: {q: [0, 1, 2}\n",
    "a later format": "format: 2\n",
    "two problems": "format: 1\ncontroller: {type: hybrid}\nsolver: {method: taylor}\n",
    "a check of a missing column": "format: 1\nchecks:\n  - {column: force_ref, of: final, equals: 0}\n",
}


def command(name: str, *arguments: str | Path, text: str = "") -> subprocess.CompletedProcess[str]:
    """Run a command of this build. Not by its console script, which names the folder that it was installed into."""
    words: list[str | Path] = [PACKAGE / "bin" / name]
    if name != "arm3r":
        module, function = entry_points(group="console_scripts", name=name)[name].value.split(":")
        words = [sys.executable, "-c", f"import sys, {module}; sys.exit({module}.{function}())"]
    environment = {**os.environ, "COLUMNS": "100"}
    return subprocess.run([*words, *arguments], input=text, env=environment, capture_output=True, text=True)


def pages() -> Results:
    """Everything that the commands print about themselves, and the header of the C interface."""
    for name, calls in PAGES.items():
        for call in calls:
            text = command(name, *call.split()).stdout
            yield f"page: {name} {call}", text.replace(str(PACKAGE), "PACKAGE")  # of a template's schema
    yield "page: arm3r.h", (PACKAGE / "include" / "arm3r" / "arm3r.h").read_text()


def message(error: arm3r.Arm3rError) -> str:
    """The class of an error and its text, which says file, line and column."""
    return f"{type(error).__name__}: {error}"


def messages() -> Results:
    """What Python and the executable say about broken scenarios."""
    for what, text in BROKEN.items():
        try:
            arm3r.Scenario(text, file="broken.yaml").run()
        except arm3r.Arm3rError as error:
            yield f"broken by {what}: in Python", message(error)
        done = command("arm3r", "run", "-", text=text)
        yield f"broken by {what}: arm3r run", f"exit code {done.returncode}\n{done.stderr}"


def public_names() -> Results:
    """The public names of the package, and of the classes among them, with their signatures."""
    for module in ("arm3r_cpp", "arm3r_cpp.plot"):
        package = import_module(module)
        for name in getattr(package, "__all__", dir(package)):
            value = getattr(package, name)
            yield f"name {module}.{name}", signature(value)
            for member, what in inspect.getmembers(value) if inspect.isclass(value) else []:
                if not member.startswith("_"):
                    yield f"name {module}.{name}.{member}", signature(what)


def signature(value: Any) -> str:
    """The signature of a function or class, and the type of anything else."""
    if not callable(value):
        return type(value).__name__
    try:
        return re.sub(r" at 0x\w+", "", str(inspect.signature(value)))
    except ValueError:  # it is written in C and has none
        return "callable"


def symbols() -> Results:
    """The symbols that the library exports."""
    library = PACKAGE / "lib" / "libarm3r.so"
    table = subprocess.run(["nm", "-D", "--defined-only", library], capture_output=True, text=True, check=True).stdout
    for line in table.splitlines():
        yield f"symbol {line.split()[-1]}", "exported"
