"""Goes through a folder of submissions: a folder for each student, and in it a file for each task."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

from .._messages import did_you_mean
from ..errors import UsageError
from .mark import MISSING, WRONG, Mark
from .task import Task
from .worker import Worker

Progress = Callable[[int, int], None]


class Row(NamedTuple):
    """What one student gets for one task."""

    student: str
    task: str
    mark: Mark


class Submission(NamedTuple):
    """The files of a student's folder that are named like a task."""

    student: str
    task: Task
    files: list[Path]


def submissions(folder: Path, tasks: Sequence[Task]) -> list[Submission]:
    """One for each student and task, students by name, tasks in their order.

    Raises:
        UsageError: there is no such folder, or no folder of a student in it.
    """
    students = _students(folder)
    if not students:
        raise UsageError(f"{folder}: holds no folders; make one for each student, with files named by task")
    found = [(student, _inside(student)) for student in students]
    return [
        Submission(student.name, task, [file for file in files if file.stem == task.name])
        for student, files in found
        for task in tasks
    ]


def notes(folder: Path, tasks: Sequence[Task]) -> Iterator[str]:
    """What is in the folders but is no submission, where its name is nearly that of a task."""
    names = [task.name for task in tasks]
    for file in (file for student in _students(folder) for file in _inside(student)):
        hint = did_you_mean(file.stem, names) if file.stem not in names else ""
        if hint:
            yield f"{file}: is not marked; {hint}"


def _students(folder: Path) -> list[Path]:
    if not folder.is_dir():
        raise UsageError(f"{folder}: is no folder; name one that holds a folder for each student")
    return [one for one in _inside(folder) if one.is_dir() and not one.name.startswith(".")]


def _inside(folder: Path) -> list[Path]:
    """What lies in a folder, by name.

    Raises:
        UsageError: it cannot be read.
    """
    try:
        return sorted(folder.iterdir())
    except OSError as error:
        raise UsageError(f"{folder}: cannot be read: {error.strerror}") from None


def runs_code(found: Sequence[Submission]) -> bool:
    """Whether a Python file is among them."""
    return any(file.suffix == ".py" for one in found for file in one.files)


def marks(
    found: Sequence[Submission], *, jobs: int, forbid_own_package: bool = False, progress: Progress | None = None
) -> list[Row]:
    """The rows of the table, in the order of the submissions, whatever the number of jobs."""

    jobs = max(jobs, 1)
    workers = [Worker() for _ in range(jobs)]
    idle = list(workers)

    def judge(one: Submission) -> Row:
        worker = idle.pop()
        try:
            return Row(one.student, one.task.name, _mark(one, worker, forbid_own_package))
        finally:
            idle.append(worker)

    rows = []
    pool = ThreadPoolExecutor(jobs)
    try:
        for row in pool.map(judge, found):
            rows.append(row)
            if progress:
                progress(len(rows), len(found))
    finally:
        pool.shutdown(wait=False, cancel_futures=True)  # Ctrl-C waits for no file
        for worker in workers:
            worker.close()
    return rows


def _mark(one: Submission, worker: Worker, forbid_own_package: bool) -> Mark:
    if not one.files:
        return Mark(MISSING)
    if len(one.files) > 1:
        names = ", ".join(file.suffix or "no suffix" for file in one.files)
        return Mark(WRONG, f"there are {len(one.files)} files of this name ({names}); hand in one")
    if one.files[0].is_symlink():
        return Mark(WRONG, "is a link; hand in the file itself")
    return worker.mark(one.task, one.files[0], forbid_own_package=forbid_own_package)
