"""arm3r-examples: the scenarios and sweeps of this installation."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from .exit_codes import attempt, print_line


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-examples`; argv without the program's name. Returns one of the exit codes of `arm3r`."""
    options = parser().parse_args(sys.argv[1:] if argv is None else argv)
    return attempt("arm3r-examples", lambda: show(options))


def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="arm3r-examples",
        description="The scenarios and sweeps of this installation: list them, print one, or copy them into a folder.",
        epilog="From Python: arm3r.Scenario.example(NAME).",
    )
    add = parser.add_argument
    add("name", nargs="?", metavar="NAME", help="print this one, such as moving_wall or lecture/05_free_fall")
    add("--copy", type=Path, metavar="DIR", help="copy NAME, or all without NAME, into DIR, which is made")
    return parser


def show(options: argparse.Namespace) -> None:
    from ..examples import copy, names, path_of, summary, text_of

    if options.copy is not None:
        wanted = [options.name] if options.name else names()
        for path in copy([path_of(name) for name in wanted], options.copy):
            print_line(path)
    elif options.name:
        print_line(text_of(path_of(options.name)).rstrip("\n"))
    else:
        width = max(map(len, names())) + 2
        for name in names():
            print_line(f"{name:{width}}{summary(path_of(name))}")


if __name__ == "__main__":
    sys.exit(main())
