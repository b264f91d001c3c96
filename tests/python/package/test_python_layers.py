"""The rooms of the Python package know only what lies below them."""

from __future__ import annotations

import ast
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path
from typing import Any, NamedTuple

import arm3r_cpp as arm3r
import pytest

# From the bottom up. A name is a folder or a module that lies beside the folders; a line may know the lines above it.
ROOMS = [
    "errors _hash _arm3r system",
    "_files _native _progress_bar",
    "_messages",
    "answers",
    "user_functions",
    "logs",
    "examples",
    "rows",
    "params arm run_file run",
    "control",
    "scenario",
    "accuracy",
    "batch simulation",
    "sweeps",
    "plot",
    "measured",
    "notebook",
    "animation",
    "live",
    "verify",
    "blocks",
    "exercises",
    "commands",
    "_api",
    "__init__",
]

# Public names that a room below hands on: these imports point up, and they are done when the name is used.
LATER = {("scenario", "batch"), ("plot", "animation"), ("plot", "measured"), ("batch", "sweeps")}
LATER |= {(room, "blocks") for room in ("scenario", "batch", "sweeps")}  # controllers in files
LATER |= {("run", "live")}  # the page with a run
LATER |= {(room, "notebook") for room in ("run", "scenario", "batch")}  # their pages and tables

MAX_MODULES = 16  # in a folder

PACKAGE = Path(arm3r.__file__).parent
LEVEL = {room: level for level, line in enumerate(ROOMS) for room in line.split()}


class Import(NamedTuple):
    """An import of a module of the package."""

    module: str
    at_once: bool
    """Whether it is done when the importing module is loaded."""


def modules() -> dict[str, Path]:
    """The files of the package by their dotted names; "plot" is the __init__ of that folder."""
    names = {path: ".".join(path.relative_to(PACKAGE).with_suffix("").parts) for path in PACKAGE.rglob("*.py")}
    return {name.removesuffix(".__init__"): path for path, name in sorted(names.items())}


def room(module: str) -> str:
    return module.split(".")[0]


@cache
def imports(module: str) -> list[Import]:
    """What a module imports from the package, also inside functions and for type checkers only."""
    tree = ast.parse(KNOWN[module].read_text())
    later = {id(inner) for node in ast.walk(tree) if is_later(node) for inner in ast.walk(node)}
    folder = module.split(".") if KNOWN[module].stem == "__init__" else module.split(".")[:-1]
    folder = [] if module == "__init__" else folder
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level > 0:
            base = [*folder[: len(folder) - node.level + 1], *(node.module or "").split(".")]
            base = [part for part in base if part]
            for alias in node.names:
                whole = ".".join([*base, alias.name])
                found.append(Import(whole if whole in KNOWN else ".".join(base), id(node) not in later))
    return found


def is_later(node: ast.AST) -> bool:
    is_types_only = isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
    return is_types_only or isinstance(node, (ast.FunctionDef, ast.Lambda))


KNOWN = modules()


def every_import() -> list[tuple[str, Import]]:
    return [(module, found) for module in KNOWN for found in imports(module)]


def test_every_import_is_read() -> None:
    """The reading of the sources by the tests below finds what Python does."""
    every = every_import()
    assert ("scenario", Import("_native", True)) in every
    assert ("sweeps.runner", Import("_native", True)) in every
    assert ("plot.force_figure", Import("plot.style", True)) in every
    assert ("plot", Import("animation.animate", False)) in every
    assert ("plot.strobe", Import("scenario", False)) in every
    assert ("_api", Import("sweeps.runner", False)) in every
    known = {*KNOWN, "_arm3r"}
    assert {found.module for _, found in every} <= known


def test_every_room_has_its_place() -> None:
    assert {room(module) for module in KNOWN} | {"_arm3r"} == set(LEVEL)


@pytest.mark.parametrize("module", KNOWN)
def test_imports_point_down(module: str) -> None:
    for found in imports(module):
        here, there = room(module), room(found.module)
        is_later = (here, there) in LATER and not found.at_once
        assert LEVEL[there] <= LEVEL[here] or is_later, f"{module} imports {found.module}, which is above it"


def test_no_modules_import_each_other() -> None:
    graph: dict[str, set[str]] = {module: set() for module in KNOWN}
    for module, found in every_import():
        if (room(module), room(found.module)) not in LATER:
            graph[module].add(found.module)
    assert len(list(TopologicalSorter(graph).static_order())) >= len(graph)  # CycleError names a circle


@pytest.mark.sample(8)
@pytest.mark.parametrize("module", [name for name in KNOWN if name != "__init__"])
def test_every_module_can_be_the_first(python: Any, module: str) -> None:
    done = python(f"import sys, arm3r_cpp.{module} as m; assert m is sys.modules['arm3r_cpp.{module}']")
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("folder", sorted({path.parent for path in KNOWN.values()}), ids=lambda folder: folder.name)
def test_a_folder_can_be_taken_in(folder: Path) -> None:
    assert len(list(folder.glob("*.py"))) <= MAX_MODULES
    text = ast.get_docstring(ast.parse((folder / "__init__.py").read_text()))
    assert text and len(text.splitlines()) >= 5, f"{folder.name}: its __init__.py says what comes in and what goes out"


def test_no_module_hides_a_public_name_of_its_package() -> None:
    """The import of plot/force.py would put the module in the place of the function plot.force."""
    assert not {f"plot.{name}" for name in arm3r.plot.__all__} & set(KNOWN)
    assert not set(dir(arm3r)) - {"plot", "verify"} & set(KNOWN)
