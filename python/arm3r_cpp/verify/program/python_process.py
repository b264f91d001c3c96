"""Runs a user's Python file in a process of its own, which is confined and ends with its work."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
import time
import weakref
from collections.abc import Callable
from typing import IO, Any, NoReturn, Protocol

import numpy as np
from numpy.typing import NDArray

from ...system.processes import bare_environment, end_with_descendants
from ...system.timed_pipe import PumpedPipe, SelectedPipe, TimedPipe
from .child import HEAD, send
from .nodes import Call, Edit, ProcessEnded, ProgramError

Floats = NDArray[np.float64]
_FOLDER = os.path.dirname(os.path.abspath(__file__))
_PACKAGE = os.path.dirname(os.path.dirname(_FOLDER))
# The modules of this folder alone, under a name of their own: what is right is not in the process that is judged.
_START = """
import sys, types
package = sys.modules["_arm3r_program"] = types.ModuleType("_arm3r_program")
package.__path__ = sys.argv[1:]
from _arm3r_program.child import main
main()
"""
_MOST_BYTES = 64 << 20  # of an answer
STARTING_TIME, ANSWER_TIME, EDIT_TIME = 20.0, 10.0, 2.0  # s


class Process(Protocol):
    """A process that reads requests from `stdin`."""

    @property
    def pid(self) -> int: ...

    @property
    def stdin(self) -> IO[bytes] | None: ...

    def wait(self) -> Any: ...


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
        self._hung = 0

    @property
    def seconds(self) -> float:
        """How long its processes have computed, as they say."""
        return sum(self._seconds)

    def evaluate(self, call: Call, table: Floats, edit: Edit | None = None) -> Floats:
        """A row of numbers for each row of the table, in the shape that the function returns.

        Raises:
            ProgramError: the function failed, or its process ended or took too long.
        """
        if edit and self._hung > 3:
            raise ProgramError("too many edits made it hang")
        if self._process is None:
            self._start()
        head = {"rows": len(table), "slots": call.slots, "lifted": call.lifted, "edit": edit and list(edit)}
        self._send(head, np.ascontiguousarray(table).tobytes())
        head, body = self._receive(EDIT_TIME if edit else ANSWER_TIME)
        if isinstance(seconds := head.get("seconds"), float):
            self._seconds[-1] = seconds
        if "error" in head:
            line = head.get("line")
            raise ProgramError(str(head["error"])[:300], line if isinstance(line, int) else None)
        shape = head.get("shape")
        if not isinstance(shape, list) or not all(isinstance(size, int) and size >= 0 for size in shape):
            raise ProgramError("returns no numbers")
        if int(np.prod(shape)) * 8 != len(body) or shape[:1] != [len(table)]:
            raise ProgramError("returns no numbers")
        return np.frombuffer(body).reshape(shape)

    def _start(self) -> None:
        environment = {
            **bare_environment(),
            "OMP_NUM_THREADS": "1",
            "MPLBACKEND": "Agg",
            "HOME": "/",
        }
        process = subprocess.Popen(
            [sys.executable, "-I", "-c", _START, _FOLDER],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=environment,
            start_new_session=True,
            cwd="/",
        )
        assert process.stdout
        answers = TimedPipe(os.dup(process.stdout.fileno()))
        process.stdout.close()
        self._attach(process, answers)
        folder = os.path.dirname(os.path.abspath(self.file)) if os.path.isfile(self.file) else ""
        self._send(
            {
                "text": self.text,
                "function": self.function,
                "file": self.file,
                "folder": folder,
                "hidden_package": _PACKAGE if self.forbid_own_package else "",
            },
            b"",
        )
        head, _ = self._receive(STARTING_TIME)
        self.unbarred = [str(one) for one in head.get("unbarred", [])]
        if self.unbarred and PythonProcess.report:
            PythonProcess.report(self.unbarred)

    def _attach(self, process: Process, answers: SelectedPipe | PumpedPipe) -> None:
        self._process, self._answers = process, answers
        self._end = weakref.finalize(self, end_process, process, answers)

    def _send(self, head: dict[str, Any], body: bytes) -> None:
        assert self._process and self._process.stdin
        try:
            send(self._process.stdin, head, body)
        except OSError:
            self._fail("ends its process")

    def _receive(self, seconds: float) -> tuple[Any, bytes]:
        deadline = time.monotonic() + seconds
        lengths = HEAD.unpack(self._read(HEAD.size, deadline))
        if sum(lengths) > _MOST_BYTES:
            self._fail("returns too many numbers")
        text, body = (self._read(length, deadline) for length in lengths)
        try:
            head = json.loads(text)
        except ValueError:
            head = None
        if not isinstance(head, dict):
            self._fail("returns no numbers")
        return head, body

    def _read(self, count: int, deadline: float) -> bytes:
        assert self._answers
        try:
            return self._answers.read(count, deadline)
        except TimeoutError:
            self._hung += 1
            self._fail("takes too long: it was stopped")
        except EOFError:
            self._fail("ends its process")

    def _fail(self, message: str) -> NoReturn:
        self.close()
        raise ProcessEnded(message)

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
