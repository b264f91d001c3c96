"""Wrap the prose of Markdown files at 100 columns.

    python tools/wrap_markdown.py FILE...

Tables, code, headings and comments stay as they are, and so does every paragraph without a line that is too long. A
line is broken at a blank outside of code, formulas and links."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path

COLUMNS = 100
WHOLE = re.compile(r"\$`.*?`\$|`[^`]+`|!?\[[^\]]*\]\([^)]*\)")  # a formula, code or a link
FENCE = re.compile(r"^\s*```.*?^\s*```\s*?$", re.M | re.S)
ITEM = re.compile(r"(\s*(?:[-*] |\d+\. )?)(.*)", re.S)
NO_START = re.compile(r"[-+*]$|#+$|[>|=]|\d+[.)]$")  # a line that begins with it would not be prose


def wrapped(text: str) -> str:
    return "".join(part if is_code else _wrapped_prose(part) for part, is_code in _parts(text))


def too_long(text: str) -> list[str]:
    """The lines of prose that are longer than COLUMNS and could be broken."""
    return [line for line in text.splitlines() if len(line) > COLUMNS and line not in wrapped(text).splitlines()]


def _parts(text: str) -> Iterator[tuple[str, bool]]:
    at = 0
    for fence in FENCE.finditer(text):
        yield text[at : fence.start()], False
        yield fence[0], True
        at = fence.end()
    yield text[at:], False


def _wrapped_prose(text: str) -> str:
    lines, out, paragraph = text.split("\n"), [], []
    for line in [*lines, ""]:
        is_prose = bool(line.strip()) and not re.match(r"\s*\||#|<!--|    ", line)
        if paragraph and (not is_prose or re.match(r"\s*(?:[-*] |\d+\. )", line)):
            out += _filled(paragraph)
            paragraph = []
        if is_prose:
            paragraph.append(line)
        else:
            out.append(line)
    return "\n".join(out[:-1])


def _filled(paragraph: list[str]) -> list[str]:
    if all(len(line) <= COLUMNS for line in paragraph):
        return paragraph
    first = ITEM.fullmatch(paragraph[0])
    assert first
    words = _words(" ".join([first[2], *(line.strip() for line in paragraph[1:])]))
    lines, indent = [first[1] + words[0]], " " * len(first[1])
    for word in words[1:]:
        if len(lines[-1]) + 1 + len(word) <= COLUMNS or NO_START.match(word):
            lines[-1] += f" {word}"
        else:
            lines.append(indent + word)
    return lines


def _words(text: str) -> list[str]:
    """The parts of a text between which a line may be broken."""
    kept: list[str] = []

    def hide(whole: re.Match[str]) -> str:
        kept.append(whole[0])
        return f"\0{len(kept) - 1}\0"

    hidden = WHOLE.sub(hide, text)
    return [re.sub(r"\0(\d+)\0", lambda m: kept[int(m[1])], word) for word in hidden.split()]


if __name__ == "__main__":
    for name in sys.argv[1:]:
        path = Path(name)
        path.write_text(wrapped(path.read_text()))
