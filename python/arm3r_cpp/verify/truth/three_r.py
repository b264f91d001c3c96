"""The scenario's arm as the truth, through the C++ functions, in either convention and with other parameters."""

from __future__ import annotations

import copy
import re
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from ..._native import Floats
from ...core.arm import Arm
from ...core.params import param_index, places
from ...core.scenario import Scenario
from ...errors import ScenarioError, UnjudgedError, UsageError
from ..kinds import SPATIAL, Kind, Rows
from .left_out import left_out

CONVENTIONS, SHAPES = ("simscape", "slide"), ("brick", "cylinder", "slender")
"""The words of arm.convention and arm.link2.shape, in the order of their parameters' values."""
FOLLOWING = (("com", "inertia"), ("com",), (), ("com", "inertia", "mass"))
"""What may follow a link's length and mass, the likeliest first: its shape, or numbers that stand in the text."""
FOLLOWING_WORDS = dict(
    zip(
        FOLLOWING,
        (
            "a link's centre of mass and inertia follow its length",
            "the centre of mass follows the length, and the inertia keeps its number",
            "the centres of mass keep their numbers",
            "the mass follows the length",
        ),
        strict=True,
    )
)
_RANGES = {"length": (0.5, 1.6), "com": (0.2, 0.45), "mass": (0.4, 2.5), "inertia": (0.02, 0.2)}
_LEAST_INERTIA = 2e-9
"""kg m^2, of link 1 about its axis: without it the mass matrix of an arm of rods that point up is singular."""


def _states_convention(scenario: Scenario) -> bool:
    """Whether the scenario gives arm.convention itself: its annotated text says where each value comes from."""
    found = re.search(r"^ +convention: \w+ +# (.*)$", scenario.to_yaml(annotate=True), re.M)
    return found is not None and found[1] != "lecture"


class _ControlledArm(Arm):
    """An arm with the law that controls it."""

    def __init__(self, params: Floats, law: Callable[[Floats, Floats], Floats]) -> None:
        super().__init__(params)
        self.law_torque = law

    def geometric_jacobian_dot(self, q: Floats, qd: Floats) -> Floats:
        """(S, 6, 3), linear rows first: axis 1 stands still, and axes 2 and 3 turn across it with joint 1."""
        quarter = np.array([np.pi / 2, 0.0, 0.0])
        angular = self.geometric_jacobian(q + quarter)[:, 3:] * qd[:, :1, None]
        angular[:, :, 0] = 0.0
        return np.concatenate([self.jacobian_dot(q, qd), angular], axis=1)


class ThreeR:
    """An arm of a scenario.

    Its quantities are "length2", "com2", "mass2", "inertia2" (about an axis across the link), the same for link 3,
    "mass1", "height" (of joint 2 above the base frame) and "gravity" (its magnitude).
    """

    joints = 3
    revolute = (True, True, True)
    groups = ((0,), (1, 2))
    """Joints with parallel axes: their angles occur as sums."""
    named_numbers: Mapping[str, float] = {}
    states_gravity = True
    states_centres = False
    """Whether centres of mass are given as numbers, and not by the shapes of links."""

    def __init__(self, scenario: Scenario | Arm | None = None) -> None:
        """By default the lecture's arm.

        Raises:
            UsageError: it is an elbow arm.
        """
        self._params = scenario.params if scenario is not None else Scenario().params
        if self._params[param_index("arm.model")]:
            raise UsageError("names such as a2 and m2 are numbers of a planar arm; this one is an elbow arm")
        self._scenario = scenario.copy() if isinstance(scenario, Scenario) else None
        self.is_default = scenario is None
        self.convention = CONVENTIONS[int(self._params[param_index("arm.convention")])]
        self._own_convention = self.convention
        is_stated = self._scenario is not None and _states_convention(self._scenario)
        self.conventions: tuple[str, ...] = (self.convention,) if is_stated else CONVENTIONS
        """Those that a formula may be meant in: the one that the scenario states, else both."""
        self._arms: dict[tuple[Any, ...], Arm] = {}
        self.values_of_quantities = self._measure()
        self.states_centres = not all(np.isnan(self._params[param_index(f"arm.link{link}.com")]) for link in (2, 3))

    def _measure(self) -> dict[str, float]:
        """The arm's own quantities, from its functions: a shape in the scenario does not tell mass and centre."""
        number = self._number
        plain = self._params.copy()
        for name in ("arm.payload.mass", "arm.armature[1]", "arm.armature[2]", "arm.base_height"):
            plain[param_index(name)] = 0
        plain[param_index("arm.convention")] = 1
        for axis, value in enumerate((0, 0, -1)):
            plain[param_index(f"arm.gravity[{axis}]")] = value
        arm = Arm(plain)
        centres, stretched = arm.centres(np.zeros(3)), np.zeros(3)
        a2, a3 = number("arm.link2.length"), number("arm.link3.length")
        l2, l3 = float(centres[1][0]), float(centres[2][0]) - a2
        torque, mass = arm.gravity_torque(stretched), arm.mass_matrix(stretched)
        m3 = number("arm.link3.mass", float(torque[2]) / l3 if l3 else 0.0)
        m2 = number("arm.link2.mass", (float(torque[1] - torque[2]) - m3 * a2) / l2 if l2 else 0.0)
        i3 = float(mass[2, 2]) - m3 * l3**2
        i2 = float(mass[1, 1]) - i3 - m3 * (a2 + l3) ** 2 - m2 * l2**2
        gravity = [number(f"arm.gravity[{axis}]") for axis in range(3)]
        return {
            "length2": a2,
            "length3": a3,
            "com2": l2,
            "com3": l3,
            "mass1": number("arm.link1.mass", 0.0),
            "mass2": m2,
            "mass3": m3,
            "inertia2": i2,
            "inertia3": i3,
            "height": number("arm.base_height"),
            "gravity": float(np.linalg.norm(gravity)),
        }

    def open_to(self, kind: Kind) -> list[ThreeR]:
        """Other arms that the scenario may mean: it says all."""
        return []

    def rows_of(self, kind: Kind, count: int) -> list[Rows]:
        """Which rows of what is right a formula may return that has so many."""
        return [tuple(range(6)) if count == 6 else SPATIAL]

    def allowing(self, kind: Kind) -> Kind:
        """The kind with the shapes that a formula of this arm may return."""
        return kind

    def assumed(self, kind: Kind, rows: Rows, varied: Sequence[str]) -> list[str]:
        """What is taken for granted, but for the convention."""
        return []

    def in_other_convention(self) -> ThreeR | None:
        """The arm in the convention that its scenario does not state; None where it states none."""
        if len(self.conventions) > 1:
            return None
        other = copy.copy(self)
        [other.convention] = other.conventions = tuple(one for one in CONVENTIONS if one != self.convention)
        return other

    def _number(self, name: str, otherwise: float = 0.0) -> float:
        value = float(self._params[param_index(name)])
        return otherwise if np.isnan(value) else value

    def random_quantities(self, names: set[str], random: np.random.Generator) -> dict[str, float]:
        """Generic values for some of the quantities: unequal, and none of them a simple number."""
        drawn = {}
        for name in sorted(names):
            low, high = _RANGES.get(name.rstrip("0123456789"), (4.0, 13.0) if name == "gravity" else (0.2, 1.0))
            if name.startswith("inertia") and not self.is_axisymmetric(int(name[-1])):
                low, high = self._possible_inertias(int(name[-1]))
            drawn[name] = float(random.uniform(low, high))
        return drawn

    def is_axisymmetric(self, link: int) -> bool:
        """Whether a link has the same inertia about all axes across it."""
        return bool(np.isclose(self._ratio(link), 1.0, rtol=1e-9))

    def _possible_inertias(self, link: int) -> tuple[float, float]:
        """About the joint's axis, with which a link's other two inertias are still those of a body."""
        axial, other = self._axial(link), self.values_of_quantities[f"inertia{link}"] * self._ratio(link)
        least, most = abs(other - axial), other + axial
        return least + 0.1 * (most - least), most - 0.1 * (most - least)

    def arm(self, convention: str, quantities: Mapping[str, float], follows: tuple[str, ...] = FOLLOWING[0]) -> Arm:
        """The arm with some quantities changed.

        Args:
            follows: what changes with a link's length and mass where it is not given itself, the others keep their
                numbers: "com" in proportion to the length, "inertia" as the same shape has it, "mass" as the length.
        """
        key = (convention, follows, *sorted(quantities.items()))
        if key not in self._arms:
            if len(self._arms) > 500:
                self._arms.clear()
            law = partial(self._law_torque, convention)
            self._arms[key] = _ControlledArm(self._changed(convention, quantities, follows), law)
        return self._arms[key]

    def _changed(self, convention: str, quantities: Mapping[str, float], follows: tuple[str, ...]) -> Floats:
        params, own = self._params.copy(), self.values_of_quantities
        params[param_index("arm.convention")] = CONVENTIONS.index(convention)
        value = {**own, **quantities}
        params[param_index("arm.base_height")] = value["height"]
        scale = value["gravity"] / own["gravity"] if own["gravity"] else 0.0
        for axis in range(3):
            params[param_index(f"arm.gravity[{axis}]")] *= scale
        for link in (2, 3):
            names = {f"{what}{link}" for what in ("length", "com", "mass", "inertia")}
            if names & set(quantities):
                self._change_link(params, link, value, quantities, follows)
        return params

    def _change_link(
        self,
        params: Floats,
        link: int,
        value: Mapping[str, float],
        given: Mapping[str, float],
        follows: tuple[str, ...],
    ) -> None:
        own, length, mass = self.values_of_quantities, value[f"length{link}"], value[f"mass{link}"]
        if "mass" in follows and f"mass{link}" not in given:
            mass *= length / own[f"length{link}"]
        at = {what: param_index(f"arm.link{link}.{what}") for what in ("length", "mass", "com")}
        axes = [param_index(f"arm.link{link}.inertia[{axis}]") for axis in range(3)]
        has_own_com, has_own_inertia = not np.isnan(params[at["com"]]), not np.isnan(params[axes]).any()
        params[at["length"]], params[at["mass"]] = length, mass
        if f"com{link}" in given:
            params[at["com"]] = value[f"com{link}"]
        elif "com" not in follows:
            params[at["com"]] = own[f"com{link}"]
        elif has_own_com:
            params[at["com"]] = own[f"com{link}"] * length / own[f"length{link}"]
        across, axial = own[f"inertia{link}"], self._axial(link)
        other = across * self._ratio(link)
        if f"inertia{link}" in given:
            across = value[f"inertia{link}"]
            if self.is_axisymmetric(link):
                other, axial = across, min(axial, across)
        elif "inertia" in follows and not has_own_inertia:
            return  # the library derives it from the shape, for any length and mass
        elif "inertia" in follows:
            old_mass, old_length = own[f"mass{link}"], own[f"length{link}"]
            across, other = (max(axial, one + old_mass * (length**2 - old_length**2) / 12) for one in (across, other))
            across, other, axial = (mass / old_mass * one for one in (across, other, axial))
        params[axes] = (axial, other, across)

    def _axial(self, link: int) -> float:
        """The inertia about the link's own axis: what it adds to M11 where the links stand upright."""
        whole, own = self._params.copy(), self.values_of_quantities
        whole[param_index("arm.link1.inertia_axial")] += _LEAST_INERTIA
        without = whole.copy()
        without[param_index(f"arm.link{link}.mass")] = own[f"mass{link}"]
        for axis, value in enumerate((0.0, own[f"inertia{link}"], own[f"inertia{link}"])):
            without[param_index(f"arm.link{link}.inertia[{axis}]")] = value
        upright = np.array([0.0, np.pi / 2, 0.0])
        with_it, without_it = (Arm(params).mass_matrix(upright)[0, 0] for params in (whole, without))
        return float(with_it - without_it)

    def _ratio(self, link: int) -> float:
        """I_y / I_z of the link as it is."""
        y, z = (self._number(f"arm.link{link}.inertia[{axis}]") for axis in (1, 2))
        return y / z if z else 1.0

    def values(
        self,
        kind: Kind,
        convention: str,
        states: Mapping[str, Floats],
        quantities: Mapping[str, float],
        *,
        follows: tuple[str, ...] = FOLLOWING[0],
        rows: Rows = SPATIAL,
    ) -> Floats:
        """What is right at the states, (N, ...)."""
        return kind.due(self.arm(convention, quantities, follows), states, rows)

    def _law_torque(self, convention: str, q: Floats, qd: Floats) -> Floats:
        signs = np.array([1.0, -1.0, -1.0]) if convention != self._own_convention else np.ones(3)
        return signs * law_torque(self._scenario, signs * q, signs * qd)

    def references(self) -> dict[str, list[float]]:
        """What its scenario's law is to reach and keep."""
        return references_of(self._scenario)

    def variants(self, kind: Kind) -> list[tuple[str, ThreeR]]:
        """Arms with a mistake that its quantities do not tell: something of them is left out, or the links are rods."""
        found = [(words, dict.fromkeys(keys, 0.0)) for words, keys in left_out(kind).items()]
        if kind.depends_on_inertia:
            upright, rods = {"arm.link1.inertia_axial": _LEAST_INERTIA}, self._rods()
            about = "the inertia of link 1 about its axis is left out"
            words = "links 2 and 3 are slender rods; the arm's have a width (`shape: slender` makes them rods)"
            found += [(about, upright), (words, rods)]
            if not kind.is_product:  # Coriolis torques do not tell
                found.append((f"{words}, and {about}", rods | upright))
        others = [(words, self._with(changes)) for words, changes in found]
        return [(words, other) for words, other in others if other is not None]

    def _rods(self) -> dict[str, float]:
        """The parameters that make links 2 and 3 slender rods of their own masses, where shapes tell their inertias."""
        changes = {}
        for link in (2, 3):
            if np.isnan(self._params[param_index(f"arm.link{link}.inertia[0]")]):
                changes[f"arm.link{link}.shape"] = float(SHAPES.index("slender"))
                changes[f"arm.link{link}.mass"] = self.values_of_quantities[f"mass{link}"]
        return changes

    def _with(self, changes: Mapping[str, float]) -> ThreeR | None:
        """The arm with other numbers of some keys; None where it is the same, or no arm can have them."""
        other = copy.copy(self)
        other._params, other._arms = self._params.copy(), {}
        for key, value in changes.items():
            other._params[places()[key]] = value
        if np.array_equal(other._params, self._params, equal_nan=True):
            return None
        try:
            other.values_of_quantities = other._measure()
        except ScenarioError:  # such as links that are rods and point up, without the armature that was left out
            return None
        return other

    def rotation(self, convention: str, q: Floats) -> Floats:
        """The axes of the tip's frame as columns, x along link 3, y across the arm's plane, in the base, (S, 3, 3)."""
        sign = 1.0 if convention == "simscape" else -1.0
        pitch = sign * (q[:, 1] + q[:, 2])
        c1, s1, c, s = np.cos(q[:, 0]), np.sin(q[:, 0]), np.cos(pitch), np.sin(pitch)
        zero = np.zeros_like(c)
        return np.stack(
            [np.stack([c1 * c, -s1, c1 * s], 1), np.stack([s1 * c, c1, s1 * s], 1), np.stack([-s, zero, c], 1)], 1
        )


def references_of(scenario: Scenario | None) -> dict[str, list[float]]:
    """What a law is to reach and keep: q, qd, qdd, and x, xd of the tip; of a reference that moves, nothing."""
    word = "" if scenario is None else str(scenario["reference.type"])
    if scenario is None or word not in ("hold", "point"):
        return {}
    still = [0.0, 0.0, 0.0]
    if word == "point" and "reference.tip" in scenario:
        return {"x": list(scenario["reference.tip"]), "xd": still}
    q = scenario["reference.q"] if word == "point" and "reference.q" in scenario else scenario["initial.q"]
    tip = scenario.arm.tip_position(q)
    return {"q": list(q), "qd": still, "qdd": still, "x": list(map(float, tip)), "xd": still}


def law_torque(scenario: Scenario | None, q: Floats, qd: Floats) -> Floats:
    """The torque of a scenario's law at the start, from each state.

    Raises:
        UsageError: there is no law.
    """
    if scenario is None or scenario["controller.type"] == "none":
        raise UsageError("a controller is judged by the law of a scenario: name one that has a controller")
    here = scenario.copy().quiet()
    start = here["time.start"]
    here["checks"], here["time"] = [], {"start": start, "stop": start + 1e-6, "log_every": 1e-6}
    _stay_at_start(here)
    torques = []
    for angles, rates in zip(q, qd, strict=True):
        here["initial.q"], here["initial.qd"] = angles, rates
        try:
            torques.append(here.run()["tau"][0])
        except ScenarioError as error:  # such as a tip that starts deep inside the wall
            words = error.problems[0]["message"] if error.problems else str(error)
            raise UnjudgedError(
                f"cannot be judged: the scenario cannot start at each state that is tried: {words}; judge the law in a "
                "scenario without a wall"
            ) from None
    return np.array(torques)


def _stay_at_start(here: Scenario) -> None:
    """Make a reference begin where the scenario starts, and not at each state.

    Raises:
        UnjudgedError: it moves at once.
    """
    word = str(here["reference.type"])
    if word in ("line", "sinusoid"):
        raise UnjudgedError(
            f"cannot be judged: the reference `{word}` moves from where the arm starts; a law is judged with the "
            "reference hold or point"
        )
    if word in ("hold", "minimum_jerk", "circle"):  # at rest at the start
        force = here["reference.force"]
        here["reference"] = {"type": "point", "q": list(here["initial.q"]), **({"force": force} if force else {})}
