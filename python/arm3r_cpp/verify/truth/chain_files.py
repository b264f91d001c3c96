"""Chains from files, and what such a file leaves open."""

from __future__ import annotations

import copy
import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from ..._native import Floats
from ...errors import UsageError
from ...robots.bodies import LARGEST, Joint, pose_words, rotation_of, vector_words, with_mass
from ...robots.serial import serial_chain
from ...robots.urdf import Urdf
from ..explain.quantities import centre_words, steiner_words
from ..kinds import SPATIAL, Kind, Rows
from .chain import SerialChain
from .dh import read_dh

_OTHER_GRAVITIES = (9.81, 9.8, 10.0)


class Chain(SerialChain):
    """A serial chain of up to seven joints.

    >>> chain = Chain.from_dh("ur5.csv")
    >>> verdict = verify.jacobian(my_jacobian, chain)
    """

    joint_names: Sequence[str] = ()
    """From the base to the tip; none where its file names no joints."""
    standing: Mapping[str, tuple[Floats, Floats]] = MappingProxyType({})
    """Frames that do not move, by the names of their links, the root's first: rotation and origin in the base, m."""
    carried: Mapping[str, tuple[Floats, Floats]] = MappingProxyType({})
    """Those on the last link, in its own frame."""

    @classmethod
    def from_urdf(cls, path: str | os.PathLike[str], *, tip: str | None = None) -> Chain:
        """The chain from the base link of a URDF to a link, by default to its only end.

        Where the same joints move several ends, what does not depend on the tip is judged without it.
        """
        urdf = Urdf(path)
        ends = urdf.ends() if tip is None else []
        moving = {tuple(joint.name for joint in urdf.way(end) if joint.kind != "fixed") for end in ends}
        is_open = len(ends) > 1 and len(moving) == 1
        found = serial_chain(urdf, ends[0] if is_open else tip, {})
        chain = cls(
            found.parts,
            tool=found.tool,
            tool_rotation=found.tool_rotation,
            name=os.path.basename(os.fspath(path)),
            tip=found.tip,
            without_tip=urdf.without_tip() if is_open else "",
            held=found.held,
            without_inertial=found.without_inertial,
            without_any_inertial=found.without_any_inertial,
        )
        chain.joint_names = [joint.name for joint in found.joints]
        chain.standing = urdf.fixed_on(urdf.way(found.tip)[0].parent)
        chain.carried = urdf.fixed_on(found.joints[-1].child)
        return chain

    @classmethod
    def from_dh(cls, path: str | os.PathLike[str]) -> Chain:
        """The chain of a DH table, see `arm3r docs verify`."""
        return read_dh(path, cls)

    # ---- what a formula of the chain may mean ----------------------------------------------------------------------

    def in_other_convention(self) -> None:
        """A chain has one convention."""

    def placed(
        self,
        *,
        gravity: Sequence[float] | None = None,
        base_rotation: Sequence[float] | None = None,
        payload: float | None = None,
    ) -> Chain:
        """The chain elsewhere, and with more at its tip.

        Args:
            gravity: in the frame in which the base stands, m/s^2.
            base_rotation: roll, pitch and yaw of the base in that frame, rad.
            payload: a mass at the tip, kg.

        Raises:
            UsageError: the payload is negative or no number, or no tip is named that carries it.
        """
        if payload is not None and not 0 <= payload <= LARGEST:
            rule = "none is negative" if payload < 0 else f"at most {LARGEST:g} kg are known"
            raise UsageError(f"{self.name}: the payload is {payload:g} kg; {rule}")
        if payload and self.without_tip:
            raise UsageError(self.without_tip)
        parts, turn = list(self.parts), rotation_of(base_rotation or (0.0, 0.0, 0.0))
        if base_rotation is not None:
            parts[0] = replace(parts[0], rotation=turn @ parts[0].rotation, origin=turn @ parts[0].origin)
        if payload:
            parts[-1] = with_mass(parts[-1], payload, self.tool)
        other = copy.copy(self)
        other.parts = parts
        other.standing = {name: (turn @ rotation, turn @ origin) for name, (rotation, origin) in self.standing.items()}
        if gravity is not None:
            other.gravity, other.states_gravity = np.array(gravity, float), True
        return other

    def _ways_down(self) -> list[Floats]:
        """Of an arm that moves across gravity, as it lies on paper: down the page, or it hangs or stands at zero."""
        if not self.is_across_gravity():
            return []
        plane = self.plane() or 0
        first, second = np.eye(3)[(plane + 1) % 3], np.eye(3)[(plane + 2) % 3]
        return [-second, first, -first]

    def is_across_gravity(self) -> bool:
        """Whether it moves in a plane across gravity, which then asks no torque."""
        plane, size = self.plane(), self.gravity_size
        return plane is not None and size > 0 and abs(self.gravity[plane]) > (1 - 1e-12) * size

    def _falling_along(self, direction: Floats, size: float) -> Chain:
        other = copy.copy(self)
        other.gravity, other.takes_direction = size * direction, True
        return other

    def _in_frame_of(self, name: str, rotation: Floats, origin: Floats) -> Chain:
        """The chain in a frame that stands in the base, instead of the base."""
        other, (first, *rest) = copy.copy(self), self.parts
        moved = replace(first, rotation=rotation.T @ first.rotation, origin=rotation.T @ (first.origin - origin))
        other.parts, other.gravity, other.standing = [moved, *rest], rotation.T @ self.gravity, {}
        other.frame = f"the frame of {name}, which {pose_words(rotation, origin)} in {self._base_words()}"
        return other

    def _base_words(self) -> str:
        """What the chain's own frame is: that of the file's root, unless this is turned."""
        for link, (turn, _) in self.standing.items():
            return f"link {link}" if np.array_equal(turn, np.eye(3)) else "that in which the base stands"
        return "the base"

    def _in_other_frames(self) -> list[Chain]:
        """In the frames that the file has beside the base, and in that of joint 1 at rest."""
        first, found = self.parts[0], [(np.eye(3), np.zeros(3))]
        others = []
        links = {f"link {link}": pose for link, pose in self.standing.items()}
        for name, pose in {**links, "joint 1": (first.rotation, first.origin)}.items():
            if not any(np.array_equal(pose[0], one[0]) and np.array_equal(pose[1], one[1]) for one in found):
                found.append(pose)
                others.append(self._in_frame_of(name, *pose))
        return others

    def open_to(self, kind: Kind) -> list[Chain]:
        """Other chains that its file may mean: it says nothing of g, and a base may stand anywhere."""
        if kind.depends_on_gravity and not self.states_gravity and self.gravity_size > 0:
            size = self.gravity_size
            placed = [self, *(self._falling_along(direction, size) for direction in self._ways_down())]
            return [*placed[1:], *(one.with_gravity(g) for one in placed for g in _OTHER_GRAVITIES)]
        return self._in_other_frames() if kind.depends_on_base else []

    def variants(self, kind: Kind) -> list[tuple[str, Chain]]:
        """Chains with a mistake in the masses of all links, or of one, in words; or with another point on the last."""
        if not kind.needs_masses:
            return [(f"the point is that of link {name}: name it by --tip {name}", self._to(origin))
                    for name, (_, origin) in self.carried.items() if not np.allclose(origin, self.tool)]  # fmt: skip
        if not self._has_masses():
            return []
        own = self.parts
        ends = [*(joint.origin for joint in own[1:]), self.tool]
        shifts = [joint.mass * (joint.centre @ joint.centre * np.eye(3) - np.outer(joint.centre, joint.centre))
                  for joint in own]  # fmt: skip
        bodies = [link for link, joint in enumerate(own) if joint.mass]
        found = []
        for links in [bodies, *([link] for link in bodies if len(bodies) > 1)]:
            numbers = [link + 1 for link in links]
            has_middle = all(own[link].is_revolute and ends[link].any() for link in links)
            for place, factor in (("end", 1.0), ("middle", 0.5))[: 1 + has_middle]:
                changes = {link: replace(own[link], centre=factor * ends[link]) for link in links}
                found.append((centre_words(numbers, place), self._with_parts(changes)))
            for sign in (1, -1) if kind.depends_on_inertia else ():
                changes = {link: replace(own[link], inertia=own[link].inertia + sign * shifts[link]) for link in links}
                found.append((steiner_words(numbers, twice=sign > 0), self._with_parts(changes)))
        found += [(f"the mass of link {link + 1} is left out", self._with_parts({link: replace(own[link], mass=0.0)}))
                  for link in bodies]  # fmt: skip
        if kind.depends_on_inertia and any(joint.armature for joint in own):
            bare = {place: replace(joint, armature=0.0) for place, joint in enumerate(own)}
            found.append(("the armature is left out", self._with_parts(bare)))
        return found

    def _to(self, tool: Floats) -> Chain:
        """The chain with its tip elsewhere on the last link."""
        other = copy.copy(self)
        other.tool = tool
        return other

    def _with_parts(self, changes: dict[int, Joint]) -> Chain:
        """The chain with other joints, and what they carry, in some places."""
        other = copy.copy(self)
        other.parts = [changes.get(place, joint) for place, joint in enumerate(self.parts)]
        return other

    def rows_of(self, kind: Kind, count: int) -> list[Rows]:
        """Which rows of what is right a formula may return that has so many: of a planar chain those in its plane.

        Rows 0 to 2 are linear, 3 to 5 angular; of a position, 3 to 5 are the sums of the joint angles about the axes.
        """
        plane = self.plane()
        whole = [tuple(range(6)) if count == 6 else SPATIAL]
        if plane is None or count not in (2, 3) or not kind.depends_on_base:
            return whole
        across = tuple(axis for axis in range(3) if axis != plane)
        return [across] if count == 2 else [*whole, (*across, 3 + plane)]

    def allowing(self, kind: Kind) -> Kind:
        """The kind with the shapes that a formula of this chain may return: of a planar one two rows."""
        return kind.in_plane() if self.plane() is not None else kind

    def assumed(self, kind: Kind, rows: Rows, varied: Sequence[str]) -> list[str]:
        """What is taken for granted, as its file does not say it or a formula may mean another."""
        found = [f"in {self.frame}"] if self.frame and kind.depends_on_base else []
        if kind.depends_on_base:
            found += [f"tip {self.tip}"] if self.tip else []
            found += [f"third row about {'xyz'[rows[2] - 3]}"] if len(rows) == 3 and rows[2] > 2 else []
        if self.held and not kind.depends_on_base:
            found.append(f"{', '.join(self.held)} at zero")
        if self.without_inertial and not kind.depends_on_base:
            found.append(f"{', '.join(self.without_inertial)} without mass, as the file gives none")
        if kind.depends_on_gravity:
            size = self.gravity_size
            down = np.allclose(self.gravity, [0, 0, -size], atol=1e-9 * size)
            words = "" if down or not size else f" along {vector_words(self.gravity / size)}"
            words += ", perpendicular to the arm's plane" if self.is_across_gravity() else ""
            words += ", as the formula has it" if self.takes_direction else ""
            is_known = "gravity" not in varied or self.takes_gravity
            found += [f"g = {size:.7g} m/s^2{words}" if is_known else f"gravity{words}"] if is_known or words else []
        return found
