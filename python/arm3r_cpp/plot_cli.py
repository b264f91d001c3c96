"""arm3r-plot: figures of a run, from its CSV or straight from a scenario."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import Arm3rError, OutputError, UsageError
from .exits import attempt, tell
from .plot_style import FORMATS

if TYPE_CHECKING:
    from .run import Run

SCENARIOS = (".yaml", ".yml")


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-plot`; argv without the program's name. Returns an exit code, one of those of `arm3r`."""
    argv = sys.argv[1:] if argv is None else argv
    if argv[:1] == ["sweep"]:
        from .plot_sweep_cli import main as draw_sweep

        return draw_sweep(argv[1:])
    options = parser().parse_args(argv)
    return attempt("arm3r-plot", lambda: draw(options))


def draw(options: argparse.Namespace) -> None:
    target = target_of(options)
    run, failure = read(options.run)
    save(run, options, target)
    if failure:
        raise failure


def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="arm3r-plot",
        description="Draw a run: an overview in one figure, or the lecture's figures.",
        epilog="arm3r-plot sweep DIR draws the table of a sweep: see arm3r-plot sweep --help.",
    )
    add = parser.add_argument
    add("run", type=Path, metavar="RUN", help="RUN.csv with RUN.json beside it, RUN.npz, or a scenario .yaml to run")
    add("--lecture", action="store_true", help="tip, velocities, torques, energies, wall, contact, strobe: a file each")
    add("-o", dest="out", type=Path, metavar="PATH", help="folder, or without --lecture also a file (default: here)")
    add("--format", choices=FORMATS, help="of the files written (default: that of -o FILE, else png)")
    return parser


def target_of(options: argparse.Namespace) -> tuple[Path, str]:
    """What the files' names begin with, and their format."""
    out = options.out or Path()
    if out.is_dir() or not out.suffix:
        return out / options.run.stem, options.format or "png"
    if options.lecture:
        raise UsageError(f"-o {out}: with --lecture several files are written; give a folder")
    if out.suffix[1:] not in FORMATS:
        raise UsageError(f"-o {out}: cannot write {out.suffix}; use one of {', '.join(FORMATS)}")
    if options.format not in (None, out.suffix[1:]):
        raise UsageError(f"-o {out}: is not {options.format}; leave --format away or change the name")
    return out.with_suffix(""), out.suffix[1:]


def read(path: Path) -> tuple[Run, Arm3rError | None]:
    """The run; and why it is only a partial one, if it is."""
    from .run import Run
    from .scenario import Scenario

    if path.suffix not in SCENARIOS:
        return Run.load(path), None
    try:
        return Scenario.load(path).run(), None
    except Arm3rError as error:
        if error.run is None:
            raise
        return error.run, error


def save(run: Run, options: argparse.Namespace, target: tuple[Path, str]) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from .plot import lecture, overview
    from .plot_style import style

    stem, suffix = target
    if options.lecture:
        figures = {f"{stem}_{name}": figure for name, figure in lecture(run).items()}
    else:
        figures = {str(stem): overview(run)}
    try:
        stem.parent.mkdir(parents=True, exist_ok=True)
        for name, figure in figures.items():
            with style():
                figure.savefig(f"{name}.{suffix}")
            tell(f"{name}.{suffix}")
    except OutputError:
        raise
    except OSError as error:
        raise OutputError(f"cannot write figures: {error}") from error


if __name__ == "__main__":
    sys.exit(main())
