"""The run that a command draws: a finished one from its file, or a scenario that is run now."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import Arm3rError, UsageError

if TYPE_CHECKING:
    from ..core.run import Run
    from ..core.scenario import Scenario

SCENARIOS = (".yaml", ".yml")


def add_set(parser: argparse.ArgumentParser) -> None:
    """The option by which a scenario is changed before it is run."""
    help = "set PATH of a scenario .yaml to VALUE; may be given several times"
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", help=help)


def add_part(parser: argparse.ArgumentParser) -> None:
    """The options for a part of a run."""
    add = parser.add_argument
    add("--from", dest="start", type=float, metavar="T", help="first time that is shown, s (default: the run's start)")
    add("--to", dest="end", type=float, metavar="T", help="last time that is shown, s (default: the run's end)")


def read(path: Path, edits: Sequence[str] = ()) -> tuple[Run, Arm3rError | None]:
    """The run, of a scenario with these edits; and why it is only a partial one, if it is."""
    from ..core.run import Run

    if path.suffix not in SCENARIOS:
        if edits:
            raise UsageError(f"--set {edits[0]}: {path} is a finished run; give a scenario's .yaml", code="usage")
        return Run.load(path), None
    try:
        return scenario_of(path, edits).run(), None
    except Arm3rError as error:
        if error.run is None:
            raise
        return error.run, error


def scenario_of(path: Path, edits: Sequence[str]) -> Scenario:
    """The scenario of a file, with these edits.

    Raises:
        UsageError: the file is none, or cannot be read.
    """
    from ..core.scenario import Scenario

    if path.suffix not in SCENARIOS:
        raise UsageError(f"{path}: a scenario's .yaml is needed", code="usage")
    scenario = Scenario.load(path)
    for edit in edits:
        scenario.set_from_option(edit)
    return scenario
