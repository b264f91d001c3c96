"""Which joints of a URDF move, at which positions others are held, and where the tip is."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..errors import UsageError
from .serial import Serial, serial_chain
from .urdf import Urdf, UrdfJoint

AXIS_TOLERANCE = 1e-6  # rad
_ANGLE = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)( ?deg)?")


@dataclass(frozen=True)
class Choice:
    """What is said of a URDF beside its name, as `arm.urdf` and `arm3r import` take it."""

    file: str
    joints: tuple[str, ...] | None = None
    """The three that move; None for the first three on the way to the tip that are not locked."""
    lock: Mapping[str, float] = field(default_factory=dict)
    """Positions of movable joints that are held, rad or m."""
    tip: str | None = None
    """The name of a link; None for the only end of the tree."""
    axis_tolerance: float = AXIS_TOLERANCE
    """By which axes may be off those of an elbow arm, rad."""
    given: frozenset[str] = frozenset()
    """Keys that stand beside `arm.urdf`, such as "link2.mass"; they replace those of the file."""

    @classmethod
    def of(cls, request: Mapping[str, Any]) -> Choice:
        """
        Args:
            request: `urdf`, a path, and where they are given `folder`, from which it counts; `joints`, `lock`, `tip`,
                `axis_tolerance` and `given`. Angles are numbers in rad, or text such as "-90 deg".

        Raises:
            UsageError: a value is none of its key.
        """
        joints, lock, tip, tolerance = map(request.get, ("joints", "lock", "tip", "axis_tolerance"))
        file = os.path.join(os.fspath(request.get("folder") or ""), os.fspath(request["urdf"]))
        if joints is not None and not (isinstance(joints, (list, tuple)) and len(joints) == len({*joints}) == 3):
            raise UsageError(f"{file}: joints: the names of three joints are needed, from base to tip, got {joints!r}")
        lock = {} if lock is None else lock
        if not isinstance(lock, Mapping):
            raise UsageError(
                f"{file}: lock: a map of names and angles is needed, such as {{wrist: -90 deg}}, got {lock!r}"
            )
        tolerance = AXIS_TOLERANCE if tolerance is None else angle(tolerance, f"{file}: axis_tolerance")
        if not 0 <= tolerance < math.pi / 4:
            raise UsageError(f"{file}: axis_tolerance: an angle from 0 to 45 deg is needed, got {tolerance:g} rad")
        return cls(
            file,
            None if joints is None else tuple(map(str, joints)),
            {str(name): angle(value, f"{file}: lock: {name}") for name, value in lock.items()},
            None if tip is None else str(tip),
            tolerance,
            frozenset(request.get("given") or ()),
        )


def angle(value: object, what: str) -> float:
    """A number, "0.5" or "-90 deg", in rad.

    Raises:
        UsageError: it is none; the message begins with `what`.
    """
    found = _ANGLE.fullmatch(value.strip()) if isinstance(value, str) else None
    number = float(found[1]) if found else value
    if isinstance(number, bool) or not isinstance(number, (int, float)) or not math.isfinite(number):
        raise UsageError(f"{what}: an angle is needed, in rad or such as -90 deg, got {value!r}")
    return math.radians(number) if found and found[2] else float(number)


def chosen(urdf: Urdf, choice: Choice) -> Serial:
    """The chain of the three revolute joints that move.

    Raises:
        UsageError: other joints move, too, or fewer do, or one of them is not revolute.
    """
    way, positions = urdf.way(choice.tip), held_positions(urdf, choice.lock)
    tip = urdf.tip(choice.tip)
    free = [joint for joint in way if joint.kind != "fixed" and joint.name not in positions]
    names = _named(urdf, choice, way, free)
    extra = [joint for joint in free if joint.name not in names]
    if extra:
        verb = "moves" if len(extra) == 1 else "move"
        raise UsageError(
            f"{urdf.file}: on the way to {tip} {listed(one.name for one in extra)} {verb}, too, and an elbow arm has "
            f"three joints ({', '.join(names)}); lock what shall not move, such as "
            f"lock: {{{', '.join(f'{joint.name}: 0' for joint in extra)}}}"
        )
    if len(free) < 3:
        moving = f"only {listed(one.name for one in free)}" if free else "no joint"
        raise UsageError(f"{urdf.file}: on the way to {tip} {moving} can move; an elbow arm has three joints")
    for joint in free:
        if joint.kind not in ("revolute", "continuous"):
            raise UsageError(
                f"{urdf.file}: {joint.name} is {joint.kind}; the three joints of an elbow arm are revolute or "
                f"continuous: lock it, such as lock: {{{joint.name}: 0}}"
            )
        if joint.mimic:
            raise UsageError(
                f"{urdf.file}: {joint.name} mimics {joint.mimic.joint}, and joints of an elbow arm move each on its "
                f"own; lock one of them"
            )
    return serial_chain(urdf, tip, positions)


def _named(urdf: Urdf, choice: Choice, way: list[UrdfJoint], free: list[UrdfJoint]) -> Sequence[str]:
    """The names of the three joints that move."""
    if choice.joints is None:
        return [joint.name for joint in free[:3]]
    order = [joint.name for joint in way]
    for name in choice.joints:
        joint = urdf.joint(name)
        if name in choice.lock:
            raise UsageError(f"{urdf.file}: {name} is among joints and is locked; it is one of them")
        if name not in order:
            raise UsageError(f"{urdf.file}: {name} is not on the way to {urdf.tip(choice.tip)}: {', '.join(order)}")
        if joint not in free:
            raise UsageError(f"{urdf.file}: {name} does not move; {listed(one.name for one in free) or 'no joint'} can")
    if sorted(choice.joints, key=order.index) != list(choice.joints):
        along = sorted(choice.joints, key=order.index)
        raise UsageError(f"{urdf.file}: joints are named from base to tip: {', '.join(along)}")
    return choice.joints


def held_positions(urdf: Urdf, lock: Mapping[str, float]) -> dict[str, float]:
    """The positions of locked joints, and of those that mimic them.

    Raises:
        UsageError: a joint is not in the file, or cannot move.
    """
    for name in lock:
        joint = urdf.joint(name)
        if not joint.is_movable:
            rule = "what can be locked is revolute, continuous or prismatic"
            raise UsageError(f"{urdf.file}: lock: {name} is {joint.kind}; {rule}")
    found = dict(lock)
    following = [(joint.name, joint.mimic) for joint in urdf.joints if joint.mimic]
    for _ in following:  # a joint may mimic one that mimics another
        for name, mimic in following:
            if mimic.joint in found and name not in found:
                found[name] = mimic.multiplier * found[mimic.joint] + mimic.offset
    return found


def listed(names: Iterable[str]) -> str:
    """ "a, b and c"."""
    *most, last = [*names] or [""]
    return f"{', '.join(most)} and {last}" if most else last
