"""arm3r-sweep: many runs from one file, into a folder with one table."""

from __future__ import annotations

import argparse
import signal
import sys
import time
import warnings
from collections.abc import Sequence
from typing import Any

from .errors import Arm3rError
from .exits import FAILED_RUNS, die_of, exit_code, tell

BAR = 30  # characters


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-sweep`; argv without the program's name. Returns an exit code, one of those of `arm3r`."""
    options = parser().parse_args(argv)
    warnings.showwarning = _say  # type: ignore[assignment]
    bar = Bar()
    try:
        from .sweep_file import Sweep
        from .sweep_run import sweep

        plan = Sweep.load(options.sweep, overrides=options.set)
        table = sweep(plan, out=options.out, jobs=options.jobs, resume=options.resume, parquet=options.parquet,
                      progress=bar.draw)  # fmt: skip
        bar.clear()
        failed = {outcome: count for outcome, count in table.outcomes.items() if outcome != "ok"}
        words = ", ".join(f"{count} {outcome}" for outcome, count in failed.items())
        counted = f"{plan.runs} run{'s' if plan.runs > 1 else ''}"
        tell(f"{table.path}: {counted}, {f'{sum(failed.values())} not ok: {words}' if failed else 'all ok'}")
    except Arm3rError as error:
        bar.clear()
        print(f"arm3r-sweep: {error}", file=sys.stderr)
        return exit_code(error)
    except KeyboardInterrupt:
        bar.clear()
        print(f"arm3r-sweep: interrupted; --resume goes on in {options.out}", file=sys.stderr)
        die_of(signal.SIGINT)
    return FAILED_RUNS if failed else 0


def parser() -> argparse.ArgumentParser:
    from ._native import version

    parser = argparse.ArgumentParser(prog="arm3r-sweep", description="Run a sweep: a table with one row a run.")
    add = parser.add_argument
    add("sweep", metavar="SWEEP.yaml", help="scenario, axes, and what is kept; see docs/sweeps.md")
    add("-o", dest="out", metavar="DIR", required=True, help="folder of the sweep: table, shards, ledger")
    add("--jobs", type=int, metavar="N", help="shards computed at a time (default: one for each CPU allowed)")
    add("--resume", action="store_true", help="go on where an interrupted sweep in DIR stopped")
    add("--set", action="append", default=[], metavar="PATH=VALUE", help="put a value into the scenario")
    add("--parquet", action="store_true", help="table.parquet instead of table.csv; needs pyarrow")
    add("--version", action="version", version=f"arm3r-sweep {version}")
    return parser


class Bar:
    """How far it is, on stderr where that is a terminal and the sweep is long: rate, and time left."""

    def __init__(self) -> None:
        self.start = time.monotonic()
        self.before: int | None = None
        self.drawn = False

    def draw(self, done: int, runs: int) -> None:
        seconds = time.monotonic() - self.start
        self.before = done if self.before is None else self.before
        if seconds < 1 or not sys.stderr.isatty():
            return
        rate = (done - self.before) / seconds
        left = f"{_clock((runs - done) / rate)} left" if rate else "-"
        filled = BAR * done // runs
        bar = "#" * filled + "." * (BAR - filled)
        line = f"sweep [{bar}] {100 * done // runs} %  {done} of {runs}  {rate:.3g} runs/s  {left}"
        print(f"\r{line}\x1b[K", end="", file=sys.stderr, flush=True)
        self.drawn = True

    def clear(self) -> None:
        if self.drawn:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
        self.drawn = False


def _clock(seconds: float) -> str:
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{seconds:02}" if hours else f"{minutes}:{seconds:02}"


def _say(message: Warning | str, *_: Any) -> None:
    print(f"arm3r-sweep: {message}", file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
