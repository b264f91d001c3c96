"""The keys of an elbow arm, evaluated by what they mean: rotations, points and Newton-Euler, link by link."""

from __future__ import annotations

from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def about(axis: str, angle: float) -> Floats:
    """An elementary rotation."""
    i = "xyz".index(axis)
    j, k = (i + 1) % 3, (i + 2) % 3
    found = np.eye(3)
    found[[j, j, k, k], [j, k, j, k]] = np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)
    return found


class ElbowKeys:
    """The arm of the keys under `arm:`, in the convention `urdf`."""

    def __init__(self, text: str) -> None:
        self.keys: dict[str, Any] = yaml.safe_load(text)
        assert self.keys["model"] == "elbow" and self.keys["convention"] == "urdf"
        roll, pitch, yaw = self.keys["base"]["rotation"]
        self.base = about("z", yaw) @ about("y", pitch) @ about("x", roll)
        self.sign, self.zero = np.array(self.keys["joint_sign"]), np.array(self.keys["joint_zero"])

    def frames(self, q: Floats) -> tuple[list[Floats], list[Floats], list[Floats], Floats]:
        """Axes (columns) and origins of the links, the positive axes of their joints, and the tip."""
        one, two, three = self.sign * q + self.zero
        first = self.base @ about("z", one)
        u, v, k = first.T
        axes, origins, spins = [first], [np.array(self.keys["base"]["position"])], [self.sign[0] * k]
        origins.append(origins[0] + self.keys["shoulder_offset"] * u)
        for place, lift in ((1, two), (2, two + three)):
            x, z = np.cos(lift) * u + np.sin(lift) * k, -self.sign[place] * v
            axes.append(np.column_stack([x, np.cross(z, x), z]))
            spins.append(z)
        link2 = self.keys["link2"]
        origins.append(origins[1] + axes[1] @ [link2["length"], 0, link2["offset"]])
        return axes, origins, spins, origins[2] + axes[2] @ self.keys["link3"]["tip"]

    def tip_position(self, q: Floats) -> Floats:
        return self.frames(q)[3]

    def jacobian(self, q: Floats) -> Floats:
        _, origins, spins, tip = self.frames(q)
        return np.column_stack([np.cross(z, tip - o) for z, o in zip(spins, origins, strict=True)])

    def inverse_dynamics(self, q: Floats, qd: Floats, qdd: Floats, gravity: Floats) -> Floats:
        """Torques of a motion, without damping and friction."""
        axes, origins, spins, _ = self.frames(q)
        turn, turn_rate, rate = np.zeros(3), np.zeros(3), -gravity  # rate: acceleration of the origin, less gravity
        forces, moments, centres = [], [], []
        before = origins[0]
        for place, (rotation, origin, z) in enumerate(zip(axes, origins, spins, strict=True)):
            rate = rate + np.cross(turn_rate, origin - before) + np.cross(turn, np.cross(turn, origin - before))
            turn_rate = turn_rate + qdd[place] * z + qd[place] * np.cross(turn, z)
            turn, before = turn + qd[place] * z, origin
            link = self.keys.get(f"link{place + 1}", {})
            xx, yy, zz, xy, xz, yz = link.get("inertia", [0] * 6)
            inertia = rotation @ [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]] @ rotation.T
            arm = rotation @ link.get("com", [0] * 3)
            forces.append(link.get("mass", 0) * (rate + np.cross(turn_rate, arm) + np.cross(turn, np.cross(turn, arm))))
            moments.append(inertia @ turn_rate + np.cross(turn, inertia @ turn))
            centres.append(origin + arm)
        return np.array([
            spins[joint] @ sum(
                moments[link] + np.cross(centres[link] - origins[joint], forces[link]) for link in range(joint, 3)
            )
            for joint in range(3)
        ])  # fmt: skip

    def mass_matrix(self, q: Floats) -> Floats:
        rest = np.zeros(3)
        return np.column_stack([self.inverse_dynamics(q, rest, column, rest) for column in np.eye(3)])
