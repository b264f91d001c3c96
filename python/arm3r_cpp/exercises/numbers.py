"""The numbers of a task: those of the lab sheet, or a student's own, drawn from a seed and the student's name."""

from __future__ import annotations

import hashlib
import json
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

T = TypeVar("T")


@dataclass(frozen=True)
class Numbers:
    """Whose numbers a task has: without a seed everyone's, those of the lab sheet."""

    seed: int | None = None
    student: str = ""

    def pick(self, what: str, lab: T, own: Sequence[T]) -> T:
        """The lab sheet's value, or another one that a student may get. Values of other names are drawn apart."""
        if self.seed is None:
            return lab
        words = json.dumps([self.seed, same_name(self.student), what])
        drawn = int.from_bytes(hashlib.sha256(words.encode()).digest(), "big")
        others = [value for value in own if value != lab]
        return others[drawn % len(others)]


LAB = Numbers()


def same_name(student: str) -> str:
    """The name as it is drawn from: systems write one letter in several ways, and people small or large."""
    return " ".join(unicodedata.normalize("NFC", student).casefold().split())


def steps(first: float, last: float, step: float) -> list[float]:
    """Numbers from the first to the last, both included, as they are written: 0.7, 0.71, 0.72."""
    return [round(first + number * step, 9) for number in range(round((last - first) / step) + 1)]
