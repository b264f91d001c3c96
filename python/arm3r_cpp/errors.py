"""The errors, one class for each way in which a caller can react."""

from __future__ import annotations

from typing import Any


class Arm3rError(Exception):
    """Base of all errors of the library; raised itself when a run was stopped by its progress function.

    Attributes:
        status: the library's status, negative; 0 when the call succeeded and the run it made did not.
        code: stable name of the error, such as "scenario.unknown_key".
        problems: everything that was found, each a dict with the keys code, message, file, line, column, path, got,
            allowed and hint.
        run: the partial `Run` up to the last good state, where there is one; else None.
        index: in a batch, the index of the state that failed; else None.
    """

    def __init__(
        self,
        message: str,
        *,
        status: int = 0,
        code: str = "",
        problems: list[dict[str, Any]] | None = None,
        run: Any = None,
        index: tuple[int, ...] | None = None,
    ) -> None:
        super().__init__(message)
        self.status = status
        self.code = code
        self.problems = problems or []
        self.run = run
        self.index = index


class UsageError(Arm3rError, ValueError):
    """An argument is not usable: out of range, out of reach, or a file that cannot be read."""


class UnjudgedError(UsageError):
    """A formula cannot be judged: it is not read, is too slow, or breaks the connection to its judge."""


class UnreadError(UnjudgedError):
    """A formula holds what is not read; its language may take it.

    Attributes:
        line: of the file, where it is known.
        reason: what is not read.
        name: without a value.
    """

    def __init__(self, message: str, *, line: int | None, reason: str, name: str = "") -> None:
        super().__init__(message)
        self.line = line
        self.reason = reason
        self.name = name


class ColumnError(UsageError, KeyError):
    """A run or a table has no column of this name."""

    __str__ = Exception.__str__  # KeyError's would quote the message


class ScenarioError(Arm3rError, ValueError):
    """The scenario is not valid; `problems` lists every place."""


class ScenarioWarning(UserWarning):
    """What is allowed in a scenario but probably a mistake, such as degrees that were written without `deg`."""


class NumericalError(Arm3rError, ArithmeticError):
    """The run diverged, its step collapsed, its contact chattered, its energy did not balance."""


class BudgetError(Arm3rError, RuntimeError):
    """The steps, time, rows or memory allowed are used up."""


class OutputError(Arm3rError, OSError):
    """A result cannot be written."""


class ControllerError(Arm3rError, RuntimeError):
    """A function called during the run failed: what it raised is `__cause__`. Or it gave no torque that can be applied.

    Attributes:
        tick: of the controller, where it was one: samples before this one; else None.
        t: s, when that was; else None.
        received: what it returned.
    """

    def __init__(
        self, message: str, *, tick: int | None = None, t: float | None = None, received: Any = None, **rest: Any
    ) -> None:
        super().__init__(message, **rest)
        self.tick = tick
        self.t = t
        self.received = received


class IncompatibleError(Arm3rError, RuntimeError):
    """Parts of different versions meet: library, extension or scenario format."""


class InternalError(Arm3rError, RuntimeError):
    """A bug in arm3r."""


_BLOCKS: dict[int, type[Arm3rError]] = {
    1: UsageError,
    2: ScenarioError,
    3: NumericalError,
    4: BudgetError,
    5: OutputError,
    6: ControllerError,
    7: IncompatibleError,
}


def class_of(status: int) -> type[Arm3rError]:
    """The class of a negative status: its hundreds decide, and what is unknown is internal."""
    return _BLOCKS.get(-status // 100, InternalError)


def class_of_outcome(outcome: str) -> type[Arm3rError]:
    """The class for a run that did not reach its end."""
    return {"stopped": Arm3rError, "budget": BudgetError, "controller": ControllerError}.get(outcome, NumericalError)
