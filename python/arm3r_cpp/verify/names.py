"""What the names of a user's arguments and constants mean."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from ..errors import UnjudgedError
from .kinds import Kind
from .samples import STATE

_ANGLE = r"(?:q|Q|qs|th|theta|thetas|phi|alpha|ang|angle|angles|joint|joints|theta_?vec|q_?vec|config|conf)"
_RATE = r"(?:qd|dq|qdot|q_dot|qp|thd|dth|thetad|dtheta|theta_?dot|thdot|w|omega|v|vel|rates?|qvel|q_?dots?)"
_ACCELERATION = r"(?:qdd|ddq|qddot|q_ddot|qpp|thdd|ddth|thetadd|ddtheta|theta_?ddot|thddot|acc|qacc|q_?ddots?)"
_TORQUE = r"(?:tau|taus|torque|torques|u|t|T|trq)"
_DEGREES = r"(?:_?(?:deg|degrees?))?"
_VECTORS = {
    name: re.compile(pattern)
    for name, pattern in {
        "q": rf"{_ANGLE}_?(\d?){_DEGREES}",
        "qdd": rf"{_ACCELERATION}_?(\d?)|(?:q|th|theta)_?(\d)_?(?:dd|ddot|pp)",
        "qd": rf"{_RATE}_?(\d?)|(?:q|th|theta)_?(\d)_?(?:d|dot|p)",
        "tau": rf"{_TORQUE}_?(\d?)",
    }.items()
}
_LETTERS = {
    "a": "length",
    "l": "length",
    "L": "length",
    "A": "length",
    "link": "length",
    "length": "length",
    "len": "length",
    "m": "mass",
    "M": "mass",
    "mass": "mass",
    "lc": "com",
    "r": "com",
    "ac": "com",
    "com": "com",
    "rc": "com",
    "c": "com",
    "d": "height",
    "h": "height",
    "I": "inertia",
    "J": "inertia",
    "Izz": "inertia",
    "Iz": "inertia",
    "Iyy": "inertia",
    "Iy": "inertia",
}
_PARAMETER = re.compile(rf"({'|'.join(sorted(_LETTERS, key=len, reverse=True))})_?(\d)(?:_?(c|com|cm))?")
_GRAVITY = re.compile(r"g0?|grav|gravity|G|g_?acc")

_STATE = re.compile(r"x|X|z|s|y|state|states|xs|x_?vec")
_TIME = re.compile(r"t|time")
TIME = "time"
_SETS_TORQUE = re.compile(r"^[ \t]*(?:tau|taus|torques?|u)[ \t]*=(?!=)[ \t]*(\[[^\]]*\]|[^;%#\n]*)", re.M)
_ZEROS = re.compile(r"(?:np\.|numpy\.)?(?:zeros(?:_like)?\([^()]*\)|array)")
_RATE_OR_TORQUE = re.compile(r"(d{0,2}(q|th)|tau|torque).*")
"""What a function that returns several kinds takes for the others of them: `M, C, g = dynamics(q, qd)`."""

SHORT = {
    "length2": "a2",
    "length3": "a3",
    "mass1": "m1",
    "mass2": "m2",
    "mass3": "m3",
    "gravity": "g",
    "height": "d1",
    "com2": "l2",
    "com3": "l3",
    "inertia2": "I2",
    "inertia3": "I3",
}
"""What sentences call the arm's quantities where the user has no name for them."""


def slot_of(name: str) -> tuple[str, int | None] | None:
    """("q", 0) for q1, ("qd", None) for a vector qd; None for what is no state."""
    for vector, pattern in _VECTORS.items():
        found = pattern.fullmatch(name)
        if found:
            digits = "".join(group or "" for group in found.groups())
            return vector, int(digits) - 1 if digits else None
    return None


def quantities_of(names: Iterable[str]) -> dict[str, str]:
    """The arm's quantities that names such as a2, m3, g stand for."""
    names = list(names)
    parts = {name: found for name in names if (found := _PARAMETER.fullmatch(name.rpartition(".")[2]))}
    digits: dict[str, set[int]] = {}
    for found in parts.values():
        digits.setdefault(found[1], set()).add(int(found[2]))
    has_lengths = any(letter in digits for letter in ("a", "A", "L", "length", "len"))
    from_1 = {letter for letter, found in digits.items() if found == {1, 2}}
    if any(_LETTERS[letter] in ("com", "mass", "inertia") for letter in from_1):
        from_1 |= {letter for letter, found in digits.items() if found <= {1, 2}}  # m1, m2 and l1: l1 is link 2's
    meaning = {name: "gravity" for name in names if _GRAVITY.fullmatch(name.rpartition(".")[2])}
    for name, found in parts.items():
        quantity = "com" if found[3] or (found[1] == "l" and has_lengths) else _LETTERS[found[1]]
        number = int(found[2])
        if quantity in ("length", "com", "mass", "inertia") and found[1] in from_1:
            number += 1  # links 2 and 3 counted from 1
        if quantity == "length" and number == 1:
            quantity = "height"
        if quantity == "height":
            if number == 1:
                meaning[name] = "height"
        elif number in (2, 3) or (quantity == "mass" and number == 1):
            meaning[name] = f"{quantity}{number}"
    return meaning


def reference_of(name: str) -> str:
    """ "q" for q_des and theta_ref, "qd" for qd_des, "x" for x_des and p_target; "" for what is no reference."""
    found = re.fullmatch(r"(\w+?)_?(?:des|desired|ref|target|goal|star)", name)
    slot = slot_of(found[1]) if found else None
    if slot and slot[1] is None:
        return slot[0]
    return {"x": "x", "p": "x", "xd": "xd", "dx": "xd", "xdot": "xd"}.get(found[1], "") if found else ""


def vectors_of(arguments: Sequence[str]) -> set[str]:
    """The joint vectors that arguments are named for; a state is q and qd."""
    untimed = [name for name in arguments if not _TIME.fullmatch(name)]
    found = {slot[0] for name in untimed if (slot := slot_of(name))}
    return found | ({"q", "qd"} if any(map(_STATE.fullmatch, untimed)) else set())


def line_of_own_torque(text: str) -> int | None:
    """The line in which a text gives a torque another value than zero."""
    for found in _SETS_TORQUE.finditer(text):
        if re.search(r"[1-9a-zA-Z]", _ZEROS.sub("", found[1])):
            return text.count("\n", 0, found.start(1)) + 1
    return None


def is_right_hand_side(arguments: Sequence[str]) -> bool:
    """Whether they are those of one, and no others: f(t, x, u), f(q, qd, tau), or f(t, x) without a torque."""
    untimed = [name for name in arguments if not _TIME.fullmatch(name)]
    states = [name for name in untimed if _STATE.fullmatch(name)]
    vectors = [slot[0] for name in untimed if name not in states and (slot := slot_of(name))]
    is_whole = len(states) + len(vectors) == len(untimed)
    if len(states) == 1:
        return is_whole and (set(vectors) == {"tau"} or (not vectors and len(untimed) < len(arguments)))
    return is_whole and set(vectors) == {"q", "qd", "tau"}


def slots_of(
    arguments: Sequence[str], kind: Kind, joints: int, parameters: Iterable[str], text: str = ""
) -> list[tuple[str, int | None]]:
    """What each argument is given: ("q", 0), ("q", None), or ("parameter name", -1).

    Args:
        text: of the function; it shows which fields an argument has.

    Raises:
        UnjudgedError: the names do not say it.
    """
    found: list[tuple[str, int | None] | None] = []
    has_state = "qd" in kind.inputs and any(_STATE.fullmatch(name) for name in arguments)
    has_angles = "tau" not in kind.inputs and any(slot and slot[0] == "q" for slot in map(slot_of, arguments))
    for place, name in enumerate(arguments):
        slot = slot_of(name)
        if has_state and _STATE.fullmatch(name) and name not in parameters:
            found.append((STATE, None))
        elif _TIME.fullmatch(name) and place in (0, len(arguments) - 1) and (has_state or has_angles):
            found.append((TIME, None))
        elif slot and slot[0] in kind.inputs and (slot[1] is None or slot[1] < joints):
            found.append(slot)
        else:
            is_of_others = slot and slot[1] is None and kind.comes_with and _RATE_OR_TORQUE.fullmatch(name)
            found.append((name, -1) if name in parameters else slot if is_of_others else None)
    in_order: list[list[tuple[str, int | None]]] = [
        [(vector, None) for vector in kind.inputs],  # q, qd, ... in the order of the field
        [(vector, joint) for vector in kind.inputs for joint in range(joints)],
    ]
    for meant in in_order:
        fits = len(meant) == len(found) and all(known in (None, one) for known, one in zip(found, meant, strict=True))
        if None in found and fits:
            return meant
    unknown = [name for name, slot in zip(arguments, found, strict=True) if slot is None]
    if unknown:
        settings = " ".join(f"--set {name}=VALUE" for name in settable(unknown[0], text))
        raise UnjudgedError(
            f"the argument {unknown[0]} is not understood; {kind.a_words} takes {', '.join(kind.inputs)}, or "
            f"{', '.join(f'{kind.inputs[0]}{n + 1}' for n in range(joints))}, and parameters such as a2, m3, g; "
            f"--args {','.join(kind.inputs)},... says what the arguments are, {settings} gives it a value"
        )
    return [slot for slot in found if slot is not None]


def settable(name: str, text: str) -> list[str]:
    """The names that `--set` can give values: those of its fields that a text reads, or itself."""
    fields = re.findall(rf"\b{re.escape(name)}(?:\.(\w+)\b(?!\s*\(\s*\))|\[[\"'](\w+)[\"']\])", text)
    return [f"{name}.{dotted or keyed}" for dotted, keyed in dict.fromkeys(fields)] or [name]
