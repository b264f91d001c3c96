"""The points of students: what they have of what can be had."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from .folder import Row
from .mark import RIGHT, UNCLEAR


class Total(NamedTuple):
    """What one student has for all tasks together."""

    student: str
    tasks: int
    right: int
    unclear: int
    points: int
    possible: int

    def __str__(self) -> str:
        """ "7 of 19 right, 31 of 60 points"."""
        unclear = f", {self.unclear} unclear" if self.unclear else ""
        return f"{self.right} of {self.tasks} right{unclear}, {self.points} of {self.possible} points"


def totals(rows: Sequence[Row]) -> list[Total]:
    """One for each student, in the order of the rows."""
    of_students: dict[str, list[Row]] = {}
    for row in rows:
        of_students.setdefault(row.student, []).append(row)
    return [_total(student, own) for student, own in of_students.items()]


def _total(student: str, rows: Sequence[Row]) -> Total:
    words = [row.mark.word for row in rows]
    return Total(
        student,
        tasks=len(rows),
        right=words.count(RIGHT),
        unclear=words.count(UNCLEAR),
        points=sum(row.points for row in rows),
        possible=sum(row.task.points for row in rows),
    )
