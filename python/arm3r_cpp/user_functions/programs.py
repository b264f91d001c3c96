"""What every program of a user has: constants, edits of its text, how it is called, and how it fails."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, NamedTuple


class Edit(NamedTuple):
    """The replacement of the text from start to end by new text."""

    start: int
    end: int
    new: str
    rank: int = 0
    """How far-fetched it is: of edits with the same effect, the one with the smallest rank is shown."""

    def apply(self, text: str) -> str:
        return text[: self.start] + self.new + text[self.end :]


class Constant(NamedTuple):
    """A number that is assigned to a name once, such as `a2 = 1`."""

    name: str
    value: float
    start: int
    end: int


def line_and_column(text: str, offset: int) -> tuple[int, int]:
    """From 1, in characters."""
    line = text.count("\n", 0, offset) + 1
    return line, offset - (text.rfind("\n", 0, offset) + 1) + 1


@dataclass(frozen=True)
class Given:
    """An argument that is the same in each evaluation: a number, nested lists of numbers, or a structure of these."""

    value: Any


class Call(NamedTuple):
    """How a program is given its inputs: from the columns of a table with a row for each evaluation."""

    slots: tuple[tuple[int, ...] | int | Given, ...]
    """For each argument the column of a scalar, the columns of a vector, or its value."""
    lifted: dict[str, int]
    """Constants of the program whose values are taken from columns."""
    output: int | None = None
    """Which of the results that it returns, from 0; None: all that it returns is one."""
    outside: Mapping[str, Any] = MappingProxyType({})
    """Values of names that the program uses and does not define, as those of `Given`."""
    as_columns: bool = False
    """Whether vectors have two axes, (n, 1)."""


class ProgramError(Exception):
    """The user's program failed: it raised, hung, or returned no numbers.

    Attributes:
        line: in the user's text, where it is known.
    """

    def __init__(self, message: str, line: int | None = None) -> None:
        super().__init__(message)
        self.line = line


class Unread(ProgramError):
    """The program holds what this package does not read, or more of it: its language may take it.

    Attributes:
        name: without a value; it may be another one, misspelt.
    """

    def __init__(self, message: str, line: int | None = None, name: str = "") -> None:
        super().__init__(message, line)
        self.name = name


class ProcessEnded(ProgramError):
    """The process that runs the user's program ended."""


class Unjudged(ProcessEnded):
    """What the program would return stays unknown: it is too slow, waits, needs too much memory, or it answered its
    judge itself."""


def calls_in(work: Callable[[], Any]) -> int:
    """How many functions `work` calls: how much it computes, in the same number on every machine."""
    count = 0

    def note(_frame: Any, event: str, _argument: Any) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    before = sys.getprofile()
    sys.setprofile(note)
    try:
        work()
    finally:
        sys.setprofile(before)
    return count


def numbers_of(text: Sequence[str]) -> str:
    """The digits that names end with, in one word: "321" for t3, t2, t1; "" where one has none."""
    digits = [name[-1:] for name in text]
    return "".join(digits) if all(digit.isdigit() for digit in digits) else ""
