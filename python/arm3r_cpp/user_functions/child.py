"""The process that runs a user's file: answers requests for evaluations until its input ends."""

from __future__ import annotations

import json
import os
import struct
import sys
import time
from typing import IO, Any, NoReturn

import numpy as np

from ..system.confinement import confine, end_with_parent
from ..system.limits import limit_resources
from .octave.program import OctaveProgram
from .programs import Call, Edit, Given, ProgramError, Unread, calls_in
from .python_program import PythonProgram

HEAD = struct.Struct("<II")  # lengths of the JSON and of the numbers that follow
_STARTS = {"os.fork", "os.forkpty", "os.exec", "os.posix_spawn", "os.system", "subprocess.Popen"}


def main() -> None:
    """Requests come from standard input, answers go to standard output."""
    serve(*own_streams())


def own_streams() -> tuple[IO[bytes], IO[bytes]]:
    """Standard input and output for requests and answers alone: what else reads or writes there finds nothing."""
    streams = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    leave_standard_streams()
    return streams


def leave_standard_streams() -> None:
    """What is read there ends at once, and what is written there is gone."""
    null = os.open(os.devnull, os.O_RDWR)
    for descriptor in (0, 1, 2):
        os.dup2(null, descriptor)


def serve(requests: IO[bytes], answers: IO[bytes]) -> NoReturn:
    """Answer requests until they end. The first one describes the program."""
    end_with_parent()
    head, _ = receive(requests)
    limit_resources()
    unbarred = confine(head["folder"], head["hidden_package"], head.get("readable", ()))
    if head["hidden_package"]:  # it cannot be read; its import says so as of one that is not there
        sys.modules[os.path.basename(head["hidden_package"])] = None  # type: ignore[assignment]
    sys.addaudithook(say_what_is_barred)
    if head["folder"]:
        sys.path.insert(0, head["folder"])
    program = program_of(head)
    send(answers, {"unbarred": unbarred}, b"")
    while True:
        answer(program, requests, answers)


def program_of(head: dict[str, Any]) -> PythonProgram | OctaveProgram:
    """The program that a first request describes."""
    if "octave" in head:
        return OctaveProgram(head["text"], head["function"], head["octave"], head["folder"])
    return PythonProgram(head["text"], head["function"], head["file"])


def say_what_is_barred(event: str, _: object) -> None:
    """In words what the system refuses without any."""
    if event in _STARTS:
        raise PermissionError("a process is started")
    if event == "socket.__new__":
        raise PermissionError("a socket is opened")


def answer(program: PythonProgram | OctaveProgram, requests: IO[bytes], answers: IO[bytes]) -> None:
    head, body = receive(requests)
    try:
        found, numbers = _result(program, head, body)
        send(answers, {**found, "seconds": time.process_time()}, numbers)
    except ProgramError as error:
        is_unread = isinstance(error, Unread)
        head = {"error": str(error), "line": error.line, "unread": is_unread, "seconds": time.process_time()}
        send(answers, head, b"")
    except MemoryError:
        send(answers, {"error": "needs too much memory", "line": None}, b"")


def _result(program: PythonProgram | OctaveProgram, head: dict[str, Any], body: bytes) -> tuple[dict[str, Any], bytes]:
    """The names of arguments, for a request without rows; or the values at the states of the body, or their calls."""
    if head["rows"] is None:
        return {"arguments": program.arguments()}, b""
    table = np.frombuffer(body).reshape(head["rows"], -1) if head["rows"] else np.zeros((0, 1))
    slots = tuple(
        Given(one["given"]) if isinstance(one, dict) else one if isinstance(one, int) else tuple(one)
        for one in head["slots"]
    )
    call = Call(slots, head["lifted"], head["output"], head["outside"], head["as_columns"])
    if head["counted"]:
        return {"calls": calls_in(lambda: program.evaluate(call, table))}, b""
    values = program.evaluate(call, table, Edit(*head["edit"]) if head["edit"] else None)
    return {"shape": values.shape}, np.ascontiguousarray(values).tobytes()


def send(stream: IO[bytes], head: dict[str, Any], body: bytes) -> None:
    text = json.dumps(head).encode()
    stream.write(HEAD.pack(len(text), len(body)) + text + body)
    stream.flush()


def receive(stream: IO[bytes]) -> tuple[Any, bytes]:
    """Ends the process where the input has ended."""
    lengths = stream.read(HEAD.size)
    if len(lengths) < HEAD.size:
        os._exit(0)
    text, body = HEAD.unpack(lengths)
    return json.loads(stream.read(text)), stream.read(body)
