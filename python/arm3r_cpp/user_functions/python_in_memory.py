"""A Python function of this process: called here, and with edits of its text in a copy of this process."""

from __future__ import annotations

import contextlib
import faulthandler
import gc
import os
import sys
import warnings
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from ..system.confinement import end_with_parent
from ..system.limits import limit_copy
from ..system.timed_pipe import SelectedPipe
from .child import answer, leave_standard_streams
from .programs import Call, Edit, ProgramError
from .python_process import PythonProcess
from .python_program import PythonProgram

Floats = NDArray[np.float64]


class PythonInMemory:
    """A function with its text. An edit of it may crash or hang: it runs in a copy of this process."""

    def __init__(self, text: str, function: str, file: str, namespace: dict[str, Any] | None = None) -> None:
        """namespace: what the function finds outside of its text; None: its text is all there is."""
        self._program = PythonProgram(text, function, file, namespace)
        self._copy = _Copy(self._program)
        self.has_surroundings = namespace is not None

    @property
    def seconds(self) -> float:
        """How long the copies of this process have computed."""
        return self._copy.seconds

    def evaluate(self, call: Call, table: Floats, edit: Edit | None = None) -> Floats:
        """A row of numbers for each row of the table, in the shape that the function returns.

        Raises:
            ProgramError: the function failed.
        """
        return (self._copy if edit else self._program).evaluate(call, table, edit)

    def arguments(self) -> tuple[list[str], list[str]]:
        """As those of `PythonProcess`."""
        return self._program.arguments()


class _Copy(PythonProcess):
    """A copy of this process, which starts with the first edit; after one that ends it, the next edit gets another."""

    def __init__(self, program: PythonProgram) -> None:
        super().__init__(program.text, program.function, program.file)
        self._program = program

    def _start(self) -> None:
        if sys.platform == "win32":
            raise ProgramError("this system cannot copy a process, in which an edit would be tried")
        requests, writing = os.pipe()
        reading, answers = os.pipe()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of threads: the copy has none, and needs none
            child = os.fork()
        if child == 0:
            os.close(writing)
            os.close(reading)
            _serve(self._program, requests, answers)
        os.close(requests)
        os.close(answers)
        self._attach(_Child(child, writing), SelectedPipe(reading))


class _Child:
    """What is needed of `subprocess.Popen`."""

    def __init__(self, pid: int, writing: int) -> None:
        self.pid, self.stdin = pid, os.fdopen(writing, "wb")

    def wait(self) -> None:
        with contextlib.suppress(ChildProcessError):
            os.waitpid(self.pid, 0)


def _serve(program: PythonProgram, requests: int, answers: int) -> NoReturn:
    """Answer in the copy until the requests end; nothing that the parent has open is touched."""
    try:
        if sys.platform != "win32":
            os.setsid()
        gc.freeze()  # what the parent made is not for the copy to end
        faulthandler.disable()
        leave_standard_streams()
        end_with_parent()
        limit_copy()
        streams = os.fdopen(requests, "rb"), os.fdopen(answers, "wb")
        while True:
            answer(program, *streams)
    finally:
        os._exit(1)
