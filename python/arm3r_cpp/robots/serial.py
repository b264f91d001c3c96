"""The serial chain on the way from a URDF's root to its tip: moving joints, and all that hangs on them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from .._native import Floats
from ..errors import UsageError
from .bodies import Body, Joint, joined, rotation_about
from .urdf import Urdf, UrdfJoint


class Serial(NamedTuple):
    """A serial chain."""

    joints: list[UrdfJoint]
    """Those that move, from the base to the tip."""
    parts: list[Joint]
    """What they and the bodies behind them measure."""
    links: list[list[str]]
    """The links that make up each body."""
    tool: Floats
    """The tip in the frame of the last link, m."""
    tool_rotation: Floats
    tip: str
    held: list[str]
    """The joints beside the way that move, and stand on what moves."""
    without_inertial: list[str]
    """The links that joints move, and of which the file says nothing."""
    without_any_inertial: list[str]
    """Those of them on which no link with an inertial is fixed."""

    def tip_position(self, q: Floats) -> Floats:
        """Of a chain of revolute joints, in the root link's axes: (S, n) -> (S, 3), m."""
        rotation, origin = np.broadcast_to(np.eye(3), (len(q), 3, 3)), np.zeros((len(q), 3))
        for place, part in enumerate(self.parts):
            origin = origin + rotation @ part.origin
            rotation = rotation @ part.rotation @ rotation_about(part.axis, q[:, place])
        return origin + rotation @ self.tool


def serial_chain(urdf: Urdf, tip: str | None, positions: Mapping[str, float]) -> Serial:
    """The chain from the root link to a link; what hangs on it by other joints belongs to its links.

    Args:
        tip: the name of the tip's link; None for the only end of the tree.
        positions: joints that do not move, with their positions, rad or m; joints beside the way are else at zero.

    Raises:
        UsageError: the file branches and names no tip, or has joints of other types on the way.
    """
    way = urdf.way(tip)
    on_way = {joint.child for joint in way}
    moving: list[UrdfJoint] = []
    parts: list[Joint] = []
    bodies: list[Body] = []
    links: list[list[str]] = []
    held: list[str] = []
    rotation, origin = np.eye(3), np.zeros(3)  # of the current link in the frame of the last moving one
    for joint in way:
        step_rotation, step_origin = joint.pose(positions.get(joint.name, 0.0))
        origin, rotation = origin + rotation @ step_origin, rotation @ step_rotation
        names: list[str] = []
        body = _with_branches(urdf, joint.child, on_way, positions, names, held)
        if joint.kind == "fixed" or joint.name in positions:
            if bodies:
                bodies[-1] = joined(bodies[-1], _moved(body, rotation, origin))
                links[-1] += names
            else:
                held.clear()  # it stands on the base
            continue
        if not joint.is_movable:
            raise UsageError(
                f"{joint.file}: the joint {joint.name!r} is {joint.kind}; revolute, continuous and prismatic are known"
            )
        moving.append(joint)
        parts.append(Joint(joint.kind != "prismatic", joint.axis, rotation, origin))
        bodies.append(body)
        links.append(names)
        rotation, origin = np.eye(3), np.zeros(3)
    for part, body in zip(parts, bodies, strict=True):
        part.mass, part.centre, part.inertia = body
    without = [names for names in links if not urdf.has_inertial(names[0])]
    without_any = [names for names in without if not any(map(urdf.has_inertial, names))]
    first = [[names[0] for names in some] for some in (without, without_any)]
    return Serial(moving, parts, links, origin, rotation, urdf.tip(tip), held, *first)


def _with_branches(
    urdf: Urdf, link: str, on_way: set[str], positions: Mapping[str, float], links: list[str], held: list[str]
) -> Body:
    """A link with all that hangs on it beside the way. Appends the names of its links and of joints held at zero."""
    whole = Body(0.0, np.zeros(3), np.zeros((3, 3)))
    for name, rotation, origin in urdf.below(link, lambda joint: joint.child not in on_way, positions):
        links.append(name)
        whole = joined(whole, _moved(urdf.body(name), rotation, origin))
        for joint in reversed(urdf.children(name)):
            if joint.child not in on_way and joint.kind != "fixed" and joint.name not in positions:
                held.append(joint.name)
    return whole


def _moved(body: Body, rotation: Floats, origin: Floats) -> Body:
    """A body of another frame, in this one."""
    return Body(body.mass, origin + rotation @ body.centre, rotation @ body.inertia @ rotation.T)
