"""The functions that a Python text defines: plain ones, lambdas, methods of its classes and of its objects."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import NamedTuple

from .python_program import pairs

_MAKERS = ("lambdify", "partial", "jit", "njit", "vectorize")


class Function(NamedTuple):
    """A function of a text; `robot.jacobian` and `Robot.jacobian` are methods, `Law` is an object that is called."""

    node: ast.FunctionDef | ast.Lambda
    names: list[str]
    """Of the arguments that it is called with."""
    is_method: bool = False

    @property
    def defaults(self) -> dict[str, ast.expr]:
        """What the last arguments are by default."""
        values = self.node.args.defaults
        return dict(zip(self.names[len(self.names) - len(values) :], values, strict=True))


def functions_of(tree: ast.Module) -> dict[str, Function]:
    """The functions of a text by name, in its order. A class stands for an object that its name makes, Robot()."""
    classes = {one.name: one for one in tree.body if isinstance(one, ast.ClassDef)}
    found: dict[str, Function] = {}
    for statement in tree.body:
        if isinstance(statement, ast.FunctionDef):
            found[statement.name] = _plain(statement)
        elif isinstance(statement, ast.ClassDef):
            found |= _called(statement.name, _methods(statement, classes))
        for name, value in pairs(statement):
            if isinstance(value, ast.Lambda):
                found[name.id] = _plain(value)
            elif (of_class := _class_of(value)) in classes:
                found |= _called(name.id, _methods(classes[of_class], classes))
    return found


def assigned(tree: ast.Module) -> dict[str, bool]:
    """The names that a text assigns and that may be functions or formulas, and whether a maker of functions does it."""
    found = {}
    for statement in tree.body:
        for name, value in pairs(statement):
            if not isinstance(value, (ast.Lambda, ast.Constant)):
                called = ast.unparse(value.func).rpartition(".")[2] if isinstance(value, ast.Call) else ""
                found[name.id] = called in _MAKERS
    return found


def needed_by(tree: ast.Module, name: str) -> list[str]:
    """What has to be said to make an object of a class."""
    classes = {one.name: one for one in tree.body if isinstance(one, ast.ClassDef)}
    methods = _methods(classes[name], classes) if name in classes else {}
    if "__init__" not in methods:
        return []
    function = methods["__init__"]
    return function.names[: len(function.names) - len(function.defaults)]


def objects_of(tree: ast.Module, name: str) -> list[str]:
    """The names of the objects of a class that a text makes."""
    return [target.id for one in tree.body for target, value in pairs(one) if _class_of(value) == name]


def _class_of(value: ast.expr) -> str:
    """The name of a class, or a function, that a value is made by: Robot(...); "" for another value."""
    return value.func.id if isinstance(value, ast.Call) and isinstance(value.func, ast.Name) else ""


def _plain(node: ast.FunctionDef | ast.Lambda) -> Function:
    return Function(node, [one.arg for one in (*node.args.posonlyargs, *node.args.args)])


def _methods(node: ast.ClassDef, classes: dict[str, ast.ClassDef]) -> dict[str, Function]:
    """With those of the bases that the text defines."""
    found: dict[str, Function] = {}
    for base in node.bases:
        if isinstance(base, ast.Name) and base.id in classes and base.id != node.name:
            found |= _methods(classes[base.id], {name: one for name, one in classes.items() if name != node.name})
    for statement in node.body:
        if isinstance(statement, ast.FunctionDef) and "property" not in (marks := list(_marks(statement))):
            names = _plain(statement).names
            found[statement.name] = Function(statement, names if "staticmethod" in marks else names[1:], True)
    return found


def _marks(node: ast.FunctionDef) -> Iterator[str]:
    return (ast.unparse(one).rpartition(".")[2] for one in node.decorator_list)


def _called(name: str, methods: dict[str, Function]) -> dict[str, Function]:
    found = {f"{name}.{one}": function for one, function in methods.items() if not one.startswith("_")}
    return found | ({name: methods["__call__"]} if "__call__" in methods else {})
