"""arm3r-converge: the observed order of a scenario's method."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from .exit_codes import attempt, print_line
from .run_source import add_set


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-converge`; argv without the program's name. Returns an exit code of `arm3r`."""
    options = parser().parse_args(sys.argv[1:] if argv is None else argv)
    return attempt("arm3r-converge", lambda: converge(options))


def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="arm3r-converge",
        description="Run a scenario with smaller and smaller steps (rk4) or tolerances, and print how its error falls: "
        "the observed order. `arm3r docs trust` says how to read it.",
    )
    parser.add_argument("scenario", type=Path, metavar="FILE", help="a scenario .yaml")
    add_set(parser)
    return parser


def converge(options: argparse.Namespace) -> None:
    from ..accuracy.convergence import converge as converged
    from ..core.scenario import Scenario

    scenario = Scenario.load(options.scenario)
    for edit in options.set:
        scenario.set_from_option(edit)
    print_line(converged(scenario))


if __name__ == "__main__":
    sys.exit(main())
