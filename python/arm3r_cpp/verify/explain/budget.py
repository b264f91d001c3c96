"""How many edits are tried: a number of them, by how much the formula computes. So every machine finds the same, unless
the calls of a formula are so slow that the processor's time ends the search."""

from __future__ import annotations

import time
from typing import Any

CALLS_AN_EDIT = 2000
"""Of functions: a formula that calls more of them has fewer edits tried."""
SECONDS_AN_EDIT = 0.004
"""Of computing, several times what an edit of so many calls takes: the end of a formula whose calls are very slow."""


def affordable(edits: int, calls: int) -> int:
    """So many edits, or fewer of a formula that calls more functions than most."""
    return edits * CALLS_AN_EDIT // max(CALLS_AN_EDIT, calls)


SECONDS_READING = 30.0
"""Of computing, for all terms that are read. Those of a matrix of Coriolis terms take about 2."""


class Budget:
    """A number of edits, and the seconds that this process and the program's own may compute for them."""

    def __init__(
        self,
        program: Any,
        edits: int,
        seconds: float | None = None,
        *,
        whole: Budget | None = None,
        reading: Budget | None = None,
    ) -> None:
        """
        Args:
            seconds: None: `SECONDS_AN_EDIT` for each.
            whole: of which this is a part.
            reading: that of the terms, which are read beside.
        """
        self._program, self._left, self._whole, self._reading = program, edits, whole, reading
        self._end = self._used() + (SECONDS_AN_EDIT * edits if seconds is None else seconds)

    @classmethod
    def of_reading(cls, program: Any) -> Budget:
        """That of the terms of a formula."""
        return cls(program, 1, SECONDS_READING)

    @property
    def reading(self) -> Budget:
        return self._reading or self.of_reading(self._program)

    def _used(self) -> float:
        return time.process_time() + float(getattr(self._program, "seconds", 0.0))

    def spend(self) -> None:
        """An edit is tried."""
        self._left -= 1
        if self._whole:
            self._whole.spend()

    def is_over(self) -> bool:
        return self._left <= 0 or self._used() >= self._end

    def share(self, parts: int) -> Budget:
        """One of so many parts of what is left."""
        return Budget(
            self._program,
            self._left // parts,
            max(self._end - self._used(), 0.0) / parts,
            whole=self,
            reading=self._reading,
        )
