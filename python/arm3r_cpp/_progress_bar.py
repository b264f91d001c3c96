"""A bar that shows how far a long command is."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Literal

Progress = Callable[[int, int], Any]

BAR = 30  # characters
DELAY = 1.0  # s, before a bar is shown


class Bar:
    """Shows rate and time left on stderr, if that is a terminal and the work takes long."""

    def __init__(self, work: str, things: str) -> None:
        """work: what is done, in a word. things: what is counted."""
        self.work, self.things = work, things
        self.start = time.monotonic()
        self.before: int | None = None
        self.drawn = False

    def draw(self, done: int, all_of_them: int) -> None:
        seconds = time.monotonic() - self.start
        self.before = done if self.before is None else self.before
        if seconds < DELAY or not sys.stderr.isatty():
            return
        rate = (done - self.before) / seconds
        left = f"{_clock((all_of_them - done) / rate)} left" if rate else "-"
        filled = BAR * done // all_of_them
        bar = "#" * filled + "." * (BAR - filled)
        share = f"{100 * done // all_of_them} %  {done} of {all_of_them}"
        line = f"{self.work} [{bar}] {share}  {rate:.3g} {self.things}/s  {left}"
        print(f"\r{line}\x1b[K", end="", file=sys.stderr, flush=True)
        self.drawn = True

    def clear(self) -> None:
        if self.drawn:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
        self.drawn = False


@contextmanager
def shown(progress: Progress | Literal[False] | None, work: str, things: str) -> Iterator[Progress | None]:
    """What reports the progress of a call that the user may watch: his own function, or a bar; False: nothing."""
    if progress is not None:
        yield progress or None
        return
    bar = Bar(work, things)
    try:
        yield bar.draw
    finally:
        bar.clear()


def _clock(seconds: float) -> str:
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{seconds:02}" if hours else f"{minutes}:{seconds:02}"
