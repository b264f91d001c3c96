"""Judges each file in a process of its own: whatever a file does to it, other files are judged as before."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
from dataclasses import asdict, replace
from pathlib import Path
from typing import IO, Any

import numpy as np

from ..errors import Arm3rError, UsageError
from ..system.confinement import end_with_parent
from ..system.limits import limit_judge
from ..system.patience import Patience
from ..system.processes import bare_environment, end_with_descendants
from ..system.timed_pipe import TimedPipe
from ..user_functions import start
from ..user_functions.child import HEAD, own_streams, receive, send
from ..user_functions.programs import Call, ProgramError
from ..user_functions.python_process import PythonProcess
from .function_judge import reading
from .judge import judge_file
from .mark import RIGHT, UNCLEAR, Mark
from .numbers import Numbers
from .task import FunctionTask, Task
from .tasks import task_with

_START = "from arm3r_cpp.exercises.worker import main; main()"
MOST_SECONDS = 300.0  # of processor time; a right answer takes less than three


class Worker:
    """A process that judges files one after the other; it leaves nothing behind."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None

    def mark(self, task: Task, path: Path, *, forbid_own_package: bool = False, with_reading: bool = False) -> Mark:
        """The mark of a file.

        Args:
            with_reading: put what `arm3r verify` says of a wrong formula into the mark's message.
        """
        request = {
            "task": task.name,
            "seed": task.numbers.seed,
            "student": task.numbers.student,
            "path": os.fspath(path.absolute()),
            "forbid": forbid_own_package,
            "reading": with_reading,
        }
        mark = None
        try:
            mark = Mark(**self._answer(request))
        except TimeoutError:
            return Mark(UNCLEAR, "takes too long")
        except (OSError, EOFError, ValueError, TypeError):
            return Mark(UNCLEAR, "ends the process that judges it")
        finally:
            if mark is None or not start.COPIES:
                self.close()
        return mark

    def _answer(self, request: dict[str, Any]) -> dict[str, Any]:
        """
        Raises:
            TimeoutError: it computes for too long, or waits.
            OSError, EOFError: its process has ended.
        """
        if self._process is None:
            self._start()
        assert self._process and self._process.stdin
        patience = Patience(self._process.pid, MOST_SECONDS)
        send(self._process.stdin, request, b"")
        text, _ = HEAD.unpack(self._answers.read(HEAD.size, patience))
        answer: dict[str, Any] = json.loads(self._answers.read(text, patience))
        return answer

    def _start(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-I", "-c", _START],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=bare_environment(),
            start_new_session=True,
            cwd="/",
        )
        assert self._process.stdout
        self._answers = TimedPipe(os.dup(self._process.stdout.fileno()))
        self._process.stdout.close()

    def close(self) -> None:
        """End the process, if it runs, and all that it started."""
        process, self._process = self._process, None
        if process is None:
            return
        if process.poll() is None:
            end_with_descendants(process.pid)
            process.wait()
        self._answers.close()
        assert process.stdin
        with contextlib.suppress(OSError):
            process.stdin.close()


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


def main() -> None:
    """Requests as JSON on standard input, marks on standard output.

    Each file is judged by a copy of this process, where the system makes safe ones; elsewhere one file by this one.
    """
    requests, answers = own_streams()
    end_with_parent()
    limit_judge()
    start.prepare()
    while True:
        request, _ = receive(requests)
        if not start.COPIES:
            send(answers, asdict(_marked(request)), b"")
        elif not _copy_answers(request, answers):
            return


def _copy_answers(request: dict[str, Any], answers: IO[bytes]) -> bool:
    """Whether a copy of this process came to its end."""
    if sys.platform == "win32":
        return False
    copy = os.fork()
    if copy:
        return os.waitpid(copy, 0)[1] == 0
    try:
        send(answers, asdict(_marked(request)), b"")
        os._exit(0)
    finally:
        os._exit(1)


def _marked(request: dict[str, Any]) -> Mark:
    task = task_with(request["task"], Numbers(request["seed"], request["student"]))
    path = Path(request["path"])
    mark = judge_file(task, path, forbid_own_package=request["forbid"])
    if request["reading"] and mark.word != RIGHT and isinstance(task, FunctionTask):
        with contextlib.suppress(Arm3rError, ProgramError):
            mark = replace(mark, message=reading(task, path) or mark.message)
    return mark
