"""URDF files: their links and joints, as they are written."""

from __future__ import annotations

import os
import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

import numpy as np

from .._messages import did_you_mean
from .._native import Floats
from ..errors import UsageError
from .bodies import LARGEST, Body, rotation_about, rotation_of

MOVABLE = ("revolute", "continuous", "prismatic")
_MOST_BYTES = 10_000_000
_ROUNDING = 5e-9  # rad, of an angle with eight decimals


class Mimic(NamedTuple):
    """A joint that follows another one: multiplier times its position, plus offset."""

    joint: str
    multiplier: float
    offset: float


class UrdfJoint:
    """A joint of a URDF. Its numbers are read when they are asked for."""

    def __init__(self, file: str, element: ElementTree.Element) -> None:
        """
        Raises:
            UsageError: the joint has no parent or no child.
        """
        self.file, self._element = file, element
        self.name, self.kind = element.get("name", ""), element.get("type", "")
        self.parent, self.child = self._link("parent"), self._link("child")

    def _link(self, end: str) -> str:
        found = self._element.find(end)
        if found is None or "link" not in found.attrib:
            raise UsageError(f"{self.file}: the joint {self.name!r} has no {end} link")
        return found.attrib["link"]

    def _number(self, tag: str, key: str, default: str) -> float:
        return float(_numbers(self.file, self._element.find(tag), key, default)[0])

    @property
    def is_movable(self) -> bool:
        return self.kind in MOVABLE

    @property
    def axis(self) -> Floats:
        """A unit vector in the joint's frame."""
        axis = _numbers(self.file, self._element.find("axis"), "xyz", "1 0 0")
        length = np.linalg.norm(axis)
        if not length > 0:
            raise UsageError(f"{self.file}: the joint {self.name!r} has no axis")
        return axis / length

    def pose(self, position: float = 0.0) -> tuple[Floats, Floats]:
        """Rotation and origin of the child link in the parent link, at a position (rad or m) of the joint."""
        rotation, origin = _pose(self.file, self._element)
        if position and self.kind == "prismatic":
            origin = origin + rotation @ (position * self.axis)
        elif position:
            rotation = rotation @ rotation_about(self.axis, _meant(np.array([position])))[0]
        return rotation, origin

    @property
    def range(self) -> tuple[float, float]:
        """The least and the greatest position, rad or m."""
        if self.kind == "continuous" or self._element.find("limit") is None:
            return -np.inf, np.inf
        return self._number("limit", "lower", "0"), self._number("limit", "upper", "0")

    @property
    def effort(self) -> float | None:
        """The largest torque or force; None where the file says nothing."""
        return None if self._element.find("limit") is None else self._number("limit", "effort", "0")

    @property
    def damping(self) -> float:
        return self._number("dynamics", "damping", "0")

    @property
    def friction(self) -> float:
        return self._number("dynamics", "friction", "0")

    @property
    def mimic(self) -> Mimic | None:
        found = self._element.find("mimic")
        if found is None:
            return None
        return Mimic(
            found.get("joint", ""), self._number("mimic", "multiplier", "1"), self._number("mimic", "offset", "0")
        )


class Urdf:
    """The tree of a URDF: links, and the joints between them."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        """
        Raises:
            UsageError: the file is no URDF.
        """
        self.file = os.fspath(path)
        root = _parsed(self.file)
        self._links = {link.get("name", ""): link for link in root.findall("link")}
        self.joints = [UrdfJoint(self.file, joint) for joint in root.findall("joint")]
        self._by_child = {joint.child: joint for joint in self.joints}
        self._by_parent: dict[str, list[UrdfJoint]] = {}
        for joint in self.joints:
            self._by_parent.setdefault(joint.parent, []).append(joint)
            if self._by_child[joint.child] is not joint:
                names = f"{joint.name!r} and {self._by_child[joint.child].name!r}"
                raise UsageError(f"{self.file}: the joints {names} have one child, {joint.child!r}; a URDF is a tree")

    def way(self, tip: str | None) -> list[UrdfJoint]:
        """The joints from the root to a link, by default to the only one that has no child.

        Raises:
            UsageError: there is no such link, or there are several that have no child, or the joints make a ring.
        """
        name = self.tip(tip)
        found = self._way_to(name)
        if found and found[0].parent in self._by_child:
            raise UsageError(
                f"{self.file}: the joints make a ring through {found[0].parent!r}; "
                "a chain begins at a link that is no child"
            )
        return found

    def _way_to(self, link: str) -> list[UrdfJoint]:
        """The joints from the root to a link; of a ring, as many as there are links."""
        found: list[UrdfJoint] = []
        while link in self._by_child and len(found) <= len(self._links):
            found.insert(0, self._by_child[link])
            link = found[0].parent
        return found

    def ends(self) -> list[str]:
        """The links that have no child and that joints move, or where none moves, all that have no child."""
        every = [link for link in self._links if link not in self._by_parent]
        return [end for end in every if any(joint.kind != "fixed" for joint in self._way_to(end))] or every

    def without_tip(self) -> str:
        """What to do where the tip is one of several ends."""
        return (
            f"{self.file}: the tree ends in {', '.join(self.ends()) or 'no link'}; name the tip's link: "
            "--tip LINK, in a scenario arm.tip, in Python tip="
        )

    def tip(self, name: str | None) -> str:
        """The name of the tip's link."""
        if name is None:
            ends = self.ends()
            if len(ends) != 1:
                raise UsageError(self.without_tip())
            (name,) = ends
        if name not in self._links:
            raise UsageError(f"{self.file}: there is no link {name!r}; it has {', '.join(self._links)}")
        return name

    def joint(self, name: str) -> UrdfJoint:
        """
        Raises:
            UsageError: there is no joint of this name.
        """
        names = [joint.name for joint in self.joints]
        if name not in names:
            hint = did_you_mean(name, names) or f"it has {', '.join(names)}"
            raise UsageError(f"{self.file}: there is no joint {name!r}; {hint}")
        return self.joints[names.index(name)]

    def children(self, link: str) -> list[UrdfJoint]:
        """The joints that stand on a link."""
        return self._by_parent.get(link, [])

    def below(
        self, link: str, is_passed: Callable[[UrdfJoint], bool], positions: Mapping[str, float] | None = None
    ) -> Iterator[tuple[str, Floats, Floats]]:
        """A link and those that joints which are passed hold on it: name, rotation and origin in its frame, m.

        Args:
            positions: of joints that are not at zero, rad or m.
        """
        rest = [(link, np.eye(3), np.zeros(3))]
        while rest:
            name, rotation, origin = rest.pop()
            yield name, rotation, origin
            for joint in reversed(self.children(name)):
                if is_passed(joint):
                    step_rotation, step_origin = joint.pose((positions or {}).get(joint.name, 0.0))
                    rest.append((joint.child, rotation @ step_rotation, origin + rotation @ step_origin))

    def fixed_on(self, link: str) -> dict[str, tuple[Floats, Floats]]:
        """A link and those that fixed joints hold on it: rotation and origin of each in the frame of the first, m."""
        found = self.below(link, lambda joint: joint.kind == "fixed")
        return {name: (rotation, origin) for name, rotation, origin in found}

    def has_inertial(self, link: str) -> bool:
        return self._links[link].find("inertial") is not None

    def body(self, link: str) -> Body:
        """A link's body, in the link's frame; without mass where the file gives none."""
        if link not in self._links:
            joint = self._by_child[link]
            raise UsageError(f"{self.file}: the joint {joint.name!r} has the child {link!r}, which is not a link")
        inertial = self._links[link].find("inertial")
        if inertial is None:
            return Body(0.0, np.zeros(3), np.zeros((3, 3)))
        rotation, centre = _pose(self.file, inertial)
        (mass,) = _numbers(self.file, inertial.find("mass"), "value", "0")
        if mass < 0:
            raise UsageError(f"{self.file}: the link {link!r} has the mass {mass:g}; none is negative")
        xx, yy, zz, xy, xz, yz = (
            float(_numbers(self.file, inertial.find("inertia"), key, "0")[0])
            for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
        )
        inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        return Body(float(mass), centre, rotation @ inertia @ rotation.T)


def _parsed(file: str) -> ElementTree.Element:
    try:
        if os.path.getsize(file) > _MOST_BYTES:
            raise UsageError(f"{file}: a URDF of at most {_MOST_BYTES} bytes is read")
        with open(file, encoding="utf-8") as stream:
            text = stream.read()
        if "<!ENTITY" in text or "<!DOCTYPE" in text:
            raise UsageError(f"{file}: a URDF has no document type")
        root = ElementTree.fromstring(text)
    except (OSError, ValueError) as error:
        raise UsageError(f"{file}: this file cannot be read: {getattr(error, 'strerror', None) or error}") from None
    except ElementTree.ParseError as error:
        if re.search(r"<xacro:", text):  # a macro file that binds no namespace
            raise _unexpanded(file) from None
        raise UsageError(f"{file}:{error.position[0]}: this is not XML: {error}") from None
    if any("xacro}" in element.tag for element in root.iter() if isinstance(element.tag, str)):
        raise _unexpanded(file)
    if root.tag != "robot":
        raise UsageError(f"{file}: a URDF begins with <robot>, got <{root.tag}>")
    return root


def _unexpanded(file: str) -> UsageError:
    return UsageError(f"{file}: this is a xacro file; `xacro {file} > robot.urdf` expands it to a URDF")


def _numbers(file: str, element: ElementTree.Element | None, key: str, default: str) -> Floats:
    text = element.get(key, default) if element is not None else default
    try:
        values = np.array([float(part) for part in text.split()])
    except ValueError:
        values = np.zeros(0)
    if len(values) != len(default.split()) or not (np.abs(values) <= LARGEST).all():
        due = f"{len(default.split())} numbers of at most {LARGEST:g} either way"
        raise UsageError(f"{file}: {key} has {due}, got {text[:80]!r}")
    return values


def _pose(file: str, element: ElementTree.Element) -> tuple[Floats, Floats]:
    """Rotation and origin of an <origin>: roll, pitch, yaw about fixed axes x, y, z."""
    origin = element.find("origin")
    rotation = rotation_of(_meant(_numbers(file, origin, "rpy", "0 0 0")))
    return rotation, _numbers(file, origin, "xyz", "0 0 0")


def _meant(angles: Floats) -> Floats:
    """Angles in which 1.570796327 is a right angle."""
    right = np.round(angles / (np.pi / 2)) * (np.pi / 2)
    return np.where(np.abs(angles - right) < _ROUNDING, right, angles)
