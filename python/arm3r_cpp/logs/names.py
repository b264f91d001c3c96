"""What a column of a log is called by others: a run's name for it, and the factor to SI units and radians."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from ..errors import UsageError
from .bare_names import LONGEST, BareName, bare_name, is_time
from .joints import label_of, names_of, sure
from .units import Unit

_ENTRY = re.compile(r"([A-Za-z]+)_?[\[({]?(\d)(?:[,_ ]|\]\[|, )?(\d)?[\])}]?")
_TIP = re.compile(
    r"(?:(?:actual|measured|meas)_)?(?:tcp|tip|ee|eef|end_effector|tool)_?(?:pose|pos|position)[_.]?[\[(]?([0-6xyz])[\])]?",
    re.IGNORECASE,
)


class Column(NamedTuple):
    """A column of a log under the name that a run has for it."""

    given: str
    name: str
    factor: float
    """By which its numbers are multiplied."""
    has_unit: bool
    """Whether the log says the unit."""
    but_for_unit: str = ""
    """The run's name for a column that is not known because its unit is not."""


def columns_of(
    names: Sequence[str],
    is_known: Callable[[str], bool],
    *,
    called: Mapping[str, str] | None = None,
    joints: Sequence[str] = (),
) -> list[Column]:
    """The columns of a log, in their order; one that is not known keeps its name.

    Args:
        is_known: whether a run, or a formula, has a column of this name.
        called: the run's name, perhaps with a unit in brackets, for a name in the log.
        joints: what the arm's joints are called, from the base to the tip.

    Raises:
        UsageError: `called` has a name that is not in the log, or a unit that is not known.
    """
    called = dict(called or {})
    if missing := [name for name in called if name not in names]:
        raise UsageError(f"no column is called {missing[0]!r}; there are {', '.join(names)[:200]}", code="usage")
    bare = [bare_name(called.get(name, name), lambda one: _is_understood(one, is_known, joints)) for name in names]
    for name, one in zip(names, bare, strict=True):
        if name in called and not one.has_known_unit:
            rule = "rad, deg, m, Nm, rpm and their like are, and numbers of them, such as 0.113 Nm"
            raise UsageError(f"{called[name]}: its unit is not known; {rule}", code="usage")
    ours = _ours(bare, _meant(names, bare, is_known, called, joints), is_known)
    first: dict[str, Unit | None] = {}  # of columns whose names differ in their units alone
    for place in sorted(ours, key=lambda place: (names[place] not in called, bare[place].unit is not None)):
        if bare[place].has_known_unit:
            first.setdefault(ours[place], bare[place].unit)
    return [_column(name, ours.get(place, ""), bare[place], first) for place, name in enumerate(names)]


def _is_understood(name: str, is_known: Callable[[str], bool], joints: Sequence[str]) -> bool:
    """Whether a name without a unit says what its column is."""
    entry = _ENTRY.fullmatch(name)
    is_entry = entry is not None and is_known("".join(part for part in entry.groups() if part))
    return is_known(name) or is_time(name) or is_entry or bool(_TIP.fullmatch(name) or label_of(name, joints))


def _meant(
    names: Sequence[str],
    bare: Sequence[BareName],
    is_known: Callable[[str], bool],
    called: Mapping[str, str],
    joints: Sequence[str],
) -> dict[int, str]:
    """The run's names for what others call otherwise, by the places of the columns."""
    labels = {
        place: label
        for place, (name, _, _) in enumerate(bare)
        if names[place] not in called and not is_known(name) and len(name) <= LONGEST
        if (label := label_of(name, joints))
    }
    labels = sure(labels, {place: one.unit.seconds for place, one in enumerate(bare) if one.unit})
    others = {place: one.name for place, one in enumerate(bare) if place not in labels}
    entries = _entries(others, is_known)
    tips = {place: name for place, name in others.items() if place not in entries and names[place] not in called}
    return names_of(labels) | entries | _of_tip(tips)


def _entries(names: Mapping[int, str], is_known: Callable[[str], bool]) -> dict[int, str]:
    """J12 for J(1,2), J_1_2 or J[0][1], and g1 for g(1): of a vector or a matrix that may be counted from 0."""
    indexed = {place: found for place, name in names.items() if (found := _ENTRY.fullmatch(name))}
    from_0 = {found[1] for found in indexed.values() if "0" in found.groups()[1:]}
    meant = {
        place: found[1] + "".join(str(int(one) + (found[1] in from_0)) for one in found.groups()[1:] if one)
        for place, found in indexed.items()
    }
    return {
        place: name
        for place, name in meant.items()
        if is_known(name) and (indexed[place][1] in from_0 or not is_known(names[place]))
    }


def _of_tip(names: Mapping[int, str]) -> dict[int, str]:
    """tip_x for tcp_pose_0, whose first three numbers are the position; they may be counted from 1."""
    letters = {place: found[1].lower() for place, name in names.items() if (found := _TIP.fullmatch(name))}
    first = 0 if "0" in letters.values() else 1
    of_letter = {str(first + axis): letter for axis, letter in enumerate("xyz")} | {letter: letter for letter in "xyz"}
    return {place: f"tip_{of_letter[one]}" for place, one in letters.items() if one in of_letter}


def _ours(bare: Sequence[BareName], meant: Mapping[int, str], is_known: Callable[[str], bool]) -> dict[int, str]:
    """The run's names for the columns that have one, by their places: its own names come before what others mean."""
    own = {one.name for place, one in enumerate(bare) if place not in meant and one.has_known_unit}
    ways = {(name, bare[place].name) for place, name in meant.items() if bare[place].has_known_unit}
    often = Counter(name for name, _ in ways)
    found = {place: name for place, name in meant.items() if name not in own and often[name] < 2}
    for place, one in enumerate(bare):
        found.setdefault(place, "t" if is_time(one.name) else one.name)
    return {place: name for place, name in found.items() if is_known(name) or name == "t"}


def _column(given: str, ours: str, bare: BareName, first: Mapping[str, Unit | None]) -> Column:
    """
    Args:
        ours: the run's name; "" where there is none.
        first: the units of the first column of each name, which is the one that is read.
    """
    if not bare.has_known_unit:
        return Column(given, given, 1.0, True, "" if ours in first else ours)
    factor = bare.unit.factor if bare.unit else 1.0
    is_read = bool(ours) and first[ours] == bare.unit
    return Column(given, ours if is_read else given, factor, bare.unit is not None)
