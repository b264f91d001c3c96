"""What a block is given for each of its arguments, by the argument's name."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from .._messages import did_you_mean
from ..control.law_state import LawState
from ..errors import UsageError
from ..verify.names import quantities_of, slot_of

Input = Callable[[LawState], Any]
"""Takes from the state of a sample what an argument is given."""

NUMBERS = tuple(name for name, value in vars(LawState).items() if isinstance(value, property))
"""What a state holds: the names that a law in Python uses."""
ALIASES = {"f": "f_on_tip", "dq": "qd"}
_MATRICES = ("jacobian",)
_VECTORS = tuple(
    name
    for name in NUMBERS
    if getattr(LawState, name).fget.__annotations__["return"] == "Floats" and name not in _MATRICES
)
_COMPONENT = re.compile(rf"({'|'.join([*_VECTORS, *ALIASES])})(?:_([xyz])|_?([123]))")


def input_of(name: str) -> Input | None:
    """What the name of an argument stands for; None: it is no number of the state."""
    if name == "state":
        return lambda state: state
    name = ALIASES.get(name, name)
    if name in NUMBERS:
        return lambda state: getattr(state, name)
    if found := _COMPONENT.fullmatch(name):
        vector, letter, digit = found.groups()
        return _component(ALIASES.get(vector, vector), "xyz".index(letter) if letter else int(digit) - 1)
    slot = slot_of(name)
    if slot is None or slot[0] not in ("q", "qd"):
        return None
    vector, joint = slot
    if joint is None:
        return lambda state: getattr(state, vector)
    return _component(vector, joint) if joint < 3 else None


def _component(vector: str, index: int) -> Input:
    return lambda state: float(getattr(state, vector)[index])


def is_angle(name: str) -> bool:
    """Whether an argument is the joint angles, or one of them."""
    slot = slot_of(name)
    return slot is not None and slot[0] == "q"


def check_numbers(names: Sequence[str], place: str) -> None:
    """
    Raises:
        UsageError: a name is no number of an arm; `place` is that of the function.
    """
    meaning = quantities_of(names)
    for name in names:
        if name not in meaning:
            hint = did_you_mean(name, (*NUMBERS, *ALIASES))
            offered = f"a controller gets {', '.join(NUMBERS)}, and numbers of the arm such as a2, m3, g"
            raise UsageError(f"{place}: the argument {name} is not known; {hint + ' ' if hint else ''}{offered}")


def numbers_of_arm(names: Sequence[str], values: Mapping[str, float]) -> dict[str, float]:
    """The numbers that arguments such as a2, m3, g stand for, of an arm with these quantities."""
    return {name: values[quantity] for name, quantity in quantities_of(names).items()}
