"""Reads MATLAB function files in the style of the lecture and of students.

Read are assignments, arithmetic, matrices, cell arrays, structures, anonymous functions, `for`, `if` and local
functions.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from ...errors import UnjudgedError
from .nodes import Node, line_and_column

_TOKEN = re.compile(
    r"(?P<blank>[ \t]+|\.\.\.[^\n]*\n)|(?P<comment>%[^\n]*)|(?P<newline>\n)"
    r"|(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?)(?![A-Za-z_])"
    r"|(?P<name>[A-Za-z]\w*(?:\.[A-Za-z]\w*)*)"  # p.a2 is the name of a field
    r"|(?P<operator>\.\*|\./|\.\^|\.'|==|~=|<=|>=|&&|\|\||[-+*/\\^'=(),;:\[\]{}@<>&|~])"
)
_REFUSED = frozenset(
    [
        "while",
        "switch",
        "case",
        "otherwise",
        "try",
        "catch",
        "parfor",
        "global",
        "persistent",
        "return",
        "break",
        "continue",
        "classdef",
        "import",
        "load",
        "save",
        "eval",
        "feval",
    ]
)
_KEYWORDS = frozenset([*_REFUSED, "for", "if", "else", "elseif", "end", "function"])
KNOWN = "known are assignments, arithmetic, matrices, cell arrays, structures, handles, `for`, `if` and functions"
MAX_CHARACTERS = 200_000
MAX_DEPTH = 150


_COMPARISONS = ("==", "~=", "<", "<=", ">", ">=")
_LOGIC = (("||",), ("&&",), ("|",), ("&",))
"""From the loosest to the tightest."""
_CLOSING = {"(": ")", "{": "}"}
_CLOSING_OF_MATRIX = {"[": "]", "{": "}"}


class Token(NamedTuple):
    kind: str
    text: str
    start: int
    end: int
    spaced: bool
    """Whether a blank stands before it."""


@dataclass
class Statement:
    """`targets = value`; a target is a name, with the node of its index where it has one.

    With a body it is the loop `for target = value`, and without targets the condition `if value`.
    """

    targets: list[tuple[str, Node | None]]
    value: Node
    start: int
    end: int
    body: list[Statement] | None = None
    otherwise: list[Statement] = field(default_factory=list)

    def walk(self) -> Iterator[Statement]:
        """The statement and those in its body."""
        yield self
        for inner in (*(self.body or ()), *self.otherwise):
            yield from inner.walk()


@dataclass
class Function:
    name: str
    outputs: list[str]
    inputs: list[str]
    line: int
    body: list[Statement] = field(default_factory=list)


def read(text: str, file: str) -> dict[str, Function]:
    """The functions of a file by their names, in their order.

    Raises:
        UnjudgedError: the file holds what is not read; the message names its line.
    """
    if len(text) > MAX_CHARACTERS:
        raise UnjudgedError(f"{file}: a function file of at most {MAX_CHARACTERS} characters is read, got {len(text)}")
    reader = _Reader(text, file)
    try:
        return reader.functions()
    except RecursionError:
        raise reader.refusal("what stands here is nested too deeply, and is not read") from None


def read_expression(text: str, file: str = "expression") -> Node:
    """A single expression."""
    reader = _Reader(text, file)
    node = reader.expression()
    if reader.peek().kind != "end":
        raise reader.refusal("the expression does not end here")
    return node


def _blank_block_comments(text: str) -> str:
    """The text with the comments between %{ and %} as blanks, so that all places stay."""
    block = re.compile(r"^[ \t]*%\{[ \t]*$.*?^[ \t]*%\}[ \t]*$", re.M | re.S)
    return block.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)


class _Reader:
    """A recursive descent over the tokens; inside brackets a blank can separate elements."""

    def __init__(self, text: str, file: str) -> None:
        self.text, self.file = text, file
        self.tokens = self._scan(_blank_block_comments(text).replace("\r", " "))
        self.at = 0
        self.inside: list[str] = []
        self.depth = 0

    def _scan(self, text: str) -> list[Token]:
        tokens, at, spaced = [], 0, False
        while at < len(text):
            found = _TOKEN.match(text, at)
            if not found:
                line, column = line_and_column(text, at)
                raise UnjudgedError(f"{self.file}:{line}:{column}: {text[at]!r} is not read; {KNOWN}")
            kind = found.lastgroup or ""
            if kind in ("blank", "comment"):
                spaced = True
            else:
                tokens.append(Token(kind, found[0], at, found.end(), spaced))
                spaced = False
            at = found.end()
        return [*tokens, Token("end", "the end of the file", len(text), len(text), False)]

    def peek(self, ahead: int = 0) -> Token:
        return self.tokens[min(self.at + ahead, len(self.tokens) - 1)]

    def next(self) -> Token:
        token = self.peek()
        self.at += 1
        return token

    def refusal(self, message: str, token: Token | None = None) -> UnjudgedError:
        line, column = line_and_column(self.text, (token or self.peek()).start)
        return UnjudgedError(f"{self.file}:{line}:{column}: {message}")

    def expect(self, text: str) -> Token:
        if self.peek().text != text:
            raise self.refusal(f"{text!r} is needed here, got {self.peek().text!r}")
        return self.next()

    def skip_separators(self) -> None:
        while self.peek().kind == "newline" or self.peek().text in (";", ","):
            self.next()

    # ---- functions and statements ------------------------------------------------------------------------------------

    def functions(self) -> dict[str, Function]:
        found: dict[str, Function] = {}
        self.skip_separators()
        while self.peek().kind != "end":
            if self.peek().text != "function":
                raise self.refusal(f"a function file begins with `function`, got {self.peek().text!r}")
            function = self.function()
            if function.name in found:
                raise self.refusal(f"there are two functions {function.name}")
            found[function.name] = function
            self.skip_separators()
        if not found:
            raise UnjudgedError(f"{self.file}:1: there is no function in this file")
        return found

    def function(self) -> Function:
        line, _ = line_and_column(self.text, self.next().start)
        if self.peek().text == "[":
            self.next()
            outputs = self.names("]")
            self.expect("=")
            name = self.name()
        else:
            name = self.name()
            outputs = []
            if self.peek().text == "=":
                self.next()
                outputs, name = [name], self.name()
        inputs = []
        if self.peek().text == "(":
            self.next()
            inputs = self.names(")")
        function = Function(name, outputs, inputs, line)
        function.body = self.statements()
        if self.peek().text == "end":
            self.next()
        return function

    def statements(self) -> list[Statement]:
        """Those up to `end`, `else`, the next function or the end of the file."""
        found = []
        self.skip_separators()
        while self.peek().text not in ("end", "else", "elseif", "function") and self.peek().kind != "end":
            found.append(self.statement())
            self.skip_separators()
        return found

    def names(self, closing: str) -> list[str]:
        names = []
        while self.peek().text != closing:
            names.append(self.name())
            if self.peek().text == ",":
                self.next()
        self.next()
        return names

    def name(self) -> str:
        token = self.next()
        if token.kind != "name" or token.text in _KEYWORDS:
            raise self.refusal(f"a name is needed here, got {token.text!r}", token)
        return token.text

    def statement(self) -> Statement:
        start = self.peek()
        if start.text in _REFUSED:
            remedy = "write the numbers into the file, or make them arguments" if start.text == "global" else KNOWN
            raise self.refusal(f"`{start.text}` is not read; {remedy}")
        if start.text in ("for", "if"):
            self.depth += 1
            if self.depth > MAX_DEPTH:
                raise self.refusal(f"loops and conditions are nested more than {MAX_DEPTH} deep")
            found = self.loop() if start.text == "for" else self.condition()
            self.depth -= 1
            return found
        targets: list[tuple[str, Node | None]] = []
        if start.text == "[":
            self.next()
            targets = [(name, None) for name in self.names("]")]
        elif start.kind == "name":
            name, index = self.name(), None
            if self.peek().text in _CLOSING:
                opening = self.next()
                index = Node("index", opening.start, 0, self.arguments(_CLOSING[opening.text]), opening.text)
                index.end = self.tokens[self.at - 1].end
            targets = [(name, index)]
        if not targets or self.peek().text != "=":
            raise self.refusal("only assignments are read: a name, `=` and a value are needed here", start)
        self.next()
        value = self.expression()
        if self.peek().kind not in ("newline", "end") and self.peek().text not in (";", ","):
            raise self.refusal(f"the expression goes on with {self.peek().text!r}, which is not read")
        return Statement(targets, value, start.start, value.end)

    def loop(self) -> Statement:
        """for i = 1:3, for (i = 1:3)"""
        start = self.next()
        has_brackets = self.peek().text == "("
        if has_brackets:
            self.next()
        name = self.name()
        self.expect("=")
        value = self.expression()
        if has_brackets:
            self.expect(")")
        body = self.statements()
        end = self.expect("end")
        return Statement([(name, None)], value, start.start, end.end, body)

    def condition(self) -> Statement:
        """if a > 0, then `elseif`, which is a condition in the other branch, and `else`."""
        start = self.next()
        value = self.expression()
        body, otherwise = self.statements(), []
        if self.peek().text == "elseif":
            self.depth += 1
            if self.depth > MAX_DEPTH:
                raise self.refusal(f"loops and conditions are nested more than {MAX_DEPTH} deep")
            otherwise = [self.condition()]
            self.depth -= 1
            return Statement([], value, start.start, otherwise[0].end, body, otherwise)
        if self.peek().text == "else":
            self.next()
            otherwise = self.statements()
        end = self.expect("end")
        return Statement([], value, start.start, end.end, body, otherwise)

    # ---- expressions -------------------------------------------------------------------------------------------------

    def expression(self) -> Node:
        """Comparisons of ranges or sums, joined by `||`, `&&`, `|` and `&`."""
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise self.refusal(f"the expression is nested more than {MAX_DEPTH} deep")
        found = self.logic(0)
        self.depth -= 1
        return found

    def logic(self, level: int) -> Node:
        if level == len(_LOGIC):
            return self.chain(_COMPARISONS, self.range, "compare")
        return self.chain(_LOGIC[level], lambda: self.logic(level + 1), "logic")

    def range(self) -> Node:
        """Sums; colons between sums make a range, first:last or first:step:last."""
        parts, colon = [self.sum()], self.peek()
        while self.peek().text == ":" and len(parts) < 3 and not self.ends_element():
            self.next()
            parts.append(self.sum())
        if len(parts) == 1:
            return parts[0]
        return Node("range", parts[0].start, parts[-1].end, tuple(parts), ":", colon.start)

    def ends_element(self) -> bool:
        """Whether a blank before the next token separates two elements of a matrix: [a -b] but not [a - b]."""
        token = self.peek()
        if not self.inside or self.inside[-1] == "(" or not token.spaced:
            return False
        return not (token.text in ("+", "-") and self.peek(1).spaced) and token.text not in (
            "*",
            "/",
            "\\",
            "^",
            ".*",
            "./",
            ".^",
            *_COMPARISONS,
            *(word for words in _LOGIC for word in words),
        )

    def chain(self, operators: tuple[str, ...], part: Callable[[], Node], kind: str = "binary") -> Node:
        left = part()
        while self.peek().text in operators and not self.ends_element():
            token = self.next()
            right = part()
            left = Node(kind, left.start, right.end, (left, right), token.text, token.start)
        return left

    def sum(self) -> Node:
        return self.chain(("+", "-"), self.product)

    def product(self) -> Node:
        return self.chain(("*", "/", "\\", ".*", "./"), self.signed)

    def signed(self) -> Node:
        if self.peek().text in ("+", "-", "~"):
            token = self.next()
            self.depth += 1
            if self.depth > MAX_DEPTH:
                raise self.refusal(f"the expression is nested more than {MAX_DEPTH} deep")
            inner = self.signed()
            self.depth -= 1
            kind = "not" if token.text == "~" else "unary"
            return Node(kind, token.start, inner.end, (inner,), token.text, token.start)
        return self.power()

    def power(self) -> Node:
        left = self.postfix()
        while self.peek().text in ("^", ".^") and not self.ends_element():
            token = self.next()
            if self.peek().text in ("+", "-"):
                sign = self.next()
                inner = self.postfix()
                right = Node("unary", sign.start, inner.end, (inner,), sign.text, sign.start)
            else:
                right = self.postfix()
            left = Node("binary", left.start, right.end, (left, right), token.text, token.start)
        return left

    def postfix(self) -> Node:
        node = self.atom()
        while self.peek().text in ("'", ".'") and not self.peek().spaced:
            token = self.next()
            node = Node("transpose", node.start, token.end, (node,), "'", token.start)
        return node

    def atom(self) -> Node:
        token = self.next()
        if token.kind == "number":
            return Node("number", token.start, token.end, (), token.text)
        if token.text == "(":
            self.inside.append("(")
            inner = self.expression()
            self.inside.pop()
            closing = self.expect(")")
            return Node("group", token.start, closing.end, (inner,))
        if token.text in ("[", "{"):
            return self.matrix(token)
        if token.text == "@":
            return self.handle(token)
        if token.text == "end" and self.inside:
            return Node("last", token.start, token.end, (), "end")
        if token.kind == "name" and token.text not in _KEYWORDS:
            node = Node("name", token.start, token.end, (), token.text)
            while self.peek().text in _CLOSING and not self.ends_element() and (node.kind == "name" or node.info):
                node = self.call(node, token)
            return node
        raise self.refusal(f"a value is needed here, got {token.text!r}", token)

    def call(self, node: Node, name: Token) -> Node:
        """f(x), or the element T{i} of a cell array, which can be indexed further."""
        opening = self.next()
        if opening.text == "{" and node.kind != "name":
            raise self.refusal("an element of an element of a cell array is not read", opening)
        parts = self.arguments(_CLOSING[opening.text])
        end = self.tokens[self.at - 1].end
        if opening.text == "{":
            return Node("call", node.start, end, parts, name.text, name.start, "element")
        if node.kind == "name":
            return Node("call", node.start, end, parts, name.text, name.start)
        return Node("part", node.start, end, (node, *parts))

    def handle(self, sign: Token) -> Node:
        """@(x, y) an expression of x and y."""
        if self.peek().text != "(":
            raise self.refusal("`@` is followed by the arguments in brackets, as in @(t)")
        self.next()
        names = self.names(")")
        self.inside.append("(")
        body = self.expression()
        self.inside.pop()
        return Node("handle", sign.start, body.end, (body,), "@", sign.start, tuple(names))

    def arguments(self, closing: str) -> tuple[Node, ...]:
        parts: list[Node] = []
        self.inside.append("(")
        while self.peek().text != closing:
            if self.peek().text == ":" and self.peek(1).text in (",", closing):
                token = self.next()
                parts.append(Node("all", token.start, token.end))
            else:
                parts.append(self.expression())
            if self.peek().text == ",":
                self.next()
            elif self.peek().text != closing:
                raise self.refusal(f"',' or {closing!r} is needed here, got {self.peek().text!r}")
        self.next()
        self.inside.pop()
        return tuple(parts)

    def matrix(self, opening: Token) -> Node:
        """Rows are separated by semicolons or new lines, elements by commas or blanks; {} is a cell array."""
        rows: list[Node] = []
        row: list[Node] = []
        self.inside.append(opening.text)
        while self.peek().text != _CLOSING_OF_MATRIX[opening.text]:
            token = self.peek()
            if token.kind == "end":
                raise self.refusal("the matrix is not closed", opening)
            if token.text == ";" or token.kind == "newline":
                self.next()
                if row:
                    rows.append(Node("row", row[0].start, row[-1].end, tuple(row)))
                row = []
            elif token.text == ",":
                self.next()
            else:
                row.append(self.expression())
        if row:
            rows.append(Node("row", row[0].start, row[-1].end, tuple(row)))
        self.inside.pop()
        closing = self.next()
        return Node("matrix" if opening.text == "[" else "cell", opening.start, closing.end, tuple(rows))
