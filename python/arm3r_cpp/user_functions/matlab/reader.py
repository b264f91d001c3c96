"""Reads MATLAB function files in the style of the lecture and of students: the grammar.

file        = [script] function ...
function    = "function" [outputs "="] name ["(" names ")"] [arguments] statement ... ["end"]
statement   = for | parfor | while | if | switch | try | "break" | "continue" | "return" | persistent | command
            | [targets "="] expression
expression  = or of and of comparisons of ranges of sums of products of signed powers of postfix values
value       = number | text | name | "(" expression ")" | matrix | cell | handle, each with indices and fields
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace

from ...errors import UnjudgedError, UnreadError
from ..expressions import (
    All,
    AnonymousFunction,
    Binary,
    Cell,
    Compare,
    Element,
    Field,
    FunctionCall,
    FunctionHandle,
    Group,
    Index,
    Last,
    Logic,
    Matrix,
    Name,
    Node,
    Not,
    Number,
    Part,
    Range,
    Row,
    Text,
    Transpose,
    Unary,
)
from ..programs import line_and_column
from .syntax import Assignment, For, Function, If, Kept, Leave, Statement, Switch, Target, Try, While
from .tokens import KNOWN, Token, tokens_of

_REMEDIES = {
    "classdef": "write the method as a function of the joint angles",
    "load": "write the numbers into the file",
    "syms": "write the symbols at the head of a script, or make a function by matlabFunction(..., 'File', 'name')",
}
_REFUSED = frozenset(["spmd", "classdef", "import", "load", "save", "eval", "evalin", "assignin", "syms"])
_LEAVES = frozenset(["break", "continue", "return"])
_BLOCKS = frozenset(["for", "parfor", "while", "if", "switch", "try"])
_STOPS = frozenset(["end", "else", "elseif", "case", "otherwise", "catch", "function"])
_KEYWORDS = _REFUSED | _LEAVES | _BLOCKS | _STOPS | {"persistent", "global"}
# What they print, draw or set changes no value.
_SHOWING = "disp display fprintf printf plot plot3 figure close hold grid axis legend title view drawnow fflush"
_SETTING = "clc clear clearvars format more warning tic toc pause beep rng addpath rmpath pkg mlock"
_CHECKING = "narginchk nargoutchk validateattributes"
_OF_SYMBOLS = "pretty latex ccode fortran assume assumeAlso digits matlabFunction"
COMMANDS = frozenset(f"{_SHOWING} {_SETTING} {_CHECKING} {_OF_SYMBOLS} xlabel ylabel zlabel".split())
_ASSUMPTIONS = frozenset(["real", "positive", "integer", "rational", "clear"])
MAX_CHARACTERS = 2_000_000
MAX_DEPTH = 150


_COMPARISONS = ("==", "~=", "<", "<=", ">", ">=")
_LOGIC = (("||",), ("&&",), ("|",), ("&",))
"""From the loosest to the tightest."""
_ARITHMETIC = frozenset(["*", "/", "\\", "^", ".*", "./", ".\\", ".^", *_COMPARISONS, "||", "&&", "|", "&"])
_CLOSING = {"(": ")", "{": "}"}
_CLOSING_OF_MATRIX = {"[": "]", "{": "}"}


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


def _at(place: Node, node: Node) -> Node:
    """A node with all in it at the place of another one."""
    return replace(node, start=place.start, end=place.end, parts=tuple(_at(place, one) for one in node.parts))


class _Reader:
    """A recursive descent over the tokens; inside brackets a blank can separate elements."""

    def __init__(self, text: str, file: str) -> None:
        self.text, self.file = text, file
        self.tokens = tokens_of(text, file)
        self.at = 0
        self.inside: list[str] = []
        self.depth = 0
        self.has_ends = _functions_have_ends(self.tokens)
        self.found: dict[str, Function] = {}
        self.symbols: list[str] | None = None
        """Of a symbolic script, while it is read."""
        self.written: set[str] = set()
        """The variables that it writes into files by matlabFunction."""

    def peek(self, ahead: int = 0) -> Token:
        place = self.at + ahead
        return self.tokens[place] if place < len(self.tokens) else self.tokens[-1]

    def next(self) -> Token:
        token = self.peek()
        self.at += 1
        return token

    def takes(self, text: str) -> bool:
        """Whether this token is next; then it is passed."""
        is_next = self.peek().text == text and self.peek().kind != "text"
        self.at += is_next
        return is_next

    def refusal(self, message: str, token: Token | None = None) -> UnjudgedError:
        line, column = line_and_column(self.text, (token or self.peek()).start)
        return UnreadError(f"{self.file}:{line}:{column}: {message}", line=line, reason=message)

    def expect(self, text: str) -> Token:
        if self.peek().text != text:
            raise self.refusal(f"{text!r} is needed here, got {self.peek().text!r}")
        return self.next()

    @contextmanager
    def deeper(self, what: str) -> Iterator[None]:
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise self.refusal(f"{what} nested more than {MAX_DEPTH} deep")
        yield
        self.depth -= 1

    def is_at_end_of_statement(self) -> bool:
        token = self.peek()
        return token.kind in ("newline", "end") or (token.kind == "operator" and token.text in (";", ","))

    def skip_separators(self) -> None:
        while self.peek().kind != "end" and self.is_at_end_of_statement():
            self.next()

    # ---- functions and statements ------------------------------------------------------------------------------------

    def functions(self) -> dict[str, Function]:
        self.skip_separators()
        first = self.peek()
        if self.is_symbolic():
            self.script()
        elif first.text in _REFUSED:
            raise self.not_read(first)
        while self.peek().kind != "end" and not self.is_at_function():
            self.next()  # a script, which may stand before its functions
        if first.kind != "end" and self.peek().kind == "end" and not self.found:
            raise self.refusal(
                "this is a script: what is judged is a function of the joint angles, `function J = jacobian(q)`", first
            )
        while self.peek().kind != "end":
            if self.peek().text != "function":
                raise self.refusal(f"`function` is needed here, got {self.peek().text!r}")
            self.function(is_nested=False)
            self.skip_separators()
        if not self.found:
            raise UnjudgedError(f"{self.file}:1: there is no function in this file")
        return self.found

    def is_symbolic(self) -> bool:
        """Whether a script declares symbols before the first function."""
        for token in self.tokens:
            if token.text == "function" and token.kind == "name":
                return False
            if token.kind == "name" and token.text in ("syms", "sym"):
                return True
        return False

    def script(self) -> None:
        """Each variable of it becomes a function of the symbols that it is made of."""
        self.symbols = []
        body = [statement for statement in self.statements() if not self.makes_symbol(statement)]
        names = dict.fromkeys(name for statement in body for name in _given_in(statement))
        for name in sorted(names, key=self.written.__contains__):  # what is written into a file last
            needed = _needed_for(name, body)
            line, _ = line_and_column(self.text, needed[-1].start)
            inputs = _symbols_in(needed, self.symbols)
            self.found[name] = Function(name, [name], inputs, line, needed, is_script=True)
        self.symbols = None

    def declare_symbols(self) -> None:
        """`syms q1 q2 real`"""
        assert self.symbols is not None
        self.next()
        while not self.is_at_end_of_statement():
            token = self.next()
            if token.kind != "name" or (self.peek().text in ("(", "[") and not self.peek().spaced):
                raise self.refusal("a symbol that is a function or a matrix, such as q1(t), is not read; "
                                   "declare q1 and its rate dq1 as symbols of their own", token)  # fmt: skip
            if token.text not in _ASSUMPTIONS:
                self.symbols.append(token.text)

    def makes_symbol(self, statement: Statement) -> bool:
        """`q1 = sym('q1')`; `q = sym('q', [3 1])` becomes `q = [q1; q2; q3]`."""
        assert self.symbols is not None
        if not isinstance(statement, Assignment) or len(statement.targets) != 1:
            return False
        value, target = statement.value, statement.targets[0]
        if not (isinstance(value, FunctionCall) and value.word == "sym" and not target.way):
            return False
        is_own = bool(value.parts) and isinstance(value.parts[0], Text) and value.parts[0].word == target.name
        if is_own and len(value.parts) > 1 and not isinstance(value.parts[1], Text):
            size = re.fullmatch(r"\[ *(\d)(?: +| *, *)(\d) *\]", self.text[value.parts[1].start : value.parts[1].end])
            if size is None or "1" not in size.groups():
                raise self.refusal("of several symbols at once a column or a row is read, sym('q', [3 1])")
            names = [f"{target.name}{number + 1}" for number in range(max(map(int, size.groups())))]
            self.symbols += names
            statement.value = _at(value, read_expression(f"[{(';' if size[2] == '1' else ' ').join(names)}]"))
            return False
        if is_own:
            self.symbols.append(target.name)
        return is_own

    def is_at_function(self) -> bool:
        return self.peek().text == "function" and (self.at == 0 or self.tokens[self.at - 1].kind == "newline")

    def not_read(self, token: Token) -> UnjudgedError:
        return self.refusal(f"`{token.text}` is not read; {_REMEDIES.get(token.text, KNOWN)}", token)

    def function(self, is_nested: bool) -> None:
        line, _ = line_and_column(self.text, self.next().start)
        outputs: list[str] = []
        if self.takes("["):
            outputs = self.names("]")
            self.expect("=")
            name = self.name()
        else:
            name = self.name()
            if self.takes("="):
                outputs, name = [name], self.name()
        inputs = self.names(")") if self.takes("(") else []
        function = Function(name, outputs, inputs, line, is_nested=is_nested)
        if name in self.found:
            raise self.refusal(f"there are two functions {name}")
        self.found[name] = function
        self.skip_separators()
        while self.peek().text == "arguments" and self.peek(1).kind in ("newline", "operator"):
            self.block_of_arguments(function)
        with self.deeper("functions are"):
            function.body = self.statements()
        self.takes("end")

    def block_of_arguments(self, function: Function) -> None:
        """`name (sizes) class {validators} = default`, a line each: the defaults are read."""
        self.next()
        depth, name = 0, ""
        while not (self.peek().text == "end" and depth == 0):
            token = self.next()
            if token.kind == "end":
                raise self.refusal("the block `arguments` is not closed", token)
            depth += (token.text in "([{") - (token.text in ")]}") if token.kind == "operator" else 0
            if token.kind == "name" and self.tokens[self.at - 2].kind == "newline":
                name = token.text
            if token.text == "=" and depth == 0:
                function.defaults[name] = self.expression()
        self.next()
        self.skip_separators()

    def statements(self) -> list[Statement]:
        """Those up to a word that ends or goes on with a block, or the next function."""
        found = []
        self.skip_separators()
        while self.peek().kind != "end":
            if self.peek().text == "function" and self.has_ends and self.symbols is None:
                self.function(is_nested=True)
            elif self.peek().text == "syms" and self.symbols is not None:
                self.declare_symbols()
            elif self.peek().kind == "name" and self.peek().text in _STOPS:
                break
            elif self.is_command():
                self.skip_command()
            else:
                found.append(self.statement())
            self.skip_separators()
        return found

    def is_command(self) -> bool:
        """Whether a statement prints, draws or sets; a variable may have the same name."""
        if self.peek().text not in COMMANDS:
            return False
        ahead, depth = 1, 0
        while self.peek(ahead).text == "(" or depth:
            depth += (self.peek(ahead).text == "(") - (self.peek(ahead).text == ")")
            ahead += 1
            if self.peek(ahead).kind == "end":
                break
        return self.peek(ahead).text != "="

    def skip_command(self) -> None:
        """`hold on`, `disp(x)`: up to the end of the statement outside of brackets."""
        if self.peek().text == "matlabFunction" and self.peek(1).text == "(":
            self.written.add(self.peek(2).text)
        depth = 0
        while self.peek().kind != "end" and (depth > 0 or not self.is_at_end_of_statement()):
            token = self.next()
            if token.kind == "operator":
                depth += (token.text in "([{") - (token.text in ")]}")

    def names(self, closing: str) -> list[str]:
        names = []
        while not self.takes(closing):
            names.append("" if self.takes("~") else self.name())
            self.takes(",")
        return names

    def name(self) -> str:
        token = self.next()
        if token.kind != "name" or token.text in _KEYWORDS:
            raise self.refusal(f"a name is needed here, got {token.text!r}", token)
        return token.text

    def statement(self) -> Statement:
        start = self.peek()
        if start.text in _REFUSED and start.kind == "name":
            raise self.not_read(start)
        if start.kind == "name" and start.text in _BLOCKS:
            with self.deeper("loops and conditions are"):
                return getattr(self, f"{start.text}_block")()
        if start.kind == "name" and start.text in _LEAVES:
            self.next()
            return Leave(start.start, start.end, word=start.text)
        if start.text in ("persistent", "global"):
            self.next()
            names = []
            while not self.is_at_end_of_statement():
                names.append(self.name())
            return Kept(start.start, self.tokens[self.at - 1].end, names=names, is_global=start.text == "global")
        return self.assignment()

    def assignment(self) -> Statement:
        start, at = self.peek(), self.at
        targets = self.targets()
        if not (targets and self.takes("=")):
            self.at, targets = at, []
        value = self.expression()
        if not self.is_at_end_of_statement():
            what = "the expression goes on with" if targets else "an assignment or a call is needed here, got"
            raise self.refusal(f"{what} {self.peek().text!r}, which is not read")
        return Assignment(start.start, value.end, value, targets=targets)

    def targets(self) -> list[Target]:
        """Names with indices and fields; none where what stands here is no target."""
        if self.peek().kind == "name" and self.peek().text not in _KEYWORDS:
            return [self.target()]
        if self.peek().text != "[":
            return []
        self.next()
        found = []
        while self.peek().kind in ("name", "operator") and not self.takes("]"):
            if self.takes("~"):
                found.append(Target(""))
            elif self.peek().kind == "name" and self.peek().text not in _KEYWORDS:
                found.append(self.target())
            else:
                return []
            self.takes(",")
        return found

    def target(self) -> Target:
        name, way = self.name(), []
        while self.peek().text in _CLOSING or self.peek().kind == "field":
            if self.inside or (self.peek().spaced and self.peek().kind != "operator"):
                break
            way.append(self.step())
        return Target(name, tuple(way))

    def step(self) -> Node:
        """An index in brackets, or a field."""
        opening = self.next()
        if opening.kind == "field":
            return Field(opening.start, opening.end, (), opening.text[1:])
        parts = self.arguments(_CLOSING[opening.text])
        return Index(opening.start, self.tokens[self.at - 1].end, parts, opening.text)

    def end_of(self, start: Token) -> int:
        """The end of a block, behind its `end`."""
        if not self.takes("end"):
            got = self.peek()
            line, _ = line_and_column(self.text, got.start)
            raise self.refusal(f"`{start.text}` is not closed by `end`: line {line} has {got.text!r}", start)
        return self.tokens[self.at - 1].end

    def for_block(self) -> Statement:
        """for i = 1:3, for (i = 1:3), parfor (i = 1:3, 4), whose last number is that of workers"""
        start = self.next()
        has_brackets = self.takes("(")
        name = self.name()
        self.expect("=")
        value = self.expression()
        if has_brackets:
            if start.text == "parfor" and self.takes(","):
                self.expression()
            self.expect(")")
        body = self.statements()
        return For(start.start, self.end_of(start), value, (body,), name=name)

    parfor_block = for_block

    def while_block(self) -> Statement:
        start, value = self.next(), self.expression()
        body = self.statements()
        return While(start.start, self.end_of(start), value, (body,))

    def if_block(self) -> Statement:
        """if a > 0, then `elseif`, which is a condition in the other branch, and `else`."""
        start, value = self.next(), self.expression()
        body: list[Statement] = self.statements()
        if self.peek().text == "elseif":
            with self.deeper("loops and conditions are"):
                other = self.if_block()
            return If(start.start, other.end, value, (body, [other]))
        otherwise = self.statements() if self.takes("else") else []
        return If(start.start, self.end_of(start), value, (body, otherwise))

    def switch_block(self) -> Statement:
        start, value = self.next(), self.expression()
        labels, bodies, otherwise = [], [], []
        self.skip_separators()
        while self.takes("case"):
            labels.append(self.expression())
            bodies.append(self.statements())
        if self.takes("otherwise"):
            otherwise = self.statements()
        return Switch(start.start, self.end_of(start), value, (*bodies, otherwise), labels=labels)

    def try_block(self) -> Statement:
        start, body, otherwise = self.next(), self.statements(), []
        if self.takes("catch"):
            if self.peek().kind == "name" and self.peek(1).kind == "newline":
                self.next()  # the error by its name
            otherwise = self.statements()
        return Try(start.start, self.end_of(start), None, (body, otherwise))

    # ---- expressions -------------------------------------------------------------------------------------------------

    def expression(self) -> Node:
        """Comparisons of ranges or sums, joined by `||`, `&&`, `|` and `&`."""
        with self.deeper("the expression is"):
            return self.logic(0)

    def logic(self, level: int) -> Node:
        if level == len(_LOGIC):
            return self.chain(_COMPARISONS, self.range, Compare)
        return self.chain(_LOGIC[level], lambda: self.logic(level + 1), Logic)

    def range(self) -> Node:
        """Sums; colons between sums make a range, first:last or first:step:last."""
        parts, colon = [self.sum()], self.peek()
        while self.peek().text == ":" and len(parts) < 3 and not self.ends_element():
            self.next()
            parts.append(self.sum())
        if len(parts) == 1:
            return parts[0]
        return Range(parts[0].start, parts[-1].end, tuple(parts), ":", colon.start)

    def ends_element(self) -> bool:
        """Whether a blank before the next token separates two elements of a matrix: [a -b] but not [a - b]."""
        token = self.peek()
        if not self.inside or self.inside[-1] == "(" or not token.spaced:
            return False
        return not (token.text in ("+", "-") and self.peek(1).spaced) and token.text not in _ARITHMETIC

    def chain(self, operators: tuple[str, ...], part: Callable[[], Node], make: type[Node] = Binary) -> Node:
        left = part()
        while self.peek().text in operators and self.peek().kind == "operator" and not self.ends_element():
            token = self.next()
            right = part()
            left = make(left.start, right.end, (left, right), token.text, token.start)
        return left

    def sum(self) -> Node:
        return self.chain(("+", "-"), self.product)

    def product(self) -> Node:
        return self.chain(("*", "/", "\\", ".*", "./", ".\\"), self.signed)

    def signed(self) -> Node:
        if self.peek().text in ("+", "-", "~"):
            token = self.next()
            with self.deeper("the expression is"):
                inner = self.signed()
            make = Not if token.text == "~" else Unary
            return make(token.start, inner.end, (inner,), token.text, token.start)
        return self.power()

    def power(self) -> Node:
        left = self.postfix()
        while self.peek().text in ("^", ".^") and not self.ends_element():
            token = self.next()
            right: Node
            if self.peek().text in ("+", "-"):
                sign = self.next()
                inner = self.postfix()
                right = Unary(sign.start, inner.end, (inner,), sign.text, sign.start)
            else:
                right = self.postfix()
            left = Binary(left.start, right.end, (left, right), token.text, token.start)
        return left

    def postfix(self) -> Node:
        node = self.atom()
        while self.peek().text in ("'", ".'") and self.peek().kind == "operator" and not self.peek().spaced:
            token = self.next()
            node = Transpose(node.start, token.end, (node,), "'", token.start)
        return node

    def atom(self) -> Node:
        token = self.next()
        if token.kind == "text":
            quote = token.text[0]
            return Text(token.start, token.end, (), token.text[1:-1].replace(2 * quote, quote))
        if token.kind == "number":
            return Number(token.start, token.end, (), token.text)
        if token.kind == "imaginary":
            raise self.refusal(f"`{token.text}` is a complex number, and real ones are read", token)
        if token.text == "(":
            self.inside.append("(")
            inner = self.expression()
            self.inside.pop()
            closing = self.expect(")")
            return Group(token.start, closing.end, (inner,))
        if token.text in ("[", "{"):
            return self.matrix(token)
        if token.text == "@":
            return self.handle(token)
        if token.text == "end" and self.inside:
            return Last(token.start, token.end, (), "end")
        if token.kind == "name" and token.text not in _KEYWORDS:
            return self.indexed(token)
        raise self.refusal(f"a value is needed here, got {token.text!r}", token)

    def indexed(self, name: Token) -> Node:
        """f(x), A(i, j), the element T{i} of a cell array, and parts and fields of these."""
        node: Node = Name(name.start, name.end, (), name.text)
        while (self.peek().text in _CLOSING or self.peek().kind == "field") and not self.ends_element():
            step = self.step()
            if isinstance(node, Name) and isinstance(step, Index):
                make = Element if step.word == "{" else FunctionCall
                node = make(node.start, step.end, step.parts, name.text, name.start)
            else:
                node = Part(node.start, step.end, (node, *step.parts), step.word, step.start, step)
        return node

    def handle(self, sign: Token) -> Node:
        """@(x, y) an expression of x and y, or @name."""
        if not self.takes("("):
            name = self.next()
            if name.kind != "name" or name.text in _KEYWORDS:
                raise self.refusal("`@` is followed by a name or by the arguments in brackets, as in @(t)", name)
            return FunctionHandle(sign.start, name.end, (), name.text, sign.start)
        names = self.names(")")
        self.inside.append("(")
        body = self.expression()
        self.inside.pop()
        return AnonymousFunction(sign.start, body.end, (body,), "@", sign.start, tuple(names))

    def arguments(self, closing: str) -> tuple[Node, ...]:
        parts: list[Node] = []
        self.inside.append("(")
        while not self.takes(closing):
            if self.peek().text == ":" and self.peek(1).text in (",", closing):
                token = self.next()
                parts.append(All(token.start, token.end))
            else:
                parts.append(self.expression())
            if not self.takes(",") and self.peek().text != closing:
                raise self.refusal(f"',' or {closing!r} is needed here, got {self.peek().text!r}")
        self.inside.pop()
        return tuple(parts)

    def matrix(self, opening: Token) -> Node:
        """Rows are separated by semicolons or new lines, elements by commas or blanks; {} is a cell array."""
        rows: list[Node] = []
        row: list[Node] = []
        self.inside.append(opening.text)
        while not self.takes(_CLOSING_OF_MATRIX[opening.text]):
            token = self.peek()
            if token.kind == "end":
                raise self.refusal("the matrix is not closed", opening)
            if token.kind == "newline" or self.takes(";"):
                self.at += token.kind == "newline"
                if row:
                    rows.append(Row(row[0].start, row[-1].end, tuple(row)))
                row = []
            elif not self.takes(","):
                row.append(self.expression())
        if row:
            rows.append(Row(row[0].start, row[-1].end, tuple(row)))
        self.inside.pop()
        closing = self.tokens[self.at - 1]
        make = Matrix if opening.text == "[" else Cell
        return make(opening.start, closing.end, tuple(rows))


def _functions_have_ends(tokens: list[Token]) -> bool:
    """Whether the functions of a file end with `end`, so that one in another is nested."""
    depth = blocks = ends = functions = 0
    for before, token in zip([None, *tokens], tokens, strict=False):
        if token.kind == "operator":
            depth += (token.text in "([{") - (token.text in ")]}")
        elif token.kind == "name" and depth == 0:
            begins = before is None or before.kind == "newline" or before.text in (";", ",")
            functions += token.text == "function"
            blocks += token.text in _BLOCKS or (token.text == "arguments" and begins)
            ends += token.text == "end"
    return functions > 0 and ends == blocks + functions


def _given_in(statement: Statement) -> list[str]:
    """The names that a statement, or one in it, gives a value, a part or a field."""
    assignments = [one for one in statement.walk() if isinstance(one, Assignment)]
    return [target.name for one in assignments for target in one.targets if target.name]


def _looked_at_in(statement: Statement) -> set[str]:
    every = list(statement.walk())
    roots = [one.value for one in every if one.value]
    roots += [step for one in every if isinstance(one, Assignment) for target in one.targets for step in target.way]
    return {node.word for root in roots for node in root.walk() if isinstance(node, (Name, FunctionCall))}


def _needed_for(name: str, statements: list[Statement]) -> list[Statement]:
    """The statements on which the last value of a variable depends."""
    needed, names = [], {name}
    for statement in reversed(statements):
        if names.intersection(_given_in(statement)):
            needed.append(statement)
            names |= _looked_at_in(statement)
    return needed[::-1]


def _symbols_in(statements: list[Statement], symbols: list[str]) -> list[str]:
    """The symbols that are looked at before they are given a value, in the order of their declaration."""
    looked_at: set[str] = set()
    given: set[str] = set()
    for statement in statements:
        looked_at |= _looked_at_in(statement) - given
        is_whole = isinstance(statement, Assignment) and not any(target.way for target in statement.targets)
        given |= set(_given_in(statement)) if is_whole else set()
    return [name for name in dict.fromkeys(symbols) if name in looked_at]
