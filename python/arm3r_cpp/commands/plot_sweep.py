"""arm3r-plot sweep: a figure of a sweep's table."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from .exit_codes import attempt, print_line


def main(argv: Sequence[str]) -> int:
    """argv without "arm3r-plot sweep". Returns an exit code, one of those of `arm3r`."""
    options = parser().parse_args(argv)
    return attempt("arm3r-plot", lambda: save(options))


def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="arm3r-plot sweep", description="Draw a sweep: a metric against an axis, a heat map over a grid of two."
    )
    add = parser.add_argument
    add("folder", type=Path, metavar="DIR", help="folder of a finished sweep")
    add(
        "-o",
        dest="out",
        type=Path,
        metavar="OUT.png",
        default=Path("sweep.png"),
        help="the figure, .png, .pdf or .svg (default: sweep.png)",
    )
    add("--metric", metavar="NAME", help="column that is drawn (default: the first one kept)")
    add("--log", action="store_true", help="logarithmic scale of the metric")
    add("--stamp", action="store_true", help="write scenario, convention and hash at the bottom of the figure")
    return parser


def save(options: argparse.Namespace) -> None:
    from .._files import check_folder
    from ..plot.figure_files import check_format, write
    from ..plot.sweep_figure import sweep
    from ..sweeps.table import SweepTable

    check_format(options.out)
    check_folder(options.out.parent)
    table = SweepTable(options.folder)
    write({options.out: sweep(table, metric=options.metric, log=options.log, stamp=options.stamp)})
    print_line(options.out)
