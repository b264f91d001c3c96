"""The table of marks: CSV, the same bytes on every machine."""

from __future__ import annotations

import csv
import io
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from .._messages import shown
from .mark import WORDS, one_line

if TYPE_CHECKING:
    from .folder import Row

COLUMNS = ("student", "task", "mark", "reason", "points")
_FORMULA = re.compile(r"\s*[=+\-@'\uff1d\uff0b\uff0d\uff20]")  # what a spreadsheet takes for a formula, or a text


def csv_of(rows: Sequence[Row]) -> str:
    """A row for each student and task."""
    cells = [
        (cell_of(row.student), row.task.name, row.mark.word, one_line(row.mark.reason), str(row.points)) for row in rows
    ]
    return as_csv([COLUMNS, *cells])


def as_csv(rows: Iterable[Sequence[str]]) -> str:
    """Rows of texts, each as one line that a spreadsheet does not compute."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerows(map(_cell, row) for row in rows)
    return text.getvalue()


def cell_of(student: str) -> str:
    """A student's name, as other names have other cells."""
    return student.replace("\\", "\\\\")


def _cell(text: str) -> str:
    line = shown(text)
    return f"'{line}" if _FORMULA.match(line) else line


def summary(rows: Sequence[Row]) -> str:
    """ "3 students, 19 tasks: 40 right, 2 wrong"."""
    counts = Counter(row.mark.word for row in rows)
    students, tasks = len({row.student for row in rows}), len({row.task.name for row in rows})
    words = ", ".join(f"{counts[word]} {word}" for word in WORDS if counts[word])
    return f"{students} student{'s' if students > 1 else ''}, {tasks} task{'s' if tasks > 1 else ''}: {words}"
