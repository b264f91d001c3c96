"""The rooms of the Python package, as pyproject.toml lists them for import-linter: each knows what lies below it."""

from __future__ import annotations

import ast
import re
import subprocess
from graphlib import TopologicalSorter
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import grimp
import pytest
from arm3r_cpp.core.provided import _places, provided

tomllib = pytest.importorskip("tomllib")  # of Python 3.11

MAX_MODULES = 16  # in a folder

PACKAGE = Path(arm3r.__file__).parent


def modules() -> dict[str, Path]:
    """The files of the package by their dotted names; "plot" is the __init__ of that folder."""
    names = {path: ".".join(path.relative_to(PACKAGE).with_suffix("").parts) for path in PACKAGE.rglob("*.py")}
    return {name.removesuffix(".__init__"): path for path, name in sorted(names.items())}


KNOWN = modules()


def test_rooms_know_only_what_lies_below_them(root: Path, scripts: Path) -> None:
    done = subprocess.run([scripts / "lint-imports", "--no-cache"], cwd=root, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_no_modules_import_each_other(root: Path) -> None:
    """Neither when they are loaded nor later, nor for their types."""
    graph = grimp.build_graph("arm3r_cpp", cache_dir=None)
    known = {module: graph.find_modules_directly_imported_by(module) for module in graph.modules}
    del known["arm3r_cpp"]  # its public face
    assert known["arm3r_cpp.core.scenario"] > {"arm3r_cpp._native"}  # the sources are read
    assert len(list(TopologicalSorter(known).static_order())) >= len(KNOWN) - 1  # CycleError names a circle


def test_what_the_package_provides_is_there() -> None:
    assert len(_places) == 14
    assert all(callable(provided(name)) for name in _places)
    asked = {name for path in KNOWN.values() for name in re.findall(r'provided\("([^"]+)"\)', path.read_text())}
    assert asked == set(_places)


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


@pytest.mark.parametrize("module", KNOWN)
def test_functions_are_taken_in_at_a_glance(module: str) -> None:
    """At most 60 lines beside the docstring."""
    for node in ast.walk(ast.parse(KNOWN[module].read_text())):
        if isinstance(node, ast.FunctionDef):
            first = node.body[0]
            has_text = ast.get_docstring(node) is not None
            of_text = first.end_lineno - first.lineno + 1 if has_text else 0
            assert node.end_lineno - node.lineno + 1 - of_text <= 60, node.name


FOREIGN = {"_getframe", "_register_atexit", "_legend_handle_box", "_legend_box", "_children"}
FOREIGN |= {"_replace", "_fields", "_exit", "_NamedFuncPointer"}
"""Of Python and of matplotlib, which have no other names for them."""


@pytest.mark.parametrize("module", KNOWN)
def test_no_module_uses_private_members_of_another(module: str) -> None:
    tree = ast.parse(KNOWN[module].read_text())
    used = {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute) and _is_private(node.attr)}
    own = {node.name for node in ast.walk(tree) if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    own |= {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    own |= {
        node.attr
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in ("self", "cls")
    }
    assert used - own - FOREIGN == set()


def _is_private(name: str) -> bool:
    return name.startswith("_") and not name.endswith("_")


def test_no_module_hides_a_public_name_of_its_package() -> None:
    """The import of plot/force.py would put the module in the place of the function plot.force."""
    assert not {f"plot.{name}" for name in arm3r.plot.__all__} & set(KNOWN)
    assert not set(dir(arm3r)) - {"plot", "verify"} & set(KNOWN)


def _named_path(node: ast.AST) -> list[str] | None:
    """The parts of ROOT / "a" / "b", or None."""
    if isinstance(node, ast.Name):
        return [] if node.id == "ROOT" else None
    if not (isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div) and isinstance(node.right, ast.Constant)):
        return None
    before = _named_path(node.left)
    return None if before is None else [*before, str(node.right.value)]


def test_a_tool_finds_the_files_that_it_names(root: Path) -> None:
    """What is built (build, dist, out) need not be there yet."""
    sources = [*(root / "tools").glob("*.py"), *(root / "benchmarks").glob("*.py"), *(root / "docs").rglob("*.py")]
    named = {
        Path(*parts)
        for source in sources
        for node in ast.walk(ast.parse(source.read_text()))
        if (parts := _named_path(node))
    }
    kept = {path for path in named if path.parts[0] not in ("build", "dist", "out")}
    assert len(kept) >= 5
    assert [path for path in sorted(kept) if not (root / path).exists()] == []
