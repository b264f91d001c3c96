"""The process in which Octave evaluates a user's MATLAB file: confined as that of a Python file is."""

from __future__ import annotations

import os
from typing import Any

from ..programs import Call, Edit, ProcessEnded, Unjudged
from ..python_process import Floats, PythonProcess
from .installation import Installation
from .names import with_own_names
from .source import OWN, headers_of


class OctaveProcess(PythonProcess):
    """A function of a MATLAB file, which Octave evaluates in a process of its own."""

    def __init__(self, text: str, function: str, file: str, installation: Installation) -> None:
        """
        Raises:
            UnreadError: the text holds what is no token.
        """
        headers = headers_of(text)
        super().__init__(with_own_names(text, set(headers), file), f"{function}{OWN}", file)
        self.installation, self.header = installation, headers[function]

    def evaluate(self, call: Call, table: Floats, edit: Edit | None = None) -> Floats:
        """As of `PythonProcess`; the end of the process is no verdict, as Octave may be its reason."""
        try:
            return super().evaluate(call, table, edit)
        except Unjudged:
            raise
        except ProcessEnded:
            raise Unjudged("ends Octave, which evaluates it") from None

    def _described(self) -> dict[str, Any]:
        return {
            **super()._described(),
            "octave": self.installation.library,
            "readable": [one for one in self.installation.folders if os.path.isdir(one)],
        }
