"""Promises about time, on machines that may be busy with something else now and then."""

from __future__ import annotations

from collections.abc import Callable


def once_within(seconds: float, attempt: Callable[[], float], tries: int = 10) -> bool:
    """Whether one of some tries, each of which returns the seconds that it took, took no longer."""
    return any(attempt() < seconds for _ in range(tries))
