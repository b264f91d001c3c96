"""The statements of a MATLAB function, as the grammar reads them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from ..expressions import Node


class Target(NamedTuple):
    """What a value is given to: a name, "" where the value is dropped, and the way from it to a part."""

    name: str
    way: tuple[Node, ...] = ()
    """Indices, whose word is their bracket, and fields."""


@dataclass(eq=False)
class Statement:
    """A piece of the text; its bodies are read in this order."""

    start: int
    end: int
    value: Node | None = None
    """What is assigned, run through, decided by or looked at."""
    bodies: tuple[list[Statement], ...] = ()

    def walk(self) -> Iterator[Statement]:
        """The statement and those in its bodies."""
        yield self
        for body in self.bodies:
            for inner in body:
                yield from inner.walk()


@dataclass(eq=False)
class Assignment(Statement):
    """`targets = value`; a value without a target is shown, or is a call that returns nothing."""

    targets: list[Target] = field(default_factory=list)


@dataclass(eq=False)
class For(Statement):
    """`for name = value`, with one body."""

    name: str = ""


class While(Statement):
    """`while value`, with one body."""


class If(Statement):
    """`if value`, with a body where it holds and one where it does not: there `elseif` is another `if`."""


@dataclass(eq=False)
class Switch(Statement):
    """`switch value`, with a body for each label, and one where none fits."""

    labels: list[Node] = field(default_factory=list)


class Try(Statement):
    """`try`, with a body, and one for the case that it fails."""


@dataclass(eq=False)
class Leave(Statement):
    """`break`, `continue` or `return`."""

    word: str = ""


@dataclass(eq=False)
class Kept(Statement):
    """Names whose values stay from call to call: `persistent` ones of a function, `global` ones of all."""

    names: list[str] = field(default_factory=list)
    is_global: bool = False


@dataclass
class Function:
    name: str
    outputs: list[str]
    inputs: list[str]
    line: int
    body: list[Statement] = field(default_factory=list)
    defaults: dict[str, Node] = field(default_factory=dict)
    """Of inputs that a block `arguments` gives a value."""
    is_nested: bool = False
    """Whether it stands in another function, and uses its variables."""
    is_script: bool = False
    """Whether it is a variable of a symbolic script, as a function of its symbols."""
