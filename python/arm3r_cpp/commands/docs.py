"""arm3r-docs: the pages of this installation."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from .._messages import did_you_mean
from ..errors import UsageError
from ..examples import DATA
from .exit_codes import attempt, print_line


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-docs`; argv without the program's name. Returns one of the exit codes of `arm3r`."""
    options = parser().parse_args(sys.argv[1:] if argv is None else argv)
    return attempt("arm3r-docs", lambda: show(options))


def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="arm3r-docs",
        description="The pages of this installation, as Markdown: list them, or print one. Their pictures and the "
        "notebooks are only in the sources.",
    )
    parser.add_argument("name", nargs="?", metavar="NAME", help="print this page, such as verify or sweeps")
    return parser


def show(options: argparse.Namespace) -> None:
    if options.name:
        print_line(text_of(path_of(options.name)).rstrip("\n"))
        return
    width = max(map(len, names())) + 2
    for name in names():
        print_line(f"{name:{width}}{title(path_of(name))}")


# ---- pages ----------------------------------------------------------------------------------------------------------


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


if __name__ == "__main__":
    sys.exit(main())
