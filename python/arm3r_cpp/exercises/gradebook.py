"""The totals as learning platforms import them: CSV, one row a student."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from .table import as_csv, cell_of

if TYPE_CHECKING:
    from .points import Total

GRADE = "arm3r exercises"
"""What the grade is called."""


def moodle(totals: Sequence[Total]) -> str:
    """For Grades, Import, CSV file: a column that names the student, and the grade."""
    return as_csv([("Username", GRADE), *((cell_of(one.student), str(one.points)) for one in totals)])


def canvas(totals: Sequence[Total]) -> str:
    """For the gradebook's import, which finds a student by login or name, and makes the assignment if there is none."""
    head = ("Student", "ID", "SIS User ID", "SIS Login ID", "Section", GRADE)
    possible = ("    Points Possible", "", "", "", "", str(totals[0].possible))
    names = [(cell_of(one.student), str(one.points)) for one in totals]
    return as_csv([head, possible, *((name, "", "", name, "", points) for name, points in names)])


PLATFORMS: dict[str, Callable[[Sequence[Total]], str]] = {"moodle": moodle, "canvas": canvas}
