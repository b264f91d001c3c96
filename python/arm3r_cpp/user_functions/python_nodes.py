"""The parts of a Python text: its function, its constants, and the nodes that can be edited."""

from __future__ import annotations

import ast
from collections import Counter

from ..errors import UsageError
from .nodes import Constant, Node
from .python_functions import Function, assigned, functions_of
from .python_program import PythonProgram, number_in, pairs

_OPERATORS = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**", ast.MatMult: "@", ast.Mod: "%",
    ast.FloorDiv: "//",
}  # fmt: skip

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

    def optional(self, function: str) -> list[str]:
        """The names of the arguments that have a default."""
        return list(self.functions[function].defaults)

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
        return [one for one in found if names_of[one.start] == 1]  # `a2 = a3 = 1` is one number for both

    def returned_names(self, function: str) -> list[str]:
        """The names in `return t3, t2, t1`."""
        if function not in self.functions:
            return []
        returns = [node for node in ast.walk(self.functions[function].node) if isinstance(node, ast.Return)]
        if len(returns) == 1 and isinstance(returns[0].value, ast.Tuple):
            names = returns[0].value.elts
            if all(isinstance(name, ast.Name) for name in names):
                return [name.id for name in names]  # type: ignore[attr-defined]
        return []

    def nodes(self) -> list[Node]:
        """The expressions of all statements, the outermost ones."""
        found = []
        for statement in ast.walk(self.tree):
            if isinstance(statement, (ast.Assign, ast.AnnAssign, ast.AugAssign, ast.Return, ast.Expr)):
                value = statement.value
                if value is not None and not (isinstance(value, ast.Constant) and isinstance(value.value, str)):
                    start, end = self._span(statement)
                    found.append(Node("assign", start, end, (self._node(value),)))
            for inner in _inner_expressions(statement):
                found.append(Node("assign", *self._span(inner), (self._node(inner),)))
        return found

    def _span(self, node: ast.AST) -> tuple[int, int]:
        start = self._place(node.lineno, node.col_offset)  # type: ignore[attr-defined]
        return start, self._place(node.end_lineno, node.end_col_offset)  # type: ignore[attr-defined]

    def _node(self, node: ast.expr) -> Node:
        start, end = self._span(node)
        make = self._node
        if isinstance(node, ast.Name):
            return Node("name", start, end, (), node.id)
        if isinstance(node, ast.Constant):
            kind = "number" if type(node.value) in (int, float) else "other"
            return Node(kind, start, end, (), self.text[start:end])
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.UAdd)):
            return Node("unary", start, end, (make(node.operand),), self.text[start], start)
        if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
            word, sides = _OPERATORS[type(node.op)], (make(node.left), make(node.right))
            between = self.text[sides[0].end : sides[1].start]
            return Node("binary", start, end, sides, word, sides[0].end + max(between.find(word), 0))
        if isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in _COMPARISONS:
            word, sides = _COMPARISONS[type(node.ops[0])], (make(node.left), make(node.comparators[0]))
            between = self.text[sides[0].end : sides[1].start]
            return Node("compare", start, end, sides, word, sides[0].end + max(between.find(word), 0))
        if isinstance(node, ast.Call):
            name = self._span(node.func)
            word = self.text[slice(*name)]
            if word.endswith((".transpose", ".copy", ".reshape", ".dot")) and isinstance(node.func, ast.Attribute):
                parts = (make(node.func.value), *(make(one) for one in node.args))
                return Node("other", start, end, parts, word)
            return Node("call", start, end, tuple(make(one) for one in node.args), word, name[0])
        if isinstance(node, ast.Subscript):
            return Node("index", start, end, (make(node.value), make(node.slice)), self.text[start:end])
        if isinstance(node, ast.Attribute) and node.attr == "T":
            return Node("transpose", start, end, (make(node.value),), ".T")
        if isinstance(node, (ast.List, ast.Tuple)):
            return Node("matrix", start, end, tuple(make(one) for one in node.elts))
        if isinstance(node, ast.Attribute):
            return Node("other", start, end, (), self.text[start:end])
        inner = [make(child) for child in ast.iter_child_nodes(node) if isinstance(child, ast.expr)]
        return Node("other", start, end, tuple(inner), self.text[start:end])
