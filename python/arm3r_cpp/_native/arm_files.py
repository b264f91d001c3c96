"""Arms that stand in files of their own: the library asks for their keys."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from .calls import call
from .library import ffi, lib

_kept: list[Any] = []  # functions that the library holds without a reference to them
_answers = threading.local()  # .text: the last one, which the library reads before it asks again


def read_arms_with(reader: Callable[[str], tuple[int, str]]) -> None:
    """Set the reader of `arm.urdf`: of a request in JSON it makes a status and a text (arm3r.h, arm3r_arm_reader)."""

    def arm3r_python_arm_reader(user: Any, request: Any, text: Any) -> int:
        status, answer = reader(ffi.string(request).decode())
        _answers.text = ffi.new("char[]", answer.encode())
        text[0] = _answers.text
        return status

    if hasattr(lib, "arm3r_python_arm_reader"):
        ffi.def_extern(error=1)(arm3r_python_arm_reader)
        function = lib.arm3r_python_arm_reader
    else:
        function = ffi.callback("arm3r_arm_reader", arm3r_python_arm_reader, error=1)
        _kept.append(function)
    call(lib.arm3r_set_arm_reader, function, ffi.NULL)
