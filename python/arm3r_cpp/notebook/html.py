"""Pieces of HTML. Every text that comes in is escaped here."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Sequence
from html import escape

GOOD, BAD = "#007a53", "#c0392b"
CELL = "text-align: left; padding: 0.1em 1.2em 0.1em 0"


def text(value: object) -> str:
    """Numbers with six digits, anything else as it is."""
    return escape(f"{value:.6g}" if isinstance(value, float) else str(value))


def page(*parts: str) -> str:
    return f"<div>{''.join(parts)}</div>"


def heading(kind: str, name: object, state: str = "", *, good: bool = True) -> str:
    """What it is, its name, and in colour how it ended."""
    colour = GOOD if good else BAD
    mark = f' <span style="color: {colour}; font-weight: bold">{text(state)}</span>' if state else ""
    return f"<p>{text(kind)} <b>{text(name)}</b>{mark}</p>"


def facts(pairs: Iterable[tuple[str, object]]) -> str:
    """One line of names and values."""
    return "<p>" + " &middot; ".join(f"{text(name)} <b>{text(value)}</b>" for name, value in pairs) + "</p>"


def table(head: Sequence[str], rows: Iterable[Sequence[object]], *, colours: Sequence[str] = ()) -> str:
    """A table; with `colours` each row has the colour of its place."""
    lines = ["".join(f'<th style="{CELL}">{text(name)}</th>' for name in head)]
    for number, row in enumerate(rows):
        colour = f"; color: {colours[number]}" if colours else ""
        lines.append("".join(f'<td style="{CELL}{colour}">{text(value)}</td>' for value in row))
    body = "".join(f"<tr>{line}</tr>" for line in lines)
    return f'<table style="border-collapse: collapse">{body}</table>'


def notes(title: str, sentences: Sequence[str]) -> str:
    """A list under a title; "" where there are no sentences."""
    if not sentences:
        return ""
    items = "".join(f"<li>{text(sentence)}</li>" for sentence in sentences)
    return f'<p style="color: {BAD}; margin-bottom: 0">{text(title)}</p><ul style="margin-top: 0">{items}</ul>'


def folded(title: str, content: str) -> str:
    """Text that the reader unfolds."""
    return f"<details><summary>{text(title)}</summary><pre>{text(content)}</pre></details>"


def image(png: bytes, width: float, what: str) -> str:
    """A picture in the page itself. width: of it on the page, inches of 96 pixels."""
    data = b64encode(png).decode()
    return f'<img src="data:image/png;base64,{data}" alt="{text(what)}" style="width: {96 * width:.0f}px">'
