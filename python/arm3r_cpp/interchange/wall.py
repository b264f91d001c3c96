"""The wall of a scenario as MuJoCo can have it exactly: an unbounded plate before one spring, which moves evenly."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from .._native import Floats


class Wall(NamedTuple):
    """A plane that pushes with a spring."""

    face: Floats
    """A point of the face at t = 0, m."""
    normal: Floats
    """Unit vector towards the arm."""
    speed: float
    """Along the normal, m/s."""
    stiffness: float
    """N/m"""


def wall_of(keys: Mapping[str, Any]) -> Wall:
    """The wall of the resolved keys under `wall`, which must have no obstacle."""
    normal = np.array(keys["normal"], float) / np.linalg.norm(keys["normal"])
    face = np.array(keys["point"], float) + keys["face_offset"] * normal
    velocity = np.array(keys["motion"].get("velocity", 0), float)
    speed = velocity @ normal if velocity.ndim else velocity
    return Wall(face, normal, float(speed), keys["contact"]["stiffness"])


def obstacles(keys: Mapping[str, Any]) -> list[str]:
    """What of a wall MuJoCo cannot have exactly: key, value, rule."""
    contact, found = keys["contact"], []
    if contact["law"] != "spring":
        found.append(f"wall.contact.law: {contact['law']}; it must be spring")
    if contact["friction"]["coefficient"]:
        found.append(f"wall.contact.friction.coefficient: {contact['friction']['coefficient']:g}; it must be 0")
    if keys["size"] != "infinite":
        found.append(f"wall.size: {keys['size']}; it must be infinite")
    if keys["motion"]["type"] not in ("fixed", "constant"):
        found.append(f"wall.motion.type: {keys['motion']['type']}; it must be fixed or constant")
    if keys["rotation"]["type"] != "none":
        found.append(f"wall.rotation.type: {keys['rotation']['type']}; it must be none")
    return found
