"""The table of marks: CSV, the same bytes on every machine."""

from __future__ import annotations

import csv
import io
import re
from collections import Counter
from collections.abc import Sequence

from .._messages import shown
from .folder import Row
from .mark import WORDS, one_line

COLUMNS = ("student", "task", "mark", "reason")
_FORMULA = re.compile(r"\s*[=+\-@'\uff1d\uff0b\uff0d\uff20]")  # what a spreadsheet takes for a formula, or a text


def csv_of(rows: Sequence[Row]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row in rows:
        student = row.student.replace("\\", "\\\\")  # other names have other cells
        writer.writerow(map(_cell, (student, row.task, row.mark.word, one_line(row.mark.reason))))
    return text.getvalue()


def _cell(text: str) -> str:
    """The text as one line that a spreadsheet does not compute."""
    line = shown(text)
    return f"'{line}" if _FORMULA.match(line) else line


def summary(rows: Sequence[Row]) -> str:
    """ "3 students, 19 tasks: 40 right, 2 wrong"."""
    counts = Counter(row.mark.word for row in rows)
    students, tasks = len({row.student for row in rows}), len({row.task for row in rows})
    words = ", ".join(f"{counts[word]} {word}" for word in WORDS if counts[word])
    return f"{students} student{'s' if students > 1 else ''}, {tasks} task{'s' if tasks > 1 else ''}: {words}"
