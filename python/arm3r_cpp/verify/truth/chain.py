"""Any serial chain of up to seven joints, by an outward and inward Newton-Euler recursion in numpy."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple, TypeVar

import numpy as np

from ..._native import Floats
from ...errors import UnjudgedError, UsageError
from ...robots.bodies import Joint, rotation_about
from ..kinds import SPATIAL, Kind, Rows

MAX_JOINTS = 7
GRAVITY = (0.0, 0.0, -9.80665)  # m/s^2


class Moves(NamedTuple):
    """What a length moves, for each metre of it."""

    joints: list[tuple[Floats, Floats]]
    """The origin of each joint in the frame before it, and the centre of what it carries."""
    tool: Floats


AnyChain = TypeVar("AnyChain", bound="SerialChain")


class SerialChain:
    """A serial chain as the truth: kinematics, Jacobian, gravity torque, mass matrix, and both dynamics."""

    conventions: tuple[str, ...] = ("",)
    convention = ""
    is_default = states_centres = False

    def __init__(
        self,
        joints: Sequence[Joint],
        *,
        tool_rotation: Floats | None = None,
        tool: Sequence[float] | Floats = (0, 0, 0),
        gravity: Sequence[float] | Floats = GRAVITY,
        name: str = "the chain",
        states_gravity: bool = False,
        tip: str = "",
        without_tip: str = "",
        held: Sequence[str] = (),
        without_inertial: Sequence[str] = (),
        without_any_inertial: Sequence[str] = (),
        named_numbers: Mapping[str, float] | None = None,
        moves: Mapping[str, Moves] | None = None,
    ) -> None:
        """
        Args:
            tool: the tip in the frame of the last link, m.
            gravity: in the base frame, m/s^2.
            tip: what the tip's frame is called; "" where it has no name.
            without_tip: what to do where one of several links is the tip and none is named.
            held: joints beside the chain, which are taken at zero.
            without_inertial: links that have no mass because their file gives none.
            without_any_inertial: those of them on which nothing with a mass is fixed.
            states_gravity: its size is known; else a formula may have 9.81, 9.8 or 10 m/s^2, too.
            named_numbers: what sentences call the chain's numbers.
            moves: what moves with each of these, which are lengths.

        Raises:
            UsageError: there is no joint, or there are more than seven.
        """
        if not 1 <= len(joints) <= MAX_JOINTS:
            raise UsageError(f"{name}: a chain has 1 to {MAX_JOINTS} joints, got {len(joints)}")
        self.parts, self.name = list(joints), name
        self.joints = len(joints)
        self.revolute = tuple(joint.is_revolute for joint in joints)
        self.tool_rotation = np.eye(3) if tool_rotation is None else tool_rotation
        self.tool, self.gravity = np.array(tool, float), np.array(gravity, float)
        self.groups = self._parallel_groups()
        self.states_gravity, self.tip, self.frame = states_gravity, tip, ""
        self.takes_gravity = False
        """Whether its size is what a formula says, as the chain's file does not."""
        self.takes_direction = False
        """Whether its direction is."""
        self.without_tip = without_tip
        self.held = tuple(held)
        self.without_inertial, self.without_any_inertial = tuple(without_inertial), tuple(without_any_inertial)
        self.named_numbers, self._moves = dict(named_numbers or {}), dict(moves or {})
        self._first_turn = self.parts[0].rotation

    @property
    def gravity_size(self) -> float:
        """m/s^2"""
        return float(np.linalg.norm(self.gravity))

    @property
    def values_of_quantities(self) -> dict[str, float]:
        """The chain's numbers that a formula may have as names."""
        g = self.gravity_size
        return {"gravity": g} if g and self._has_masses() else {}

    def plane(self) -> int | None:
        """The axis of the base across which the chain moves, 0 for x; None where it leaves every such plane."""
        axes = [rotation @ joint.axis for rotation, joint in zip(self._at_rest(), self.parts, strict=True)]
        if not any(self.revolute):
            return None
        across = axes[self.revolute.index(True)]
        off = np.abs(np.abs(np.array(axes) @ across) - np.array(self.revolute, float)).max()
        return int(np.argmax(np.abs(across))) if np.abs(across).max() > 1 - 1e-12 and off < 1e-9 else None

    def _parallel_groups(self) -> tuple[tuple[int, ...], ...]:
        """Neighbouring revolute joints with parallel axes."""
        groups: list[list[int]] = [[0]]
        for place in range(1, self.joints):
            before, joint = self.parts[place - 1], self.parts[place]
            is_parallel = np.linalg.norm(np.cross(before.axis, joint.rotation @ joint.axis)) < 1e-9
            if is_parallel and joint.is_revolute and before.is_revolute:
                groups[-1].append(place)
            else:
                groups.append([place])
        return tuple(tuple(group) for group in groups)

    def random_quantities(self, names: set[str], random: np.random.Generator) -> dict[str, float]:
        """Generic values for some of the quantities, of which there is one: g."""
        return {name: float(random.uniform(4.0, 13.0)) for name in sorted(names)}

    # ---- kinematics --------------------------------------------------------------------------------------------------

    def _steps(self, q: Floats) -> list[tuple[Floats, Floats]]:
        """Of each joint: rotation (S, 3, 3) and origin (S, 3) of the link's frame in that of the link before."""
        steps = []
        for place, joint in enumerate(self.parts):
            value = q[:, place]
            if joint.is_revolute:
                rotation = joint.rotation @ rotation_about(joint.axis, value)
                origin = np.broadcast_to(joint.origin, (len(q), 3))
            else:
                rotation = np.broadcast_to(joint.rotation, (len(q), 3, 3))
                origin = joint.origin + value[:, None] * (joint.rotation @ joint.axis)
            steps.append((rotation, origin))
        return steps

    def frames(self, q: Floats) -> tuple[list[Floats], list[Floats]]:
        """Rotations (S, 3, 3) and origins (S, 3) of all links in the base frame, and behind them of the tip."""
        rotation, origin = np.broadcast_to(np.eye(3), (len(q), 3, 3)), np.zeros((len(q), 3))
        rotations, origins = [], []
        for step_rotation, step_origin in self._steps(q):
            origin = origin + np.einsum("sij,sj->si", rotation, step_origin)
            rotation = rotation @ step_rotation
            rotations.append(rotation)
            origins.append(origin)
        return [*rotations, rotation @ self.tool_rotation], [*origins, origin + rotation @ self.tool]

    def geometric_jacobian(self, q: Floats) -> Floats:
        """(S, 6, n): linear rows of the tip first."""
        rotations, origins = self.frames(q)
        columns = []
        for place, joint in enumerate(self.parts):
            axis = rotations[place] @ joint.axis
            if joint.is_revolute:
                columns.append(np.concatenate([np.cross(axis, origins[-1] - origins[place]), axis], axis=1))
            else:
                columns.append(np.concatenate([axis, np.zeros_like(axis)], axis=1))
        return np.stack(columns, axis=2)

    def geometric_jacobian_dot(self, q: Floats, qd: Floats) -> Floats:
        """The rate of the Jacobian, (S, 6, n): each column by the product rule, from the rates of axes and origins."""
        rotations, origins = self.frames(q)
        spin, velocity, before = np.zeros((len(q), 3)), np.zeros((len(q), 3)), np.zeros((len(q), 3))
        axes, turning, velocities = [], [], []
        for place, joint in enumerate(self.parts):
            axis, rate = rotations[place] @ joint.axis, qd[:, place, None]
            velocity = velocity + np.cross(spin, origins[place] - before)
            turning.append(np.cross(spin, axis))
            if joint.is_revolute:
                spin = spin + axis * rate
            else:
                velocity = velocity + axis * rate
            before = origins[place]
            axes.append(axis)
            velocities.append(velocity)
        tip = velocity + np.cross(spin, origins[-1] - before)
        columns = []
        for place, joint in enumerate(self.parts):
            axis, change = axes[place], turning[place]
            if joint.is_revolute:
                lever, sliding = origins[-1] - origins[place], tip - velocities[place]
                columns.append(np.concatenate([np.cross(change, lever) + np.cross(axis, sliding), change], axis=1))
            else:
                columns.append(np.concatenate([change, np.zeros_like(change)], axis=1))
        return np.stack(columns, axis=2)

    def rotation(self, convention: str, q: Floats) -> Floats:
        """The axes of the tip's frame as columns, in the base frame, (S, 3, 3)."""
        return self.frames(q)[0][-1]

    def tip_position(self, q: Floats) -> Floats:
        """(S, 6): the tip in the base, and behind it the sums of the joint angles about the base's axes."""
        position = self.frames(q)[1][-1]
        axes = np.stack([rotation @ joint.axis for rotation, joint in zip(self._at_rest(), self.parts, strict=True)])
        return np.concatenate([position, q @ axes], axis=1)

    def _at_rest(self) -> list[Floats]:
        """The rotations of the links in the base where all joints are at zero."""
        return [rotation[0] for rotation in self.frames(np.zeros((1, self.joints)))[0][:-1]]

    # ---- dynamics ----------------------------------------------------------------------------------------------------

    def torque(self, q: Floats, qd: Floats, qdd: Floats, gravity: Floats) -> Floats:
        """Newton-Euler: outward velocities and accelerations, inward forces and moments, in the links' own frames."""
        steps = self._steps(q)
        count = len(q)
        spin, turning = np.zeros((count, 3)), np.zeros((count, 3))
        acceleration = np.broadcast_to(-gravity, (count, 3))
        forces, moments = [], []
        for place, (joint, (rotation, origin)) in enumerate(zip(self.parts, steps, strict=True)):
            back = np.swapaxes(rotation, 1, 2)
            acceleration = acceleration + np.cross(turning, origin) + np.cross(spin, np.cross(spin, origin))
            spin, turning, acceleration = (np.einsum("sij,sj->si", back, one) for one in (spin, turning, acceleration))
            rate, change = qd[:, place, None] * joint.axis, qdd[:, place, None] * joint.axis
            if joint.is_revolute:
                turning = turning + change + np.cross(spin, rate)
                spin = spin + rate
            else:
                acceleration = acceleration + change + 2 * np.cross(spin, rate)
            at_centre = acceleration + np.cross(turning, joint.centre) + np.cross(spin, np.cross(spin, joint.centre))
            force = joint.mass * at_centre
            momentum = spin @ joint.inertia.T
            moments.append(turning @ joint.inertia.T + np.cross(spin, momentum) + np.cross(joint.centre, force))
            forces.append(force)
        return self._inward(steps, forces, moments) + np.array([joint.armature for joint in self.parts]) * qdd

    def _inward(self, steps: list[tuple[Floats, Floats]], forces: list[Floats], moments: list[Floats]) -> Floats:
        """The components of forces and moments along the joints' axes."""
        tau = np.zeros((len(forces[0]), self.joints))
        force, moment = np.zeros_like(forces[0]), np.zeros_like(forces[0])
        for place in range(self.joints - 1, -1, -1):
            force, moment = force + forces[place], moment + moments[place]
            joint, (rotation, origin) = self.parts[place], steps[place]
            tau[:, place] = (moment if joint.is_revolute else force) @ joint.axis
            force, moment = (np.einsum("sij,sj->si", rotation, one) for one in (force, moment))
            moment = moment + np.cross(origin, force)
        return tau

    def _has_masses(self) -> bool:
        return any(joint.mass for joint in self.parts)

    def mass_matrix(self, q: Floats) -> Floats:
        """(S, n, n): a column is the torque of a unit acceleration."""
        zero = np.zeros_like(q)
        columns = [self.torque(q, zero, zero + unit, np.zeros(3)) for unit in np.eye(self.joints)]
        return np.stack(columns, axis=2)

    def gravity_torque(self, q: Floats) -> Floats:
        return self.torque(q, np.zeros_like(q), np.zeros_like(q), self.gravity)

    def velocity_product(self, q: Floats, qd: Floats) -> Floats:
        return self.torque(q, qd, np.zeros_like(q), np.zeros(3))

    def inverse_dynamics(self, q: Floats, qd: Floats, qdd: Floats) -> Floats:
        return self.torque(q, qd, qdd, self.gravity)

    def forward_dynamics(self, q: Floats, qd: Floats, tau: Floats) -> Floats:
        bias = self.torque(q, qd, np.zeros_like(q), self.gravity)
        acceleration = np.linalg.solve(self.mass_matrix(q), (tau - bias)[..., None])[..., 0]
        return np.asarray(acceleration, np.float64)

    def with_lengths(self: AnyChain, numbers: Mapping[str, float]) -> AnyChain:
        """The chain with other values of its named numbers."""
        other = copy.copy(self)
        other.parts, other.named_numbers = list(self.parts), {**self.named_numbers, **numbers}
        turn = self.parts[0].rotation @ self._first_turn.T  # of the base, since the chain was made
        for name, value in numbers.items():
            more, moves = value - self.named_numbers[name], self._moves[name]
            for place, (origin, centre) in enumerate(moves.joints):
                joint = other.parts[place]
                shift = more * (origin if place else turn @ origin)
                other.parts[place] = replace(joint, origin=joint.origin + shift, centre=joint.centre + more * centre)
            other.tool = other.tool + more * moves.tool
        return other

    def with_gravity(self: AnyChain, g: float) -> AnyChain:
        """The chain where gravity is as large, m/s^2."""
        other = copy.copy(self)
        other.gravity = self.gravity * (g / np.linalg.norm(self.gravity))
        other.takes_gravity = True
        return other

    def values(self, kind: Kind, convention: str, states: Mapping[str, Floats], quantities: Mapping[str, float],
               *, follows: tuple[str, ...] = (), rows: Rows = SPATIAL) -> Floats:  # fmt: skip
        """What is right at the states, (S, ...).

        Raises:
            UnjudgedError: the chain has not all masses, which the kind needs.
            UsageError: the kind needs the tip, and none of several ends is named.
        """
        if kind.needs_masses:
            self._require_masses(kind)
        elif self.without_tip:
            raise UsageError(self.without_tip)
        chain = self.with_gravity(quantities["gravity"]) if "gravity" in quantities else self
        return kind.due(chain, states, rows)

    def references(self) -> dict[str, list[float]]:
        """
        Raises:
            UsageError: a chain has no law.
        """
        raise UsageError(
            f"{self.name}: a controller is judged by the law of a scenario: name one by --arm, in the place of a chain"
        )

    def _require_masses(self, kind: Kind) -> None:
        if self.without_any_inertial:
            *others, last = self.without_any_inertial
            links = f"links {', '.join(others)} and {last} move and have" if others else f"link {last} moves and has"
            why = f"the {links} no <inertial>; write it into the file, with the mass 0 where there is none"
        elif not self._has_masses():
            why = "no link has a mass; a DH table has columns for it, see `arm3r docs verify`"
        else:
            return
        raise UnjudgedError(f"{self.name}: {kind.a_words} cannot be judged: {why}")
