"""arm3r-view: a run from its file, in the live page."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from .exit_codes import attempt
from .live import add_server, open_page


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-view`; argv without the program's name. Returns one of the exit codes of `arm3r`."""
    options = parser().parse_args(sys.argv[1:] if argv is None else argv)
    return attempt("arm3r-view", lambda: view(options))


def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="arm3r-view",
        description="A run in the live page: its rows as they are, not simulated again, until something is changed "
        "there. The page is served to this computer alone, until Ctrl-C.",
        epilog="`arm3r docs live` describes the page.",
    )
    parser.add_argument("run", type=Path, metavar="RUN", help="RUN.csv with RUN.json beside it, or RUN.npz")
    add_server(parser)
    return parser


def view(options: argparse.Namespace) -> None:
    from ..core.run import Run
    from ..live import page, page_data

    page.check()
    open_page(options, page_data.of_run(Run.load(options.run)))


if __name__ == "__main__":
    sys.exit(main())
