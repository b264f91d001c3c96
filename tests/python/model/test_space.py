"""Physics knows no x axis and no sign of an angle: a scenario turned about the vertical, or told in the other
convention, gives the same motion. That of an elbow arm, whose base has any pose, may be turned about any axis.

A failure prints the seed of its scenario and its YAML; ARM3R_SEED sets another seed, the gates that of the day.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Callable
from functools import partial
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from agreement import ADAPTIVE, SIZE, Band, Gap, OwnError, disturbed, instants, kinds, rk4, run_of
from elbow_arms import WITH_OFFSETS, moved, random_elbow_scenario, random_turn, told_in
from elbow_truth import Truth
from random_scenarios import Keys, random_scenario, sample_seed, yaml_of

SEED = sample_seed()
PER_AXIS = ("mass", "damping", "stiffness", "position_gain", "velocity_gain")
VECTORS = (
    "arm.gravity", "wall.point", "wall.normal", "wall.motion.velocity", "wall.motion.direction", "wall.rotation.axis",
    "controller.gravity", "controller.plane_point", "controller.plane_normal", "reference.tip",
    "reference.tip_amplitude", "sensors.force.bias", "push.force",
)  # fmt: skip
MIRRORED = ("initial.q", "initial.qd", "controller.torque", "reference.q", "reference.q_amplitude")
MIRRORED_COLUMNS = ("q", "qd", "qdd", "tau", "tau_g", "residual", "q_ref")


def entry(scenario: Keys, path: str) -> tuple[dict[str, Any], str] | None:
    """The map that holds a path's value, and its key in it; None where the scenario lacks it or it is one number."""
    *sections, key = path.split(".")
    place: Any = scenario
    for section in sections:
        place = place.get(section, {})
    return (place, key) if isinstance(place.get(key), list) else None


# ---- the two conventions ---------------------------------------------------------------------------------------------


def mirrored(scenario: Keys) -> Keys:
    """The scenario in the other convention."""
    other = copy.deepcopy(scenario)
    convention = {"slide": "simscape", "simscape": "slide"}[scenario["arm"]["convention"]]
    is_elbow = scenario["arm"].get("model") == "elbow"
    other["arm"] = told_in(scenario["arm"], convention) if is_elbow else scenario["arm"] | {"convention": convention}
    for path in MIRRORED:
        if found := entry(other, path):
            place, key = found
            place[key] = [place[key][0], -place[key][1], -place[key][2]]
    return other


def wrong_in_mirror(scenario: Keys, solver: Keys) -> list[str]:
    """Columns that are not the same bits in the other convention."""
    run, other = run_of(scenario, solver), run_of(mirrored(scenario), solver)
    if run is None or other is None:
        return [] if run is other else ["one convention is refused"]
    signs = {f"{name}{joint}": -1 for name in MIRRORED_COLUMNS for joint in (2, 3)}
    return [name for name in run.columns if not np.array_equal(run[name], signs.get(name, 1) * other[name])]


def check_mirror(numbers: range, longest: float, draw: Callable[..., Keys] = random_scenario) -> None:
    found = []
    for number in numbers:
        scenario = draw(np.random.default_rng([SEED, number]), longest=longest)
        for method, solver in {**ADAPTIVE, "rk4": rk4(scenario, 1e-3)}.items():
            if wrong := wrong_in_mirror(scenario, solver):
                found.append(f"# seed {SEED}, scenario {number}, {method}: {wrong}\n{yaml_of(scenario)}")
    assert not found, "\n".join(found[:10])


def test_both_conventions_give_the_same_bits() -> None:
    check_mirror(range(60), longest=0.3)


@pytest.mark.gate
@pytest.mark.random
def test_both_conventions_give_the_same_bits_in_many() -> None:
    check_mirror(range(1000, 2000), longest=1.2)


IN_TWO_CONVENTIONS = partial(random_elbow_scenario, conventions=("slide", "simscape"))


def test_elbow_arms_have_the_same_bits_in_both_conventions() -> None:
    check_mirror(range(20), longest=0.3, draw=IN_TWO_CONVENTIONS)


@pytest.mark.gate
@pytest.mark.random
def test_many_elbow_arms_have_the_same_bits_in_both_conventions() -> None:
    check_mirror(range(1000, 1200), longest=1.2, draw=IN_TWO_CONVENTIONS)


# ---- turned about the vertical ---------------------------------------------------------------------------------------


def alike_in_all_directions(scenario: Keys) -> Keys | None:
    """The scenario without what belongs to base axes or to counts of joint 1; None where that is all of it."""
    other = copy.deepcopy(scenario)
    for key in PER_AXIS:
        if found := entry(other, f"controller.{key}"):
            found[0][key] = found[0][key][0]
    sensors = other.get("sensors", {})
    sensors.pop("encoder", None)
    for key in ("noise", "resolution"):
        sensors.get("force", {}).pop(key, None)
    if other.get("reference", {}).get("type") == "circle" and "wall" not in other:
        return None
    return other


def turned(scenario: Keys, angle: float) -> Keys:
    """The arm and the world about it turned about the vertical."""
    other, R = copy.deepcopy(scenario), turn(angle)
    for path in VECTORS:
        if found := entry(other, path):
            place, key = found
            place[key] = (R @ place[key]).tolist()
    reference = other.get("reference", {})
    if reference.get("type") == "table":
        path = R @ np.array([reference[axis] for axis in "xyz"])
        reference |= {axis: path[i].tolist() for i, axis in enumerate("xyz")}
    for section in (other["initial"], reference):
        if "q" in section:
            section["q"] = [section["q"][0] + angle, *section["q"][1:]]
    return other


def turn(angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


class TurnedBack:
    """A run as it looks from axes turned by an angle."""

    def __init__(self, run: arm3r.Run, angle: float) -> None:
        self.t, self.events, self._run = run.t, run.events, run
        self._angle, self._back = angle, turn(-angle)

    def __getitem__(self, name: str) -> np.ndarray:
        if name in ("q1", "q_ref1"):
            return self._run[name] - self._angle
        stem, axis = name[:-1], "xyz".find(name[-1])
        if axis < 0 or not all(stem + letter in self._run.columns for letter in "xyz"):
            return self._run[name]
        return self._back[axis] @ np.array([self._run[stem + letter] for letter in "xyz"])


Back = Callable[[arm3r.Run, arm3r.Run], Any]
"""Shows a run of the moved world, of which the second argument is the run in place, as it looks from moved axes."""


def wrong_in_turn(scenario: Keys, there: Keys, back: Back, number: int, solver: Keys, share: float) -> Gap | None:
    """Where the run of the moved world leaves this share of the band by more than rounding explains.

    A turned world has other roundings at every step. A pose near a singular one, a contact or an unstable loop makes
    them larger as it makes the disturbances of 1e-15 rad, m and rad/s of a dozen other runs: ten times as much as
    these do is rounding, whatever share of the band it is; and so is another outcome, where one of them has another.
    """
    run, other = run_of(scenario, solver), run_of(there, solver)
    if run is None or run.outcome != "ok":
        return None
    if other is None or other.outcome != "ok":
        rounded = (disturbed(scenario, np.random.default_rng([SEED, number, 50 + i]), 1e-15) for i in range(12))
        is_rounding = any(one is None or one.outcome != "ok" for one in (run_of(near, solver) for near in rounded))
        return None if is_rounding else Gap(np.inf, "outcome", 0.0)
    seen = back(other, run)
    for disturbances in (2, 12):
        others = (disturbed(scenario, np.random.default_rng([SEED, number, i])) for i in range(disturbances))
        band = Band(run, [run_of(one, solver) for one in others])
        gap = max(band.gap(seen), band.event_gap(seen))
        if gap.ratio <= share:
            return None
    rounding = rounding_of(scenario, number, solver, run, share)
    gap = max(band.gap(seen, rounding), band.event_gap(seen, rounding))
    return None if gap.ratio <= share else gap


def rounding_of(scenario: Keys, number: int, solver: Keys, run: arm3r.Run, share: float) -> OwnError:
    """Ten times what disturbances of the size of a rounding error do, in parts of this share of a band.

    Rows after these have grown to the size of the band's own disturbances say nothing.
    """
    others = (disturbed(scenario, np.random.default_rng([SEED, number, 50 + i]), 1e-15) for i in range(12))
    runs = [one for other in others if (one := run_of(other, solver)) is not None and len(one.t) == len(run.t)]
    times = 10 / share

    def error_of(name: str) -> np.ndarray:
        return times * np.maximum.accumulate(np.max([abs(one[name] - run[name]) for one in runs], axis=0))

    alike = all(kinds(one) == kinds(run) for one in runs)
    events = times * np.max([abs(instants(one) - instants(run)) for one in runs], axis=0) if alike else None
    errors = {name: error_of(name) for name in run.columns}
    if "stiffness_sigma" in errors:  # without noise it is the size of a rounding error, which the origin decides on
        sigma = run["stiffness_sigma"]
        errors["stiffness_sigma"] += np.where(sigma < 1e-6 * run["stiffness_estimate"], times * sigma, 0.0)
    rows = np.max([errors[name] / times for name in ("q1", "q2", "q3")], axis=0) < SIZE
    return OwnError(errors, events if rows.all() else None, rows)


def check_turn(numbers: range, longest: float) -> None:
    found = []
    for number in numbers:
        scenario = alike_in_all_directions(random_scenario(np.random.default_rng([SEED, number]), longest=longest))
        if scenario:
            angle = float(np.random.default_rng([SEED, number, 99]).uniform(-3, 3))
            back = partial(seen_from_turned_axes, angle=angle)
            found += wrong_of_methods(scenario, turned(scenario, angle), back, number)
    assert not found, "\n".join(found[:10])


def seen_from_turned_axes(run: arm3r.Run, here: arm3r.Run, angle: float) -> TurnedBack:
    return TurnedBack(run, angle)


def wrong_of_methods(scenario: Keys, there: Keys, back: Back, number: int) -> list[str]:
    """A text for each method by which the moved world has another run."""
    found = []
    for method in ("dopri5", "taylor", "rk4"):
        solver, share = (ADAPTIVE[method], 1.0) if method in ADAPTIVE else (rk4(scenario, 1e-3), 1e-3)
        if gap := wrong_in_turn(scenario, there, back, number, solver, share):
            found.append(f"# seed {SEED}, scenario {number}, {method}: {gap}\n{yaml_of(scenario)}")
    return found


def test_a_turned_world_gives_the_turned_run() -> None:
    check_turn(range(60), longest=0.3)


@pytest.mark.gate
@pytest.mark.random
def test_many_turned_worlds_give_the_turned_runs() -> None:
    check_turn(range(1000, 2000), longest=1.2)


# ---- turned about any axis, and moved --------------------------------------------------------------------------------

POINTS = ("wall.point", "controller.plane_point", "reference.tip")
DIRECTIONS = tuple(path for path in VECTORS if path not in (*POINTS, "arm.gravity", "controller.gravity"))
POINT_COLUMNS = ("tip_", "wall_", "tip_ref_")


def without_a_vertical(scenario: Keys) -> Keys | None:
    """The scenario without what the vertical decides: outline and axes of the plate; None for a circle on it."""
    other = alike_in_all_directions(scenario)
    if other is None or other.get("reference", {}).get("type") == "circle":
        return None
    if "wall" in other:
        other["wall"]["size"] = "infinite"
        if other["wall"]["contact"]["law"] == "diagonal":
            other["wall"]["contact"] |= {"law": "spring", "stiffness": other["wall"]["contact"]["stiffness"][0]}
    return other


def moved_in_space(scenario: Keys, R: np.ndarray, by: np.ndarray) -> Keys:
    """An elbow arm and the world about it turned about the origin and moved; its joint angles stay."""
    other = copy.deepcopy(scenario)
    other["arm"] = moved(scenario["arm"], R, by)
    for path in DIRECTIONS:
        if found := entry(other, path):
            place, key = found
            place[key] = (R @ place[key]).tolist()
    for path in POINTS:
        if found := entry(other, path):
            place, key = found
            place[key] = (R @ place[key] + by).tolist()
    reference, controller = other.get("reference", {}), other["controller"]
    if reference.get("type") == "table":
        path = R @ np.array([reference[axis] for axis in "xyz"]) + by[:, None]
        reference |= {axis: path[i].tolist() for i, axis in enumerate("xyz")}
    if controller["type"] not in ("none", "constant"):
        gravity = controller.get("gravity", 9.80665)
        controller["gravity"] = (R @ (gravity if isinstance(gravity, list) else [0, 0, -gravity])).tolist()
    return other


class MovedBack:
    """A run of the moved world as it looks from axes that have moved with it, with the same zero of the energy."""

    def __init__(self, run: arm3r.Run, here: arm3r.Run, R: np.ndarray, by: np.ndarray) -> None:
        self.t, self.events, self._run, self._R, self._by = run.t, run.events, run, R, by
        self._higher = run["energy_potential"][0] - here["energy_potential"][0]

    def __getitem__(self, name: str) -> np.ndarray:
        stem, axis = name[:-1], "xyz".find(name[-1])
        if name == "energy_potential":
            return self._run[name] - self._higher
        if axis < 0 or not all(stem + letter in self._run.columns for letter in "xyz"):
            return self._run[name]
        vectors = np.array([self._run[stem + letter] for letter in "xyz"])
        return self._R[:, axis] @ (vectors - self._by[:, None] if stem in POINT_COLUMNS else vectors)


def check_moved(numbers: range, longest: float) -> None:
    found = []
    for number in numbers:
        scenario = without_a_vertical(random_elbow_scenario(np.random.default_rng([SEED, number]), longest=longest))
        if scenario:
            rng = np.random.default_rng([SEED, number, 98])
            R, by = random_turn(rng), rng.uniform(-1, 1, 3)
            back = partial(MovedBack, R=R, by=by)
            found += wrong_of_methods(scenario, moved_in_space(scenario, R, by), back, number)
    assert not found, "\n".join(found[:10])


def test_a_world_of_an_elbow_arm_that_is_turned_and_moved_gives_the_moved_run() -> None:
    check_moved(range(25), longest=0.3)


def test_a_stiffness_on_a_plate_that_turns_does_not_depend_on_the_origin() -> None:
    """The way of the tip along a normal that turns is that from where the contact began."""
    arm = {**WITH_OFFSETS, "gravity": [0, 0, 0]}
    tip = Truth(arm).tip_position(np.array([0.3, 0.4, -0.7]))
    normal = np.array([-0.6, -0.3, 0.74])
    plate = {
        "point": (tip + 0.02 * np.array([0.74, 0, 0.6]) + 0.001 * normal).tolist(),
        "normal": normal.tolist(),
        "size": "infinite",
        "motion": {"type": "fixed"},
        "rotation": {"type": "sinusoid", "axis": [0.2, 1.0, 0.1], "amplitude": 0.02, "frequency": 1.0},
        "contact": {"law": "spring", "stiffness": 1500.0},
        "acts_on_arm": True,
    }
    scenario = {
        "format": 1,
        "arm": arm,
        "initial": {"q": [0.3, 0.4, -0.7]},
        "wall": plate,
        "controller": {"type": "hybrid", "gravity": [0, 0, 0]},
        "reference": {"force": {"type": "sinusoid", "value": 20.0, "amplitude": 12.0, "frequency": 4.0}},
        "estimator": {},
        "time": {"stop": 1.0},
    }
    here, there = (
        run_of(keys, ADAPTIVE["dopri5"])
        for keys in (scenario, moved_in_space(scenario, np.eye(3), np.array([3.0, -2.0, 5.0])))
    )
    assert here is not None and there is not None
    assert here["identifiable"].any() and np.array_equal(here["identifiable"], there["identifiable"])
    assert abs(here["stiffness_estimate"] - there["stiffness_estimate"]).max() <= 1e-4


@pytest.mark.gate
@pytest.mark.random
def test_many_worlds_of_elbow_arms_that_are_turned_and_moved_give_the_moved_runs() -> None:
    check_moved(range(1000, 1300), longest=1.2)


# ---- raised ----------------------------------------------------------------------------------------------------------

HEIGHTS = ("wall.point", "reference.tip", "controller.plane_point")


def raised(scenario: Keys, by: float) -> Keys:
    """The arm and the world about it at another height: the zero of the potential energy is elsewhere."""
    other = copy.deepcopy(scenario)
    other["arm"]["base_height"] = other["arm"].get("base_height", 0.0) + by
    model = other["controller"].get("model", {})
    if "base_height" in model:
        model["base_height"] += by
    for path in HEIGHTS:
        if found := entry(other, path):
            place, key = found
            place[key] = [*place[key][:2], place[key][2] + by]
    if other.get("reference", {}).get("type") == "table":
        other["reference"]["z"] = [z + by for z in other["reference"]["z"]]
    return other


def verdict(run: arm3r.Run | None) -> tuple[str, ...]:
    """What a run says of itself: how it ended, and of what it warns, without the numbers."""
    if run is None:
        return ("refused",)
    return run.outcome, *sorted(re.sub(r"[-+]?[0-9.]+(e[-+]?[0-9]+)?", "#", text) for text in run.summary["warnings"])


def check_height(numbers: range, longest: float) -> None:
    found = []
    for number in numbers:
        rng = np.random.default_rng([SEED, number, 31])
        scenario = random_scenario(rng, longest=longest)
        by = float(rng.choice([-0.7, 1.3, 40.0]))
        for method, solver in {
            "dopri5": {"method": "dopri5"},
            "taylor": {"method": "taylor"},
            "rk4": rk4(scenario, 1e-3),
        }.items():
            here, there = verdict(run_of(scenario, solver)), verdict(run_of(raised(scenario, by), solver))
            nudged = {
                verdict(run_of(disturbed(scenario, np.random.default_rng([SEED, number, i])), solver)) for i in range(2)
            }
            if here != there and nudged == {here}:
                found.append(
                    f"# seed {SEED}, scenario {number}, {method}, raised {by}: {here} {there}\n{yaml_of(scenario)}"
                )
    assert not found, "\n".join(found[:10])


def test_no_verdict_knows_the_height_of_the_base() -> None:
    check_height(range(15), longest=0.3)


@pytest.mark.gate
@pytest.mark.random
def test_no_verdict_knows_the_height_of_the_base_in_many() -> None:
    check_height(range(1000, 1400), longest=1.2)


@pytest.mark.parametrize(
    "law", ["none", "gravity_compensation", "stiffness", "impedance", "joint_pd", "computed_torque"]
)
def test_an_arm_that_rests_where_its_energy_is_zero_closes_its_balance(law: str) -> None:
    """All that it has is rounding, at whatever height, of whatever weight: no outcome may come of it."""
    for height in (0.0, 0.7, 1e3):
        for gravity in ([0, 0, -9.80665], [0, 0, 0], [0, 0, -1e-9], [3, 0, -9]):
            for q in ([0.3, 0, 0], [0.3, -0.5, 1.1]):
                for method in ("dopri5", "rodas4", "taylor"):
                    scenario = {
                        "format": 1,
                        "arm": {"base_height": height, "gravity": gravity},
                        "initial": {"q": q},
                        "controller": {"type": law},
                        "time": {"stop": 2.0},
                    }
                    run = run_of(scenario, {"method": method})
                    assert run is None or run.outcome == "ok", (height, gravity, q, method, run.summary["message"])
