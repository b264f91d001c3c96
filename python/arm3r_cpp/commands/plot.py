"""arm3r-plot: figures of a run, from its CSV or straight from a scenario."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .._files import check_folder, make_folder
from ..errors import UsageError
from ..plot.figure_files import check_format, write
from ..plot.style import FORMATS, WIDTH
from .exit_codes import attempt, print_line
from .run_source import add_set, read

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..run import Run

MIN_WIDTH, MAX_WIDTH = 3.0, 12.0  # inches


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-plot`; argv without the program's name. Returns an exit code, one of those of `arm3r`."""
    argv = sys.argv[1:] if argv is None else argv
    if argv[:1] == ["sweep"]:
        from .plot_sweep import main as draw_sweep

        return draw_sweep(argv[1:])
    options = parser().parse_args(argv)
    return attempt("arm3r-plot", lambda: draw(options))


def draw(options: argparse.Namespace) -> None:
    runs = {path: read(path, options.set) for path in paths_of(options)}
    target = target_of(options)
    save({path: run for path, (run, _) in runs.items()}, options, target)
    for _, failure in runs.values():
        if failure:
            raise failure


def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="arm3r-plot",
        usage="arm3r-plot RUN [options] | arm3r-plot --compare RUN RUN ... [options]",
        description="Draw a run: its force control, if it controls force, else an overview; or the lecture's figures; "
        "or several runs over each other. docs/figures.md says what stands on them.",
        epilog="arm3r-plot sweep DIR draws the table of a sweep: see arm3r-plot sweep --help.",
    )
    add = parser.add_argument
    add(
        "run", type=Path, nargs="?", metavar="RUN", help="RUN.csv with RUN.json beside it, RUN.npz, or a scenario .yaml"
    )
    kind = parser.add_mutually_exclusive_group()
    pick = kind.add_argument
    pick(
        "--overview", action="store_true", help="angles, tip, torques and force of any run (default without force_ref)"
    )
    pick(
        "--force", action="store_true", help="the force-control figure of any run with a wall (default with force_ref)"
    )
    pick(
        "--lecture", action="store_true", help="tip, velocities, torques, energies, wall, contact, strobe: a file each"
    )
    pick("--compare", type=Path, nargs="+", metavar="RUN", help="two to six runs over each other, and their metrics")
    add(
        "-o",
        dest="out",
        type=Path,
        metavar="PATH",
        help="folder, made if it is missing, or without --lecture also a file in a folder that exists (default: here)",
    )
    add_set(parser)
    add("--format", choices=FORMATS, help="of the files written (default: that of -o FILE, else png)")
    width = f"of --force and --compare (default: {WIDTH}; 3.4 fits a journal's column)"
    add("--width", type=inches, metavar="INCHES", help=width)
    return parser


def inches(text: str) -> float:
    width = float(text)
    if not MIN_WIDTH <= width <= MAX_WIDTH:
        raise argparse.ArgumentTypeError(f"{MIN_WIDTH:g} to {MAX_WIDTH:g} inches are possible, got {text}")
    return width


def paths_of(options: argparse.Namespace) -> list[Path]:
    paths = [*([options.run] if options.run else []), *(options.compare or [])]
    if not paths:
        raise UsageError("RUN: a run is needed, such as RUN.csv; see arm3r-plot --help", code="usage")
    if options.compare and len(set(paths)) < len(paths):
        raise UsageError("--compare: the same run is given twice; give different ones", code="usage")
    return paths


def target_of(options: argparse.Namespace) -> tuple[Path, str]:
    """What the files' names begin with, and their format."""
    out = options.out or Path()
    if out.is_dir() or not out.suffix:
        make_folder(out)
        return out / ("compare" if options.compare else options.run.stem), options.format or "png"
    if options.lecture:
        raise UsageError(f"-o {out}: with --lecture several files are written; give a folder")
    check_format(out)
    check_folder(out.parent)
    if options.format not in (None, out.suffix[1:]):
        raise UsageError(f"-o {out}: is not {options.format}; leave --format away or change the name")
    return out.with_suffix(""), out.suffix[1:]


def save(runs: dict[Path, Run], options: argparse.Namespace, target: tuple[Path, str]) -> None:
    import matplotlib

    matplotlib.use("Agg")
    stem, suffix = target
    files = {Path(f"{stem}{name}.{suffix}"): figure for name, figure in figures(runs, options).items()}
    write(files)
    for path in files:
        print_line(path)


def figures(runs: dict[Path, Run], options: argparse.Namespace) -> dict[str, Figure]:
    """The figures by the ends of their files' names."""
    from ..plot import compare, force, lecture, overview

    if options.compare:
        return {"": compare(named(runs), width=options.width or WIDTH)}
    (run,) = runs.values()
    if options.force or not (options.lecture or options.overview or "force_ref" not in run):
        return {"": force(run, width=options.width or WIDTH)}
    if options.width:
        raise UsageError("--width: this figure has a width of its own; leave it away or add --force", code="usage")
    if options.lecture:
        return {f"_{name}": figure for name, figure in lecture(run).items()}
    return {"": overview(run)}


def named(runs: dict[Path, Run]) -> dict[str, Run]:
    """The runs by their names, or where these are alike by those of their files."""
    for names in ([run.summary["name"] for run in runs.values()], [path.stem for path in runs]):
        if len(set(names)) == len(names):
            return dict(zip(names, runs.values(), strict=True))
    return {str(path.with_suffix("")): run for path, run in runs.items()}


if __name__ == "__main__":
    sys.exit(main())
