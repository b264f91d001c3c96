"""Figures into files: all of them whole, or none."""

from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import OutputError, UsageError
from ..folders import check_folder
from .style import FORMATS, style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

UNDATED: dict[str, dict[str, Any]] = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}


def check_format(out: Path) -> None:
    """
    Raises:
        UsageError: figures of this kind are not written.
    """
    if out.suffix[1:] not in FORMATS:
        raise UsageError(f"-o {out}: cannot write {out.suffix or 'that'}; use one of {', '.join(FORMATS)}")


def write(figures: Mapping[Path, Figure]) -> None:
    """Each figure under its name, whose suffix tells the format. The same figure is the same bytes.

    Raises:
        OutputError: one cannot be written, or its folder does not exist; then none is.
    """
    for folder in {path.parent for path in figures}:
        check_folder(folder)
    parts = {path: path.with_name(f".{path.name}.{os.getpid()}.part") for path in figures}
    try:
        for path, figure in figures.items():
            kind = path.suffix[1:]
            with style():
                figure.savefig(parts[path], format=kind, metadata=UNDATED.get(kind))
        for path, part in parts.items():
            part.replace(path)
    except OSError as error:
        raise OutputError(f"cannot write figures: {error}") from error
    finally:
        for part in parts.values():
            with suppress(OSError):  # its folder is none: the error that is under way says so
                part.unlink(missing_ok=True)
