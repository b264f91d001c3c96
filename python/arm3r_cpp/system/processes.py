"""The end of processes: of another one with all that it started, and of this one as by a signal."""

from __future__ import annotations

import _thread
import contextlib
import os
import signal
import subprocess
import sys
import threading
from typing import NoReturn

_NEEDED = ("SYSTEMROOT",)  # by programs on Windows
_ENDED_BY_CONTROL_C = 0xC000013A  # what Windows gives for STATUS_CONTROL_C_EXIT


def bare_environment() -> dict[str, str]:
    """The environment of a process that runs a user's file: nothing of this one's, but what the system needs."""
    needed = {name: os.environ[name] for name in _NEEDED if name in os.environ}
    return {
        **needed,
        "PATH": os.defpath,
        "LANG": "C.UTF-8",
        "OPENBLAS_NUM_THREADS": "1",
        "PYTHONDONTWRITEBYTECODE": "1",
    }


def end_by_interrupt() -> NoReturn:
    """End this process as Ctrl-C does, so that its caller sees the reason."""
    if sys.platform == "win32":
        os._exit(_ENDED_BY_CONTROL_C)
    end_by_signal(signal.SIGINT)


def end_by_signal(number: signal.Signals) -> NoReturn:
    """End this process by the signal itself."""
    signal.signal(number, signal.SIG_DFL)
    os.kill(os.getpid(), number)
    raise SystemExit(128 + number)


def interrupt_main_thread() -> None:
    """As Ctrl-C; also while the main thread sleeps, but on Windows."""
    if sys.platform == "win32":
        _thread.interrupt_main()
    else:
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)


def end_by_closed_pipe() -> None:
    """End this process as one whose reader is gone, where the system knows that."""
    if sys.platform != "win32":
        end_by_signal(signal.SIGPIPE)


def end_with_descendants(pid: int) -> None:
    """End a process, which leads a group of its own, and all that it started."""
    if sys.platform == "win32":
        subprocess.run(["taskkill", "/F", "/T", "/PID", str(pid)], capture_output=True, check=False)
        return
    for _ in range(20):  # a process may start others while they are ended
        started = _descendants(pid)
        for descendant in started:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.kill(descendant, signal.SIGKILL)
        if not started:
            break
    for end in (os.killpg, os.kill):  # a process that has just started may not lead its group yet
        with contextlib.suppress(ProcessLookupError, PermissionError):
            end(pid, signal.SIGKILL)


def processor_time(pid: int) -> float | None:
    """Seconds that a process, and all that it started, have computed; None where the system does not tell."""
    every = _statistics()
    if sys.platform == "win32" or pid not in every:
        return None
    ticks = sum(sum(map(int, every[one][11:15])) for one in (pid, *_descendants_in(every, pid)))
    return float(ticks / os.sysconf("SC_CLK_TCK"))


def _descendants(ancestor: int) -> list[int]:
    """The processes that a process started, directly or not; orphans among them became its children."""
    return _descendants_in(_statistics(), ancestor)


def _statistics() -> dict[int, list[str]]:
    """What Linux tells of each process behind its name: state, parent, ..., its own times and its children's."""
    found = {}
    for name in os.listdir("/proc") if os.path.isdir("/proc") else []:
        if name.isdigit():
            with contextlib.suppress(OSError, ValueError, IndexError), open(f"/proc/{name}/stat", "rb") as file:
                found[int(name)] = file.read().rsplit(b")", 1)[1].decode().split()
    return found


def _descendants_in(every: dict[int, list[str]], ancestor: int) -> list[int]:
    parents = {pid: int(words[1]) for pid, words in every.items()}
    found = {ancestor}
    while more := {child for child, parent in parents.items() if parent in found} - found:
        found |= more
    return sorted(found - {ancestor})
