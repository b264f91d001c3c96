"""Where results go: a folder that is asked for is made, a file needs a folder that exists."""

from __future__ import annotations

from pathlib import Path

from .errors import OutputError


def check_folder(folder: Path) -> None:
    """
    Raises:
        OutputError: a file cannot be written there, because it does not exist.
    """
    if not folder.is_dir():
        raise OutputError(f"{folder}: is no folder that exists; make it first, or name another one", code="output")


def make_folder(folder: Path) -> None:
    """A folder that was asked for, with those above it.

    Raises:
        OutputError: it cannot be made.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: cannot be made: {error.strerror}", code="output") from error
