"""How long the work of another process is waited for: seconds that it computes, whatever else the machine does."""

from __future__ import annotations

import time

from .processes import processor_time

SLICE = 0.1
"""Seconds between two looks at the process."""
WAITING_TIME = 60.0
"""Seconds in which a process that computes less than a hundredth of them is taken to wait for something."""
_LEAST_SHARE = 0.01


class TooSlow(TimeoutError):
    """The process has used up its seconds."""


class Waits(TimeoutError):
    """The process does not compute: it sleeps, or waits for what does not come."""


class Patience:
    """Ends a wait when a process has computed for so many seconds more.

    The clock counts only against a process that sleeps; and where the system does not tell what a process computes.
    """

    def __init__(self, pid: int, seconds: float) -> None:
        self._pid, self._window = pid, 0.0
        self._window_begun: float | None = None
        self.renew(seconds)

    def renew(self, seconds: float) -> None:
        """So many seconds for the next piece of work; how long the process has slept so far is not forgotten.

        It counts from the first look on, since most work ends before one, and each reads all of /proc.
        """
        self._seconds, self._waited, self._last = seconds, 0.0, time.monotonic()
        self._begun: float | None = None

    def check(self) -> None:
        """To be called at least every `SLICE` seconds.

        Raises:
            TooSlow: the process has computed for longer.
            Waits: it does not compute.
        """
        now = time.monotonic()
        passed = now - self._last
        if passed < SLICE / 2:
            return
        self._last = now
        passed = min(passed, 2 * SLICE)  # where this process was stopped, the other one may have been, too
        self._waited += passed
        self._window += passed
        used = processor_time(self._pid)
        if self._begun is None:
            self._begun = used
        if self._window_begun is None:
            self._window_begun = used
        if (self._waited if used is None else used - (self._begun or 0.0)) >= self._seconds:
            raise TooSlow
        if self._window >= WAITING_TIME:
            if used is not None and used - (self._window_begun or 0.0) < _LEAST_SHARE * self._window:
                raise Waits
            self._window, self._window_begun = 0.0, used
