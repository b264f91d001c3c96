"""Cuts the text of a MATLAB file into tokens; those of Octave become MATLAB's."""

from __future__ import annotations

import re
from typing import NamedTuple

from ...errors import UnreadError
from ..programs import line_and_column

_TOKEN = re.compile(
    r"(?P<blank>[ \t\f]+|\.\.\.[^\n]*\n)|(?P<comment>[%#][^\n]*)|(?P<newline>\n)"
    r"|(?P<number>(?:\d+(?:\.(?![*/\\^'])\d*)?|\.\d+)(?:[eEdD][+-]?\d+)?)(?![A-Za-z_])"
    r"|(?P<imaginary>(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?[ij])(?!\w)"
    r"|(?P<name>[A-Za-z]\w*(?:\.[A-Za-z]\w*)*)"  # p.a2 is the name of a field
    r"|(?P<field>\.[A-Za-z]\w*)"  # behind an index, as in link(2).m
    r"|(?P<operator>\.\*|\./|\.\\|\.\^|\.'|==|~=|!=|<=|>=|&&|\|\||[-+*/\\^'=(),;:\[\]{}@<>&|~!])"
)
_TEXT = re.compile(r"'(?:[^'\n]|'')*'|\"(?:[^\"\n]|\"\")*\"")
_OF_OCTAVE = {"!=": "~=", "!": "~"} | dict.fromkeys(
    ("endfunction", "endif", "endfor", "endwhile", "endswitch", "end_try_catch"), "end"
)
_BLOCK_COMMENT = re.compile(r"^[ \t]*[%#]\{[ \t]*$.*?^[ \t]*[%#]\}[ \t]*$", re.M | re.S)
_BEFORE_TEXT = ("case", "if", "elseif", "while", "switch")
_CLOSING = (")", "]", "}", "'", ".'")
KNOWN = (
    "known are assignments, arithmetic, matrices, text, cell arrays, structures, handles, `for`, `while`, `if`, "
    "`switch`, `try` and functions"
)


class Token(NamedTuple):
    kind: str
    text: str
    start: int
    end: int
    spaced: bool
    """Whether a blank stands before it."""


def tokens_of(text: str, file: str) -> list[Token]:
    """Those of a text, and one for its end.

    Raises:
        UnreadError: there is what is no token.
    """
    text = _BLOCK_COMMENT.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text).replace("\r", " ")
    tokens: list[Token] = []
    at, spaced = 0, False
    while at < len(text):
        begins_text = text[at] == '"' or (text[at] == "'" and not _is_transpose(tokens, spaced))
        found = _TEXT.match(text, at) if begins_text else _TOKEN.match(text, at)
        if not found:
            line, column = line_and_column(text, at)
            why = "begins a text that does not end in its line" if begins_text else f"is not read; {KNOWN}"
            reason = f"{text[at]!r} {why}"
            raise UnreadError(f"{file}:{line}:{column}: {reason}", line=line, reason=reason)
        kind = "text" if begins_text else found.lastgroup or ""
        if kind in ("blank", "comment"):
            spaced = True
        else:
            tokens.append(Token(kind, _OF_OCTAVE.get(found[0], found[0]), at, found.end(), spaced))
            spaced = False
        at = found.end()
    return [*tokens, Token("end", "the end of the file", len(text), len(text), False)]


def _is_transpose(before: list[Token], spaced: bool) -> bool:
    """Whether an apostrophe belongs to the value that stands right before it."""
    if not before or spaced or before[-1].text in _BEFORE_TEXT:
        return False
    return before[-1].kind in ("name", "number", "field") or before[-1].text in _CLOSING
