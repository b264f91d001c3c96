"""The expressions of a text, the same types for Python and for MATLAB."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field


@dataclass
class Node:
    """A part of an expression; offsets count the characters of the text."""

    start: int
    end: int
    parts: tuple[Node, ...] = ()
    word: str = ""
    """The name, the number's text, the operator, or the function that is called."""
    at: int = -1
    """Where the operator or the function's name begins, where it has a place of its own."""

    def walk(self) -> Iterator[Node]:
        """The part and all in it, each before what it consists of, however deep."""
        left = [self]
        while left:
            node = left.pop()
            yield node
            left.extend(reversed(node.parts))


class Root(Node):
    """The outermost expression of a statement, its only part; start and end are those of the statement."""


class Name(Node): ...


class Number(Node):
    @property
    def value(self) -> float:
        """NaN: it is written in another way than with decimals, such as 0x1F."""
        try:
            return float(self.word.lower().replace("d", "e"))
        except ValueError:
            return math.nan


class Text(Node): ...


class Unary(Node):
    """A sign and its operand."""


class Binary(Node):
    """Two operands of arithmetic."""


class Compare(Node):
    """Two sides of a comparison."""


class Logic(Node):
    """Two sides of "and" or "or"."""


class Not(Node): ...


class Group(Node):
    """Brackets around an expression."""


class Transpose(Node): ...


class FunctionCall(Node):
    """A function of arguments; in MATLAB it may be an index of a variable."""


class Element(FunctionCall):
    """T{i}: what is in a cell array."""


class Index(Node):
    """What is indexed, and the index; on a way to a part the indices alone, whose word is their bracket."""


class Field(Node):
    """A field on a way to a part."""


@dataclass
class Part(Node):
    """A part of what an expression gives, the first part: an index or a field behind it."""

    step: Node = field(default_factory=lambda: Node(0, 0), compare=False)


class Matrix(Node):
    """A list of elements, or of rows."""


class Row(Node): ...


class Cell(Node):
    """A cell array in rows."""


class Range(Node):
    """first:last or first:step:last"""


class All(Node):
    """A colon alone, as an index."""


class Last(Node):
    """`end` in an index."""


class FunctionHandle(Node):
    """A function by its name, which is its word."""


@dataclass
class AnonymousFunction(Node):
    """An expression, its only part, of arguments."""

    names: tuple[str, ...] = ()


class Other(Node):
    """What is not edited itself."""
