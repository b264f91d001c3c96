"""arm3r-plot: figures of a run, from its CSV or straight from a scenario."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from .._files import check_folder, folder_named, make_folder
from ..errors import UsageError
from ..measured.reader import is_measurement
from ..plot.figure_files import check_format, write
from ..plot.style import FORMATS, WIDTH
from .exit_codes import attempt, print_line
from .run_source import add_part, add_set, read, scenario_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..core.run import Run

MIN_WIDTH, MAX_WIDTH = 3.0, 12.0  # inches
MIN_HEIGHT, MAX_HEIGHT = 1.0, 30.0  # inches


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-plot`; argv without the program's name. Returns an exit code, one of those of `arm3r`."""
    argv = sys.argv[1:] if argv is None else argv
    if argv[:1] == ["sweep"]:
        from .plot_sweep import main as draw_sweep

        return draw_sweep(argv[1:])
    options = parser().parse_args(argv)
    return attempt("arm3r-plot", lambda: draw(options))


def draw(options: argparse.Namespace) -> None:
    if options.controller:
        return draw_beside(options)
    paths = paths_of(options)
    logs = [path for path in paths if is_measurement(path)]
    check_measured(logs, options)
    target = target_of(options)
    runs = {path: read(path, options.set) for path in paths if path not in logs}
    save({path: run for path, (run, _) in runs.items()}, options, target, logs)
    for _, failure in runs.values():
        if failure:
            raise failure


def check_measured(logs: Sequence[Path], options: argparse.Namespace) -> None:
    """
    Raises:
        UsageError: there are several measurements, or a figure of runs alone is asked for.
    """
    if len(logs) > 1:
        raise UsageError(
            f"{logs[1]}: one measurement (a CSV file without a JSON file beside it) is drawn, got {len(logs)}"
        )
    if logs and (options.lecture or options.force or options.overview):
        why = "a measurement has no summary (there is no JSON file beside it); give --compare, or leave the option out"
        raise UsageError(f"{logs[0]}: {why}", code="usage")


def draw_beside(options: argparse.Namespace) -> None:
    """Your function as the controller, and the scenario's."""
    if options.panels:
        raise UsageError("--panels: with --controller the panels are those of two controllers; leave it out")
    paths_of(options)
    scenario, (stem, suffix) = scenario_of(options.run, options.set), target_of(options)
    with contextlib.redirect_stdout(sys.stderr):  # what the user's function prints
        beside = scenario.run_beside(options.controller)
    path = Path(f"{stem}.{suffix}")
    part = {"start": options.start, "end": options.end, "degrees": options.degrees, "stamp": options.stamp}
    write({path: beside.figure(width=options.width or WIDTH, height=options.height, **part)})
    print_line(path)
    if beside.failure:
        raise beside.failure


def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="arm3r-plot",
        usage="arm3r-plot RUN [options] | arm3r-plot --compare RUN RUN ... [options]",
        description="Draw a run: its force control, if it controls force, else an overview; or the lecture's figures; "
        "or several runs over each other. A file names scenario, convention and hash in its metadata. "
        "`arm3r docs figures` describes the figures.",
        epilog="arm3r-plot sweep DIR draws the table of a sweep: see arm3r-plot sweep --help.",
    )
    add = parser.add_argument
    add(
        "run", type=Path, nargs="?", metavar="RUN", help="RUN.csv with RUN.json beside it, RUN.npz, or a scenario .yaml"
    )
    kind = parser.add_mutually_exclusive_group()
    pick = kind.add_argument
    pick(
        "--overview",
        action="store_true",
        help="angles, tip, errors, torques and force of any run (default without force_ref)",
    )
    pick(
        "--force", action="store_true", help="the force-control figure of any run with a wall (default with force_ref)"
    )
    pick(
        "--lecture", action="store_true", help="tip, velocities, torques, energies, wall, contact, strobe: a file each"
    )
    pick(
        "--compare",
        type=Path,
        nargs="+",
        metavar="RUN",
        help="two to six runs over each other, and their "
        "metrics; or runs over a measurement, a CSV file with a column t or time and no JSON file beside it",
    )
    add(
        "-o",
        dest="out",
        type=Path,
        metavar="PATH",
        help="folder, made if it is missing, or without --lecture also a file in a folder that exists (default: here)",
    )
    controller = "run your function as the controller of the scenario RUN, beside its own, and draw both; FILE is "
    pick("--controller", metavar="FILE[:FUNCTION]", help=f"{controller}executed without confinement")
    add_set(parser)
    add("--format", choices=FORMATS, help="of the files written (default: that of -o FILE, else png)")
    add_part(parser)
    add_layout(parser)
    return parser


def add_layout(parser: argparse.ArgumentParser) -> None:
    """The options for what stands on a figure, and how large it is."""
    add = parser.add_argument
    names = "panels to draw, in order, such as force,torques; with --lecture figures; a wrong name lists what there is"
    add("--panels", type=names_of, metavar="NAME,NAME", help=names)
    width = f"width (default: {WIDTH}; 3.4 fits a journal's column; not with --lecture)"
    add("--width", type=partial(inches, MIN_WIDTH, MAX_WIDTH), metavar="INCHES", help=width)
    height = "height (default: what the panels need, at most a page of 9; not with --lecture)"
    add("--height", type=partial(inches, MIN_HEIGHT, MAX_HEIGHT), metavar="INCHES", help=height)
    unit = "angles in degrees, or in radians (default: as the scenario gives those of its start; not with --lecture)"
    angles = parser.add_mutually_exclusive_group()
    angles.add_argument("--degrees", action="store_true", default=None, help=unit)
    angles.add_argument("--radians", dest="degrees", action="store_false", default=None, help="see --degrees")
    add("--stamp", action="store_true", help="write scenario, convention and hash at the bottom of the figure")


def inches(least: float, most: float, text: str) -> float:
    size = float(text)
    if not least <= size <= most:
        raise argparse.ArgumentTypeError(f"{least:g} to {most:g} inches are possible, got {text}")
    return size


def names_of(text: str) -> list[str]:
    return [name.strip() for name in text.split(",") if name.strip()]


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
        make_folder(folder_named(out))
        return out / ("compare" if options.compare else options.run.stem), options.format or "png"
    if options.lecture:
        raise UsageError(f"-o {out}: with --lecture several files are written; give a folder")
    check_format(out)
    check_folder(out.parent)
    if options.format not in (None, out.suffix[1:]):
        raise UsageError(f"-o {out}: is not {options.format}; leave out --format or change the name")
    return out.with_suffix(""), out.suffix[1:]


def save(
    runs: dict[Path, Run], options: argparse.Namespace, target: tuple[Path, str], logs: Sequence[Path] = ()
) -> None:
    stem, suffix = target
    files = {Path(f"{stem}{name}.{suffix}"): figure for name, figure in figures(runs, options, logs).items()}
    write(files)
    for path in files:
        print_line(path)


def figures(runs: dict[Path, Run], options: argparse.Namespace, logs: Sequence[Path] = ()) -> dict[str, Figure]:
    """The figures by the ends of their files' names."""
    from ..plot import compare, force, lecture, measured, overview

    if options.lecture and (options.width or options.height):
        given = "--width" if options.width else "--height"
        raise UsageError(f"{given}: the lecture's figures have a fixed size; leave it out", code="usage")
    if options.lecture and options.degrees is not None:
        given = "--degrees" if options.degrees else "--radians"
        raise UsageError(f"{given}: the lecture's figures show no joint angles; leave it out", code="usage")
    part = {"start": options.start, "end": options.end, "panels": options.panels, "stamp": options.stamp}
    look = {"width": options.width or WIDTH, "height": options.height, "degrees": options.degrees}
    if logs:
        return {"": measured(logs[0], named(runs), **look, **part)}
    if options.compare:
        return {"": compare(named(runs), **look, **part)}
    (run,) = runs.values()
    if options.lecture:
        return {f"_{name}": figure for name, figure in lecture(run, **part).items()}
    draws_force = options.force or ("force_ref" in run and not options.overview)
    return {"": (force if draws_force else overview)(run, **look, **part)}


def named(runs: dict[Path, Run]) -> dict[str, Run]:
    """The runs by their names, or where these are alike by those of their files."""
    for names in ([run.summary["name"] for run in runs.values()], [path.stem for path in runs]):
        if len(set(names)) == len(names):
            return dict(zip(names, runs.values(), strict=True))
    return {str(path.with_suffix("")): run for path, run in runs.items()}


if __name__ == "__main__":
    sys.exit(main())
