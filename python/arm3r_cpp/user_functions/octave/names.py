"""Names of a MATLAB file's functions that no function of Octave has.

Octave reads the text as if it were typed: its functions would stand in the place of Octave's own, also where those call
each other. In a file they are at hand for this file alone.
"""

from __future__ import annotations

from ..matlab.tokens import Token, tokens_of
from .source import OWN

_CALLERS = ("feval", "str2func", "cellfun", "arrayfun")


def with_own_names(text: str, names: set[str], file: str) -> str:
    """The text with its functions called by names of their own, wherever they are named.

    Raises:
        UnreadError: there is what is no token.
    """
    tokens = tokens_of(text, file)
    ends = [end for place in range(len(tokens)) if (end := _end_of_name(tokens, place, names)) is not None]
    for end in reversed(ends):
        text = text[:end] + OWN + text[end:]
    return text


def _end_of_name(tokens: list[Token], place: int, names: set[str]) -> int | None:
    """Where the name of a function ends, if a token is one or begins with one."""
    token = tokens[place]
    first = token.text.partition(".")[0]
    if token.kind == "name" and first in names:
        return token.start + len(first)
    if token.kind == "text" and token.text[1:-1] in names and place > 1 and tokens[place - 2].text in _CALLERS:
        return token.end - 1
    return None
