"""Figures into files: all of them whole, or none."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from .._files import check_folder, replacing
from ..errors import UsageError
from .style import FORMATS

if TYPE_CHECKING:
    from matplotlib.figure import Figure


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
    with ExitStack() as whole:
        for path, figure in figures.items():
            figure.savefig(whole.enter_context(replacing(path)), format=path.suffix[1:])
