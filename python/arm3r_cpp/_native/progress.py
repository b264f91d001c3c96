"""A run in progress: what the library calls back, and what that raises."""

from __future__ import annotations

import atexit
import os
import sys
import threading
import time
from collections.abc import Callable
from typing import Any

from ..errors import Arm3rError
from .library import ffi, lib

Progress = Callable[[float, float, int], Any]
BatchProgress = Callable[[int, int], Any]

_ENDING_TAKES = 0.8  # s, at most


class Interpreter:
    """Its end. A daemon thread that then calls back into Python is killed there, so its runs are stopped before.

    Attributes:
        stop: the stop flag of all runs of daemon threads.
        busy: those that are in progress.
    """

    def __init__(self) -> None:
        self.stop = ffi.new("int32_t *")
        self.busy: set[InProgress] = set()
        atexit.register(self.end)
        if sys.platform != "win32":
            os.register_at_fork(after_in_child=self.busy.clear)  # the child has one thread

    def end(self) -> None:
        """Stop the runs, and wait until their threads have seen it."""
        self.stop[0] = 1
        deadline = time.monotonic() + _ENDING_TAKES
        while self.busy and time.monotonic() < deadline:
            time.sleep(0.001)

    def enter(self, call: InProgress) -> None:
        if threading.current_thread().daemon:
            self.busy.add(call)

    def leave(self, call: InProgress) -> None:
        """A thread whose run was stopped by the end of the interpreter waits here for its own end."""
        self.busy.discard(call)
        if self.stop[0] and threading.current_thread().daemon:
            threading.Event().wait()

    def stop_flag(self) -> Any:
        """Of a call of this thread. Other threads than daemons have ended before the interpreter does."""
        return self.stop if threading.current_thread().daemon else ffi.NULL


interpreter = Interpreter()


class InProgress:
    """While the library calls `progress`, of one run or one batch, or a law. What they raise comes out again."""

    def __init__(self, progress: Callable[..., Any] | None, law: Any = None) -> None:
        self.progress = progress
        self.law = law
        self.raised: BaseException | None = None
        self.stop = ffi.new("int32_t *")

    def __enter__(self) -> None:
        self._outer, this_thread.call = getattr(this_thread, "call", None), self
        interpreter.enter(self)

    def __exit__(self, kind: Any, raised: BaseException | None, traceback: Any) -> None:
        this_thread.call = self._outer
        interpreter.leave(self)
        if self.raised is not None and isinstance(raised, Arm3rError):
            raise self.raised from None


this_thread = threading.local()  # .call: its run in progress


def keep(kind: type[BaseException], raised: BaseException, traceback: Any) -> None:
    this_thread.call.raised = raised.with_traceback(traceback)
    this_thread.call.stop[0] = 1


def called_by_the_library(kind: str) -> Callable[[Callable[..., int]], Any]:
    """Makes a function of Python one of the C type `kind`: compiled with the extension, or without one, here."""

    def make(function: Callable[..., int]) -> Any:
        if not hasattr(lib, function.__name__):
            return ffi.callback(kind, function, error=-1, onerror=keep)
        ffi.def_extern(error=-1, onerror=keep)(function)
        return getattr(lib, function.__name__)

    return make
