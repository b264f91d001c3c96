"""Goes through a folder of submissions: a folder for each student, and in it a file for each task."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

from .._messages import did_you_mean
from ..errors import UsageError
from .mark import MISSING, RIGHT, WRONG, Mark
from .numbers import Numbers
from .task import Task
from .tasks import TASKS, task_with
from .worker import Worker

Progress = Callable[[int, int], None]


class Row(NamedTuple):
    """What one student gets for one task."""

    student: str
    task: Task
    mark: Mark

    @property
    def points(self) -> int:
        """All of the task's for a right file, none for any other."""
        return self.task.points if self.mark.word == RIGHT else 0


class Submission(NamedTuple):
    """The files of a student's folder that are named like a task."""

    student: str
    task: Task
    files: list[Path]


def students(folder: Path) -> list[Path]:
    """The folders of the students, by name.

    Raises:
        UsageError: there is no such folder, or no folder of a student in it.
    """
    if not folder.is_dir():
        raise UsageError(f"{folder}: is not a folder; name one that holds a folder for each student")
    found = [one for one in _inside(folder) if one.is_dir() and not one.name.startswith(".")]
    if not found:
        raise UsageError(f"{folder}: holds no folders; make one for each student, with files named by task")
    return found


def submissions(folder: Path, names: Sequence[str], numbers: Numbers) -> list[Submission]:
    """What a student's folder holds for the tasks of these names, in their order.

    Raises:
        UsageError: it cannot be read.
    """
    files = _inside(folder)
    return [
        Submission(folder.name, task_with(name, numbers), [file for file in files if file.stem == name])
        for name in names
    ]


def notes(folder: Path) -> Iterator[str]:
    """What is in a student's folder but is no submission, where its name is nearly that of a task."""
    for file in _inside(folder):
        hint = did_you_mean(file.stem, TASKS) if file.stem not in TASKS else ""
        if hint:
            yield f"{file}: is not marked; {hint}"


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
            return Row(one.student, one.task, _mark(one, worker, forbid_own_package))
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
