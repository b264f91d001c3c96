"""Our reader of MATLAB beside another one, tree-sitter-matlab: both find the same parts at the same places."""

from __future__ import annotations

import os
import random
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from arm3r_cpp.user_functions.documents import decoded
from arm3r_cpp.user_functions.expressions import (
    AnonymousFunction,
    Cell,
    Compare,
    FunctionHandle,
    Logic,
    Matrix,
    Node,
    Not,
    Range,
    Text,
    Transpose,
)
from arm3r_cpp.user_functions.matlab.reader import COMMANDS, read
from arm3r_cpp.user_functions.matlab.syntax import Assignment, For, If, Leave, Statement, Switch, Try, While
from formulas.programs import PROGRAMS, Program

SEED = int(os.environ.get("ARM3R_SEED", random.randrange(10**6)))
Places = Counter[tuple[str, int, int]]

OURS: dict[type, str] = {
    Range: "range", Text: "string", Transpose: "transpose", Compare: "comparison", Logic: "logic", Not: "not",
    AnonymousFunction: "function", FunctionHandle: "handle", Matrix: "matrix", Cell: "cell",
}  # fmt: skip
THEIRS = {
    "range": "range", "string": "string", "postfix_operator": "transpose", "comparison_operator": "comparison",
    "boolean_operator": "logic", "not_operator": "not", "lambda": "function", "handle_operator": "handle",
    "matrix": "matrix", "cell": "cell",
}  # fmt: skip
BLOCKS: dict[type, str] = {For: "for", While: "while", Switch: "switch", Try: "try"}
THEIR_BLOCKS = {
    "for_statement": "for", "while_statement": "while", "if_statement": "if", "elseif_clause": "if",
    "switch_statement": "switch", "try_statement": "try", "break_statement": "break", "continue_statement": "continue",
    "return_statement": "return",
}  # fmt: skip


def of_expression(top: Node) -> Iterator[tuple[str, int, int]]:
    for node in top.walk():
        if what := OURS.get(type(node)):
            yield what, node.start, node.end
        if isinstance(node, (Matrix, Cell)):
            yield from (("element", one.start, one.end) for row in node.parts for one in row.parts)


def of_statement(statement: Statement) -> Iterator[tuple[str, int, int]]:
    for inner in statement.walk():
        match inner:
            case If() | For() | While() | Switch() | Try():
                yield BLOCKS.get(type(inner), "if"), 0, 0
            case Leave():
                yield inner.word, 0, 0
            case Assignment(targets=[_, *_]):
                yield "assignment", inner.start, inner.end
                for step in (step for target in inner.targets for step in target.way):
                    yield from of_expression(step)
        for node in [inner.value, *getattr(inner, "labels", [])]:
            yield from of_expression(node) if node else ()


def ours(text: str) -> Places:
    functions = read(text, "formula.m")
    return Counter(one for of in functions.values() for statement in of.body for one in of_statement(statement))


def theirs(text: str) -> Places:
    tree_sitter = pytest.importorskip("tree_sitter")
    language = pytest.importorskip("tree_sitter_matlab").language()
    data = text.encode()
    root = tree_sitter.Parser(tree_sitter.Language(language)).parse(data).root_node
    if root.has_error:
        pytest.skip("the other reader does not read it")

    def part(what: str, node: Any) -> tuple[str, int, int]:
        return what, len(data[: node.start_byte].decode()), len(data[: node.end_byte].decode())

    found: Places = Counter()
    left = [one for one in root.children if one.type == "function_definition"]  # a script before them is not read
    while left:
        node = left.pop()
        if node.type in ("command", "arguments_statement", "comment", "line_continuation") or is_shown(node):
            continue
        if node.type in THEIR_BLOCKS:
            found[THEIR_BLOCKS[node.type], 0, 0] += 1
        if node.type in THEIRS:
            found[part(THEIRS[node.type], node)] += 1
        if node.type == "assignment":
            found[part("assignment", node)] += 1
        if node.type == "row":
            for child in (one for one in node.named_children if one.type not in ("comment", "line_continuation")):
                found[part("element", child)] += 1
        left += [child for child in node.children if not (node.type == "string" and child.is_named)]
    return found


def is_shown(node: Any) -> bool:
    """Whether a statement shows, draws or checks something, which is no part of a formula: disp(x)."""
    is_statement = node.type == "function_call" and node.parent.type == "block"
    return is_statement and node.named_children[0].text.decode() in COMMANDS


def assert_the_same(text: str) -> None:
    one, other = ours(text), theirs(text)
    assert one == other, {"only ours": sorted(one - other), "only theirs": sorted(other - one)}


FILES = sorted((Path(__file__).parents[1] / "formulas").rglob("*.m"))


@pytest.mark.parametrize("path", FILES, ids=[path.stem for path in FILES])
def test_a_file_has_the_same_parts(path: Path) -> None:
    assert_the_same(decoded(path.read_bytes()))


@pytest.mark.parametrize("program", [one for one in PROGRAMS if one.language == "matlab"], ids=lambda one: one.name)
def test_a_program_has_the_same_parts(program: Program) -> None:
    assert_the_same(program.text)


class Writer:
    """Writes expressions, with blanks where people put them, and where a blank separates two elements."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)

    def blank(self) -> str:
        return self.random.choice(["", "", " "])

    def atom(self, depth: int) -> str:
        choices = [
            lambda: self.random.choice(["a", "q1", "L.a2", "x1"]),
            lambda: self.random.choice(["1", "0.5", "2e-3", ".5", "3."]),
            lambda: f"sin({self.sum(depth - 1)})",
            lambda: f"q({self.random.choice(['1', 'end', 'end-1', ':', '2:3', ':,1'])})",
            lambda: f"({self.sum(depth - 1)})",
            lambda: f"{self.random.choice(['a', 'q(1)', 'R'])}'",
            lambda: self.matrix(depth - 1),
        ]
        return self.random.choice(choices[:2] if depth <= 0 else choices)()

    def sum(self, depth: int) -> str:
        text = self.random.choice(["", "", "-"]) + self.atom(depth)
        for _ in range(self.random.randrange(3)):
            around = self.random.choice(["", " "])
            text += f"{around}{self.random.choice(['+', '-', '*', '.*', '/'])}{around}{self.atom(depth)}"
        return text

    def matrix(self, depth: int) -> str:
        rows = []
        for _ in range(self.random.randint(1, 3)):
            between = self.random.choice([", ", " ", ",", "  "])
            rows.append(between.join(self.sum(depth) for _ in range(self.random.randint(1, 3))))
        return f"[{self.random.choice(['; ', ';', chr(10)]).join(rows)}]"

    def function(self) -> str:
        lines = [f"  J = {self.random.choice([self.sum, self.matrix])(2)};" for _ in range(5)]
        lines.insert(2, f"  if {self.sum(1)} {self.random.choice(['>', '~=', '=='])} {self.sum(1)}")
        return "\n".join(["function J = f(q)", *lines, "  end", "end", ""])


def test_random_expressions_have_the_same_parts() -> None:
    print(f"ARM3R_SEED={SEED}")
    for number in range(200):
        assert_the_same(Writer(SEED + number).function())


@pytest.mark.gate
@pytest.mark.random
def test_many_random_expressions_have_the_same_parts() -> None:
    print(f"ARM3R_SEED={SEED}")
    for number in range(5_000):
        assert_the_same(Writer(1_000_000 + SEED + number).function())
