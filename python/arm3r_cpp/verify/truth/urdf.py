"""Chains from URDF files."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ElementTree
from typing import NamedTuple

import numpy as np

from ..._native import Floats
from ...errors import UsageError
from .bodies import LARGEST, Body, Joint, joined, rotation_of
from .chain import AnyChain

_MOST_BYTES = 10_000_000


class _Tree(NamedTuple):
    links: dict[str, ElementTree.Element]
    behind: dict[str, list[ElementTree.Element]]
    """The joints beside the chain, by the links on which they stand."""
    held: list[str]
    """Those of them that move, and stand on what moves."""


def read_urdf(path: str | os.PathLike[str], tip: str | None, make: type[AnyChain]) -> AnyChain:
    """The chain from the root link to a link; what hangs on it by other joints belongs to its links, held at zero.

    Raises:
        UsageError: the file is no URDF, branches and names no tip, or has joints of other types.
    """
    file = os.fspath(path)
    root = _parsed(file)
    links = {link.get("name", ""): link for link in root.findall("link")}
    by_child = {_name(file, joint, "child"): joint for joint in root.findall("joint")}
    parents = {_name(file, joint, "parent") for joint in root.findall("joint")}
    if tip is None:
        ends = [name for name in links if name not in parents]
        if len(ends) != 1:
            words = f"the tree ends in {', '.join(ends) or 'no link'}; name the tip's link: --tip LINK, in Python tip="
            raise UsageError(f"{file}: {words}")
        (tip,) = ends
    if tip not in links:
        raise UsageError(f"{file}: there is no link {tip!r}; it has {', '.join(links)}")
    path_of_joints: list[ElementTree.Element] = []
    name = tip
    while name in by_child and len(path_of_joints) <= len(links):
        path_of_joints.insert(0, by_child[name])
        name = _name(file, by_child[name], "parent")
    if name in by_child:
        raise UsageError(f"{file}: the joints make a ring through {name!r}; a chain begins at a link that is no child")
    behind: dict[str, list[ElementTree.Element]] = {}
    for joint in by_child.values():
        if not any(joint is one for one in path_of_joints):
            behind.setdefault(_name(file, joint, "parent"), []).append(joint)
    return _chain(file, path_of_joints, _Tree(links, behind, []), tip, make)


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
        raise UsageError(f"{file}:{error.position[0]}: this is not XML: {error}") from None
    if root.tag != "robot":
        raise UsageError(f"{file}: a URDF begins with <robot>, got <{root.tag}>")
    return root


def _name(file: str, joint: ElementTree.Element, end: str) -> str:
    found = joint.find(end)
    if found is None or "link" not in found.attrib:
        raise UsageError(f"{file}: the joint {joint.get('name')!r} has no {end} link")
    return found.attrib["link"]


def _child(file: str, joint: ElementTree.Element, links: dict[str, ElementTree.Element]) -> str:
    name = _name(file, joint, "child")
    if name not in links:
        raise UsageError(f"{file}: the joint {joint.get('name')!r} has the child {name!r}, which is not a link")
    return name


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


def _pose(file: str, element: ElementTree.Element | None) -> tuple[Floats, Floats]:
    """Rotation and origin of an <origin>: roll, pitch, yaw about fixed axes x, y, z."""
    origin = element.find("origin") if element is not None else None
    rotation = rotation_of(_numbers(file, origin, "rpy", "0 0 0"))
    return rotation, _numbers(file, origin, "xyz", "0 0 0")


def _link(file: str, element: ElementTree.Element) -> Body:
    inertial = element.find("inertial")
    if inertial is None:
        return Body(0.0, np.zeros(3), np.zeros((3, 3)))
    rotation, centre = _pose(file, inertial)
    (mass,) = _numbers(file, inertial.find("mass"), "value", "0")
    if mass < 0:
        raise UsageError(f"{file}: the link {element.get('name')!r} has the mass {mass:g}; none is negative")
    xx, yy, zz, xy, xz, yz = (
        float(_numbers(file, inertial.find("inertia"), key, "0")[0])
        for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
    )
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return Body(float(mass), centre, rotation @ inertia @ rotation.T)


def _joined(one: Body, other: Body, rotation: Floats, origin: Floats) -> Body:
    """Two links that a fixed joint joins, in the frame of the first."""
    return joined(one, Body(other.mass, origin + rotation @ other.centre, rotation @ other.inertia @ rotation.T))


def _with_branches(file: str, name: str, tree: _Tree) -> Body:
    """A link with all that hangs on it beside the chain: fixed, or held by joints at zero."""
    body = _link(file, tree.links[name])
    for joint in tree.behind.get(name, ()):
        if joint.get("type") != "fixed":
            tree.held.append(joint.get("name", ""))
        rotation, origin = _pose(file, joint)
        body = _joined(body, _with_branches(file, _child(file, joint, tree.links), tree), rotation, origin)
    return body


def _chain(file: str, path: list[ElementTree.Element], tree: _Tree, tip: str, make: type[AnyChain]) -> AnyChain:
    joints: list[Joint] = []
    bodies: list[Body] = []
    rotation, origin = np.eye(3), np.zeros(3)  # of the current link in the frame of the last moving one
    for element in path:
        step_rotation, step_origin = _pose(file, element)
        origin, rotation = origin + rotation @ step_origin, rotation @ step_rotation
        kind = element.get("type")
        link = _with_branches(file, _child(file, element, tree.links), tree)
        if kind == "fixed":
            if bodies:
                bodies[-1] = _joined(bodies[-1], link, rotation, origin)
            else:
                tree.held.clear()  # it stands on the base
            continue
        if kind not in ("revolute", "continuous", "prismatic"):
            raise UsageError(
                f"{file}: the joint {element.get('name')!r} is {kind}; revolute, continuous and prismatic are known"
            )
        axis = _numbers(file, element.find("axis"), "xyz", "1 0 0")
        length = np.linalg.norm(axis)
        if not length > 0:
            raise UsageError(f"{file}: the joint {element.get('name')!r} has no axis")
        joints.append(Joint(kind != "prismatic", axis / length, rotation, origin))
        bodies.append(link)
        rotation, origin = np.eye(3), np.zeros(3)
    for joint, body in zip(joints, bodies, strict=True):
        joint.mass, joint.centre, joint.inertia = body
    return make(joints, tool=origin, tool_rotation=rotation, name=os.path.basename(file), tip=tip, held=tree.held)
