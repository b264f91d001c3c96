"""arm3r-live: the live page in a browser."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..errors import UsageError
from .exit_codes import attempt, print_line

LAST_PORT = 65535


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-live`; argv without the program's name. Returns one of the exit codes of `arm3r`."""
    options = parser().parse_args(sys.argv[1:] if argv is None else argv)
    return attempt("arm3r-live", lambda: open_page(options, scenario_data(options.scenario)))


def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="arm3r-live",
        description="The live page: a scenario as scene, plots, text and sliders, simulated anew at each change. It is "
        "served to this computer alone, until Ctrl-C.",
        epilog="`arm3r docs live` describes the page.",
    )
    add = parser.add_argument
    add("scenario", nargs="?", metavar="SCENARIO", help="a scenario .yaml, or the name of an example (default: "
        "moving_wall)")  # fmt: skip
    add_server(parser)
    return parser


def add_server(parser: argparse.ArgumentParser) -> None:
    """The options for how a page is served."""
    add = parser.add_argument
    add("--port", type=port, metavar="N", default=0, help="port of the address (default: a free one)")
    add("--no-browser", action="store_true", help="only print the address")


def port(text: str) -> int:
    number = int(text)
    if not 0 <= number <= LAST_PORT:
        raise argparse.ArgumentTypeError(f"0 to {LAST_PORT} are possible, got {text}")
    return number


def scenario_data(scenario: str | None) -> dict[str, Any] | None:
    """What the page is given of a file or of an example.

    Raises:
        UsageError: it is neither, or cannot be read.
    """
    from .._files import regular
    from ..examples import path_of
    from ..live import page_data

    if scenario is None:
        return None
    path = Path(scenario)
    if not path.exists() and path.suffix not in (".yaml", ".yml"):
        path = path_of(scenario)
    try:
        text = regular(path).read_text(encoding="utf-8")
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}", code="file.scenario") from error
    except UnicodeDecodeError as error:
        raise UsageError(f"{path}: is not a text in UTF-8: {error.reason}", code="file.scenario") from error
    return page_data.of_text(text, path.stem)


def open_page(options: argparse.Namespace, data: dict[str, Any] | None) -> None:
    """
    Raises:
        UsageError: the installation has no page, or the port cannot be used.
    """
    from ..live import page
    from ..live.server import serve

    serve(page.html("index.html", data), port=options.port, browser=not options.no_browser, say=print_line)


if __name__ == "__main__":
    sys.exit(main())
