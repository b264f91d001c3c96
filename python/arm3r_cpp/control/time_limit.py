"""The end of a control law that does not come back."""

from __future__ import annotations

import ctypes
import signal
import threading
from collections.abc import Callable
from typing import Any


class OutOfTime(BaseException):
    """Raised in a law when the time limit is used up. Not an Exception: a law that catches those shall not live on."""


class Watchdog:
    """Ends a function that is being called when the time is used up: a sleep in the main thread too.

    In other threads what blocks outside Python ends when it comes back.
    """

    def __init__(self, function: Callable[..., Any], seconds: float) -> None:
        self._function = function
        self._lock = threading.Lock()
        self._inside = False
        self._fired = False
        self._thread = threading.get_ident()
        self._timer = threading.Timer(seconds, self._fire)
        self._timer.daemon = True

    def __enter__(self) -> Watchdog:
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
                raise OutOfTime from None
            raise

    def _fire(self) -> None:
        with self._lock:
            if not self._inside:
                return  # the library looks at the clock itself
            self._fired = True
            in_main = self._thread == threading.main_thread().ident
            if in_main and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
                signal.pthread_kill(self._thread, signal.SIGINT)
            else:
                ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(self._thread), ctypes.py_object(OutOfTime))
