"""How the commands end: the exit codes of `arm3r`, and signals."""

from __future__ import annotations

import sys
from collections.abc import Callable

from .._messages import shown
from ..errors import (
    Arm3rError,
    BudgetError,
    ControllerError,
    IncompatibleError,
    NumericalError,
    OutputError,
    ScenarioError,
    UnjudgedError,
    UsageError,
)
from ..system.processes import end_by_closed_pipe, end_by_interrupt

FAILED_RUNS = 7
FAILED_CHECK = 10
WRONG_FORMULA = 11
UNJUDGED = 12
_CODES: dict[type[Arm3rError], int] = {
    UnjudgedError: UNJUDGED,  # before its base
    UsageError: 2,
    ScenarioError: 3,
    NumericalError: 4,
    BudgetError: 5,
    OutputError: 6,
    ControllerError: 8,
    IncompatibleError: 9,
}


def exit_code(error: Arm3rError) -> int:
    return next((code for kind, code in _CODES.items() if isinstance(error, kind)), 1)


def attempt(program: str, work: Callable[[], None]) -> int:
    """Do the work of a command: its exit code, and on stderr what went wrong. Ctrl-C ends it by the signal."""
    try:
        work()
    except Arm3rError as error:
        say(program, error)
        return exit_code(error)
    except ModuleNotFoundError as error:
        say(program, f"needs {error.name}, which is not installed: pip install {error.name}")
        return exit_code(UsageError(str(error)))
    except KeyboardInterrupt:
        end_by_interrupt()
    return 0


def say(program: str, message: object) -> None:
    """Print a message on stderr: one line, whatever foreign text it holds; or a line for each problem of a scenario."""
    text = str(message)
    lines = text.split("\n") if isinstance(message, ScenarioError) else [text]
    print("\n".join(map(shown, [f"{program}: {lines[0]}", *lines[1:]])), file=sys.stderr, flush=True)


def print_line(line: object) -> None:
    """Print lines of text on stdout, with what else is not printable escaped.

    If the reader has closed the pipe, the process ends by SIGPIPE.

    Raises:
        OutputError: it cannot be written.
    """
    try:
        print("\n".join(map(shown, str(line).split("\n"))), flush=True)
    except OSError as error:
        sys.stdout = None  # else Python tries again when it ends
        if isinstance(error, BrokenPipeError):
            end_by_closed_pipe()
        raise OutputError(f"standard output cannot be written: {error.strerror}", code="output") from error
