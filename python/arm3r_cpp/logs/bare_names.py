"""The names of columns without their units."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

from .units import Unit, unit_of

LONGEST = 200
"""Characters of a name that is read at all."""
_TIMES = ("t", "time", "timestamp", "%time")
_INDEX = r"_?[\[({]?\d[\])}]?"
_IN_BRACKETS = re.compile(rf"(.*?\S)\s*(?:\[([^\[\]]*)\]|\(((?:[^()]|\([^()]*\))*)\))\s*({_INDEX})?")
_INDEXED = re.compile(rf"(.*[^\W\d_]|.*\d(?=[_\[(]))({_INDEX})")
_GAP = re.compile(r"\s+(?:in|/)\s+|,\s+|[_\s]+|(?<=\d)(?=[^\W\d_]|°)")
_POSITION = re.compile(r"p_?[1-3xyz]|(?:\w+_)?(?:tip|tcp|ee|eef|end_effector|tool)_.*", re.IGNORECASE)


class BareName(NamedTuple):
    """A name without its unit."""

    name: str
    unit: Unit | None = None
    """None: it has none, or none that is known."""
    has_known_unit: bool = True
    """Whether its unit is known, if it has one."""


def is_time(name: str) -> bool:
    return name.lower() in _TIMES


def bare_name(name: str, is_understood: Callable[[str], bool]) -> BareName:
    """A name without its unit.

    Args:
        is_understood: whether it is known what a column of a name without a unit is.
    """
    name = name.strip()
    if len(name) > LONGEST or is_understood(name):
        return BareName(name)
    match = _IN_BRACKETS.fullmatch(name)
    if match and is_understood(bare := match[1] + (match[4] or "")):
        text = match[2] or match[3] or ""
        if unit := unit_of(text):
            return BareName(bare, unit)
        if re.search(r"[^\W\d_]|[°%]", text):
            return BareName(bare, has_known_unit=False)
    for bare, text in _split(name):
        if (unit := unit_of(text)) and _may_follow(bare, text, unit) and is_understood(bare):
            return BareName(bare, unit)
    return BareName(name)


def _split(name: str) -> Iterator[tuple[str, str]]:
    """q1 and deg of q1_deg, q1 deg or q1deg; q_1 and deg of q_deg_1."""
    indexed = _INDEXED.fullmatch(name)
    for stem, index in [(name, ""), *([indexed.groups()] if indexed else [])]:
        for gap in _GAP.finditer(stem):
            yield stem[: gap.start()] + index, stem[gap.end() :]


def _may_follow(name: str, text: str, unit: Unit) -> bool:
    """Whether a text is the name's unit, and no word of the name: tau1_m is that of a motor, and q1_min the least."""
    if unit.seconds > 0:
        return is_time(name)
    return bool(_POSITION.fullmatch(name)) if text == "m" else len(text) > 1 or text == "°"
