"""The law that calls a block at each sample, and the sentences about what went wrong in it."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..control.law import TORQUE
from ..control.law_state import LawState
from ..user_functions.programs import ProgramError

OTHER_SHAPES = ((3, 1), (1, 3))
EXIT = "it called exit()"


class Place(NamedTuple):
    """Where a function stands."""

    file: str
    line: int
    function: str


class BlockLaw:
    """A law as `Scenario.run` takes it."""

    def __init__(self, place: Place, call: Callable[[LawState], Any], order: Sequence[int] | None) -> None:
        """
        Args:
            call: computes what the function returns.
            order: where t1, t2, t3 stand in what it returns; None: in this order.
        """
        self._place, self._call, self._order = place, call, order
        self.__qualname__ = f"{place.file}: {place.function}"

    def __call__(self, t: float, state: LawState) -> Any:
        try:
            returned = self._call(state)
        except SystemExit as error:
            raise RuntimeError(EXIT) from error
        if isinstance(returned, (list, tuple)):
            ordered = returned if self._order is None or len(returned) != 3 else [returned[i] for i in self._order]
            return [float(one) if np.ndim(one) == 0 else _number(one) for one in ordered]
        return returned.reshape(3) if getattr(returned, "shape", None) in OTHER_SHAPES else returned

    def why_it_failed(self, raised: BaseException | None, received: Any) -> str:
        """The sentence for a sample at which it raised, or returned no torque."""
        if raised:
            return failure(self._place, raised)
        file, line, function = self._place
        return f"{file}:{line}: {function} returned {shown(received)}; {TORQUE}"


def _number(part: Any) -> Any:
    """A matrix with one number is that number; any other stays, and is refused."""
    return float(np.ravel(part)[0]) if np.size(part) == 1 else part


def failure(place: Place, raised: BaseException) -> str:
    """What a function raised, with the line of its file."""
    if isinstance(raised, ProgramError):
        return f"{place.file}:{raised.line or place.line}: {place.function}: {raised}"
    frames = [frame for frame in traceback.extract_tb(raised.__traceback__) if frame.filename == place.file]
    line = (frames[-1].lineno if frames else None) or place.line
    message = str(raised).split("\n")[0]
    return f"{place.file}:{line}: {place.function} raised {type(raised).__name__}{message and f': {message}'}"


def shown(received: Any) -> str:
    """What was returned, on one line."""
    shape = np.shape(received) if isinstance(received, (np.ndarray, list, tuple)) else ()
    if len(shape) > 1 or (shape and shape[0] > 6):
        return f"an array of {' x '.join(map(str, shape))} numbers"
    return repr(received.tolist() if isinstance(received, (np.ndarray, np.generic)) else received).split("\n")[0]
