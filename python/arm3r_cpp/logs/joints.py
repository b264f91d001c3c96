"""Which quantity of which joint a column of a log is: q1, qd1, qdd1, tau1, ... by the words that others have for them.

Which joint it is says its name where the arm's joints have names, else the last number in the column's name, else the
order of the columns. Of two names for the same number of a joint, one with more words, such as target, is left out.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

_QUANTITIES = {  # of a joint: what others call them, in small letters
    "q": "q theta θ th joint angle angles pos position positions joint_angle joint_angles joint_pos joint_position "
    "joint_positions",
    "qd": "qd dq qdot q_dot thetad thetadot theta_dot dtheta omega ω w vel velocity velocities speed speeds joint_vel "
    "joint_velocity joint_velocities joint_speed joint_speeds",
    "qdd": "qdd ddq qddot q_ddot thetadd thetaddot theta_ddot ddtheta omegadot omega_dot alpha α acc acceleration "
    "accelerations joint_acc joint_acceleration joint_accelerations",
    "tau": "tau τ torque torques effort efforts trq joint_torque joint_torques joint_effort joint_efforts",
}
_OF_WORD = {word: quantity for quantity, words in _QUANTITIES.items() for word in words.split()}
_OF_OTHERS_TOO = {"w": -1, "alpha": -2, "α": -2}
"""Words that mean other things, too: the power of seconds in the unit with which they mean a joint's rate."""
_BESIDE = {  # what a name has beside a joint and a quantity
    "same": "joint joints state states actual act measured meas current present feedback",
    "another": "target targets desired des command commands commanded cmd reference references ref setpoint setpoints "
    "goal demand nominal planned trajectory controller motor motors rotor filtered filt raw error errors estimated est "
    "simulated sim external ext",
}
_SAME, _ANOTHER = (frozenset(words.split()) for words in _BESIDE.values())

_WORDS = "|".join(sorted(_OF_WORD, key=len, reverse=True))
_INDEXED = re.compile(rf"(?:actual_|measured_|meas_)?({_WORDS})_?[\[({{]?(\d)[\])}}]?")
_DOTTED = re.compile(r"(?:q|theta)_?(\d)_?(d?)dot")
_OF_JOINT = re.compile(rf"(.*?)([_ ]?)({_WORDS})")
_AT_END = re.compile(rf"(?:(.*)_)?({_WORDS})")


class Label(NamedTuple):
    """What the name of a column says."""

    quantity: str
    word: str
    """For the quantity."""
    joint: str
    """The joint's name or number, without what many names have."""
    number: int | None
    """Of the joint: its place in the arm from 1, or the last number in the name."""
    more: frozenset[str]
    """The words of the name beside these."""
    same: frozenset[str]
    """Those with which a name means the same as without."""
    is_of_arm: bool = False
    """Whether the name has that of a joint of the arm."""

    def says_more_than(self, other: Label) -> bool:
        """Whether it has the words of another label of the same quantity and number, and more."""
        return self.more > other.more or (self.more == other.more and self.same > other.same)


def label_of(name: str, joints: Sequence[str] = ()) -> Label | None:
    """What a name says; None where it names no quantity of a joint.

    Args:
        name: without a unit.
        joints: what the arm's joints are called, from the base to the tip.
    """
    parts = [part for part in re.split(r"[/.]", name.lower().replace(" ", "_")) if part]
    if len(parts) > 1 and parts[-1].isdigit():
        parts[-2:] = [f"{parts[-2]}_{parts[-1]}"]
    return _by_name_of_joint(parts, joints) or _by_number(parts) if parts else None


def _by_name_of_joint(parts: Sequence[str], joints: Sequence[str]) -> Label | None:
    """elbow_joint/position, elbow_joint_position or position/elbow_joint of an arm with a joint elbow_joint."""
    telling = [words for words in map(_words, parts) if not _SAME.issuperset(words)]
    text = "_".join(word for words in telling[-2:] for word in words)
    for joint in sorted(joints, key=len, reverse=True):
        match = re.fullmatch(rf"(?:(.+)_)?{'_'.join(_words(joint.lower()))}(?:_(.+))?", text)
        if not match:
            continue
        before, behind = ([word for word in _words(one or "") if word not in _SAME] for one in match.groups())
        said = _AT_END.fullmatch("_".join(behind or before) or "q")
        if not said:
            continue
        path = [word for words in telling[:-2] for word in words]
        more = frozenset([*path, *(before if behind else []), *_words(said[1] or "")]) - _SAME
        same = frozenset(_words(text)) & _SAME
        return Label(_OF_WORD[said[2]], said[2], joint, joints.index(joint) + 1, more, same, True)
    return None


def _by_number(parts: Sequence[str]) -> Label | None:
    """q_0, joint_1_position, position[0] or base/position."""
    last = parts[-1]
    if match := _INDEXED.fullmatch(last):
        word, joint = match[1], match[2]
    elif match := _DOTTED.fullmatch(last):
        word, joint = "qddot" if match[2] else "qdot", match[1]
    else:
        match = _OF_JOINT.fullmatch(last)
        if not match or not (len(parts) > 1 or re.search(r"joint|\d", match[1])):
            return None
        word, joint = match[3], match[1] or parts[-2]
        if len(word) < 3 and match[1][-1:].isalpha() and not match[2]:  # length ends in no th
            return None
    own = _words(joint)
    numbers = [int(one) for one in own if one.isdecimal()]
    telling = "_".join(one for one in own if one not in _SAME)
    words = frozenset(one for part in (joint, *parts[:-1]) for one in _words(part) if not one.isdecimal())
    same = frozenset(own) & _SAME
    return Label(_OF_WORD[word], word, telling, numbers[-1] if numbers else None, words - _SAME, same)


def _words(text: str) -> list[str]:
    """ "ur5_arm": ur, 5, arm."""
    return re.findall(r"[^\W\d_]+|\d+", text)


def sure(labels: Mapping[int, Label], seconds: Mapping[int, int]) -> dict[int, Label]:
    """The labels but those whose word means other things, too, and whose unit does not say that it means a rate.

    Args:
        seconds: the power of seconds in the unit of a column, by its place.
    """
    has_omega = any(label.word in ("omega", "ω") for label in labels.values())
    return {
        place: label
        for place, label in labels.items()
        if (due := _OF_OTHERS_TOO.get(label.word)) is None or seconds.get(place) == due or (has_omega and due == -2)
    }


def names_of(labels: Mapping[int, Label]) -> dict[int, str]:
    """The names q1, q2, ... by the places of columns; those of other joints and numbers have none."""
    of_arm = _plain({place: label for place, label in labels.items() if label.is_of_arm})
    named = {label.quantity for label in of_arm.values()}
    others = {
        place: label
        for place, label in labels.items()
        if not named or (label.quantity not in named and label.joint.isdecimal())
    }
    return {place: f"{label.quantity}{label.number}" for place, label in of_arm.items()} | _numbered(others)


def _plain(labels: Mapping[int, Label], words: frozenset[str] | None = None) -> dict[int, Label]:
    """The labels without those that say more than another one: any words, or these."""
    alike: dict[tuple[str, int | None], set[Label]] = {}
    for label in labels.values():
        alike.setdefault((label.quantity, label.number), set()).add(label)
    return {
        place: label
        for place, label in labels.items()
        if not any(
            label.says_more_than(other) and (words is None or label.more - other.more <= words)
            for other in alike[label.quantity, label.number]
        )
    }


def _numbered(labels: Mapping[int, Label]) -> dict[int, str]:
    """By the numbers of the joints, which may begin with 0, else in the order of the columns."""
    found: dict[int, tuple[str, int]] = {}
    for quantity in {label.quantity for label in labels.values()}:
        known = _plain({place: label for place, label in labels.items() if label.quantity == quantity}, _ANOTHER)
        plain = _plain(known)
        numbers = {label.joint: label.number for label in plain.values() if label.number is not None}
        if len(set(numbers.values())) < len({label.joint for label in plain.values()}):
            plain, order = known, dict.fromkeys(label.joint for label in known.values())
            numbers = dict(zip(order, range(1, len(order) + 1), strict=True))
        found |= {place: (quantity, numbers[label.joint]) for place, label in plain.items()}
    shift = 1 if 0 in (number for _, number in found.values()) else 0
    return {place: f"{quantity}{number + shift}" for place, (quantity, number) in found.items()}
