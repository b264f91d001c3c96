"""What a column of a log is called by others: a run's name for it, and the factor to SI units and radians."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from ..errors import UsageError

_DEGREE = math.pi / 180
_UNITS = {
    "": 1.0, "1": 1.0, "-": 1.0, "s": 1.0, "ms": 1e-3, "us": 1e-6, "rad": 1.0, "deg": _DEGREE, "degree": _DEGREE,
    "degrees": _DEGREE, "°": _DEGREE, "m": 1.0, "mm": 1e-3, "n": 1.0, "nm": 1.0, "n m": 1.0, "n*m": 1.0, "dps": _DEGREE,
    **{f"{length}/{time}": factor for length, factor in (("rad", 1.0), ("deg", _DEGREE), ("°", _DEGREE), ("m", 1.0))
       for time in ("s", "s2", "s^2", "s²")},
}  # fmt: skip
_BRACKETS = re.compile(r"(.*?)\s*[\[(]\s*([^\[\]()\d]*[²2]?)\s*[\])]\s*")
_WORD_UNIT = re.compile(r"(.*\d)_?(deg|degrees|rad)", re.IGNORECASE)
_TIMES = ("t", "time", "timestamp", "time_s", "t_s", "%time")
_QUANTITIES = {  # of a joint: what others call them, in small letters
    "q": "q theta th joint angle pos position joint_angle joint_pos joint_position joint_positions",
    "qd": "qd dq qdot q_dot thetadot theta_dot dtheta vel velocity speed joint_vel joint_velocity joint_velocities "
    "joint_speed",
    "qdd": "qdd ddq qddot q_ddot thetaddot theta_ddot ddtheta acc acceleration joint_acc joint_acceleration "
    "joint_accelerations",
    "tau": "tau torque effort trq joint_torque joint_torques joint_effort",
}
_OF_WORD = {word: quantity for quantity, words in _QUANTITIES.items() for word in words.split()}
_WORDS = "|".join(sorted(_OF_WORD, key=len, reverse=True))
_INDEXED = re.compile(rf"(?:actual_|measured_|meas_)?({_WORDS})_?[\[({{]?(\d)[\])}}]?")
_ENTRY = re.compile(r"([A-Za-z]+)_?[\[({]?(\d)(?:[,_ ]|\]\[|, )?(\d)?[\])}]?")
_TIP = re.compile(
    r"(?:(?:actual|measured|meas)_)?(?:tcp|tip|ee|eef|end_effector|tool)_?(?:pose|pos|position)[_.]?[\[(]?([0-6xyz])[\])]?",
    re.IGNORECASE,
)
_DOTTED = re.compile(r"(q|theta)_?(\d)_?(d?)dot")
_OF_JOINT = re.compile(rf"(.*?)[_ ]?({_WORDS})")


class Column(NamedTuple):
    """A column of a log under the name that a run has for it."""

    given: str
    name: str
    factor: float
    """By which its numbers are multiplied."""
    has_unit: bool
    """Whether the log says the unit."""


class _Joint(NamedTuple):
    quantity: str
    joint: str  # its number or its name


def columns_of(
    names: Sequence[str], is_known: Callable[[str], bool], *, called: Mapping[str, str] | None = None
) -> list[Column]:
    """The columns of a log, in their order; one that is not known keeps its name.

    Args:
        is_known: whether a run, or a formula, has a column of this name.
        called: the run's name, perhaps with a unit in brackets, for a name in the log.

    Raises:
        UsageError: `called` has a name that is not in the log.
    """
    called = dict(called or {})
    if missing := [name for name in called if name not in names]:
        raise UsageError(f"no column is called {missing[0]!r}; there are {', '.join(names)[:200]}", code="usage")
    parted = [_parted(called.get(name, name)) for name in names]
    joints = {
        place: joint
        for place, (bare, _) in enumerate(parted)
        if names[place] not in called and not is_known(bare) and (joint := _joint(bare))
    }
    meant = _numbered(joints) | _entries(
        {place: bare for place, (bare, _) in enumerate(parted) if place not in joints}, is_known
    )
    meant |= _of_tip(
        {place: bare for place, (bare, _) in enumerate(parted) if place not in meant and names[place] not in called}
    )
    own = {bare for place, (bare, _) in enumerate(parted) if place not in meant and is_known(bare)}
    own |= set(called.values())
    often = Counter(meant.values())
    found = []
    for place, (name, (bare, unit)) in enumerate(zip(names, parted, strict=True)):
        other = meant.get(place, "t" if bare.lower() in _TIMES else bare)
        ours = other if other not in own and often[other] < 2 else bare
        found.append(
            Column(name, ours if is_known(ours) or ours == "t" else name, _UNITS[unit or ""], unit is not None)
        )
    return found


def _parted(name: str) -> tuple[str, str | None]:
    """A name without its unit, and that; None: it has none."""
    for match in (_BRACKETS.fullmatch(name), _WORD_UNIT.fullmatch(name)):
        if match and match[2].strip().lower() in _UNITS and match[1]:
            return match[1].strip(), match[2].strip().lower()
    return name.strip(), None


def _joint(name: str) -> _Joint | None:
    """The quantity of a joint that a name stands for, and which joint it is."""
    parts = [part for part in re.split(r"[/.]", name.lower().replace(" ", "_")) if part]
    if len(parts) > 1 and parts[-1].isdigit():
        parts[-2:] = [f"{parts[-2]}_{parts[-1]}"]
    if not parts:
        return None
    last = parts[-1]
    if match := _INDEXED.fullmatch(last):
        return _Joint(_OF_WORD[match[1]], match[2])
    if match := _DOTTED.fullmatch(last):
        return _Joint("qdd" if match[3] else "qd", match[2])
    match = _OF_JOINT.fullmatch(last)
    if not match or not (len(parts) > 1 or re.search(r"joint|\d", match[1])):
        return None
    return _Joint(_OF_WORD[match[2]], match[1] or parts[-2])


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


def _numbered(joints: Mapping[int, _Joint]) -> dict[int, str]:
    """The names q1, q2, ...: by the numbers of the joints, which may begin with 0, else in the order of the columns."""
    number_of: dict[_Joint, int] = {}
    for quantity in {joint.quantity for joint in joints.values()}:
        order = list(dict.fromkeys(joint for joint in joints.values() if joint.quantity == quantity))
        digits = [re.findall(r"\d+", joint.joint)[-1:] for joint in order]
        numbers = [int(one[0]) for one in digits if one]
        if len(set(numbers)) < len(order):
            numbers = list(range(1, len(order) + 1))
        number_of.update(zip(order, numbers, strict=True))
    shift = 1 if 0 in number_of.values() else 0
    return {place: f"{joint.quantity}{number_of[joint] + shift}" for place, joint in joints.items()}
