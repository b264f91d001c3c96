"""arm3r-animate: a run as a film, from its CSV or straight from a scenario."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from .._progress_bar import Bar
from .exit_codes import attempt, print_line
from .run_source import add_part, add_set, read


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-animate`; argv without the program's name. Returns one of the exit codes of `arm3r`."""
    options = parser().parse_args(sys.argv[1:] if argv is None else argv)
    bar = Bar("animate", "frames")
    try:
        return attempt("arm3r-animate", lambda: film(options, bar))
    finally:
        bar.clear()


def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="arm3r-animate",
        description="A run as a film: the arm and the wall from the side and from above, force and contact over time. "
        "A contact that falls between two frames is shown by the second one, with its largest force.",
        epilog="The same run and options give the same bytes. `arm3r docs figures` has examples.",
    )
    add = parser.add_argument
    add("run", type=Path, metavar="RUN", help="RUN.csv with RUN.json beside it, RUN.npz, or a scenario .yaml to run")
    add("-o", dest="out", type=Path, metavar="PATH", help="NAME.gif, NAME.mp4 (by ffmpeg, if it is on PATH), or a new "
        "folder for PNG files (default: RUN.gif here)")  # fmt: skip
    add("--fps", type=float, metavar="N", default=25.0, help="frames a second of the film (default: 25)")
    add_set(parser)
    add_part(parser)
    pace = parser.add_mutually_exclusive_group()
    pick = pace.add_argument
    pick(
        "--speed",
        type=float,
        metavar="X",
        default=1.0,
        help="seconds of the run in each second of the film (default: 1)",
    )
    pick("--every", type=int, metavar="N", help="one frame for every N-th row of the run, whatever its time")
    return parser


def film(options: argparse.Namespace, bar: Bar) -> None:
    from ..animation.animate import animate

    out: Path = options.out or Path(f"{options.run.stem}.gif")
    run, failure = read(options.run, options.set)
    pace = {"fps": options.fps, "speed": options.speed, "every": options.every}
    animate(run, out, **pace, start=options.start, end=options.end, progress=bar.draw)
    bar.clear()
    print_line(out)
    if failure:
        raise failure


if __name__ == "__main__":
    sys.exit(main())
