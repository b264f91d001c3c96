"""How messages say where something stands, what is wrong there, and what was likely meant."""

from __future__ import annotations

import json
import re
import sys
import warnings
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from ._native import nearest_word
from .errors import ColumnError


def place(file: object, line: int = 0, column: int = 0) -> str:
    """file:line:column; a line or a column that is 0 is not known, and is left out."""
    return ":".join(str(part) for part in (file, line, column) if part)


_INVISIBLE = re.compile(
    "[\u034f\u115f\u1160\u17b4\u17b5\u180b-\u180f\u2800\u3164\ufe00-\ufe0f\uffa0\U000e0100-\U000e01ef]"
)
"""What Python takes for printable, and has no shape on a screen."""


def shown(text: str) -> str:
    """Foreign text on one line, as it can do no harm to a terminal, a table or a page, nor pass for another line.

    Escaped, as Python writes them, are line breaks and controls, what turns the direction of writing, what has no
    width, and halves of characters.
    """
    if text.isascii() and text.isprintable():
        return text
    return "".join(c if c.isprintable() and not _INVISIBLE.match(c) else _escaped(c) for c in text)


def _escaped(character: str) -> str:
    return ascii(character)[1:-1]


def as_json(value: object) -> str:
    """JSON to be read by people too: letters of all languages stay, and what `shown` escapes is escaped."""
    text = json.dumps(value, indent=2, ensure_ascii=False)
    return "".join(c if c == "\n" or shown(c) == c else json.dumps(c)[1:-1] for c in text)


def describe(problem: Mapping[str, Any]) -> str:
    """A problem as the library lists it in one line.

    That is file:line:column: error[code]: path: message, got X, allowed Y; hint.
    """
    got = f", got {problem['got']}" if problem["got"] else ""
    allowed = f", allowed {problem['allowed']}" if problem["allowed"] else ""
    hint = f"; {problem['hint']}" if problem["hint"] else ""
    path = f"{problem['path']}: " if problem["path"] else ""
    where = place(problem["file"], problem["line"], problem["column"])
    line = f"{where}: error[{problem['code']}]: {path}{problem['message']}{got}{allowed}{hint}"
    return shown(line)


def did_you_mean(word: str, words: Iterable[str]) -> str:
    """A question with the word that is most like the given one; "" where none is like it."""
    near = nearest_word(word, words)
    return f"did you mean {near}?" if near else ""


def in_columns(rows: Sequence[Sequence[str]], *, right: bool = False) -> list[str]:
    """A line a row, cells below each other, set to the left or to the right."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    pad = str.rjust if right else str.ljust
    return ["  ".join(map(pad, row, widths)).rstrip() for row in rows]


def no_column(name: object, names: Iterable[str]) -> ColumnError:
    """The error for a column that a table does not have."""
    names = list(names)
    hint = did_you_mean(str(name), names) or f"there are {', '.join(names)}"
    return ColumnError(f"no column {name!r}; {hint}", code="usage")


def warn_user(message: str, category: type[Warning]) -> None:
    """Issue a warning at the line outside the package that called it."""
    package = __name__.partition(".")[0]
    frame, level = sys._getframe(1), 2
    while frame.f_back and frame.f_globals.get("__name__", "").partition(".")[0] == package:
        frame, level = frame.f_back, level + 1
    warnings.warn(message, category, stacklevel=level)
