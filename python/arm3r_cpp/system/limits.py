"""Limits of a process that runs a user's file: its time, and, where the system has such limits, memory and files."""

from __future__ import annotations

import contextlib
import os
import sys

if sys.platform != "win32":
    import resource

MEMORY = 2 << 30  # bytes of address space
JUDGE_MEMORY = 4 << 30
PROCESSOR_TIME = 100  # s
_NOBODY = 65534
_OWN_MEMORY = "/proc/self/statm"


def limit_resources() -> None:
    """No file is written, no core is dumped, and memory and time are bounded; nothing of this can be taken back."""
    if sys.platform != "win32":
        _limit_time_and_files()
        _limit_memory(MEMORY)
        _limit(resource.RLIMIT_NOFILE, 64)
        if os.getuid() == 0:
            _be_counted()
        _limit(resource.RLIMIT_NPROC, _threads_of_this_user() + 64)


def limit_copy() -> None:
    """The same for a copy of a process, which keeps what that has: its memory and its files."""
    if sys.platform != "win32":
        _limit_time_and_files()
        if os.path.exists(_OWN_MEMORY):
            _limit_memory(_memory_in_use() + MEMORY)


def limit_judge() -> None:
    """The same for a process that starts the one of the user's file."""
    if sys.platform != "win32":
        _limit_memory(JUDGE_MEMORY)
        _limit(resource.RLIMIT_FSIZE, 0)
        _limit(resource.RLIMIT_CORE, 0)


if sys.platform != "win32":

    def _limit_time_and_files() -> None:
        for what, value in (
            (resource.RLIMIT_CPU, PROCESSOR_TIME),
            (resource.RLIMIT_FSIZE, 0),
            (resource.RLIMIT_CORE, 0),
        ):
            _limit(what, value)

    def _limit_memory(size: int) -> None:
        if sys.platform == "linux":  # macOS refuses: each process has more address space than that from its start
            _limit(resource.RLIMIT_AS, size)

    def _limit(what: int, value: int) -> None:
        hard = resource.getrlimit(what)[1]
        value = value if hard == resource.RLIM_INFINITY else min(value, hard)
        resource.setrlimit(what, (value, value))

    def _memory_in_use() -> int:
        """Bytes of address space."""
        with open(_OWN_MEMORY) as file:
            return int(file.read().split()[0]) * resource.getpagesize()

    def _be_counted() -> None:
        """The kernel bounds the threads of each real user but root: this process gets another one, if there is any."""
        if sys.platform == "darwin":
            return
        with contextlib.suppress(OSError):
            os.setresuid(_NOBODY, -1, -1)

    def _threads_of_this_user() -> int:
        """The kernel counts them all against RLIMIT_NPROC."""
        count = 0
        for name in os.listdir("/proc") if os.path.isdir("/proc") else []:
            try:
                if name.isdigit() and os.stat(f"/proc/{name}").st_uid == os.getuid():
                    count += len(os.listdir(f"/proc/{name}/task"))
            except OSError:
                continue  # it has ended
        return count
