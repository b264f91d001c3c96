"""Judges a file that a student hands in, whatever the task asks for."""

from __future__ import annotations

import os
from pathlib import Path

from .function_judge import judge_function
from .mark import WRONG, Mark
from .scenario_judge import judge_scenario
from .task import FunctionTask, ScenarioTask, Task

MOST_BYTES = 200_000


def judge_file(task: Task, path: str | os.PathLike[str], *, forbid_own_package: bool = False) -> Mark:
    """The mark of a file. Code in it runs confined; a file that cannot be judged is wrong, with a reason.

    Args:
        forbid_own_package: whether a Python file may not import this package.
    """
    file = Path(path)
    refusal = refused(task, file)
    if refusal:
        return Mark(WRONG, refusal)
    if isinstance(task, ScenarioTask):
        return judge_scenario(task, file)
    assert isinstance(task, FunctionTask)
    return judge_function(task, file, forbid_own_package=forbid_own_package)


def refused(task: Task, file: Path) -> str:
    """Why a file is not even opened; "" where it is."""
    if file.suffix not in task.suffixes:
        return f"ends with {file.suffix!r}; it should be {' or '.join(task.suffixes)}"
    if not file.is_file() or not os.access(file, os.R_OK):
        return "is not a readable file"
    if file.stat().st_size > MOST_BYTES:
        return f"is larger than {MOST_BYTES // 1000} kB"
    return ""
