"""arm3r-docs: the pages of this installation."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from .exit_codes import attempt, print_line


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-docs`; argv without the program's name. Returns one of the exit codes of `arm3r`."""
    options = parser().parse_args(sys.argv[1:] if argv is None else argv)
    return attempt("arm3r-docs", lambda: show(options))


def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="arm3r-docs",
        description="The pages of this installation, as Markdown: list them, or print one. Their pictures and the "
        "notebooks are in the sources alone.",
    )
    parser.add_argument("name", nargs="?", metavar="NAME", help="print this page, such as verify or sweeps")
    return parser


def show(options: argparse.Namespace) -> None:
    from ..manual import names, path_of, text_of, title

    if options.name:
        print_line(text_of(path_of(options.name)).rstrip("\n"))
        return
    width = max(map(len, names())) + 2
    for name in names():
        print_line(f"{name:{width}}{title(path_of(name))}")


if __name__ == "__main__":
    sys.exit(main())
