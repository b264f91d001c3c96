"""What an exercise consists of, as data."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from .._native import Floats
from ..core.run import Run
from .loop import Loop
from .numbers import LAB, Numbers

_SAMPLES = 40


@dataclass(frozen=True, kw_only=True)
class Task:
    """An exercise: what is asked, and three hints, each of which says more than the one before."""

    name: str
    title: str
    text: str
    hints: tuple[str, str, str]
    points: int
    """What it is worth when it is right."""
    given: str = ""
    """What the student begins with: a listing with a fault, or a scenario."""
    given_suffix: str = ".m"
    numbers: Numbers = LAB
    """Whose numbers it has."""
    suffixes: ClassVar[tuple[str, ...]]


@dataclass(frozen=True)
class Input:
    """An argument of a student's function: so many numbers, drawn between two limits. One number is a scalar."""

    name: str
    low: float
    high: float
    size: int = 3


@dataclass(frozen=True)
class Mistake:
    """A mistake that is known: what it is, and what a function with this mistake returns."""

    sentence: str
    values: Callable[..., Floats]


@dataclass(frozen=True, kw_only=True)
class FunctionTask(Task):
    """An exercise in which a function is handed in; its values are compared with the right ones.

    `right` and the mistakes take the inputs by name, (N, size) or (N,), and return (N, ...).
    """

    suffixes = (".py", ".m")
    function: str
    """What the function is called. A file without such a name has its only function judged."""
    inputs: tuple[Input, ...]
    right: Callable[..., Floats]
    entries: tuple[str, ...]
    """What the numbers of its result are called, row by row."""
    mistakes: tuple[Mistake, ...] = ()
    kind: str = ""
    """A kind of `verify`: arguments are then found by their names. Without it they are taken by position."""
    scenario: str = ""
    """Where there is a kind: the arm, and for a controller the law."""
    loop: Loop | None = None
    """What the function does in a loop, where the task is about one."""

    def samples(self) -> dict[str, Floats]:
        """The states at which values are compared."""
        random = np.random.default_rng(34)
        drawn = {one.name: random.uniform(one.low, one.high, (_SAMPLES, one.size)) for one in self.inputs}
        return {one.name: drawn[one.name][:, 0] if one.size == 1 else drawn[one.name] for one in self.inputs}

    @property
    def signature(self) -> str:
        return f"{self.function}({', '.join(one.name for one in self.inputs)})"


@dataclass(frozen=True, kw_only=True)
class Condition:
    """A number of a run that is due. An error of less than a tenth of the threshold is none."""

    what: str
    unit: str
    measure: Callable[[Run], float]
    due: float
    threshold: float


@dataclass(frozen=True, kw_only=True)
class ScenarioTask(Task):
    """An exercise in which a scenario is handed in; it is run, and its numbers are compared with the right ones.

    `takes` are the paths that are taken from the student's scenario; all other values are those of `given`.
    """

    suffixes = (".yaml", ".yml")
    given_suffix: str = ".yaml"
    takes: tuple[str, ...]
    conditions: tuple[Condition, ...]
    keys: Mapping[str, tuple[Any, ...]] = field(default_factory=dict)
    """The values that some paths may have."""
