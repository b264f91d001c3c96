"""The parts of a Python text: its function, its constants, and the nodes that can be edited."""

from __future__ import annotations

import ast
import re
from collections import Counter

from ..errors import UsageError
from .expressions import (
    Binary,
    Compare,
    FunctionCall,
    Index,
    Matrix,
    Name,
    Node,
    Number,
    Other,
    Root,
    Transpose,
    Unary,
)
from .programs import Constant
from .python_functions import Function, assigned, functions_of
from .python_program import PythonProgram, number_in, pairs

_OPERATORS = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**", ast.MatMult: "@", ast.Mod: "%",
    ast.FloorDiv: "//",
}  # fmt: skip

_METHODS = ("transpose", "copy", "reshape", "dot")
"""Of arrays: what stands before them is a part that is edited."""
_COMPARISONS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}


def _inner_expressions(node: ast.AST) -> list[ast.expr]:
    """The expressions of a statement that are no value of it: of loops and conditions, indices, arguments by name."""
    if isinstance(node, (ast.If, ast.While)):
        return [node.test]
    if isinstance(node, (ast.For, ast.comprehension)):
        return [node.iter, *getattr(node, "ifs", ())]
    if isinstance(node, ast.keyword):
        return [node.value]
    targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AugAssign) else []
    return [target.slice for target in targets if isinstance(target, ast.Subscript)]


class PythonText:
    """A Python text that is parsed and not run."""

    def __init__(self, text: str, file: str = "<formula>") -> None:
        self.text, self.file = text, file
        try:
            self.tree = ast.parse(text)
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            line = getattr(error, "lineno", None) or 1
            raise UsageError(f"{file}:{line}: this is not Python: {getattr(error, 'msg', error)}") from None
        self._place = PythonProgram(text, "").offset
        self.functions: dict[str, Function] = functions_of(self.tree)
        self.assigned = {name: made for name, made in assigned(self.tree).items() if name not in self.functions}
        """Names that may be functions or formulas once the text is run; whether a maker of functions made them."""

    def arguments(self, function: str) -> tuple[list[str], dict[str, float]]:
        """The names of a function's arguments, and the numbers that some of them have by default."""
        given = self.functions[function]
        if given.node.args.vararg and not given.names:
            return ["*"], {}
        numbers = {name: number_in(value) for name, value in given.defaults.items()}
        return given.names, {name: value for name, value in numbers.items() if value is not None}

    def keywords(self, function: str) -> list[str]:
        """The names of the arguments that are given by keyword alone."""
        return [one.arg for one in self.functions[function].node.args.kwonlyargs]

    def optional(self, function: str) -> list[str]:
        """The names of the arguments that have a default."""
        return list(self.functions[function].defaults)

    def numbers_of_arguments(self) -> list[Node]:
        """The numbers that arguments of any function have by default."""
        every = [node for node in ast.walk(self.tree) if isinstance(node, ast.arguments)]
        values = [value for one in every for value in (*one.defaults, *one.kw_defaults) if value is not None]
        return [node for node in map(self._node, values) if isinstance(node, Number)]

    def line(self, function: str) -> int:
        """Where a function begins, or a name is assigned first."""
        if function in self.functions:
            return self.functions[function].node.lineno
        return next(
            (one.lineno for statement in self.tree.body for one, _ in pairs(statement) if one.id == function), 1
        )

    def comments(self, function: str) -> str:
        """The docstring of a function and the text's comments."""
        words = [line.split("#", 1)[1] for line in self.text.splitlines() if "#" in line]
        node = self.functions[function].node if function in self.functions else None
        return " ".join([(ast.get_docstring(node) if isinstance(node, ast.FunctionDef) else None) or "", *words])

    def constants(self) -> list[Constant]:
        """The names that are assigned once, and a number."""
        stored = [
            node.id for node in ast.walk(self.tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
        ]
        stored += [node.arg for node in ast.walk(self.tree) if isinstance(node, ast.arg)]
        count = Counter(stored)
        changed = {
            node.target.id
            for node in ast.walk(self.tree)
            if isinstance(node, ast.AugAssign) and isinstance(node.target, ast.Name)
        }
        found = []
        for statement in ast.walk(self.tree):
            for target, value in pairs(statement):
                number = number_in(value)
                if number is not None and count[target.id] == 1 and target.id not in changed:
                    found.append(Constant(target.id, number, *self._span(value)))
        names_of = Counter(one.start for one in found)
        ends = re.compile(r"[ \t]*([\n;#]|$)")  # so that `a2 = a3 = 1` can be two numbers
        return [one for one in found if names_of[one.start] == 1 or ends.match(self.text, one.end)]

    def returned_names(self, function: str) -> list[str]:
        """The names in `return t3, t2, t1`; "" for what has none."""
        if function not in self.functions:
            return []
        returns = [node for node in ast.walk(self.functions[function].node) if isinstance(node, ast.Return)]
        if len(returns) == 1 and isinstance(returns[0].value, ast.Tuple):
            names = [one.id if isinstance(one, ast.Name) else "" for one in returns[0].value.elts]
            return names if any(names) else []
        return []

    def nodes(self) -> list[Node]:
        """The expressions of all statements, the outermost ones."""
        found: list[Node] = []
        for statement in ast.walk(self.tree):
            if isinstance(statement, (ast.Assign, ast.AnnAssign, ast.AugAssign, ast.Return, ast.Expr)):
                value = statement.value
                if value is not None and not (isinstance(value, ast.Constant) and isinstance(value.value, str)):
                    start, end = self._span(statement)
                    found.append(Root(start, end, (self._node(value),)))
            for inner in _inner_expressions(statement):
                found.append(Root(*self._span(inner), (self._node(inner),)))
        return found

    def _span(self, node: ast.AST) -> tuple[int, int]:
        start = self._place(node.lineno, node.col_offset)  # type: ignore[attr-defined]
        return start, self._place(node.end_lineno, node.end_col_offset)  # type: ignore[attr-defined]

    def _node(self, node: ast.expr) -> Node:
        start, end = self._span(node)
        text, make = self.text[start:end], self._node
        match node:
            case ast.Name(id=word):
                return Name(start, end, (), word)
            case ast.Constant(value=value) if type(value) in (int, float):
                return Number(start, end, (), text)
            case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=operand):
                return Unary(start, end, (make(operand),), text[0], start)
            case ast.BinOp(left=left, op=sign, right=right) if type(sign) in _OPERATORS:
                return Binary(start, end, *self._sides(left, _OPERATORS[type(sign)], right))
            case ast.Compare(left=left, ops=[sign], comparators=[right]) if type(sign) in _COMPARISONS:
                return Compare(start, end, *self._sides(left, _COMPARISONS[type(sign)], right))
            case ast.Call(func=ast.Attribute(value=value) as function, args=given) if function.attr in _METHODS:
                parts = (make(value), *(make(one) for one in given))
                return Other(start, end, parts, self.text[slice(*self._span(function))])
            case ast.Call(func=called, args=given):
                name = self._span(called)
                return FunctionCall(start, end, tuple(make(one) for one in given), self.text[slice(*name)], name[0])
            case ast.Subscript(value=value, slice=index):
                return Index(start, end, (make(value), make(index)), text)
            case ast.Attribute(value=value, attr="T"):
                return Transpose(start, end, (make(value),), ".T")
            case ast.Attribute():
                return Other(start, end, (), text)
            case ast.List(elts=elements) | ast.Tuple(elts=elements):
                return Matrix(start, end, tuple(make(one) for one in elements))
        inner = [make(child) for child in ast.iter_child_nodes(node) if isinstance(child, ast.expr)]
        return Other(start, end, tuple(inner), text)

    def _sides(self, left: ast.expr, word: str, right: ast.expr) -> tuple[tuple[Node, Node], str, int]:
        """Both sides of an operator, the operator, and where it begins."""
        sides = (self._node(left), self._node(right))
        between = self.text[sides[0].end : sides[1].start]
        return sides, word, sides[0].end + max(between.find(word), 0)
