"""How long edits are tried: in seconds of computing, so that a busy machine finds no less."""

from __future__ import annotations

import time
from typing import Any

_WAITING = 6.0  # times as long as computing: the most that is waited on a busy machine


class Budget:
    """Seconds of computing, in this process and in the program's own."""

    def __init__(self, program: Any, seconds: float, latest: float | None = None) -> None:
        self._program = program
        self._end = self._used() + seconds
        self._latest = time.monotonic() + _WAITING * seconds if latest is None else latest

    def _used(self) -> float:
        return time.process_time() + float(getattr(self._program, "seconds", 0.0))

    def is_over(self) -> bool:
        return self._used() >= self._end or time.monotonic() >= self._latest

    def share(self, parts: int) -> Budget:
        """One of so many parts of what is left."""
        left = max(self._latest - time.monotonic(), 0.0)
        return Budget(self._program, max(self._end - self._used(), 0.0) / parts, time.monotonic() + left / parts)
