"""Files: what is read is a regular file, what is written is whole, and its folder exists."""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path

from .errors import OutputError, UsageError

_number = count()  # of the files that this process has begun: two threads may write to the same path


def regular(path: Path) -> Path:
    """The path of a file that can be opened and read to its end; one that does not exist is left to `open`.

    Reading a FIFO would wait for its writer, and a device may never end.

    Raises:
        OSError: it is not a regular file.
    """
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "not a regular file", str(path))
    return path


def check_ending(path: str | os.PathLike[str], endings: Sequence[str], *, hint: str = "") -> None:
    """
    Raises:
        UsageError: the name ends in none of these, so that the file would not be what its name says.
    """
    suffix = Path(path).suffix
    if suffix not in endings:
        got = f"got {suffix}" if suffix else "the name has no ending"
        words = f"{os.fspath(path)}: {' or '.join(endings)} is written there, {got}"
        raise UsageError(f"{words}; {hint}" if hint else words, code="usage")


def folder_named(name: str | os.PathLike[str]) -> Path:
    """The folder that is written, which may have to be made.

    Raises:
        UsageError: there is none yet, and the name is that of a file or of standard output.
    """
    text, path = os.fspath(name), Path(name)
    if text == "-":
        raise UsageError("-: a folder is written, which standard output cannot take; name one", code="usage")
    if path.suffix and not path.exists() and not text.endswith(("/", os.sep)):
        hint = "write / at its end, or make it first, if it is a folder"
        raise UsageError(f"{text}: a folder is written, and this is the name of a file; {hint}", code="usage")
    return path


def check_folder(folder: Path) -> None:
    """
    Raises:
        OutputError: a file cannot be written there, because the folder does not exist.
    """
    if not folder.is_dir():
        raise OutputError(f"{folder}: there is no such folder; create it first, or name another one", code="output")


def make_folder(folder: Path) -> None:
    """Make a folder that was asked for, with those above it.

    Raises:
        OutputError: it cannot be made.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: cannot be made: {error.strerror}", code="output") from error


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Write a file or a folder whole or not at all.

    The block writes to the path that it gets, where nothing is yet. When the block ends, that takes the place of
    `path`; when the block raises, nothing is left of it.

    Raises:
        OutputError: it cannot be written.
    """
    part = path.with_name(f".{path.name}.{os.getpid()}-{next(_number)}.part")
    with writing(path):
        try:
            yield part
            part.replace(path)
        finally:
            _remove(part)


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """What the operating system refuses in the block is raised as OutputError that names the path."""
    try:
        yield
    except OutputError:
        raise
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror or error}", code="output") from error


def _remove(part: Path) -> None:
    if part.is_dir():
        shutil.rmtree(part, ignore_errors=True)
    else:
        with suppress(OSError):  # its folder is none: the error that is under way says so
            part.unlink(missing_ok=True)
