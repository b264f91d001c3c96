"""What a student reads: the task, the mark of a file, and hints."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from .._messages import shown
from .mark import MISSING, RIGHT, Mark
from .numbers import Numbers
from .task import Task

GRADES = (1, 2, 3)


def listed(tasks: Sequence[Task], marks: Sequence[Mark] = ()) -> str:
    """A line for each task, in columns; with marks what is done."""
    words = ["open" if mark.word == MISSING else mark.word for mark in marks] or [""] * len(tasks)
    names, states = (max(map(len, texts)) + 2 for texts in ([task.name for task in tasks], words))
    return "\n".join(
        f"{task.name:{names}}{task.points} points  {f'{word:{states}}' if word else ''}{task.title}"
        for task, word in zip(tasks, words, strict=True)
    )


def described(task: Task) -> str:
    """The task in words, with what is given."""
    parts = [f"{task.name}: {task.title}", task.text.strip("\n")]
    if task.given:
        parts.append(f"Given, {task.name}{task.given_suffix}:\n\n" + textwrap.indent(task.given.strip("\n"), "    "))
    parts.append(hand_in(task))
    if task.numbers.student:
        parts.append(f"These are the {whose(task.numbers)}.")
    return "\n\n".join(parts)


def hand_in(task: Task) -> str:
    """What is due, and for how many points."""
    files = " or ".join(f"{task.name}{suffix}" for suffix in task.suffixes)
    return f"Hand in {files}: {task.points} points."


def whose(numbers: Numbers) -> str:
    """ "numbers of anna, seed 7"."""
    return f"numbers of {shown(numbers.student)}, seed {numbers.seed}"


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
