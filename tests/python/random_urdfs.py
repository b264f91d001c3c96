"""Random elbow arms as URDF files: what a file can hold beside three joints, and frames of any direction."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def rpy_of(rotation: Floats) -> tuple[float, float, float]:
    pitch = np.arctan2(-rotation[2, 0], np.hypot(rotation[0, 0], rotation[1, 0]))
    return (
        float(np.arctan2(rotation[2, 1], rotation[2, 2])),
        float(pitch),
        float(np.arctan2(rotation[1, 0], rotation[0, 0])),
    )


def rotation_of(axis: Floats, angle: float) -> Floats:
    """Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def pose(rotation: Floats, origin: Floats) -> Floats:
    found = np.eye(4)
    found[:3, :3], found[:3, 3] = rotation, origin
    return found


@dataclass
class RandomUrdf:
    """A random elbow arm. Frames are in the root link's, where all moving joints are at zero and locked ones locked."""

    random: np.random.Generator
    is_upright: bool = False
    """Axis 1 is the root's z or -z."""
    lock: dict[str, float] = field(default_factory=dict)
    lines: list[str] = field(default_factory=list)
    links: int = 0

    def __post_init__(self) -> None:
        turn = np.diag([1.0, 1.0, 1.0]) if self.is_upright else self._rotation()
        base = self._vector()
        up = turn @ [0, 0, self.random.choice([-1.0, 1.0])]
        forward = np.cross(up, self._unit())
        forward /= np.linalg.norm(forward)
        left = np.cross(up, forward)
        lift, bend = self.random.uniform(-np.pi, np.pi, 2)
        along = [np.cos(a) * forward + np.sin(a) * up for a in (lift, lift + bend)]
        length, reach = self.random.uniform(0.2, 1.0, 2)
        shoulder = base + self.random.choice([0.0, self.random.uniform(-0.3, 0.3)]) * forward
        elbow = shoulder + length * along[0] + self.random.uniform(-0.3, 0.3) * left
        tip = elbow + reach * along[1] + self.random.uniform(-0.3, 0.3) * left
        current, name = np.eye(4), self._link("root")
        for number, (axis, point) in enumerate(((up, base), (left, shoulder), (left, elbow)), start=1):
            for _ in range(self.random.integers(0, 2)):
                current, name = self._fixed(current, name)
            if self.random.random() < 0.4:
                current, name = self._locked(current, name)
            axis = axis * self.random.choice([-1.0, 1.0])
            point = point + (self.random.uniform(-0.5, 0.5) * axis if number < 3 else 0)
            target = pose(self._rotation(), point)
            child = self._link(f"link{number}")
            kind = self.random.choice(["revolute", "continuous"])
            self._joint(f"joint{number}", kind, name, child, np.linalg.inv(current) @ target, target[:3, :3].T @ axis)
            current, name = target, child
            self._branch(child)
        for _ in range(self.random.integers(0, 3)):
            current, name = self._locked(current, name)
        self._link("tip", has_mass=bool(self.random.integers(2)))
        self._joint("hand", "fixed", name, "tip", np.linalg.inv(current) @ pose(self._rotation(), tip))
        self.text = "\n".join(['<robot name="random">', *self.lines, "</robot>"])

    def _vector(self) -> Floats:
        return self.random.uniform(-0.4, 0.4, 3)

    def _unit(self) -> Floats:
        vector = self.random.standard_normal(3)
        return vector / np.linalg.norm(vector)

    def _rotation(self) -> Floats:
        if self.random.random() < 0.3:  # as in files that people write
            return rotation_of(np.eye(3)[self.random.integers(3)], self.random.integers(-2, 3) * np.pi / 2)
        return rotation_of(self._unit(), self.random.uniform(-np.pi, np.pi))

    def _link(self, name: str, *, has_mass: bool = True) -> str:
        if not has_mass:
            self.lines.append(f'<link name="{name}"/>')
            return name
        factor = self.random.uniform(-0.2, 0.2, (3, 3))
        inertia = factor @ factor.T + 0.01 * np.eye(3)
        inertia = 0.5 * np.trace(inertia) * np.eye(3) - inertia + 0.01 * np.eye(3)
        xyz, rpy = self._words(self._vector()), self._words(self.random.uniform(-1, 1, 3))
        entries = " ".join(
            f'i{"xyz"[i]}{"xyz"[j]}="{inertia[i, j]!r}"'.replace("np.float64(", "").replace(")", "")
            for i in range(3) for j in range(i, 3)
        )  # fmt: skip
        self.lines.append(
            f'<link name="{name}"><inertial><origin xyz="{xyz}" rpy="{rpy}"/>'
            f'<mass value="{float(self.random.uniform(0.2, 5))!r}"/><inertia {entries}/></inertial></link>'
        )
        return name

    def _words(self, vector: Floats) -> str:
        return " ".join(repr(float(number)) for number in vector)

    def _joint(self, name: str, kind: str, parent: str, child: str, place: Floats, axis: Floats | None = None) -> None:
        words = f'<axis xyz="{self._words(axis)}"/>' if axis is not None else ""
        words += '<limit lower="-9" upper="9" effort="50" velocity="3"/>' * (kind != "fixed")
        self.lines.append(
            f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
            f'<origin xyz="{self._words(place[:3, 3])}" rpy="{self._words(np.array(rpy_of(place[:3, :3])))}"/>'
            f"{words}</joint>"
        )

    def _new(self) -> str:
        self.links += 1
        return f"more{self.links}"

    def _fixed(self, current: Floats, name: str) -> tuple[Floats, str]:
        child = self._link(self._new(), has_mass=bool(self.random.integers(2)))
        step = pose(self._rotation(), self._vector())
        self._joint(f"to_{child}", "fixed", name, child, step)
        return current @ step, child

    def _locked(self, current: Floats, name: str) -> tuple[Floats, str]:
        child = self._link(self._new(), has_mass=bool(self.random.integers(2)))
        axis, step = self._unit(), pose(self._rotation(), self._vector())
        is_revolute = self.random.random() < 0.8
        position = float(self.random.uniform(-2, 2) if is_revolute else self.random.uniform(-0.2, 0.2))
        self._joint(f"to_{child}", "revolute" if is_revolute else "prismatic", name, child, step, axis)
        self.lock[f"to_{child}"] = position
        moved = pose(rotation_of(axis, position), np.zeros(3)) if is_revolute else pose(np.eye(3), position * axis)
        return current @ step @ moved, child

    def _branch(self, name: str) -> None:
        """Links beside the way: fixed, at zero, or locked."""
        for _ in range(self.random.integers(0, 3)):
            child = self._link(self._new())
            kind = str(self.random.choice(["fixed", "revolute", "prismatic"]))
            self._joint(f"to_{child}", kind, name, child, pose(self._rotation(), self._vector()), self._unit())
            if kind != "fixed" and self.random.integers(2):
                self.lock[f"to_{child}"] = float(self.random.uniform(-1, 1))
            name = child if self.random.integers(2) else name
