"""Runs a user's Python file in a process of its own, which is confined and ends with its work."""

from __future__ import annotations

import contextlib
import os
import weakref
from collections.abc import Callable
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from ..system.limits import PROCESSOR_TIME
from ..system.patience import Patience, TooSlow, Waits
from ..system.processes import end_with_descendants, processor_time
from ..system.timed_pipe import PumpedPipe, SelectedPipe
from .answers import BROKEN, BrokenAnswer, answer_of, arguments_of, calls_of, head_of, unbarred_of
from .child import HEAD, send
from .programs import Call, Edit, Given, ProcessEnded, ProgramError, Unjudged
from .start import STARTING_TIME, Process, start

Floats = NDArray[np.float64]
_PACKAGE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
_MOST_BYTES, _MOST_BYTES_OF_HEAD = 64 << 20, 1 << 16  # of an answer
ANSWER_TIME, EDIT_TIME = 10.0, 2.0  # s of processor time
_MOST_ENDS = 3
"""Processes that edits may end one after the other, by a crash of the interpreter; and in all, by taking too long."""


class PythonProcess:
    """A function of a Python file; its process starts with the first evaluation."""

    forbid_own_package = False
    """Whether the user's file may not import this package, and copy its answer."""
    report: Callable[[list[str]], None] | None = None
    """Told what the system cannot bar, before the user's file runs."""

    def __init__(self, text: str, function: str, file: str) -> None:
        self.text, self.function, self.file = text, function, file
        self.unbarred: list[str] = []
        self._seconds = [0.0]
        self._process: Process | None = None
        self._answers: SelectedPipe | PumpedPipe | None = None
        self._ends = self._stops = 0

    @property
    def seconds(self) -> float:
        """How long its processes have computed, as they say."""
        return sum(self._seconds)

    def evaluate(self, call: Call, table: Floats, edit: Edit | None = None) -> Floats:
        """A row of numbers for each row of the table, in the shape that the function returns.

        Raises:
            ProgramError: the function failed, or its process ended.
            Unjudged: it took too long, needs too much memory, or answered in the process's place.
        """
        if edit and self._ends > _MOST_ENDS:
            raise ProgramError("too many edits ended its process")
        head, body = self._asked(call, table, edit=edit)
        answer = self._understood(lambda: answer_of(head, body, len(table)))
        self._ends, self._seconds[-1] = self._stops, answer.seconds
        if answer.values is None:
            raise answer.failure()
        return answer.values

    def calls(self, call: Call, table: Floats) -> int:
        """How many functions an evaluation calls, as the process says.

        Raises:
            ProgramError, Unjudged: as `evaluate`.
        """
        head, _ = self._asked(call, table, counted=True)
        return self._understood(lambda: calls_of(head))

    def _asked(
        self, call: Call, table: Floats, *, edit: Edit | None = None, counted: bool = False
    ) -> tuple[Any, bytes]:
        """The answer to a request for an evaluation."""
        if self._process is None:
            self._start()
        head = {
            "rows": len(table),
            "slots": [{"given": one.value} if isinstance(one, Given) else one for one in call.slots],
            "outside": dict(call.outside),
            "lifted": call.lifted,
            "output": call.output,
            "as_columns": call.as_columns,
            "edit": edit and list(edit),
            "counted": counted,
        }
        self._send(head, np.ascontiguousarray(table).tobytes())
        return self._receive(EDIT_TIME if edit else ANSWER_TIME)

    def arguments(self) -> tuple[list[str], list[str]]:
        """The names of the arguments of what the text makes a function of, and those that have a default.

        Raises:
            ProgramError, Unjudged: the text failed, or the name stands for no function.
        """
        if self._process is None:
            self._start()
        self._send({"rows": None}, b"")
        head, _ = self._receive(ANSWER_TIME)
        return self._understood(lambda: arguments_of(head))

    def _start(self) -> None:
        self._attach(*start())
        self._send(self._described(), b"")
        head, _ = self._receive(STARTING_TIME)
        self.unbarred = self._understood(lambda: unbarred_of(head))
        if self.unbarred and PythonProcess.report:
            PythonProcess.report(self.unbarred)

    def _described(self) -> dict[str, Any]:
        """The program, for the process that is to run it."""
        folder = os.path.dirname(os.path.abspath(self.file)) if os.path.isfile(self.file) else ""
        return {
            "text": self.text,
            "function": self.function,
            "file": self.file,
            "folder": folder,
            "hidden_package": _PACKAGE if self.forbid_own_package else "",
        }

    def _attach(self, process: Process, answers: SelectedPipe | PumpedPipe) -> None:
        self._process, self._answers = process, answers
        self._patience = Patience(process.pid, STARTING_TIME)
        self._end = weakref.finalize(self, end_process, process, answers)

    def _send(self, head: dict[str, Any], body: bytes) -> None:
        assert self._process and self._process.stdin
        try:
            send(self._process.stdin, head, body)
        except OSError:
            self._fail("ends its process")

    def _receive(self, seconds: float) -> tuple[Any, bytes]:
        assert self._process
        self._patience.renew(seconds)
        lengths = HEAD.unpack(self._read(HEAD.size))
        if lengths[0] > _MOST_BYTES_OF_HEAD or lengths[1] > _MOST_BYTES:
            self._fail(BROKEN, Unjudged)
        text, body = map(self._read, lengths)
        return self._understood(lambda: head_of(text)), body

    def _understood(self, parse: Callable[[], Any]) -> Any:
        try:
            return parse()
        except BrokenAnswer:
            self._fail(BROKEN, Unjudged)

    def _read(self, count: int) -> bytes:
        assert self._answers and self._process
        try:
            return self._answers.read(count, self._patience)
        except TooSlow:
            self._fail("takes too long: it was stopped", Unjudged)
        except Waits:
            self._fail("takes too long: it waits for something", Unjudged)
        except EOFError:
            if (processor_time(self._process.pid) or 0.0) > PROCESSOR_TIME - 1:
                self._fail("takes too long: it was stopped", Unjudged)
            self._fail("ends its process")

    def _fail(self, message: str, kind: type[ProcessEnded] = ProcessEnded) -> NoReturn:
        self._ends += 1
        self._stops += kind is Unjudged
        if self._process is not None:
            self._seconds[-1] = processor_time(self._process.pid) or self._seconds[-1]
        self.close()
        raise kind(message)

    def close(self) -> None:
        """End the process and all that it started."""
        if self._process is not None:
            self._end()
            self._process = None
            self._seconds.append(0.0)


def end_process(process: Process, answers: SelectedPipe | PumpedPipe) -> None:
    """End a process, and all that it started."""
    end_with_descendants(process.pid)
    process.wait()
    answers.close()
    if process.stdin:
        with contextlib.suppress(OSError):
            process.stdin.close()
