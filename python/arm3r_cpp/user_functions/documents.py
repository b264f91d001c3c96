"""The code of documents that hold more than code: Jupyter notebooks and MATLAB's live scripts."""

from __future__ import annotations

import io
import json
import zipfile
import zlib
from typing import Any
from xml.etree import ElementTree

from ..errors import UsageError

_WORD = "{http://schemas.openxmlformats.org/wordprocessingml/2006/main}"
_BROKEN_ARCHIVE = (
    *(zipfile.BadZipFile, zlib.error, EOFError, OSError),
    *(KeyError, ValueError, NotImplementedError, RuntimeError, ElementTree.ParseError),
)
_MOST_BYTES = 20 << 20  # of a live script's text
MATLAB = (".m", ".mlx")


def code_of(file: str, content: bytes) -> str:
    """The code in a file by its ending, cell by cell; its lines end with a line feed.

    Raises:
        UsageError: it is no such document.
    """
    if file.endswith(".ipynb"):
        return _of_notebook(file, content)
    if file.endswith(".mlx"):
        return _of_live_script(file, content)
    return decoded(content)


def decoded(content: bytes) -> str:
    """The text of a file in UTF-8 or, as older editors write it, in Latin-1."""
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("latin-1")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _of_notebook(file: str, content: bytes) -> str:
    try:
        document: Any = json.loads(content)
    except (ValueError, RecursionError):
        document = None
    cells = document.get("cells") if isinstance(document, dict) else None
    if not isinstance(cells, list):
        raise UsageError(f"{file}: this is no Jupyter notebook: JSON with cells is needed")
    code = [one.get("source", "") for one in cells if isinstance(one, dict) and one.get("cell_type") == "code"]
    texts = ["".join(map(str, one)) if isinstance(one, list) else str(one) for one in code]
    return "\n\n".join("\n".join(map(_without_command, text.split("\n"))) for text in texts) + "\n"


def _without_command(line: str) -> str:
    """Commands of the notebook, such as %matplotlib, become comments."""
    return f"#{line}" if line.lstrip().startswith(("%", "!", "?")) else line


def _of_live_script(file: str, content: bytes) -> str:
    """The paragraphs of the style `code`."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            about = archive.getinfo("matlab/document.xml")
            text = archive.read(about) if about.file_size <= _MOST_BYTES else b""
        if not text or b"<!DOCTYPE" in text or b"<!ENTITY" in text:
            raise ValueError
        document = ElementTree.fromstring(text)
    except _BROKEN_ARCHIVE:
        raise UsageError(f"{file}: this is no live script of MATLAB: save it as a file .m") from None
    paragraphs = [one for one in document.iter(f"{_WORD}p") if _style(one) == "code"]
    return "\n".join("".join(part.text or "" for part in one.iter(f"{_WORD}t")) for one in paragraphs) + "\n"


def _style(paragraph: ElementTree.Element) -> str:
    found = paragraph.find(f"{_WORD}pPr/{_WORD}pStyle")
    return found.get(f"{_WORD}val", "") if found is not None else ""
