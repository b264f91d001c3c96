"""Random scenarios for tests of classes of defects: every law, wall, motion, sensor, delay, observer and push.

>>> scenario = random_scenario(np.random.default_rng(7))
>>> run = arm3r.Scenario(yaml_of(scenario)).run()

The scenarios are sane: an arm of human size that meets a wall at moderate speed, with gains about the defaults. No
length, mass or angle is round, for round numbers hide mistakes.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
from arm3r_cpp.core.scenario import flow

Keys = dict[str, Any]

IN_JOINTS = ("joint_pd", "computed_torque", "joint_stiffness")
AT_THE_TIP = ("resolved_acceleration", "stiffness", "impedance", "shaped_impedance", "admittance", "energy_tank")
ON_THE_FORCE = ("operational_space", "hybrid", "parallel", "adaptive_reference")
FEELING = ("computed_torque", "resolved_acceleration", "shaped_impedance", "admittance", *ON_THE_FORCE)
"""Laws that answer to the measured force: a one-way wall leads them astray, for the arm does not feel what they do."""
WITHOUT_A_PATH = ("none", "constant", "gravity_compensation", "virtual_wall")
LAWS = (*WITHOUT_A_PATH, *IN_JOINTS, *AT_THE_TIP, *ON_THE_FORCE)
MOST_DRAWS = 1000
"""until one is valid: a few are enough"""


def sample_seed() -> int:
    """The seed of the environment variable ARM3R_SEED, which the gates set to that of the day; else a fixed one."""
    return int(os.environ.get("ARM3R_SEED") or 20261122)


def yaml_of(scenario: Mapping[str, Any]) -> str:
    """The scenario as YAML, one line for each section."""
    return "".join(f"{key}: {flow(value, key)}\n" for key, value in scenario.items())


def random_scenario(
    rng: np.random.Generator,
    *,
    law: str | None = None,
    sampled: bool | None = None,
    longest: float = 1.2,
    start: Callable[[Draw], tuple[Keys, Keys]] | None = None,
) -> Keys:
    """A valid scenario as nested dictionaries; a draw that validation refuses is drawn anew.

    Args:
        law: fixes controller.type.
        sampled: fixes whether there is a section `sampling`.
        longest: s, the largest time.stop; the shortest is a quarter of it.
        start: draws the sections `arm` and `initial`, by default those of a planar arm.
    """
    for draws in range(MOST_DRAWS):
        try:
            drawn_law = law or Draw(rng).one_of(LAWS)
            scenario = drawn_scenario(Draw(rng), drawn_law, sampled, longest, start or _planar_start)
            arm3r.Scenario(yaml_of(scenario)).validate()
        except arm3r.ScenarioError:
            if draws == MOST_DRAWS - 1:
                raise
            continue
        break
    return scenario


def drawn_scenario(
    draw: Draw, law: str, sampled: bool | None, longest: float, start: Callable[[Draw], tuple[Keys, Keys]]
) -> Keys:
    """A scenario that validation may still refuse."""
    stop = draw.number(longest / 4, longest)
    arm, initial = start(draw)
    at_start = arm3r.Scenario(yaml_of({"format": 1, "arm": arm, "initial": initial})).arm
    tip = at_start.tip_position(np.array(initial["q"]))
    outwards = _outwards(arm, tip)
    scenario: Keys = {"format": 1, "arm": arm, "initial": initial}
    has_wall = law in ON_THE_FORCE or draw.chance(0.75)
    if has_wall:
        scenario["wall"] = _wall(draw, tip, outwards, stop, 0.9 if law in FEELING else 0.5)
    scenario["controller"] = _controller(draw, law, tip, outwards)
    if law not in WITHOUT_A_PATH:
        scenario["reference"] = _reference(draw, law, tip, np.array(initial["q"]), stop, has_wall)
    computes = law not in ("none", "constant")
    if computes and (draw.chance(0.5) if sampled is None else sampled):
        scenario["sampling"] = _sampling(draw, _fastest_decay(scenario))
    if computes and draw.chance(0.35):
        scenario["sensors"] = _sensors(draw, "sampling" in scenario)
    if draw.chance(0.25):
        scenario["observer"] = _observer(draw, "sampling" in scenario)
    if has_wall and draw.chance(0.2):
        scenario["estimator"] = _estimator(draw, stop)
    if draw.chance(0.25):
        scenario["push"] = _push(draw, stop)
    scenario["solver"] = {"max_steps": 20000}
    scenario["time"] = {"stop": stop, "log_every": _log_every(draw, scenario)}
    if arm.get("model") == "elbow":
        scenario["controller"].get("model", {}).pop("base_height", None)
    return scenario


def _planar_start(draw: Draw) -> tuple[Keys, Keys]:
    arm, initial = _arm(draw), _initial(draw)
    if arm["convention"] == "simscape":
        initial = {key: [first, -second, -third] for key, (first, second, third) in initial.items()}
    return arm, initial


def _outwards(arm: Keys, tip: np.ndarray) -> np.ndarray:
    """The direction in which the arm reaches: of a planar arm level, of an elbow arm from its base to the tip."""
    if arm.get("model") == "elbow":
        reach = tip - arm.get("base", {}).get("position", [0, 0, 0])
        return reach / np.linalg.norm(reach)
    return np.array([tip[0], tip[1], 0]) / math.hypot(tip[0], tip[1])


def _log_every(draw: Draw, scenario: Keys) -> float:
    """A time between rows, which often brings them to samples and to the instants at which a late torque changes."""
    every = draw.one_of([0.01, 0.005, 0.02, 0.00731, 0.0133])
    if "sampling" not in scenario or draw.chance(0.4):
        return every
    period, delay = 1 / scenario["sampling"]["rate"], scenario["sampling"].get("delay", 0) % 1 or 0.5
    return draw.one_of([5 * period, 2.5 * period, (4 + delay) * period, 0.2 * period * round(every / period)])


class Draw:
    """Random numbers of few digits, so that a scenario is short to read and its text means the same bits."""

    def __init__(self, rng: np.random.Generator) -> None:
        self._rng = rng

    def chance(self, share: float) -> bool:
        """True in this share of all draws."""
        return bool(self._rng.random() < share)

    def one_of(self, values: Sequence[Any]) -> Any:
        """One of the values, each as likely as any other."""
        return values[int(self._rng.integers(len(values)))]

    def number(self, low: float, high: float) -> float:
        """A number from a uniform distribution."""
        return float(f"{self._rng.uniform(low, high):.5g}")

    def scale(self, low: float, high: float) -> float:
        """A positive number whose logarithm is uniform."""
        return float(f"{math.exp(self._rng.uniform(math.log(low), math.log(high))):.4g}")

    def numbers(self, low: float, high: float, count: int = 3) -> list[float]:
        """Several uniform numbers."""
        return [self.number(low, high) for _ in range(count)]

    def about(self, default: float, factor: float = 3.0) -> float:
        """A number within a factor of the default."""
        return self.scale(default / factor, default * factor)

    def one_or_three(self, default: float, factor: float = 3.0) -> float | list[float]:
        """A gain for all axes, or one for each."""
        return [self.about(default, factor) for _ in range(3)] if self.chance(0.4) else self.about(default, factor)

    def direction(self) -> list[float]:
        """A direction of no special kind, not normalised."""
        while True:
            direction = self.numbers(-1, 1)
            if 0.3 < np.linalg.norm(direction) < 1:
                return direction

    def instant(self, low: float, high: float) -> float:
        """An instant, half of them on the milliseconds where samples, rows and steps of other things stand too."""
        return round(self.number(low, high), 3 if self.chance(0.5) else 6)

    def some(self, share: float, **keys: Callable[[], Any]) -> Keys:
        """Each of the keys with this share, with the value that its function draws."""
        return {key: value() for key, value in keys.items() if self.chance(share)}


# ---- the arm ---------------------------------------------------------------------------------------------------------


def _arm(draw: Draw) -> Keys:
    arm: Keys = {
        "convention": draw.one_of(["slide", "simscape"]),
        "link1": _column(draw),
        "link2": _link(draw),
        "link3": _link(draw),
        "armature": draw.numbers(0.005, 0.1),
    }
    if draw.chance(0.4):
        arm["gravity"] = draw.one_of([[0, 0, 0], [0, 0, -1.62], draw.numbers(-9, 9)])
    arm |= draw.some(
        0.3,
        base_height=lambda: draw.number(-0.5, 0.5),
        damping=lambda: draw.numbers(0, 1),
        payload=lambda: {"mass": draw.number(0.1, 1.5)},
        torque_limit=lambda: draw.numbers(10, 60),
    )
    if draw.chance(0.2):
        arm |= {"friction": draw.numbers(0, 0.5), "friction_velocity": draw.scale(0.02, 0.2)}
    return arm


def _column(draw: Draw) -> Keys:
    explicit = {"mass": draw.number(0.3, 3), "com": draw.number(-0.1, 0.1), "inertia_axial": draw.number(0.005, 0.05)}
    cylinder = {"shape": "cylinder", "length": draw.number(0.2, 0.5), "radius": draw.number(0.02, 0.06)}
    return draw.one_of([explicit, cylinder])


def _link(draw: Draw) -> Keys:
    length = draw.number(0.4, 1.1)
    density = draw.scale(2000, 9000)
    com = draw.number(0.3, 0.7) * length
    about = draw.number(0.01, 0.1)
    return draw.one_of(
        [
            {"length": length, "shape": "brick", "section": draw.numbers(0.01, 0.03, 2), "density": density},
            {"length": length, "shape": "cylinder", "radius": draw.number(0.005, 0.02), "density": density},
            {"length": length, "shape": "slender", "mass": draw.number(0.3, 3), "com": com},
            {"length": length, "mass": draw.number(0.3, 3), "com": com, "inertia": [about / 50, about, about * 0.99]},
        ]
    )


def _initial(draw: Draw) -> Keys:
    """A pose well away from the singular ones, in the slide convention: elbow up or down, tip in front or behind."""
    elbow = draw.one_of([-1, 1]) * draw.number(0.5, 2.2)
    shoulder = -elbow / 2 + draw.number(-0.7, 0.7) + draw.one_of([0, 0, 0, math.pi])
    initial: Keys = {"q": [draw.number(-3, 3), float(f"{shoulder:.5g}"), elbow]}
    if draw.chance(0.4):
        initial["qd"] = draw.numbers(-0.5, 0.5)
    return initial


# ---- the wall --------------------------------------------------------------------------------------------------------


def _wall(draw: Draw, tip: np.ndarray, outwards: np.ndarray, stop: float, acting: float) -> Keys:
    """A plate in front of the tip, which the tip meets as a rule within the run; `acting` is the share of two-way ones.

    Springs along the plate are one-way only.
    """
    normal = -outwards + np.array(draw.numbers(-0.6, 0.6))
    normal = np.array([float(f"{part:.5g}") for part in normal])
    unit = normal / np.linalg.norm(normal)
    aside = np.array(draw.numbers(-0.1, 0.1))
    offset = draw.number(-0.02, 0.05) if draw.chance(0.3) else 0.0
    gap = draw.number(-0.004, 0.0) if draw.chance(0.2) else draw.number(0.0, 0.05)
    place = tip - (gap + offset) * unit + aside - (aside @ unit) * unit
    wall: Keys = {
        "point": [float(f"{part:.7g}") for part in place],
        "normal": normal.tolist(),
        "size": "infinite" if draw.chance(0.5) else draw.numbers(0.25, 1.0, 2),
        "motion": _motion(draw, unit, stop),
        "contact": _contact(draw, acts_on_arm := draw.chance(acting)),
        "acts_on_arm": acts_on_arm,
    }
    if offset:
        wall["face_offset"] = offset
    if draw.chance(0.15):
        wall["rotation"] = _rotation(draw)
    return wall


def _motion(draw: Draw, unit: np.ndarray, stop: float) -> Keys:
    kind = draw.one_of(["fixed", "constant", "constant", "vector", "sinusoid", "ramp", "table"])
    if kind == "fixed":
        return {"type": "fixed"}
    if kind == "constant":
        return {"type": "constant", "velocity": draw.number(0.02, 0.3)}
    if kind == "vector":
        velocity = draw.number(0.02, 0.3) * unit + np.array(draw.numbers(-0.1, 0.1))
        return {"type": "constant", "velocity": [float(f"{part:.5g}") for part in velocity]}
    motion: Keys = {"type": kind}
    if kind == "sinusoid":
        frequency = draw.number(0.5, 4)
        motion |= {"amplitude": draw.number(0.01, 0.04), "frequency": frequency, "phase": draw.number(-3, 3)}
    elif kind == "ramp":
        motion |= {"distance": draw.number(0.01, 0.08), "duration": draw.number(0.1, 0.6)}
        motion |= draw.some(0.6, start=lambda: draw.instant(0, stop / 2))
    else:
        motion |= _quintics(draw, stop)
    if draw.chance(0.2):
        motion["direction"] = [float(f"{part:.5g}") for part in unit + np.array(draw.numbers(-0.5, 0.5))]
    return motion


def _quintics(draw: Draw, stop: float) -> Keys:
    if draw.chance(0.2):  # more points than keys have places for
        t = np.linspace(0, draw.number(0.3, 1) * stop, draw.one_of([17, 25, 40]))
        s = draw.number(0.01, 0.03) * np.sin(draw.number(1, 6) * t) + draw.number(-0.02, 0.05) * t
        return {"t": [float(f"{at:.6g}") for at in t], "s": [float(f"{at:.6g}") for at in s]}
    count = draw.one_of([2, 3, 4])
    t = sorted({draw.instant(0, stop) for _ in range(count)})
    if len(t) < 2 or min(np.diff(t)) < 0.05:
        t = [0.1, 0.35]
    count = len(t)
    return {
        "t": t,
        "s": [0.0, *draw.numbers(-0.01, 0.05, count - 1)],
        "v": [0.0, *draw.numbers(-0.05, 0.1, count - 2), 0.0],
        "a": [0.0, *draw.numbers(-1, 1, count - 2), 0.0],
    }


def _rotation(draw: Draw) -> Keys:
    if draw.chance(0.5):
        return {"type": "constant", "axis": draw.direction(), "rate": draw.number(-0.3, 0.3)}
    swing = {"amplitude": draw.number(0.02, 0.15), "frequency": draw.number(0.3, 2)}
    return {"type": "sinusoid", "axis": draw.direction(), **swing, **draw.some(0.5, phase=lambda: draw.number(-3, 3))}


def _contact(draw: Draw, acts_on_arm: bool) -> Keys:
    laws = ["spring", "spring", "kelvin_voigt", "hunt_crossley"]
    law = draw.one_of(laws if acts_on_arm else [*laws, "diagonal"])
    contact: Keys = {"law": law, "stiffness": draw.scale(200, 1e4)}
    if law == "diagonal":
        contact["stiffness"] = [draw.scale(200, 5000) for _ in range(3)]
    if law == "kelvin_voigt":
        contact |= {"restitution": draw.number(0.3, 0.95)} if draw.chance(0.4) else {"damping": draw.scale(1, 40)}
    if law == "hunt_crossley":
        contact |= {"stiffness": draw.scale(3e3, 1e5), "exponent": draw.one_of([1.5, draw.number(1, 2)])}
        if draw.chance(0.4):
            contact |= {"restitution": draw.number(0.3, 0.95), "impact_speed": draw.number(0.05, 0.5)}
        else:
            contact["dissipation"] = draw.scale(0.05, 2)
    if draw.chance(0.25):
        contact["friction"] = {"coefficient": draw.number(0.05, 0.6), "slip_velocity": draw.scale(0.01, 0.1)}
    return contact


# ---- the controller --------------------------------------------------------------------------------------------------


def _controller(draw: Draw, law: str, tip: np.ndarray, outwards: np.ndarray) -> Keys:
    controller: Keys = {"type": law, **_gains(draw, law)}
    if law == "constant":
        controller["torque"] = draw.numbers(-5, 5)
    if law not in ("none", "constant"):
        controller |= draw.some(0.2, gravity=lambda: draw.one_of([9.5, draw.numbers(-9, 9)]))
        controller |= draw.some(0.2, model=lambda: _wrong_model(draw))
    if law != "none":
        controller |= draw.some(0.3, saturation=lambda: draw.one_of(["clamp", "scale"]))
    if law == "gravity_compensation":
        controller |= draw.some(0.3, algorithm=lambda: "recursion")
    if law in ("operational_space", "hybrid", "parallel"):
        controller |= _integral(draw)
    if law in ON_THE_FORCE and draw.chance(0.5):
        controller["switching"] = draw.one_of(["in_contact", "latched", "always"])
    if law == "virtual_wall":
        normal = -outwards + np.array(draw.numbers(-0.5, 0.5))
        plane = tip - draw.number(-0.01, 0.02) * normal
        controller["plane_point"] = [float(f"{part:.6g}") for part in plane]
        controller["plane_normal"] = [float(f"{part:.5g}") for part in normal]
    return controller


def _gains(draw: Draw, law: str) -> Keys:
    """Gains within a factor of the defaults: each of a law's keys is drawn or left out."""

    def some(**defaults: float) -> Keys:
        return draw.some(0.6, **{key: lambda value=value: draw.one_or_three(value) for key, value in defaults.items()})

    def scalars(**defaults: float) -> Keys:
        return draw.some(0.6, **{key: lambda value=value: draw.about(value) for key, value in defaults.items()})

    joints = draw.some(
        0.6,
        joint_stiffness=lambda: [draw.about(200), draw.about(200), draw.about(100)],
        joint_damping=lambda: [draw.about(30), draw.about(30), draw.about(10)],
    )
    force = scalars(force_mass=1, force_gain=0.5, force_integral_gain=5)
    if law == "joint_pd":
        return joints | draw.some(0.3, compensate_gravity=lambda: False)
    if law in ("computed_torque", "resolved_acceleration"):
        flags = {"cancel_force": lambda: draw.chance(0.5)}
        if law == "resolved_acceleration":
            flags["ideal_cancellation"] = lambda: draw.chance(0.5)
        return some(position_gain=100, velocity_gain=20) | draw.some(0.4, **flags)
    ideal = draw.some(0.2, ideal_cancellation=lambda: True)
    if law in ("stiffness", "joint_stiffness", "impedance"):
        return some(stiffness=500, damping=100)
    if law == "shaped_impedance":
        return some(mass=2, damping=40, stiffness=200) | ideal
    if law == "operational_space":
        moves = some(position_gain=400, velocity_gain=40) | scalars(force_damping=70)
        return moves | force | ideal | draw.some(0.3, force_term=lambda: "feedforward")
    if law == "hybrid":
        return force | scalars(force_damping=70) | ideal | _variant(draw, joints, some)
    if law == "parallel":
        return some(damping=80, stiffness=100) | force | ideal
    if law == "admittance":
        return some(mass=2, damping=40, stiffness=200) | ideal | _inner(draw, joints)
    if law == "adaptive_reference":
        return some(mass=2, damping=80, stiffness=200) | ideal | _adaptation(draw)
    if law == "energy_tank":
        return some(stiffness=200) | _tank(draw)
    if law == "virtual_wall":
        return {"stiffness": draw.scale(300, 5000), **draw.some(0.5, damping=lambda: draw.scale(0.5, 20))}
    return {}


def _variant(draw: Draw, joints: Keys, some: Callable[..., Keys]) -> Keys:
    variant = draw.one_of(["dynamic", "jacobian_transpose", "projected", "raibert_craig"])
    if variant == "dynamic":
        return {"variant": variant, **some(position_gain=400, velocity_gain=40)}
    if variant == "jacobian_transpose":
        return {"variant": variant, **some(stiffness=500, damping=100)}
    return {"variant": variant, **joints}


def _inner(draw: Draw, joints: Keys) -> Keys:
    inner = draw.one_of(["exact", "position", "joint_pd"])
    if inner == "joint_pd":
        return {"inner": inner, **joints}
    if inner == "exact":
        return {"inner": inner}
    bandwidth = {"inner_bandwidth": lambda: draw.about(50), "inner_damping_ratio": lambda: draw.number(0.7, 1.5)}
    return {"inner": inner, **draw.some(0.5, **bandwidth)}


def _adaptation(draw: Draw) -> Keys:
    if draw.chance(0.5):
        return {"adaptation": "indirect", "assumed_stiffness": draw.scale(300, 1e4)}
    return {"adaptation": "integral", **draw.some(0.6, reference_gain=lambda: draw.about(0.02))}


def _tank(draw: Draw) -> Keys:
    return draw.some(
        0.5,
        damping=lambda: draw.scale(0.3, 30),
        stiffness_amplitude=lambda: draw.number(0, 150),
        stiffness_frequency=lambda: draw.number(1, 8),
        tank=lambda: draw.chance(0.6),
        tank_energy=lambda: draw.number(0.005, 0.2),
    )


def _integral(draw: Draw) -> Keys:
    integral = draw.some(0.3, integral_limit=lambda: draw.scale(0.01, 1))
    if draw.chance(0.5):
        integral["anti_windup"] = draw.one_of(["none", "conditional", "back_calculation"])
        if integral["anti_windup"] == "back_calculation":
            integral |= draw.some(0.5, tracking_time=lambda: draw.about(0.1))
    return integral


def _wrong_model(draw: Draw) -> Keys:
    """The controller's copy of the arm, some percent off."""
    return draw.some(
        0.5,
        payload=lambda: {"mass": draw.number(0.1, 1)},
        armature=lambda: draw.numbers(0.005, 0.1),
        link2=lambda: {"mass": draw.number(0.3, 2)},
        link3=lambda: {"mass": draw.number(0.3, 2)},
        damping=lambda: draw.numbers(0, 1),
        base_height=lambda: draw.number(-0.02, 0.02),
    )


# ---- what is wanted --------------------------------------------------------------------------------------------------


def _reference(draw: Draw, law: str, tip: np.ndarray, q: np.ndarray, stop: float, has_wall: bool) -> Keys:
    kinds = ["hold", "point", "line", "minimum_jerk", "sinusoid"]
    if law not in IN_JOINTS:
        kinds += ["circle", "table"]
    kind = draw.one_of(kinds)
    reference: Keys = {"type": kind}
    if kind in ("point", "line", "minimum_jerk"):
        reference |= _target(draw, tip, q)
    if kind in ("line", "minimum_jerk"):
        reference["duration"] = draw.instant(0.1, 0.8)
    if kind == "circle":
        reference |= {"radius": draw.number(0.01, 0.06), "period": draw.instant(0.4, 2)}
        reference |= draw.some(0.4, turns=lambda: draw.number(0.3, 2))
    if kind == "sinusoid":
        swing = (
            {"q_amplitude": draw.numbers(-0.15, 0.15)}
            if law in IN_JOINTS
            else {"tip_amplitude": draw.numbers(-0.06, 0.06)}
        )
        reference |= {**swing, "frequency": draw.number(0.3, 2.5)}
    if kind == "table":
        reference |= _table(draw, tip, stop)
    if kind in ("line", "minimum_jerk", "circle", "sinusoid"):
        reference |= draw.some(0.6, start=lambda: draw.instant(0, stop / 2))
    if law in ON_THE_FORCE or (law == "admittance" and has_wall and draw.chance(0.6)):
        reference["force"] = _wanted_force(draw, stop)
    return reference


def _target(draw: Draw, tip: np.ndarray, q: np.ndarray) -> Keys:
    if draw.chance(0.5):
        return {"tip": [float(f"{part:.6g}") for part in tip + draw.numbers(-0.08, 0.08)]}
    return {"q": [float(f"{part:.6g}") for part in q + draw.numbers(-0.2, 0.2)]}


def _table(draw: Draw, tip: np.ndarray, stop: float) -> Keys:
    t = sorted({draw.instant(0, stop) for _ in range(draw.one_of([2, 3, 4]))})
    if len(t) < 2 or min(np.diff(t)) < 0.08:
        t = [0.05, 0.4]
    steps = [tip + np.array(draw.numbers(-0.05, 0.05)) for _ in t[1:]]
    path = np.array([tip, *steps])
    return {"t": t, **{axis: [float(f"{part:.6g}") for part in path[:, i]] for i, axis in enumerate("xyz")}}


def _wanted_force(draw: Draw, stop: float) -> Keys:
    kind = draw.one_of(["constant", "step", "ramp", "sinusoid"])
    force: Keys = {"type": kind, "value": draw.number(2, 40)}
    if kind in ("step", "ramp"):
        force |= {"start": draw.instant(0, stop), **draw.some(0.6, initial=lambda: draw.number(0, 20))}
    if kind == "ramp":
        force["duration"] = draw.instant(0.05, 0.5)
    if kind == "sinusoid":
        force |= draw.some(0.7, amplitude=lambda: draw.number(0.5, 5), frequency=lambda: draw.number(0.5, 5))
    return force


# ---- what stands between arm and controller --------------------------------------------------------------------------


def _sampling(draw: Draw, decay: float) -> Keys:
    """A rate and a delay that leave the law stable: a decay at c 1/s under a hold of T s needs c T well below 2."""
    delay = draw.one_of([0, 0, 0, 0.25, 0.4, 0.5, 1, 1, 1.4, 2, 3])
    rates = [100, 200, 250, 333, 500, 730, 1000, 1000, 2000]
    rate = draw.one_of([rate for rate in rates if decay * (0.5 + delay) < 0.4 * rate] or [4000])
    sampling: Keys = {"rate": rate}
    if delay:
        sampling["delay"] = delay
    return sampling | draw.some(0.3, seed=lambda: draw.one_of([2, 7, 12345]))


def _fastest_decay(scenario: Keys) -> float:
    """An upper bound, 1/s, of how fast the law's dampers brake the arm at its start and the contact's spring swings."""
    resolved = arm3r.Scenario(yaml_of(scenario))
    arm, q = resolved.arm, np.array(scenario["initial"]["q"])
    joints = np.linalg.inv(arm.mass_matrix(q))
    tip = arm.jacobian(q) @ joints @ arm.jacobian(q).T

    def largest(key: str) -> float:
        return float(np.max(resolved[f"controller.{key}"])) if f"controller.{key}" in resolved else 0.0

    masses = [resolved[f"controller.{key}"] for key in ("mass", "force_mass") if f"controller.{key}" in resolved]
    tip_mobility = np.linalg.norm(tip, 2) if not masses else 1 / np.min([np.min(mass) for mass in masses])
    stiffness = max(np.max(scenario["wall"]["contact"]["stiffness"]), 0) if "wall" in scenario else 0.0
    return float(
        largest("joint_damping") * np.linalg.norm(joints, 2)
        + max(largest("damping"), largest("force_damping")) * tip_mobility
        + max(largest("velocity_gain"), largest("inner_bandwidth"))
        + math.sqrt(min(stiffness, 1e4) * tip_mobility)
    )


def _sensors(draw: Draw, is_sampled: bool) -> Keys:
    sensors: Keys = {}
    force = draw.some(0.4, bias=lambda: draw.numbers(-1, 1), analog_cutoff=lambda: draw.scale(30, 500))
    if is_sampled:
        force |= draw.some(
            0.3,
            noise=lambda: draw.number(0.01, 0.3),
            resolution=lambda: draw.scale(0.001, 0.1),
            cutoff=lambda: draw.scale(20, 300),
            delay=lambda: draw.one_of([0.3, 1, 1.5, 2]),
            tool_mass=lambda: draw.number(0.05, 0.3),
        )
        sensors |= draw.some(0.3, encoder=lambda: {"counts": draw.one_of([4096, 65536, 1048576])})
        sensors |= draw.some(0.4, velocity=lambda: _velocity(draw))
    if force:
        sensors["force"] = force
    return sensors


def _velocity(draw: Draw) -> Keys:
    if draw.chance(0.4):
        return {"estimate": "difference"}
    return {"estimate": "filtered", **draw.some(0.6, cutoff=lambda: draw.scale(30, 200))}


def _observer(draw: Draw, is_sampled: bool) -> Keys:
    observer: Keys = draw.some(
        0.5,
        gain=lambda: draw.one_or_three(40, 2),
        threshold=lambda: draw.one_or_three(1, 4),
        hold=lambda: draw.number(0.005, 0.05),
    )
    if not is_sampled or draw.chance(0.4):
        return observer
    observer["reaction"] = draw.one_of(["stop", "float", "reflex", "retreat"])
    if observer["reaction"] == "reflex":
        observer |= draw.some(0.5, reflex_gain=lambda: draw.number(0.2, 2))
    if observer["reaction"] == "retreat":
        observer |= draw.some(0.5, retreat_gain=lambda: draw.number(0.02, 0.2))
    return observer


def _estimator(draw: Draw, stop: float) -> Keys:
    return draw.some(
        0.5,
        rate=lambda: draw.one_of([100, 200, 500, 1000, 370]),
        forgetting=lambda: draw.number(0.98, 1),
        wall=lambda: "fixed",
        start=lambda: draw.instant(0, stop / 2),
    )


def _push(draw: Draw, stop: float) -> Keys:
    return {
        "force": draw.numbers(-15, 15),
        **draw.some(
            0.6,
            start=lambda: draw.instant(0, 0.8 * stop),
            rise=lambda: draw.instant(0.01, 0.2),
            duration=lambda: draw.instant(0.05, 0.5),
        ),
    }
