"""arm3r-sweep: many runs from one file, into a folder with one table."""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Sequence
from typing import Any

from .._progress_bar import Bar
from ..errors import Arm3rError
from ..system.processes import end_by_interrupt
from .exit_codes import FAILED_RUNS, exit_code, print_line, say

PROGRAM = "arm3r-sweep"


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-sweep`; argv without the program's name. Returns an exit code, one of those of `arm3r`."""
    options = parser().parse_args(argv)
    warnings.showwarning = _say  # type: ignore[assignment]
    bar = Bar("sweep", "runs")
    try:
        from ..answers.refusals import lines_of
        from ..sweeps.definition import Sweep
        from ..sweeps.runner import sweep

        plan = Sweep.load(options.sweep, overrides=options.set)
        table = sweep(plan, out=options.out, jobs=options.jobs, resume=options.resume, parquet=options.parquet,
                      progress=bar.draw, controller=options.controller)  # fmt: skip
        bar.clear()
        failed = {outcome: count for outcome, count in table.outcomes.items() if outcome != "ok"}
        words = ", ".join(f"{count} {outcome}" for outcome, count in failed.items())
        for line in lines_of(table.refusals, failed.get("invalid", 0)):
            print_line(f"  {line}")
        counted = f"{plan.runs} run{'s' if plan.runs > 1 else ''}"
        print_line(f"{table.path}: {counted}, {f'{sum(failed.values())} not ok: {words}' if failed else 'all ok'}")
    except Arm3rError as error:
        bar.clear()
        say(PROGRAM, error)
        return exit_code(error)
    except KeyboardInterrupt:
        bar.clear()
        say(PROGRAM, f"interrupted; --resume goes on in {options.out}")
        end_by_interrupt()
    return FAILED_RUNS if failed else 0


def parser() -> argparse.ArgumentParser:
    from .._native import version

    parser = argparse.ArgumentParser(prog=PROGRAM, description="Run a sweep: a table with one row a run.")
    add = parser.add_argument
    add("sweep", metavar="SWEEP.yaml", help="scenario, axes, and what is kept; see `arm3r docs sweeps`")
    add(
        "-o",
        dest="out",
        metavar="DIR",
        required=True,
        help="folder (without an ending) of the sweep: its table and its finished shards",
    )
    add("--jobs", type=int, metavar="N", help="shards computed at the same time (default: the number of usable CPUs)")
    add("--resume", action="store_true", help="go on where an interrupted sweep in DIR stopped")
    add(
        "--set",
        action="append",
        default=[],
        metavar="PATH=VALUE",
        help="set a value of the scenario; may be given several times",
    )
    controller = "a MATLAB or Python function of yours as the controller of every run; "
    unconfined = "FILE is executed without confinement"
    add("--controller", metavar="FILE[:FUNCTION]", help=controller + unconfined)
    add("--parquet", action="store_true", help="table.parquet instead of table.csv; needs pyarrow")
    add("--schema", action=_PrintSchema, nargs=0, help="print the JSON Schema of sweep files, for editors")
    add("--version", action="version", version=f"arm3r-sweep {version}")
    return parser


class _PrintSchema(argparse.Action):
    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        from .. import _native

        print_line(_native.string(_native.lib.arm3r_sweep_schema_json()).rstrip("\n"))
        parser.exit()


def _say(message: Warning | str, *_: Any) -> None:
    say(PROGRAM, str(message))


if __name__ == "__main__":
    sys.exit(main())
