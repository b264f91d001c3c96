"""Reads the answers of the process that runs a user's file. The file can write any bytes there: nothing is believed."""

from __future__ import annotations

import json
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .programs import ProgramError, Unjudged, Unread

Floats = NDArray[np.float64]
BROKEN = "breaks the connection to its judge"
NO_MEMORY = "needs too much memory"
_MOST_AXES, _LONGEST, _MOST_LINES, _MOST_SECONDS = 8, 300, 10**7, 1e6


class BrokenAnswer(Exception):
    """It is none that this package writes."""


class Answer(NamedTuple):
    """What a function returned, a row for each state; or None, and why it failed."""

    values: Floats | None
    seconds: float
    """How long the process has computed, as it says."""
    error: str = ""
    line: int | None = None
    is_unread: bool = False

    def failure(self) -> ProgramError:
        """The error that it stands for."""
        kind = Unjudged if self.error == NO_MEMORY else Unread if self.is_unread else ProgramError
        return kind(self.error, self.line)


def head_of(text: bytes) -> dict[str, Any]:
    """
    Raises:
        BrokenAnswer: the text is no JSON object.
    """
    try:
        head = json.loads(text.decode())
    except (ValueError, RecursionError):
        raise BrokenAnswer from None
    return _checked(head, type(head) is dict)


def answer_of(head: dict[str, Any], body: bytes, rows: int) -> Answer:
    """
    Raises:
        BrokenAnswer: the head is that of no answer, or the body has other than its numbers.
    """
    seconds = head.get("seconds", 0.0)
    _checked(seconds, type(seconds) is float and math.isfinite(seconds) and 0 <= seconds < _MOST_SECONDS)
    if "error" in head:
        error, line = head["error"], head.get("line")
        _checked(error, type(error) is str and not body)
        _checked(line, line is None or (type(line) is int and 0 < line < _MOST_LINES))
        return Answer(None, seconds, error[:_LONGEST], line, head.get("unread") is True)
    shape: Any = head.get("shape")
    _checked(shape, type(shape) is list and 0 < len(shape) <= _MOST_AXES)
    _checked(shape, all(type(size) is int and 0 <= size <= max(rows, len(body)) for size in shape))
    _checked(shape, shape[0] == rows and math.prod(shape) * 8 == len(body))
    return Answer(np.frombuffer(body).reshape(shape), seconds)


def calls_of(head: dict[str, Any]) -> int:
    """How many functions an evaluation called.

    Raises:
        BrokenAnswer: the head does not say it.
    """
    calls: Any = head.get("calls")
    return int(_checked(calls, type(calls) is int and calls >= 0))


def arguments_of(head: dict[str, Any]) -> tuple[list[str], list[str]]:
    """The names of arguments, and of those of them that have a default.

    Raises:
        BrokenAnswer: the head has none.
        ProgramError: it is that of a failure.
    """
    if "error" in head:
        raise answer_of(head, b"", 0).failure()
    names: Any = head.get("arguments")
    _checked(names, type(names) is list and [type(one) for one in names] == [list, list])
    for one in (*names[0], *names[1]):
        _checked(one, type(one) is str and one.isidentifier() and len(one) < _LONGEST)
    return names[0], names[1]


def unbarred_of(head: dict[str, Any]) -> list[str]:
    """What the process could not be barred from, by the answer to its first request.

    Raises:
        BrokenAnswer: the head is that of no such answer.
    """
    names: Any = head.get("unbarred")
    return _checked(names, type(names) is list and len(names) <= _MOST_AXES and all(type(one) is str for one in names))


def _checked(value: Any, holds: bool) -> Any:
    if not holds:
        raise BrokenAnswer
    return value
