"""How the commands end: the exit codes of `arm3r`, and signals."""

from __future__ import annotations

import sys
from collections.abc import Callable

from ..errors import (
    Arm3rError,
    BudgetError,
    ControllerError,
    IncompatibleError,
    NumericalError,
    OutputError,
    ScenarioError,
    UsageError,
)
from ..system.processes import end_by_closed_pipe, end_by_interrupt

FAILED_RUNS = 7
FAILED_CHECK = 10
WRONG_FORMULA = 11
_CODES: dict[type[Arm3rError], int] = {
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
        print(f"{program}: {error}", file=sys.stderr)
        return exit_code(error)
    except ModuleNotFoundError as error:
        print(f"{program}: needs {error.name}, which is not installed: pip install {error.name}", file=sys.stderr)
        return exit_code(UsageError(str(error)))
    except KeyboardInterrupt:
        end_by_interrupt()
    return 0


def print_line(line: object) -> None:
    """Print a line on stdout. If its reader has closed the pipe, end by SIGPIPE.

    Raises:
        OutputError: it cannot be written.
    """
    try:
        print(line, flush=True)
    except OSError as error:
        sys.stdout = None  # else Python tries again when it ends
        if isinstance(error, BrokenPipeError):
            end_by_closed_pipe()
        raise OutputError(f"standard output cannot be written: {error.strerror}", code="output") from error
