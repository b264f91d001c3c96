"""The installed page, and data in it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..errors import UsageError
from ..examples import DATA

FOLDER = DATA / "live"
"""index.html with the files that it loads, and live.html, which needs none."""


def html(name: str, data: Mapping[str, Any] | None) -> str:
    """A page of this folder, "index.html" or "live.html", that shows these data; None: what it shows by itself.

    Raises:
        UsageError: this installation has no page.
    """
    text = _file(name).read_text(encoding="utf-8")
    if data is None:
        return text
    head, mark, tail = text.partition("</main>")
    return f'{head}{mark}\n<script type="application/json" id="arm3r-data">{as_json(data)}</script>{tail}'


def as_json(data: Mapping[str, Any]) -> str:
    """JSON that may stand in a script element: no text in it can end the element or begin a comment."""
    text = json.dumps(data, ensure_ascii=False, allow_nan=False)
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def check() -> None:
    """
    Raises:
        UsageError: this installation has no page.
    """
    _file("index.html")


def _file(name: str) -> Path:
    path = FOLDER / name
    if not path.is_file():
        how = "install a wheel that has it, or run `make page` (which needs node) and then `make run` in a clone"
        raise UsageError(f"the live page is not part of this installation: {how}", code="usage")
    return path
