"""The elbow arm of a scenario as the truth: three bodies on three joints, with its rotors and its friction."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..._native import Floats
from ...core.arm import Arm
from ...core.params import param_index, places
from ...core.scenario import Scenario
from ...errors import ScenarioError, UnjudgedError, UsageError
from ...robots.arm_bodies import arm_of
from ...robots.bodies import with_mass
from ..kinds import SPATIAL, Kind, Rows
from .chain_files import Chain
from .left_out import left_out
from .three_r import ThreeR, law_torque, references_of


def truth_of_arm(arm: Scenario | Arm | None) -> ThreeR | ElbowArm:
    """A planar arm through the C++ functions, an elbow arm by the recursion in numpy.

    Raises:
        UsageError: an elbow arm comes without its scenario.
    """
    if isinstance(arm, Scenario) and arm["arm.model"] == "elbow":
        return ElbowArm(arm)
    if isinstance(arm, Arm) and arm.params[param_index("arm.model")]:
        raise UsageError("arm: an elbow arm is judged by the keys of its scenario; give the Scenario or its path")
    return ThreeR(arm)


class ElbowArm(Chain):
    """In the convention of its scenario."""

    def __init__(self, scenario: Scenario) -> None:
        keys = scenario["arm"]
        arm = arm_of(keys)
        joints = [*arm.joints[:2], with_mass(arm.joints[2], keys["payload"]["mass"], arm.tip)]
        super().__init__(joints, tool=arm.tip, gravity=keys["gravity"], name=scenario.name, states_gravity=True)
        self._scenario = scenario.copy()
        self._damping, self._friction = np.array(keys["damping"]), np.array(keys["friction"])
        self._friction_velocity = keys["friction_velocity"]
        self._rotor_inertia, self._is_known = np.zeros((3, 3)), True
        for rotor in arm.rotors:
            rates = arm.rates(rotor)
            if rates is None:
                self._is_known = False
            else:
                self._rotor_inertia += rotor.inertia * np.outer(rates, rates)

    def torque(self, q: Floats, qd: Floats, qdd: Floats, gravity: Floats) -> Floats:
        """That of the bodies, and that of the rotors, whose spin is a sum of joint rates times numbers."""
        return super().torque(q, qd, qdd, gravity) + qdd @ self._rotor_inertia

    def _resistance(self, qd: Floats) -> Floats:
        return self._damping * qd + self._friction * np.tanh(qd / self._friction_velocity)

    def inverse_dynamics(self, q: Floats, qd: Floats, qdd: Floats) -> Floats:
        return super().inverse_dynamics(q, qd, qdd) + self._resistance(qd)

    def forward_dynamics(self, q: Floats, qd: Floats, tau: Floats) -> Floats:
        return super().forward_dynamics(q, qd, tau - self._resistance(qd))

    def law_torque(self, q: Floats, qd: Floats) -> Floats:
        """The torque of the scenario's law at the start, from each state."""
        return law_torque(self._scenario, q, qd)

    def variants(self, kind: Kind) -> list[tuple[str, Chain]]:
        """Those of a chain, and the arm without what a formula may have left out."""
        others = [(words, self._without(keys)) for words, keys in left_out(kind).items()]
        return [*super().variants(kind), *((words, other) for words, other in others if other is not None)]

    def _without(self, keys: Sequence[str]) -> ElbowArm | None:
        """The arm with zeros for some keys; None where it has them already, or where no arm can have them."""
        other = self._scenario.copy()
        for key in keys:
            count = len(places()[key])
            other[key] = [0.0] * count if count > 1 else 0.0
        try:
            is_same = other.params.tobytes() == self._scenario.params.tobytes()
        except ScenarioError:  # such as links without width that point up, without their armature
            return None
        return None if is_same else ElbowArm(other)

    def references(self) -> dict[str, list[float]]:
        """What the scenario's law is to reach and keep."""
        return references_of(self._scenario)

    def values(self, kind: Kind, convention: str, states: Mapping[str, Floats], quantities: Mapping[str, float],
               *, follows: tuple[str, ...] = (), rows: Rows = SPATIAL) -> Floats:  # fmt: skip
        """What is right at the states, (S, ...).

        Raises:
            UnjudgedError: the kind depends on a rotor whose spin depends on the angles, too.
        """
        if kind.depends_on_inertia and not self._is_known:
            raise UnjudgedError(
                f"cannot be judged: the {kind.words} of an arm whose rotor3 spins about an axis that is not "
                "parallel to that of joint 2: what it adds depends on the angles, and no serial chain has that"
            )
        return super().values(kind, convention, states, quantities, follows=follows, rows=rows)
