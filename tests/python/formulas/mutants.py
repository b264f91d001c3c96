"""Plants mistakes: one operator, number, name, function, sign or index of a program is changed."""

from __future__ import annotations

import ast
import random
import re
from collections.abc import Iterator
from functools import cache

_SWAPS = {ast.Add: (ast.Sub, ast.Mult), ast.Sub: (ast.Add,), ast.Mult: (ast.Add, ast.Div), ast.Div: (ast.Mult,)}
_PAIRS = {
    "sin": "cos",
    "cos": "sin",
    "a2": "a3",
    "a3": "a2",
    "m2": "m3",
    "m3": "m2",
    "q1": "q2",
    "q2": "q3",
    "q3": "q2",
    "lc2": "lc3",
    "lc3": "lc2",
    "I2": "I3",
    "I3": "I2",
    "c2": "c23",
    "c23": "c2",
    "c1": "s1",
    "s1": "c1",
    "r": "h",
    "h": "r",
    "s23": "c23",
    "tip": "elbow",
    "elbow": "tip",
    "T1": "T2",
    "T2": "T1",
}


def python_mutants(text: str) -> list[str]:
    """Every mutant of a Python text by one change of what it computes."""
    tree = ast.parse(text)
    places = [node for statement in _computing(tree) for node in ast.walk(statement)]
    constants = {
        id(node.value) for node in places if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant)
    }
    found = []
    for node in places:
        if id(node) in constants and getattr(node, "value", 0) != 0:
            continue  # `a2 = 1` is the arm's own number
        for change in range(8):
            before = dict(vars(node))
            if _changed(node, change):
                found.append(ast.unparse(ast.fix_missing_locations(tree)) + "\n")
            vars(node).update(before)
    return list(dict.fromkeys(found))


def _computing(tree: ast.Module) -> Iterator[ast.stmt]:
    """The statements in functions and methods, and those outside that compute something from names."""
    for statement in tree.body:
        if isinstance(statement, (ast.FunctionDef, ast.ClassDef)):
            yield from statement.body
        elif isinstance(statement, (ast.Assign, ast.AugAssign)) and any(
            isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load) and node.id not in ("np", "sp", "sympy")
            for node in ast.walk(statement.value)
        ):
            yield statement


def _changed(node: ast.AST, change: int) -> bool:
    """Change a node in place; False where it does not have this change."""
    if isinstance(node, ast.BinOp):
        swaps = _SWAPS.get(type(node.op), ())
        if change < len(swaps):
            node.op = swaps[change]()
            return True
        if change == 3:  # without its right part
            node.op, node.right = (
                (ast.Add(), ast.Constant(0))
                if isinstance(node.op, (ast.Add, ast.Sub))
                else (ast.Mult(), ast.Constant(1))
            )
            return True
        if change == 4 and isinstance(node.op, ast.Add):
            node.left = ast.Constant(0)
            return True
        return False
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub) and change == 0:
        node.op = ast.UAdd()
        return True
    if isinstance(node, ast.Constant) and type(node.value) in (int, float) and change < 2:
        node.value = node.value + 1 if change == 0 else (2 * node.value if node.value else -1)
        return True
    if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
        if change == 0 and node.id in _PAIRS:
            node.id = _PAIRS[node.id]
            return True
        if change == 1 and (node.id[0] in "amqIlB" or node.id in ("r", "h", "n2", "n3", "f3")):
            node.id = f"-{node.id}"
            return True
    if isinstance(node, ast.Attribute) and node.attr in ("sin", "cos") and change == 0:
        node.attr = _PAIRS[node.attr]
        return True
    if isinstance(node, ast.Call) and change == 2 and len(node.args) == 2:
        node.args = node.args[::-1]
        return True
    return False


_SLIPS = (
    ("a2", "a3"),
    ("a3", "a2"),
    ("m2", "m3"),
    ("m3", "m2"),
    ("q2+q3", "q2"),
    ("q2+q3", "q2-q3"),
    ("sin(", "cos("),
    ("cos(", "sin("),
    ("q1", "0"),
    ("q1", "-q1"),
    ("/2", ""),
    ("+", "-"),
    ("-", "+"),
    ("*", "/"),
    ("(q1)", "(q2)"),
    ("T1", "T2"),
    ("T2", "T3"),
    ("s*ca", "c*ca"),
    ("q(2)", "q(3)"),
    ("q(1)", "q(2)"),
    ("a*s", "a*c"),
)


def matlab_mutants(text: str) -> list[str]:
    """Every mutant of a MATLAB text by one slip in a line that is no number's and no function's head."""
    found = []
    lines = text.split("\n")
    for number, line in enumerate(lines):
        if re.match(r"\s*(function|%|end|\w+ ?= ?[\d.]+;)", line):
            continue
        for letters, slip in _SLIPS:
            for place in re.finditer(re.escape(letters), line):
                if re.fullmatch(r"[*+-]", letters) and line[max(place.start() - 1, 0) : place.start() + 2].count("."):
                    continue
                new = line[: place.start()] + slip + line[place.end() :]
                found.append("\n".join([*lines[:number], new, *lines[number + 1 :]]))
    return list(dict.fromkeys(found))


@cache
def mutants(text: str, language: str) -> list[str]:
    return python_mutants(text) if language == "python" else matlab_mutants(text)


def two_mistakes(text: str, language: str, seed: int, count: int) -> Iterator[str]:
    """Mutants of mutants."""
    choose = random.Random(seed)
    first = mutants(text, language)
    for _ in range(count):
        second = mutants(choose.choice(first), language)
        if second:
            yield choose.choice(second)
