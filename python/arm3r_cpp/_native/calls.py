"""Calls of the library that fail by an exception, and text in and out."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable
from typing import Any, Protocol

from ..errors import Arm3rError, UsageError, class_of
from .library import ffi, lib, string


class Places(Protocol):
    """Where the caller's own arrays have what the library names."""

    def find(self, path: str) -> tuple[str, tuple[int, ...]] | None: ...


def error(status: int, states: Places | None = None) -> Arm3rError:
    """The error of this thread's last failed call, which names places in the shapes of the states that were given."""
    report = json.loads(ffi.string(lib.arm3r_error_json()))
    message, problems, index = report["message"], report["problems"], None
    for problem in problems:
        if states and (found := states.find(problem["path"])):
            place, index = found
            message, problem["path"] = message.replace(problem["path"], place), place
    return class_of(status)(message, status=status, code=report["code"], problems=problems, index=index)


def call(function: Callable[..., int], *arguments: Any) -> None:
    """Call a function of the library; raise when it fails."""
    status = function(*arguments)
    if status:
        raise error(status)


def create(kind: str, function: Callable[..., int], *arguments: Any) -> Any:
    """Call a function whose last argument receives a new handle of `arm3r_<kind>`, freed when nothing holds it."""
    out = ffi.new(f"arm3r_{kind} **")
    call(function, *arguments, out)
    return ffi.gc(out[0], getattr(lib, f"arm3r_{kind}_free"))


def utf8(text: str, name: str) -> tuple[bytes, int]:
    """Text as the library takes it: bytes and their number. TypeError: it is not text. UsageError: not UTF-8."""
    if not isinstance(text, str):
        raise TypeError(f"{name}: text (str) is needed, got {type(text).__name__}")
    try:
        data = text.encode()
    except UnicodeEncodeError as error:
        raise UsageError(f"{name}: {text!a} is not UTF-8", code="argument.utf8") from error
    return data, len(data)


def file_path(path: str | os.PathLike[str]) -> tuple[bytes, int]:
    """A path as the library takes it."""
    data = os.fsencode(path)
    return data, len(data)


def text(function: Callable[..., int], *arguments: Any) -> str:
    """Call a function whose last argument receives text."""
    out = ffi.new("const char **")
    call(function, *arguments, out)
    return string(out[0])


def sweep(text: bytes, file: str) -> tuple[Any, dict[str, Any]]:
    """The scenario of a sweep's file, a handle, and what its keys say, as arm3r_sweep_read describes it."""
    out = ffi.new("const char **")
    scenario = create("scenario", lib.arm3r_sweep_read, text, len(text), *utf8(file, "file"), out)
    return scenario, json.loads(ffi.string(out[0]))


def nearest_word(word: str, words: Iterable[str]) -> str:
    """The one of `words` that `word` is most likely a slip for; "" where none is near."""
    names = list(words)
    texts = [ffi.new("char[]", name.encode()) for name in names]
    place = ffi.new("int64_t *")
    call(lib.arm3r_nearest_word, word.encode(errors="replace"), texts, len(texts), place)
    return names[place[0]] if place[0] >= 0 else ""
