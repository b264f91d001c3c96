"""A process that has loaded what a user's file needs, and copies itself for each file: none waits for numpy.

It runs no file itself. Its input is a socket: a message "copy" with two pipes asks for a copy that reads its requests
from the first and answers through the second; a message with a number and a pipe asks to close the pipe when the copy
with that number has ended.
"""

from __future__ import annotations

import gc
import os
import socket
import struct
import sys
from typing import NoReturn

from .child import leave_standard_streams, serve

COPY = b"copy"
PID = struct.Struct("<i")
"""The first bytes that a copy answers: its number."""
_LONGEST = 32  # bytes of a message


def main() -> None:
    """Serve until every process that holds the other end of the socket has ended."""
    if sys.platform == "win32":
        return
    asked = socket.socket(fileno=os.dup(0))
    leave_standard_streams()
    gc.freeze()  # what is loaded here is not for a copy to end
    while True:
        message, pipes, _, _ = socket.recv_fds(asked, _LONGEST, 2)
        if not message:
            return
        if message != COPY:
            os.waitpid(int(message), 0)
        elif os.fork() == 0:
            asked.close()
            _serve_apart(*pipes)
        for pipe in pipes:
            os.close(pipe)


def _serve_apart(requests: int, answers: int) -> NoReturn:
    """In a copy: it never comes back to the loop of the server."""
    try:
        if sys.platform != "win32":
            os.setsid()
        os.write(answers, PID.pack(os.getpid()))
        serve(os.fdopen(requests, "rb"), os.fdopen(answers, "wb"))
    finally:
        os._exit(1)
