"""What the modules of this room ask of a scenario, and of what stands above the room."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

from .._native import Floats
from ..answers.refusals import Validated
from ..control.law import Law
from .run import Run

if TYPE_CHECKING:
    from typing_extensions import Self


class AnyScenario(Validated, Protocol):
    """A `Scenario`, for modules that it imports."""

    file: str

    @property
    def is_quiet(self) -> bool: ...
    @property
    def params(self) -> Floats:
        """All its numbers."""
        ...

    def batch(self, values: Mapping[str, Any], *, threads: int, progress: Any) -> Any: ...
    def copy(self) -> Self: ...
    def run(self, *, controller: Any = None, progress: Any = None, time_limit: float | None = None) -> Run: ...
    def __contains__(self, path: str) -> bool: ...
    def __getitem__(self, path: str) -> Any: ...
    def __setitem__(self, path: str, value: Any) -> None: ...
    def for_law(self, rate: float | None) -> Self: ...
    def quiet(self) -> Self: ...
    def warn(self, sentences: Any) -> None: ...


@runtime_checkable
class LawOfFile(Protocol):
    """A function in a file of the user's own, which becomes a law for the arm of a scenario."""

    @property
    def text(self) -> str: ...
    @property
    def function(self) -> str: ...
    def law(self, scenario: Any) -> Law: ...
