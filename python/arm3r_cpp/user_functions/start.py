"""Starts the processes that run users' files: copies of one that is ready, where the system makes safe ones."""

from __future__ import annotations

import contextlib
import os
import socket
import subprocess
import sys
import threading
import weakref
from typing import IO, Any, NamedTuple, Protocol

from ..system.patience import Patience
from ..system.processes import bare_environment
from ..system.timed_pipe import PumpedPipe, SelectedPipe, TimedPipe
from .fork_server import COPY, PID
from .programs import Unjudged

STARTING_TIME = 20.0  # s of processor time
COPIES = sys.platform == "linux"
"""Whether processes are copies of one. macOS does not bear copies of a process that has loaded its linear algebra."""
_FOLDER = os.path.dirname(os.path.abspath(__file__))
_SYSTEM = os.path.join(os.path.dirname(_FOLDER), "system")
# The modules of two folders alone, under a name of their own: what is right is not in the process that is judged.
_START = """
import sys, types
for name, path in (("", []), (".user_functions", [{program!r}]), (".system", [{system!r}])):
    package = sys.modules["_arm3r_user" + name] = types.ModuleType(name)
    package.__path__ = path
from _arm3r_user.user_functions.{module} import main
main()
"""


class Process(Protocol):
    """A process that reads requests from `stdin`."""

    @property
    def pid(self) -> int: ...

    @property
    def stdin(self) -> IO[bytes] | None: ...

    def wait(self) -> Any: ...


class Started(NamedTuple):
    process: Process
    answers: SelectedPipe | PumpedPipe


def start() -> Started:
    """A process that waits for its first request, which describes a user's file.

    Raises:
        Unjudged: the system has no process for it.
    """
    if not COPIES:
        return _start_alone()
    for _ in range(2):  # the server may have ended since its last copy: another one is started
        with contextlib.suppress(OSError, EOFError):
            return _server().copy()
    raise Unjudged("this system starts no process for it")


def prepare() -> None:
    """Start what `start` copies, where it does: a process that copies itself afterwards shares it with its copies."""
    if COPIES:
        _server()


def _start_alone() -> Started:
    process = _run("child", subprocess.PIPE, subprocess.PIPE)
    assert process.stdout
    answers = TimedPipe(os.dup(process.stdout.fileno()))
    process.stdout.close()
    return Started(process, answers)


def _run(module: str, requests: Any, answers: Any) -> subprocess.Popen[bytes]:
    environment = {
        **bare_environment(),
        "OMP_NUM_THREADS": "1",
        "MPLBACKEND": "Agg",
        "HOME": "/",
        "MPLCONFIGDIR": os.environ.get("TMPDIR") or os.environ.get("TEMP") or "/tmp",  # it insists on a writable one
    }
    return subprocess.Popen(
        [sys.executable, "-I", "-c", _START.format(module=module, program=_FOLDER, system=_SYSTEM)],
        stdin=requests,
        stdout=answers,
        stderr=subprocess.DEVNULL,
        env=environment,
        start_new_session=True,
        cwd="/",
    )


class ForkServer:
    """The process that copies itself, and the socket that asks it to; a copy of this process asks the same one."""

    _socket: socket.socket
    _end: weakref.finalize[Any, ForkServer]

    def __init__(self) -> None:
        if sys.platform == "win32":
            raise OSError
        self._socket, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with other:
            self._process = _run("fork_server", other, subprocess.DEVNULL)
        self._owner = os.getpid()
        self._end = weakref.finalize(self, _end_server, self._socket, self._process, self._owner)

    def copy(self) -> Started:
        """
        Raises:
            OSError, EOFError: the server has ended.
        """
        if sys.platform == "win32":
            raise OSError
        (requests, writing), (reading, answers) = os.pipe(), os.pipe()
        pipe = SelectedPipe(reading)
        try:
            socket.send_fds(self._socket, [COPY], [requests, answers])
            os.close(answers)
            answers = -1
            (pid,) = PID.unpack(pipe.read(PID.size, Patience(self._process.pid, STARTING_TIME)))
        except (OSError, EOFError):
            os.close(writing)
            pipe.close()
            self._end()
            raise
        finally:
            os.close(requests)
            if answers >= 0:
                os.close(answers)
        return Started(_Copy(self, pid, os.fdopen(writing, "wb")), pipe)

    @property
    def is_alive(self) -> bool:
        return self._end.alive

    def wait(self, pid: int) -> None:
        """Wait for the end of a copy, whose number is not given to another process before."""
        if sys.platform == "win32":
            raise OSError
        reading, writing = os.pipe()
        with contextlib.suppress(OSError):  # where the server has ended, its copies have
            socket.send_fds(self._socket, [str(pid).encode()], [writing])
        os.close(writing)
        with os.fdopen(reading, "rb") as ended:
            ended.read()


def _end_server(asking: socket.socket, process: subprocess.Popen[bytes], owner: int) -> None:
    """With all of its copies, where this is the process that started it."""
    asking.close()
    if os.getpid() == owner:
        process.kill()
        process.wait()


class _Copy(NamedTuple):
    server: ForkServer
    pid: int
    stdin: IO[bytes]

    def wait(self) -> None:
        self.server.wait(self.pid)


_starting = threading.Lock()
_servers: list[ForkServer] = []


def _server() -> ForkServer:
    """The one of this process, which is started once."""
    with _starting:
        if not (_servers and _servers[-1].is_alive):
            _servers[:] = [ForkServer()]
        return _servers[-1]
