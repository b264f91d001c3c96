"""arm3r-run: `arm3r run --controller FILE`: a function of the user's own as the controller, beside the scenario's."""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._files import folder_named, make_folder
from .._messages import as_json, shown
from .._progress_bar import Bar
from ..errors import Arm3rError, UsageError
from .exit_codes import FAILED_CHECK, attempt, exit_code, print_line

if TYPE_CHECKING:
    from ..blocks.block import Block
    from ..core.comparison import Beside
    from ..core.scenario import Scenario

PROGRAM = "arm3r"


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-run`; argv without the program's name. Returns one of the exit codes of `arm3r`."""
    options = parser().parse_args(sys.argv[1:] if argv is None else argv)
    codes: list[int] = []
    code = attempt(PROGRAM, lambda: codes.extend(run_all(options)))
    return code or min((one for one in codes if one), default=0)


def parser() -> argparse.ArgumentParser:
    """The executable has read the words before: it hands them over in their long form."""
    parser = argparse.ArgumentParser(prog="arm3r-run", usage="arm3r run FILE... --controller FILE[:FUNCTION] [options]",
                                     description="See arm3r run --help.")  # fmt: skip
    add = parser.add_argument
    add("files", nargs="+", metavar="FILE")
    add("--controller", required=True, metavar="FILE[:FUNCTION]")
    add("--output", "-o", default="", metavar="OUT")
    add("--set", action="append", default=[], metavar="PATH=VALUE")
    add("--no-checks", action="store_true")
    add("--json", action="store_true")
    add("--time-limit", type=float, metavar="SECONDS")
    return parser


def run_all(options: argparse.Namespace) -> list[int]:
    """The exit code of each run."""
    from ..blocks.block import Block

    block = Block.read(options.controller)
    scenarios = load_all(options)
    outputs = plan_outputs(options, scenarios)
    say = print_error if options.output == "-" else print_line
    found, codes = [], []
    for scenario, output in zip(scenarios, outputs, strict=True):
        with contextlib.redirect_stdout(sys.stderr):  # what the user's function prints
            beside = beside_of(scenario, block, options)
        write(beside, output)
        codes.append(code_of(beside))
        found.append(summary(beside))
        if not options.json:
            say(("\n" if len(codes) > 1 else "") + beside.yours.report() + str(beside))
        if beside.failure:
            print_error(f"{PROGRAM}: {shown(str(beside.failure))}")
    if options.json:
        say(as_json(found if len(found) > 1 else found[0]))
    elif len(found) > 1:
        say(f"\n{len(found)} runs, {sum(map(bool, codes))} not ok")
    return codes


# ---- scenarios and files, as the executable treats them -------------------------------------------------------------


def load_all(options: argparse.Namespace) -> list[Scenario]:
    """All scenarios, with the edits.

    Raises:
        Arm3rError: one cannot be read or is not valid; the problems of all of them.
    """
    found, failures = [], []
    for file in options.files:
        try:
            found.append(loaded(file, options))
        except Arm3rError as error:
            failures.append(error)
    if failures:
        raise type(failures[0])("\n".join(map(str, failures)), code=failures[0].code)
    return found


def loaded(file: str, options: argparse.Namespace) -> Scenario:
    from ..core.scenario import Scenario

    scenario = Scenario.load(file)
    for edit in options.set:
        scenario.set_from_option(edit)
    if options.no_checks:
        scenario.edit("checks", "[]", "--no-checks")
    scenario.quiet().validate()  # the summary has its warnings
    return scenario


def plan_outputs(options: argparse.Namespace, scenarios: Sequence[Scenario]) -> list[str]:
    """A file for each scenario, checked before the first run; "-" is standard output, "" nowhere.

    Raises:
        UsageError: two runs would write one file, or a run would overwrite what is read.
        OutputError: a file cannot be written.
    """
    out: str = options.output
    if out in ("", "-"):
        if out and len(scenarios) > 1:
            raise UsageError("-o - takes one scenario", code="usage")
        return [out] * len(scenarios)
    if len(scenarios) > 1 or out.endswith(("/", os.sep)):
        make_folder(folder_named(out))
    paths = [os.path.join(out, f"{scenario.name}.csv") if os.path.isdir(out) else out for scenario in scenarios]
    for i, path in enumerate(paths):
        if path in paths[:i]:
            raise UsageError(f"{path}: two scenarios would write this file; give them names", code="usage")
        probe(path, options)
    return paths


def probe(path: str, options: argparse.Namespace) -> None:
    """Whether a run can be written there, without harm to what is read."""
    from .. import _native
    from ..verify.formula import split_name

    beside = _native.text(_native.lib.arm3r_output_summary, *_native.file_path(path))
    for read in (*options.files, split_name(options.controller)[0]):
        for written in (path, beside):
            if os.path.exists(read) and os.path.exists(written) and os.path.samefile(read, written):
                raise UsageError(f"{written}: this would overwrite {read}; give -o another name", code="usage")
    _native.call(_native.lib.arm3r_output_probe, *_native.file_path(path))


# ---- a run ----------------------------------------------------------------------------------------------------------


def beside_of(scenario: Scenario, block: Block, options: argparse.Namespace) -> Beside:
    from ..blocks.beside import run_beside

    bar = Bar(scenario.name, "ms")

    def draw(t: float, stop: float, _: int) -> None:
        bar.draw(int(1e3 * t), max(1, int(1e3 * stop)))

    try:
        return run_beside(scenario, block, time_limit=options.time_limit, progress=draw)
    finally:
        bar.clear()


def write(beside: Beside, output: str) -> None:
    """Your run as CSV, with its summary beside it.

    Raises:
        OutputError: it cannot be written.
    """
    if output == "-":
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "run.csv"
            beside.yours.to_csv(path)
            print_line(path.read_text().rstrip("\n"))
    elif output:
        beside.yours.save(output)


def code_of(beside: Beside) -> int:
    if beside.failure:
        return exit_code(beside.failure)
    return 0 if beside.yours.passed else FAILED_CHECK


def summary(beside: Beside) -> dict[str, Any]:
    """The JSON summary of your run, with what lies beside it."""
    from .. import _native
    from ..blocks.report import as_json

    text = _native.text(_native.lib.arm3r_run_summary, beside.yours.handle)
    return {**json.loads(text), "beside": as_json(beside)}


def print_error(line: object) -> None:
    print(line, file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
