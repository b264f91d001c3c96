"""A pipe that is read with patience for the process at its other end."""

from __future__ import annotations

import contextlib
import os
import select
import sys
import threading
from queue import Empty, SimpleQueue

from .patience import SLICE, Patience

_AT_ONCE = 1 << 16  # bytes


class SelectedPipe:
    """The reading end of a pipe, where the system can wait for one."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor

    def read(self, count: int, patience: Patience) -> bytes:
        """As many bytes.

        Args:
            patience: with the process that writes them.

        Raises:
            TimeoutError: as patience says.
            EOFError: the other end is closed.
        """
        parts = b""
        while len(parts) < count:
            patience.check()
            ready, _, _ = select.select([self._descriptor], [], [], SLICE)
            if not ready:
                continue
            part = os.read(self._descriptor, count - len(parts))
            if not part:
                raise EOFError
            parts += part
        return parts

    def close(self) -> None:
        """No more is read."""
        with contextlib.suppress(OSError):
            os.close(self._descriptor)


class PumpedPipe:
    """The same where the system waits for sockets alone: a thread reads what comes."""

    def __init__(self, descriptor: int) -> None:
        self._parts: SimpleQueue[bytes] = SimpleQueue()
        self._rest = b""
        threading.Thread(target=self._pump, args=(descriptor,), daemon=True).start()

    def _pump(self, descriptor: int) -> None:
        part = b"."
        while part:
            try:
                part = os.read(descriptor, _AT_ONCE)
            except OSError:
                part = b""
            self._parts.put(part)
        os.close(descriptor)

    def read(self, count: int, patience: Patience) -> bytes:
        """As `SelectedPipe.read`."""
        while len(self._rest) < count:
            patience.check()
            try:
                part = self._parts.get(timeout=SLICE)
            except Empty:
                continue
            if not part:
                self._parts.put(part)  # for the next call
                raise EOFError
            self._rest += part
        parts, self._rest = self._rest[:count], self._rest[count:]
        return parts

    def close(self) -> None:
        """Nothing: the thread ends with the process at the other end."""


TimedPipe = PumpedPipe if sys.platform == "win32" else SelectedPipe
