"""The plate's own axes over time, docs/model.md (4.1), and its outline."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .._native import Floats
from ..core.scenario import Scenario


class WallFrame(NamedTuple):
    """Unit vectors in base axes, a row for each time: (rows, 3)."""

    normal: Floats
    """From the wall towards the arm."""
    e1: Floats
    e2: Floats


def wall_frame(scenario: Scenario, t: ArrayLike) -> WallFrame:
    """The frame of a scenario's wall at times t (rows,), s."""
    normal = np.array(scenario["wall.normal"], float)
    normal /= np.linalg.norm(normal)
    level = np.array([normal[1], -normal[0], 0.0])
    size = np.linalg.norm(level)
    e1 = level / size if size >= 1e-12 else np.array([0.0, 1.0, 0.0])
    return WallFrame(*(_turned(scenario, axis, np.atleast_1d(t)) for axis in (normal, e1, np.cross(e1, normal))))


def half_sides(scenario: Scenario) -> tuple[float, float] | None:
    """Half the plate's sides along e1 and e2, m; None: it is infinite."""
    size = scenario["wall.size"]
    return None if isinstance(size, str) else (size[0] / 2, size[1] / 2)


def _turned(scenario: Scenario, v: Floats, t: Floats) -> Floats:
    """A vector fixed to the wall, at times t."""
    angle = _angle(scenario, t)
    if angle is None:
        return np.tile(v, (len(t), 1))
    axis = np.array(scenario["wall.rotation.axis"], float)
    axis /= np.linalg.norm(axis)
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    return v * c + np.cross(axis, v) * s + axis * (axis @ v) * (1 - c)


def _angle(scenario: Scenario, t: Floats) -> Floats | None:
    """By how much the wall has turned about its axis since t = 0, rad; None: it does not turn."""
    if "wall.rotation.type" not in scenario or scenario["wall.rotation.type"] == "none":
        return None
    if scenario["wall.rotation.type"] == "constant":
        return scenario["wall.rotation.rate"] * t
    amplitude, frequency, phase = (scenario[f"wall.rotation.{key}"] for key in ("amplitude", "frequency", "phase"))
    return amplitude * (np.sin(2 * np.pi * frequency * t + phase) - np.sin(phase))
