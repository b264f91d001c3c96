"""A student's function in a loop: what it does there, beside what is due."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from .._native import Floats
from ..errors import NumericalError
from .mark import RIGHT, WRONG, two_digits, word_of, worst

Function = Callable[..., Floats]
"""Takes the inputs of an exercise by name, at one state."""
RATE = 500.0
"""Samples per second at which a function is called."""


def at_one_state(values: Function) -> Function:
    """A function of many states, (N, size), as one of a single state."""
    return lambda **given: values(**{name: np.asarray(one, float)[None] for name, one in given.items()})[0]


@dataclass(frozen=True)
class Goal:
    """A number of a loop that is due. As everywhere, an error of less than a tenth of the threshold is none."""

    what: str
    unit: str
    due: float
    threshold: float


@dataclass(frozen=True)
class Loop:
    """A run in which a function computes, and the numbers of it that are due, in the order of the goals."""

    measured: Callable[[Function], Sequence[float]]
    goals: tuple[Goal, ...]

    def judged(self, function: Function) -> tuple[str, str]:
        """The word for a function, and what is off."""
        try:
            numbers = self.measured(function)
        except NumericalError as error:
            outcome = error.run.outcome if error.run else "an error"
            return WRONG, f"in the loop the run ends as {outcome}"
        errors = [number - goal.due for number, goal in zip(numbers, self.goals, strict=True)]
        words = [word_of(abs(error), goal.threshold) for error, goal in zip(errors, self.goals, strict=True)]
        parts = zip(self.goals, errors, words, strict=True)
        off = [f"{goal.what} is off by {two_digits(error)} {goal.unit}" for goal, error, word in parts if word != RIGHT]
        return worst(words), f"in the loop {'; '.join(off)}" if off else ""
