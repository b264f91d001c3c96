"""Judges each file in a process of its own: whatever a file does to it, other files are judged as before."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

from ..errors import Arm3rError, UsageError
from ..system.patience import SLICE, Patience
from ..system.processes import bare_environment, end_with_descendants
from ..verify.program.confinement import end_with_parent
from ..verify.program.limits import limit_judge
from ..verify.program.nodes import Call, ProgramError
from ..verify.program.python_process import PythonProcess
from .function_judge import reading
from .judge import judge_file
from .mark import RIGHT, UNCLEAR, Mark
from .task import FunctionTask, Task
from .tasks import TASKS

_START = "from arm3r_cpp.exercises.worker import main; main()"
MOST_SECONDS = 300.0  # of processor time; a right answer takes less than three


def judge_apart(task: Task, path: Path, *, forbid_own_package: bool = False, with_reading: bool = False) -> Mark:
    """The mark of a file, judged in another process, which leaves nothing behind.

    Args:
        with_reading: put what `arm3r verify` says of a wrong formula into the mark's message.
    """
    request = {
        "task": task.name,
        "path": os.fspath(path.absolute()),
        "forbid": forbid_own_package,
        "reading": with_reading,
    }
    process = subprocess.Popen(
        [sys.executable, "-I", "-c", _START],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=bare_environment(),
        start_new_session=True,
        cwd="/",
    )
    try:
        return Mark(**json.loads(_answer(process, json.dumps(request).encode())))
    except TimeoutError:
        return Mark(UNCLEAR, "takes too long")
    except (ValueError, TypeError):
        return Mark(UNCLEAR, "ends the process that judges it")
    finally:
        _end(process)


def _answer(process: subprocess.Popen[bytes], request: bytes) -> bytes:
    """
    Raises:
        TimeoutError: it computes for too long, or waits.
    """
    patience, given = Patience(process.pid, MOST_SECONDS), [request]
    while True:
        try:
            return process.communicate(given.pop() if given else None, timeout=SLICE)[0]
        except subprocess.TimeoutExpired:
            patience.check()


def what_is_not_barred() -> list[str]:
    """What this system cannot keep a Python file from, such as "files" or "network".

    Raises:
        UsageError: it cannot run one at all.
    """
    process = PythonProcess("def nothing(q):\n    return q\n", "nothing", "nothing.py")
    try:
        process.evaluate(Call((0,), {}), np.zeros((1, 1)))
    except ProgramError as error:
        raise UsageError(f"a Python file cannot be run here: its process {error}") from None
    finally:
        process.close()
    return process.unbarred


def _end(process: subprocess.Popen[bytes]) -> None:
    """End the process, if it runs, and all that it started."""
    if process.poll() is None:
        end_with_descendants(process.pid)
        process.wait()
    for stream in (process.stdin, process.stdout):
        if stream:
            stream.close()


def main() -> None:
    """A request as JSON on standard input; the mark as JSON on standard output."""
    end_with_parent()
    limit_judge()
    request = json.load(sys.stdin)
    task, path = TASKS[request["task"]], Path(request["path"])
    mark = judge_file(task, path, forbid_own_package=request["forbid"])
    if request["reading"] and mark.word != RIGHT and isinstance(task, FunctionTask):
        with contextlib.suppress(Arm3rError, ProgramError):
            mark = replace(mark, message=reading(task, path) or mark.message)
    sys.stdout.write(json.dumps(asdict(mark)))
