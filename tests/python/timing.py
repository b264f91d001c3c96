"""Promises about time, on machines that may be busy with something else now and then."""

from __future__ import annotations

import os
from collections.abc import Callable

PATIENCE = float(os.environ.get("ARM3R_PATIENCE", "20"))  # 1 where nothing else runs: `make gates` asks for that


def once_within(seconds: float, attempt: Callable[[], float], tries: int = 10) -> bool:
    """Whether one of some tries, each of which returns the seconds that it took, took no longer.

    seconds: what is promised where nothing else runs. Elsewhere PATIENCE times as much is allowed, which still tells a
    call that comes back from one that goes on to its end.
    """
    return any(attempt() < PATIENCE * seconds for _ in range(tries))
