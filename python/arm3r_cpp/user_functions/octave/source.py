"""The functions and the constants of a MATLAB text that is not read: by the words that begin its lines alone."""

from __future__ import annotations

import re
from typing import NamedTuple

from ..programs import Constant

OWN = "_of_this_file"
"""Behind the names of functions in the text that Octave reads."""
_COMMENT_BLOCK = re.compile(r"^[ \t]*[%#]\{[ \t]*$.*?^[ \t]*[%#]\}[ \t]*$", re.M | re.S)
_COMMENT_LINE = re.compile(r"^[ \t]*[%#].*$", re.M)
_CONTINUED = re.compile(r"\.\.\.[^\n]*\n")
_HEADER = re.compile(
    r"^[ \t]*function\s+(?:(?:\[(?P<several>[^\]]*)\]|(?P<one>[A-Za-z]\w*))\s*=\s*)?(?P<name>[A-Za-z]\w*)[ \t]*"
    r"(?:\((?P<inputs>[^)]*)\))?",
    re.M,
)
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_CONSTANT = re.compile(
    rf"^[ \t]*(?P<name>[A-Za-z]\w*)[ \t]*=[ \t]*(?P<value>{_NUMBER})[ \t]*;?[ \t]*(?:[%#].*)?$", re.M
)


class Header(NamedTuple):
    """The first line of a function."""

    name: str
    outputs: list[str]
    inputs: list[str]
    line: int


def headers_of(text: str) -> dict[str, Header]:
    """The functions of a text by their names, in its order; none of a script or a class."""
    plain = without_comments(text)
    first = re.search(r"\S+", plain)
    if first and first[0].startswith("classdef"):
        return {}
    found = {}
    for one in _HEADER.finditer(plain):
        outputs = _names(one["several"] or one["one"] or "")
        line = plain.count("\n", 0, one.start("name")) + 1
        found[one["name"]] = Header(one["name"], outputs, _names(one["inputs"] or ""), line)
    return found


def functions_alone(text: str) -> str:
    """The text without a script before its first function, everything in its place."""
    first = _HEADER.search(without_comments(text))
    return re.sub(r"[^\n]", " ", text[: first.start()]) + text[first.start() :] if first else text


def constants_of(text: str) -> list[Constant]:
    """The names that are given a number in a line of its own, and nothing else in the whole text."""
    plain = without_comments(functions_alone(text))
    taken = {word for one in headers_of(text).values() for word in (one.name, *one.inputs, *one.outputs)}
    return [
        Constant(one["name"], float(one["value"]), one.start("value"), one.end("value"))
        for one in _CONSTANT.finditer(plain)
        if one["name"] not in taken and len(_assignments(plain, one["name"])) == 1
    ]


def without_comments(text: str) -> str:
    """The text with blanks in the place of comments that take whole lines."""
    for pattern in (_COMMENT_BLOCK, _COMMENT_LINE):
        text = pattern.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)
    return text


def _assignments(text: str, name: str) -> list[str]:
    """Where a name, or a part of it, may be given a value: before an equals sign, in a loop, in a list, as a global."""
    return re.findall(rf"\b{name}\b[^=\n;]*=(?!=)|\b(?:global|persistent)\b[^\n;]*\b{name}\b", text)


def _names(text: str) -> list[str]:
    words = re.split(r"[,\s]+", _CONTINUED.sub(" ", text).split("%")[0].strip())
    return ["" if word == "~" else word.split("=")[0] for word in words if word]
