"""What a student reads: the task, the mark of a file, and hints."""

from __future__ import annotations

import textwrap

from .._messages import shown
from .mark import RIGHT, Mark
from .task import Task

GRADES = (1, 2, 3)


def described(task: Task) -> str:
    """The task in words, with what is given."""
    files = " or ".join(f"{task.name}{suffix}" for suffix in task.suffixes[:2])
    parts = [f"{task.name}: {task.title}", task.text.strip("\n")]
    if task.given:
        parts.append(f"Given, {task.name}{task.given_suffix}:\n\n" + textwrap.indent(task.given.strip("\n"), "    "))
    parts.append(f"Hand in {files}.")
    return "\n\n".join(parts)


def answer(task: Task, file: str, mark: Mark, grade: int) -> str:
    """The mark of a file; where it is not right, the hints up to a grade. The second names a known mistake."""
    lines = [f"{shown(file)}: {mark.word}{f': {mark.found}' if mark.found else ''}"]
    if mark.word == RIGHT:
        return lines[0]
    if mark.cause and grade >= 2:
        lines.append(f"  {mark.cause}")
    lines += [f"  hint {number}: {task.hints[number - 1]}" for number in GRADES[:grade]]
    if mark.message:
        lines += [f"  {shown(line)}" for line in mark.message.split("\n")]
    if grade < GRADES[-1]:
        lines.append(f"  --hint {grade + 1} says more")
    return "\n".join(lines)
