"""Chains from tables of Denavit-Hartenberg parameters, standard or modified."""

from __future__ import annotations

import csv
import os
import re
from pathlib import Path

import numpy as np

from ..._native import Floats
from ...errors import UsageError
from ...robots.bodies import LARGEST, Joint
from .chain import AnyChain, Moves

_NUMBER = re.compile(
    r"(?P<sign>[+-]?)(?:(?P<pi>pi)(?:/(?P<part>0*[1-9]\d{0,8}))?"
    r"|(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(?P<deg> ?deg)?)"
)
_ANGLE = re.compile(r"(alpha|theta)[ _]?[\[(]?(deg|degrees|rad)[\])]?")
_NEEDED = ("a", "alpha", "d", "theta")
_OPTIONAL = ("mass", "cx", "cy", "cz", "Ixx", "Iyy", "Izz", "Ixy", "Ixz", "Iyz", "armature")


def _turn_x(angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


def _turn_z(angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def read_dh(path: str | os.PathLike[str], make: type[AnyChain]) -> AnyChain:
    """The chain of a CSV file: "standard" or "modified", a header, then a row a joint.

    The header names, in any order, type (R or P; without it all are R), a, alpha, d, theta, and where they are known
    mass, cx, cy, cz (centre of mass in the link's frame), Ixx, Iyy, Izz, Ixy, Ixz, Iyz (about it) and armature. Angles
    are in radians, "90 deg", or "pi/2", or in degrees where the header says `alpha_deg`; theta of a revolute joint and
    d of a prismatic one are offsets. A last row of type "tool" moves the tip.

    Raises:
        UsageError: the file cannot be read, or a line of it says something else.
    """
    file = os.fspath(path)
    try:
        lines = [line.strip() for line in Path(file).read_text(encoding="utf-8").splitlines()]
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"{file}: this file cannot be read: {getattr(error, 'strerror', None) or error}") from None
    rows = [(number, line) for number, line in enumerate(lines, start=1) if line and not line.startswith("#")]
    word = rows[0][1].rstrip(",").lower() if rows else ""
    if word not in ("standard", "modified"):
        raise UsageError(f"{file}:1: the first line says which table it is: standard or modified, got {word!r}")
    names, units = _header(rows[1][1] if len(rows) > 1 else "")
    unknown = [name for name in names if name not in ("type", *_NEEDED, *_OPTIONAL)]
    if not set(_NEEDED) <= set(names) or unknown:
        raise UsageError(f"{file}:2: the header is type,{','.join(_NEEDED)} and then any of {','.join(_OPTIONAL)}"
                         + (f"; {unknown[0]!r} is none of them" if unknown else ""))  # fmt: skip
    if len(names) != len(set(names)):
        raise UsageError(f"{file}:{rows[1][0]}: two columns have one name")
    try:
        table = [_row(file, number, names, units, next(csv.reader([line]))) for number, line in rows[2:]]
    except csv.Error as error:
        raise UsageError(f"{file}: this file cannot be read: {error}") from None
    return _chain(table, word, os.path.basename(file), make)


def _header(line: str) -> tuple[list[str], dict[str, str]]:
    """The names of the columns, and the units of angles that stand in them: `alpha_deg`, `theta [rad]`."""
    names: list[str] = []
    units: dict[str, str] = {}
    for name in line.split(","):
        found = _ANGLE.fullmatch(name.strip())
        names.append(found[1] if found else name.strip())
        if found:
            units[found[1]] = found[2][:3]
    return names, units


def _row(file: str, number: int, names: list[str], units: dict[str, str], cells: list[str]) -> dict[str, object]:
    least = 1 + max(names.index(name) for name in _NEEDED)
    if not least <= len(cells) <= len(names):
        raise UsageError(f"{file}:{number}: a row has {len(names)} values, got {len(cells)}")
    texts = dict(zip(names, (cell.strip() for cell in cells), strict=False))
    kind = texts.pop("type", "R")
    if kind not in ("R", "P", "tool"):
        raise UsageError(f"{file}:{number}: the type of a joint is R or P (or tool, for the last row), got {kind!r}")
    values: dict[str, object] = {"type": kind}
    for name, text in texts.items():
        found = _NUMBER.fullmatch(text or "0")
        if not found:
            raise UsageError(f"{file}:{number}: {name} is a number, such as 0.25, 90 deg or pi/2, got {text!r}")
        value = np.pi / float(found["part"] or 1) if found["pi"] else float(found["number"])
        unit = "deg" if found["deg"] else "rad" if found["pi"] else units.get(name)
        value = float(np.deg2rad(value)) if unit == "deg" else value
        if name in ("alpha", "theta") and value > 2 * np.pi and not unit:
            remedy = f"write {text} deg, or {name}_deg in the header"
            raise UsageError(f"{file}:{number}: {name} is {text} rad, more than a turn; {remedy}")
        if value > LARGEST:
            raise UsageError(f"{file}:{number}: {name} is at most {LARGEST:g} either way, got {text!r}")
        values[name] = -value if found["sign"] == "-" else value
    return values


def _chain(table: list[dict[str, object]], word: str, name: str, make: type[AnyChain]) -> AnyChain:
    joints, tool = _parts(table, word)
    lengths = [(key, row, float(row[key])) for row in table if row["type"] != "tool" for key in ("a", "d")]  # type: ignore[arg-type]
    named, moves = {}, {}
    for key, row, value in lengths:
        if value:
            longer = [{**one, key: value + 1.0} if one is row else one for one in table]
            others, (other_tool, _) = _parts(longer, word)
            label = f"{key}{table.index(row) + 1}"
            named[label] = value
            moves[label] = Moves(
                [
                    (other.origin - one.origin, other.centre - one.centre)
                    for one, other in zip(joints, others, strict=True)
                ],
                other_tool - tool[0],
            )
    return make(joints, tool=tool[0], tool_rotation=tool[1], name=name, named_numbers=named, moves=moves)


def _parts(table: list[dict[str, object]], word: str) -> tuple[list[Joint], tuple[Floats, Floats]]:
    """Joint i turns about (or moves along) z of frame i-1 in a standard table, of frame i in a modified one.

    The tool is the tip in the last joint's frame, and how that is turned.
    """
    tool = np.zeros(3), np.eye(3)
    if table and table[-1]["type"] == "tool":
        a, alpha, d, theta = (float(table[-1][key]) for key in ("a", "alpha", "d", "theta"))  # type: ignore[arg-type]
        tool = _turn_z(theta) @ np.array([a, 0, 0]) + [0, 0, d], _turn_z(theta) @ _turn_x(alpha)
        table = table[:-1]
    joints: list[Joint] = []
    before_rotation, before_origin = np.eye(3), np.zeros(3)
    z = np.array([0.0, 0.0, 1.0])
    for row in table:
        number = {key: float(value) for key, value in row.items() if key != "type"}  # type: ignore[arg-type]
        a, alpha, d, theta = (number[key] for key in ("a", "alpha", "d", "theta"))
        turned = _turn_z(theta)
        if word == "standard":
            rotation, origin = before_rotation @ turned, before_origin + before_rotation @ (d * z)
            before_rotation, before_origin = _turn_x(alpha), np.array([a, 0.0, 0.0])
        else:
            rotation, origin = _turn_x(alpha) @ turned, np.array([a, 0, 0]) + _turn_x(alpha) @ (d * z)
        shift = (before_rotation, before_origin) if word == "standard" else (np.eye(3), np.zeros(3))
        joints.append(_joint(row["type"] == "R", z, rotation, origin, number, shift))
    if word == "standard":
        tool = before_origin + before_rotation @ tool[0], before_rotation @ tool[1]
    return joints, tool


def _joint(is_revolute: bool, axis: Floats, rotation: Floats, origin: Floats, number: dict[str, float],
           frame: tuple[Floats, Floats]) -> Joint:  # fmt: skip
    """A joint whose link has its DH frame where `frame` says; masses are given in that frame."""
    centre = np.array([number.get(name, 0.0) for name in ("cx", "cy", "cz")])
    get = number.get
    xy, xz, yz = get("Ixy", 0.0), get("Ixz", 0.0), get("Iyz", 0.0)
    inertia = np.array([[get("Ixx", 0.0), xy, xz], [xy, get("Iyy", 0.0), yz], [xz, yz, get("Izz", 0.0)]])
    turn, shift = frame
    return Joint(is_revolute, axis, rotation, origin, get("mass", 0.0), shift + turn @ centre, turn @ inertia @ turn.T,
                 get("armature", 0.0))  # fmt: skip
