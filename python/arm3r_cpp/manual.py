"""The pages of the documentation that are installed with the package: their names, titles and texts."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from ._messages import did_you_mean
from .errors import UsageError
from .examples import DATA


@cache
def names() -> list[str]:
    """Every page by its name without ".md", such as "verify"; "README" comes first and "CHANGELOG" last."""
    return ["README", *sorted(path.stem for path in (DATA / "docs").glob("*.md")), "CHANGELOG"]


def path_of(name: str) -> Path:
    """The file of a page. It may be named as pages name each other: "docs/verify.md", "verify.md#other-arms".

    Raises:
        UsageError: there is no such page; the message names the nearest one.
    """
    wanted = name.partition("#")[0].removesuffix(".md").removeprefix("docs/")
    found = next((known for known in names() if known.lower() == wanted.lower()), None)
    if found is None:
        hint = did_you_mean(wanted, names()) or "`arm3r docs` lists them"
        raise UsageError(f"{name}: there is no page of this name; {hint}", code="usage")
    return DATA / ("" if found.isupper() else "docs") / f"{found}.md"


def text_of(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def title(path: Path) -> str:
    """Its first heading."""
    return next(line.lstrip("# ") for line in text_of(path).splitlines() if line.startswith("# "))
