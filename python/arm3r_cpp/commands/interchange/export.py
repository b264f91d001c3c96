"""arm3r-export: a scenario's arm as URDF or MJCF."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from ..exit_codes import attempt
from ..run_source import add_set, scenario_of


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-export`; argv without the program's name. Returns one of the exit codes of `arm3r`."""
    options = parser().parse_args(sys.argv[1:] if argv is None else argv)
    return attempt("arm3r-export", lambda: write(options))


def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="arm3r-export",
        description="Write the arm of a scenario as URDF, or as MJCF with motors, wall and initial state, for MuJoCo. "
        "The joint angles are those of arm.convention. What a format cannot have is refused or named on stderr.",
        epilog="`arm3r docs export` says what is in the files. From Python: arm3r.export(scenario, PATH).",
    )
    parser.add_argument("scenario", type=Path, metavar="SCENARIO", help="a scenario .yaml")
    add = parser.add_argument
    add("-o", dest="out", required=True, metavar="OUT", help="the file: .urdf, or .xml for MJCF")
    add_set(parser)
    return parser


def write(options: argparse.Namespace) -> None:
    from ...interchange.export import export

    export(scenario_of(options.scenario, options.set), options.out)


if __name__ == "__main__":
    sys.exit(main())
