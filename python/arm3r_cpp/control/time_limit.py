"""Ends a control law that does not return within the time limit of its run."""

from __future__ import annotations

import ctypes
import signal
import threading
from collections.abc import Callable
from typing import Any

from ..system.processes import interrupt_main_thread


class TimeLimitReached(BaseException):
    """Raised in a law when the time limit is used up. It is no Exception, so that a law that catches those ends too."""


class TimeLimit:
    """Ends a function that is being called when the time is used up, also while it sleeps in the main thread.

    In another thread, a call that blocks outside Python ends when it returns.
    """

    def __init__(self, function: Callable[..., Any], seconds: float) -> None:
        self._function = function
        self._lock = threading.Lock()
        self._inside = False
        self._fired = False
        self._thread = threading.get_ident()
        self._timer = threading.Timer(seconds, self._fire)
        self._timer.daemon = True

    def __enter__(self) -> TimeLimit:
        self._timer.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._timer.cancel()

    def __call__(self, t: float, state: Any) -> Any:
        try:
            with self._lock:
                self._inside = True
            try:
                return self._function(t, state)
            finally:
                with self._lock:
                    self._inside = False
        except KeyboardInterrupt:
            if self._fired:
                raise TimeLimitReached from None
            raise

    def _fire(self) -> None:
        with self._lock:
            if not self._inside:
                return  # the library looks at the clock itself
            self._fired = True
            in_main = self._thread == threading.main_thread().ident
            if in_main and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
                interrupt_main_thread()
            else:
                thread, error = ctypes.c_ulong(self._thread), ctypes.py_object(TimeLimitReached)
                ctypes.pythonapi.PyThreadState_SetAsyncExc(thread, error)
