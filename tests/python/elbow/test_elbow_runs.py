"""Runs of elbow arms: lanes, energy, an independent integration, conventions, and what each law promises.

A failure prints the seed and the YAML; ARM3R_SEED sets another seed, the gates that of the day. That methods agree, and
that runs know neither place nor time, is tested where it is for planar arms.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from agreement import ADAPTIVE, Band, disturbed, run_of
from elbow_arms import (
    WITH_OFFSETS,
    as_elbow,
    inner_angles,
    joint_angles,
    random_arm,
    random_elbow_scenario,
    scenario_of,
    signs_and_zeros,
    told_in,
)
from elbow_truth import Pinocchio, Truth, transpose
from random_scenarios import Draw, Keys, sample_seed, yaml_of
from scipy.integrate import solve_ivp

SEED = sample_seed()
TIGHT = {"method": "dopri5", "rtol": 1e-12, "atol": 1e-13}
LANE_METHODS: dict[str, Keys] = {
    "rk4": {"method": "rk4", "step": 1e-3},
    "dopri5": {"method": "dopri5"},
    "rk4 to events": {"method": "rk4", "step": 1e-3, "events": "located"},
}

# ---- lanes -----------------------------------------------------------------------------------------------------------


def assert_lanes_are_runs(scenario: arm3r.Scenario, values: dict[str, Any], told: str) -> int:
    """Asserts that every lane has the bits of its run alone; returns how many lanes came to their end."""
    batch = scenario.batch(values)
    for index in np.ndindex(batch.shape):
        try:
            run = batch.run(index)
        except arm3r.Arm3rError as error:
            assert batch.outcomes[index] != "ok", (index, error, told)
            continue
        assert batch.outcomes[index] == "ok", (index, told)
        assert [batch[f"q{i}"][index] for i in (1, 2, 3)] == run["q"][-1].tolist(), (index, told)
        for name, value in run.summary["metrics"].items():
            due = np.nan if value is None else value
            assert name == "outcome" or np.array_equal(batch[name][index], due, equal_nan=True), (index, name, told)
    return int(batch.ok.sum())


def check_lanes(numbers: range, longest: float) -> None:
    finished = 0
    for number in numbers:
        rng = np.random.default_rng([SEED, number])
        keys = random_elbow_scenario(rng, longest=longest)
        starts = np.array(keys["initial"]["q"]) + rng.uniform(-0.02, 0.02, (9, 3))
        for method, solver in LANE_METHODS.items():
            text = yaml_of({**keys, "solver": {**solver, "max_steps": 20000}})
            scenario = arm3r.Scenario(text)
            try:
                scenario.validate()
            except arm3r.ScenarioError:
                continue  # steps that do not part the samples
            told = f"seed {SEED}, scenario {number}, {method}\n{text}"
            finished += assert_lanes_are_runs(scenario, {"initial.q": starts}, told)
    assert finished > 9 * len(numbers)


def test_lanes_have_the_bits_of_their_runs() -> None:
    """Nine lanes: one more than a pack holds."""
    check_lanes(range(25), longest=0.3)


@pytest.mark.gate
@pytest.mark.random
def test_many_lanes_have_the_bits_of_their_runs() -> None:
    check_lanes(range(1000, 1300), longest=1.2)


@pytest.mark.parametrize("method", LANE_METHODS)
def test_arms_of_every_kind_may_stand_side_by_side(method: str) -> None:
    """A lane has the same bits whether its neighbours have offsets, products of inertia and skew rotors or not."""
    arm = {**WITH_OFFSETS, "rotor3": {"inertia": 2e-4, "ratio": 60.0, "mass": 0.4, "axis": [1.0, 0.2, 0.0]}}
    q = joint_angles(arm, [0.5, 0.7, -1.3]).tolist()
    sections = {"initial": {"q": q}, "solver": LANE_METHODS[method], "time": {"stop": 0.3}}
    lanes = {
        "arm.shoulder_offset": [0.0, 0.2, -0.3, 0.0, 0.1, 0.0, 0.3, 0.0, 0.2],
        "arm.link2.offset": [0.0, 0.1, 0.0, -0.2, 0.0, 0.0, 0.1, 0.0, 0.0],
        "arm.rotor3.inertia": [0.0, 1e-4, 0.0, 1e-4, 2e-4, 0.0, 0.0, 1e-3, 0.0],
        "arm.link2.inertia[3]": [0.0, 0.003, 0.0, 0.0, 0.002, 0.0, 0.0, -0.003, 0.001],
        "arm.gravity[0]": [0.0, 1.0, 0.0, 3.0, 0.0, 0.0, -2.0, 0.0, 0.0],
        "arm.base.rotation[1]": [0.0, 0.0, 0.4, 0.0, 0.0, 0.0, -0.3, 0.0, 0.2],
    }
    scenario = scenario_of(arm, **sections, controller={"type": "gravity_compensation"})
    assert assert_lanes_are_runs(scenario, lanes, method) == 9
    free = scenario_of(arm, **sections, controller={"type": "none"})
    assert assert_lanes_are_runs(free, lanes, method) == 9


# ---- energy ----------------------------------------------------------------------------------------------------------


def check_energy(numbers: range, longest: float) -> None:
    """The energies of the rows are those of the truth, and the balance closes to what the tolerance allows."""
    for number in numbers:
        keys = random_elbow_scenario(np.random.default_rng([SEED, number]), longest=longest)
        told = f"seed {SEED}, scenario {number}\n{yaml_of(keys)}"
        run = run_of(keys, ADAPTIVE["dopri5"])
        if run is None or run.outcome != "ok":
            continue
        kinetic, potential = Truth(keys["arm"]).energy(run["q"], run["qd"])
        size = 1 + abs(kinetic).max() + abs(potential).max()
        assert abs(run["energy_kinetic"] - kinetic).max() <= 1e-12 * size, told
        assert abs(run["energy_potential"] - potential).max() <= 1e-12 * size, told
        moved = size + abs(run["work_actuators"]).max() + abs(run["energy_dissipated"]).max()
        assert abs(run["energy_residual"]).max() <= 1e-6 * moved, told


def test_energy_closes() -> None:
    check_energy(range(40), longest=0.3)


@pytest.mark.gate
@pytest.mark.random
def test_energy_closes_in_many_runs() -> None:
    check_energy(range(1000, 1500), longest=1.2)


@pytest.mark.parametrize("method", ["dopri5", "rodas4", "taylor", "rk4"])
def test_an_arm_that_nothing_drives_keeps_its_energy(method: str) -> None:
    """Free fall of the arm with all offsets: to 1e-8 of the energy that it exchanges, at 1e-11 a step."""
    solver = {"method": "rk4", "step": 1e-4} if method == "rk4" else ADAPTIVE[method]
    start = {"q": joint_angles(WITH_OFFSETS, [0.5, 0.7, -1.3]).tolist(), "qd": [0.5, -0.4, 0.3]}
    run = scenario_of(WITH_OFFSETS, initial=start, controller={"type": "none"}, solver=solver, time={"stop": 2}).run()
    total = run["energy_kinetic"] + run["energy_potential"]
    exchanged = np.ptp(run["energy_potential"])
    assert exchanged > 10
    assert np.ptp(total) <= 1e-8 * exchanged


# ---- an independent integration --------------------------------------------------------------------------------------


def integrated(keys: Keys, times: np.ndarray) -> np.ndarray:
    """q at the times, of Pinocchio's arm under a constant torque and a spring behind a plane, by DOP853.

    No step reaches across the spring's kink: each ends where the tip meets the plane or leaves it.
    """
    truth, peer, wall = Truth(keys["arm"]), Pinocchio(keys["arm"]), keys["wall"]
    normal = np.array(wall["normal"]) / np.linalg.norm(wall["normal"])
    torque, stiffness = np.array(keys["controller"]["torque"]), wall["contact"]["stiffness"]

    def depth(t: float, y: np.ndarray, touching: bool) -> float:
        return float(normal @ (np.array(wall["point"]) - peer.tip(y[:3], y[3:])[0]))

    def rate(t: float, y: np.ndarray, touching: bool) -> np.ndarray:
        load = torque - truth.friction_torque(y[3:])
        if touching:
            force = stiffness * depth(t, y, touching) * normal
            load = load + peer.tip(y[:3], y[3:])[1][:3].T @ force
        return np.concatenate([y[3:], peer.forward_dynamics(y[:3], y[3:], load)])

    depth.terminal = True
    options = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-12, "max_step": 2e-3, "dense_output": True}
    y, now, angles = np.array([*keys["initial"]["q"], *keys["initial"]["qd"]]), 0.0, [keys["initial"]["q"]]
    touching = depth(now, y, False) > 0
    while len(angles) < len(times):
        depth.direction = -1 if touching else 1
        found = solve_ivp(rate, (now, times[-1]), y, events=depth, args=(touching,), **options)
        angles += [found.sol(t)[:3] for t in times if now < t <= found.t[-1]]
        now, y, touching = found.t[-1], found.y[:, -1], not touching
    return np.array(angles)


def check_integration(numbers: range) -> None:
    """To 1e-8 rad: contacts multiply what both integrations leave."""
    contacts = 0
    for number in numbers:
        rng = np.random.default_rng([SEED, number, 7])
        draw = Draw(rng)
        arm = random_arm(rng)
        q, qd = draw.numbers(-2, 2), draw.numbers(-1, 1)
        normal, tip = np.array(draw.direction()), Truth(arm).tip_position(np.array(q))
        point = tip - normal * draw.number(-0.001, 0.05) / np.linalg.norm(normal)
        contact = {"law": "spring", "stiffness": draw.scale(300, 3000)}
        keys = {
            "format": 1,
            "arm": arm,
            "initial": {"q": q, "qd": qd},
            "controller": {"type": "constant", "torque": draw.numbers(-10, 10)},
            "wall": {
                "point": point.tolist(),
                "normal": normal.tolist(),
                "size": "infinite",
                "motion": {"type": "fixed"},
                "contact": contact,
                "acts_on_arm": True,
            },
            "solver": TIGHT,
            "time": {"stop": 0.3, "log_every": 0.01},
        }
        run = arm3r.Scenario(yaml_of(keys)).run()
        contacts += bool(run["contact"].any())
        gap = abs(run["q"] - integrated(keys, run.t)).max()
        assert gap <= 1e-8, f"seed {SEED}, scenario {number}: {gap:.1e}\n{yaml_of(keys)}"
    assert contacts > 0.3 * len(numbers)


def test_runs_are_those_of_an_independent_integration() -> None:
    check_integration(range(8))


@pytest.mark.gate
@pytest.mark.random
def test_many_runs_are_those_of_an_independent_integration() -> None:
    check_integration(range(100, 200))


# ---- conventions -----------------------------------------------------------------------------------------------------

IN_JOINTS = ("initial.q", "reference.q")
RATES_IN_JOINTS = ("initial.qd", "controller.torque", "reference.q_amplitude")


def scenario_told_in(keys: Keys, convention: str, sign: Any, zero: Any) -> Keys:
    """The same scenario with all joint vectors in another convention."""
    other = {**keys, "arm": told_in(keys["arm"], convention, sign=sign, zero=zero)}
    ways = signs_and_zeros(keys["arm"])[0] * signs_and_zeros(other["arm"])[0]
    for path in (*IN_JOINTS, *RATES_IN_JOINTS):
        section, key = path.split(".")
        if key in keys.get(section, {}):
            vector = np.array(keys[section][key])
            angles = joint_angles(other["arm"], inner_angles(keys["arm"], vector))
            told = angles if path in IN_JOINTS else ways * vector
            other[section] = {**other[section], key: told.tolist()}
    return other


class ToldBack:
    """A run with its joint columns in the convention of another arm."""

    JOINT_COLUMNS = ("qd", "qdd", "tau", "tau_g", "residual")

    def __init__(self, run: arm3r.Run, arm: Keys, own: Keys) -> None:
        self.t, self.events, self._run, self._arm, self._own = run.t, run.events, run, arm, own
        self._ways = signs_and_zeros(arm)[0] * signs_and_zeros(own)[0]

    def __getitem__(self, name: str) -> np.ndarray:
        stem, joint = name[:-1], name[-1]
        if stem in ("q", "q_ref"):
            angles = np.column_stack([self._run[f"{stem}{i}"] for i in (1, 2, 3)])
            return joint_angles(self._arm, inner_angles(self._own, angles))[:, int(joint) - 1]
        return self._ways[int(joint) - 1] * self._run[name] if stem in self.JOINT_COLUMNS else self._run[name]


def check_conventions(numbers: range, longest: float) -> None:
    """An encoder is left out: its counts are those of the joint's own zero."""
    compared = 0
    for number in numbers:
        rng = np.random.default_rng([SEED, number])
        keys = random_elbow_scenario(rng, longest=longest)
        keys.get("sensors", {}).pop("encoder", None)
        run = run_of(keys, ADAPTIVE["dopri5"])
        if run is None or run.outcome != "ok":
            continue
        others = [disturbed(keys, np.random.default_rng([SEED, number, i])) for i in range(4)]
        band = Band(run, [run_of(other, ADAPTIVE["dopri5"]) for other in others])
        for convention in ("slide", "simscape", "urdf"):
            there = scenario_told_in(keys, convention, rng.choice([-1, 1], 3), rng.uniform(-3, 3, 3))
            other = run_of(there, ADAPTIVE["dopri5"])
            told = f"seed {SEED}, scenario {number}, {convention}\n{yaml_of(keys)}{yaml_of(there)}"
            assert other is not None and other.outcome == "ok", told
            seen = ToldBack(other, keys["arm"], there["arm"])
            gap = max(band.gap(seen), band.event_gap(seen))
            assert gap.ratio <= 3, (gap, told)
            compared += 1
    assert compared > len(numbers)


def test_every_convention_tells_the_same_run() -> None:
    check_conventions(range(15), longest=0.3)


@pytest.mark.gate
@pytest.mark.random
def test_every_convention_tells_the_same_run_in_many() -> None:
    check_conventions(range(1000, 1200), longest=1.2)


def test_a_planar_arm_runs_alike_as_an_elbow_arm() -> None:
    """The same numbers in another order: 1e-9 after a second of contacts, which multiply rounding by less than 1e4."""
    link = {"mass": 1.3, "inertia": [0.004, 0.031, 0.033]}
    arm: Keys = {
        "convention": "simscape",
        "base_height": 0.2,
        "link1": {"mass": 0.6, "com": 0.1, "inertia_axial": 0.02},
        "link2": {"length": 0.8, "com": 0.37, **link},
        "link3": {"length": 0.6, "com": 0.25, **link},
        "armature": [0.02, 0.03, 0.01],
    }
    sections: Keys = {
        "initial": {"q": [0.3, -0.5, 1.1]},
        "wall": {
            "point": [1.17, 0.36, 0.24],
            "normal": [-1, -0.2, 0.1],
            "size": "infinite",
            "motion": {"type": "constant", "velocity": 0.1},
            "acts_on_arm": True,
        },
        "controller": {"type": "gravity_compensation"},
        "solver": TIGHT,
        "time": {"stop": 1.0},
    }
    planar, elbow = scenario_of(arm, **sections).run(), scenario_of(as_elbow(arm), **sections).run()
    assert [event.type for event in planar.events] == [event.type for event in elbow.events] != []
    for name in planar.columns:
        assert abs(planar[name] - elbow[name]).max() <= 1e-9 * (1 + abs(planar[name]).max()), name


# ---- what laws promise -----------------------------------------------------------------------------------------------

ARM: Keys = WITH_OFFSETS
BENT = joint_angles(ARM, [0.5, 0.7, -1.3])
TIP = Truth(ARM).tip_position(BENT)
NORMAL = np.array([-0.6, -0.3, 0.74])
NORMAL /= np.linalg.norm(NORMAL)


def plate(gap: float = -0.002, **keys: Any) -> Keys:
    """A plate before the tip of the bent arm; a negative gap begins in contact."""
    return {
        "point": (TIP - gap * NORMAL).tolist(),
        "normal": NORMAL.tolist(),
        "size": "infinite",
        "motion": {"type": "fixed"},
        "contact": {"law": "kelvin_voigt", "stiffness": 2000, "damping": 30},
        "acts_on_arm": True,
        **keys,
    }


def run_with(controller: Keys, arm: Keys | None = None, stop: float = 2.0, **sections: Any) -> arm3r.Run:
    """The bent arm under this law."""
    sections = {"initial": {"q": BENT.tolist()}, "solver": TIGHT, "time": {"stop": stop}, **sections}
    return scenario_of(arm or ARM, controller=controller, **sections).run()


@pytest.mark.parametrize("algorithm", ["closed_form", "recursion"])
@pytest.mark.parametrize("gravity", [[0, 0, -9.80665], [3, -4, -7]])
def test_a_compensated_arm_stays(algorithm: str, gravity: list[float]) -> None:
    controller = {"type": "gravity_compensation", "algorithm": algorithm, "gravity": gravity}
    run = run_with(controller, {**ARM, "gravity": gravity})
    assert abs(run["q"] - BENT).max() <= 1e-11
    assert abs(run["tau"][0] - Truth({**ARM, "gravity": gravity}).gravity_torque(BENT)).max() <= 1e-12 * 100


@pytest.mark.parametrize("algorithm", ["closed_form", "recursion"])
def test_a_model_of_other_masses_compensates_its_own_weight(algorithm: str) -> None:
    """The torque of the first row is that which would hold the model's arm."""
    model = {"link2": {"mass": 5.0, "com": [0.1, 0.03, 0.02]}, "payload": {"mass": 0.7}}
    run = run_with({"type": "gravity_compensation", "algorithm": algorithm, "model": model}, stop=0.01)
    wrong = {**ARM, "link2": {**ARM["link2"], **model["link2"]}, "payload": model["payload"]}
    assert abs(run["tau"][0] - Truth(wrong).gravity_torque(BENT)).max() <= 1e-12 * 100


@pytest.mark.parametrize("rotors", [False, True])
def test_computed_torque_follows_its_path(rotors: bool) -> None:
    """With the right model nothing is left of the dynamics, rotors included, but the error of the integration."""
    arm = dict(ARM)
    if rotors:
        arm |= {
            "rotor2": {"inertia": 3e-4, "ratio": 80.0, "mass": 0.5, "axis": [0.3, 0.2, 0.9]},
            "rotor3": {"inertia": 2e-4, "ratio": -60.0, "mass": 0.4, "axis": [1.0, 0.1, -0.2]},
        }
    target = (BENT + np.array([0.6, -0.3, 0.5])).tolist()
    reference = {"type": "minimum_jerk", "q": target, "duration": 1.0}
    run = run_with({"type": "computed_torque"}, arm, stop=1.5, reference=reference)
    assert abs(run["q"] - np.column_stack([run[f"q_ref{i}"] for i in (1, 2, 3)])).max() <= 1e-8
    truth = Truth(arm).inverse_dynamics(run["q"], run["qd"], run["qdd"], 0 * run["q"])
    assert abs(run["tau"] - truth).max() <= 1e-10 * abs(truth).max()


def test_resolved_acceleration_follows_its_path_of_the_tip() -> None:
    reference = {"type": "minimum_jerk", "tip": (TIP + np.array([-0.1, 0.05, 0.1])).tolist(), "duration": 1.0}
    run = run_with({"type": "resolved_acceleration"}, stop=1.5, reference=reference)
    assert abs(run["tip"] - run["tip_ref"]).max() <= 1e-8
    assert abs(run["tip"][-1] - reference["tip"]).max() <= 1e-8


@pytest.mark.parametrize("law", ["stiffness", "impedance"])
def test_at_rest_a_spring_at_the_tip_bears_the_push(law: str) -> None:
    """K (x_ref - x) + f = 0 once all motion is damped away."""
    push = np.array([8.0, -5.0, 6.0])
    run = run_with({"type": law, "stiffness": 400, "damping": 80}, stop=8.0, push={"force": push.tolist()})
    assert abs(run["qd"][-1]).max() < 1e-6
    assert abs(400 * (run["tip"][-1] - TIP) - push).max() <= 1e-3


@pytest.mark.parametrize("sampled", [False, True])
@pytest.mark.parametrize("law", ["hybrid", "parallel", "operational_space"])
def test_laws_on_the_force_reach_it(law: str, sampled: bool) -> None:
    """Their integral leaves no error: after four seconds a thousandth of the force."""
    sections: Keys = {"wall": plate(), "reference": {"force": {"value": 15.0}}}
    if sampled:
        sections["sampling"] = {"rate": 1000}
    run = run_with({"type": law}, stop=4.0, **sections)
    assert run["force"][-1] == pytest.approx(15.0, abs=0.015)
    assert run["f_on_tip"][-1] == pytest.approx(run["force"][-1] * NORMAL, abs=1e-9)


@pytest.mark.parametrize("inner", ["exact", "position", "joint_pd"])
def test_admittance_yields_to_a_wall(inner: str) -> None:
    """Its reference is a pose of the arm: with a wrong branch or frame of inverse kinematics it would leave at once."""
    run = run_with(
        {"type": "admittance", "inner": inner},
        stop=2.0,
        wall=plate(0.01, motion={"type": "ramp", "distance": 0.03, "duration": 0.5}),
    )
    assert run["force"].max() > 1 and abs(run["tip"] - TIP).max() < 0.1
    assert abs(run["qd"][-1]).max() < 0.05


@pytest.mark.parametrize("rotors", [False, True])
def test_the_observer_finds_the_push(rotors: bool) -> None:
    """Held by springs: once at rest the residual is J^T f, and the estimate f."""
    arm = {**ARM, "rotor3": {"inertia": 2e-4, "ratio": 60.0, "mass": 0.4, "axis": [1.0, 0.1, -0.2]}} if rotors else ARM
    push = np.array([8.0, -5.0, 6.0])
    run = run_with({"type": "joint_pd"}, arm, stop=6.0, push={"force": push.tolist()}, observer={})
    due = transpose(Truth(arm).jacobian(run["q"][-1])) @ push
    assert abs(run["qd"][-1]).max() < 1e-5
    assert abs(run["residual"][-1] - due).max() <= 1e-3 * abs(due).max()
    assert abs(run["f_estimate"][-1] - push).max() <= 0.02


def test_an_observer_of_another_model_takes_its_weight_for_a_force() -> None:
    """At rest r = tau_g of the model - tau_g of the arm."""
    model = {"link2": {"mass": 5.0}, "payload": {"mass": 0.7}}
    wrong = {**ARM, "link2": {**ARM["link2"], "mass": 5.0}, "payload": model["payload"]}
    run = run_with({"type": "joint_pd", "model": model}, stop=6.0, observer={})
    q = run["q"][-1]
    assert abs(run["qd"][-1]).max() < 1e-5
    due = Truth(wrong).gravity_torque(q) - Truth(ARM).gravity_torque(q)
    assert abs(run["residual"][-1] - due).max() <= 1e-3 * abs(due).max()


def test_the_observer_needs_the_momentum_of_the_coupling() -> None:
    """No force acts on an arm that swings freely: its residual stays at the size of rounding, whatever is coupled."""
    arm = {**ARM, "rotor3": {"inertia": 2e-3, "ratio": 60.0, "mass": 0.4, "axis": [1.0, 0.1, -0.2]}}
    initial = {"q": BENT.tolist(), "qd": [1.0, -0.8, 1.2]}
    run = run_with({"type": "gravity_compensation"}, arm, stop=1.0, initial=initial, observer={})
    assert abs(run["residual"]).max() <= 1e-6


def test_the_estimator_finds_the_stiffness() -> None:
    """A force that swings on a wall that stands: without noise the least squares leave a thousandth."""
    force = {"type": "sinusoid", "value": 20.0, "amplitude": 10.0, "frequency": 1.5}
    wall = plate(contact={"law": "spring", "stiffness": 1500})
    run = run_with({"type": "hybrid"}, wall=wall, reference={"force": force}, estimator={"wall": "fixed"})
    identified = run["identifiable"] == 1
    assert identified[-1]
    assert run["stiffness_estimate"][-1] == pytest.approx(1500, rel=1e-3)


def test_torques_stay_within_their_limits() -> None:
    limit = np.array([3.0, 30.0, 8.0])
    arm = {**ARM, "torque_limit": limit.tolist()}
    reference = {"type": "minimum_jerk", "q": (BENT + np.array([0.9, -0.6, 0.8])).tolist(), "duration": 0.2}
    run = run_with({"type": "computed_torque"}, arm, stop=0.5, reference=reference)
    assert np.all(abs(run["tau"]) <= limit) and run["saturated"].any()
    assert (abs(run["tau"]) == limit).any(axis=0)[0]


def test_beside_its_outline_a_plate_is_not_there() -> None:
    """The tip falls past a plate that it would hit if this were larger."""
    across = np.cross(NORMAL, [0, 0, 1])
    beside = (TIP - 0.01 * NORMAL + 0.3 * across / np.linalg.norm(across)).tolist()
    initial = {"q": BENT.tolist(), "qd": (-0.5 * np.linalg.solve(Truth(ARM).jacobian(BENT), NORMAL)).tolist()}
    law = {"type": "gravity_compensation"}
    hit = run_with(law, stop=0.3, wall=plate(point=beside, size=[1.0, 1.0]), initial=initial)
    missed = run_with(law, stop=0.3, wall=plate(point=beside, size=[0.4, 1.0]), initial=initial)
    assert hit["contact"].any() and not missed["contact"].any()


def test_the_sensors_of_the_tip_agree() -> None:
    """The position differentiated, J times the rates and the recursion: three ways to one velocity."""
    initial = {"q": BENT.tolist(), "qd": [1.0, -0.8, 1.2]}
    run = run_with({"type": "none"}, stop=0.5, initial=initial)
    truth = Truth(ARM)
    assert abs(run["tip"] - truth.tip_position(run["q"])).max() <= 1e-13
    assert abs(run["tip_v"] - run["tip_jv"]).max() <= 1e-12
    assert abs(run["tip_v"] - run["tip_dv"])[1:-1].max() <= 1e-5


@pytest.mark.parametrize("convention", ["slide", "simscape", "urdf"])
def test_a_law_of_the_users_own_speaks_the_convention_of_the_arm(convention: str) -> None:
    """Angles, rates, Jacobian and weight that it reads, and the torque that it writes."""
    arm = told_in(ARM, convention, sign=[-1, 1, -1], zero=[0.4, -0.7, 1.1]) if ARM.get("model") == "elbow" else ARM
    start, truth = joint_angles(arm, inner_angles(ARM, BENT)), Truth(arm)
    target, wrong = start + np.array([0.1, -0.2, 0.3]), set()

    def law(t: float, state: Any) -> np.ndarray:
        q, qd = np.array(state.q), np.array(state.qd)
        if state.tick % 50 == 7:
            J = truth.jacobian(q)
            due = {
                "tip": truth.tip_position(q),
                "tip_velocity": J @ qd,
                "jacobian": J,
                "tau_g": truth.gravity_torque(q),
            }
            wrong.update(name for name, value in due.items() if abs(getattr(state, name) - value).max() > 1e-11)
        return state.tau_g + 40 * (target - q) - 8 * qd

    scenario = scenario_of(
        arm,
        initial={"q": start.tolist()},
        controller={"type": "user"},
        sampling={"rate": 500},
        time={"stop": 3.0},
    )
    run = scenario.run(controller=law)
    assert not wrong
    assert abs(run["q"][-1] - target).max() <= 1e-2


def test_the_executable_and_a_file_have_the_same_bits(cli: Any, tmp_path: Path) -> None:
    start = {"q": BENT.tolist(), "qd": [1.0, -0.8, 1.2]}
    scenario = scenario_of(ARM, initial=start, controller={"type": "none"}, time={"stop": 0.2})
    (tmp_path / "s.yaml").write_text(scenario.to_yaml())
    done = cli("run", tmp_path / "s.yaml", "-o", tmp_path / "run.csv")
    assert done.returncode == 0, done.stderr
    ours, theirs = scenario.run(), arm3r.Run.load(tmp_path / "run.csv")
    for name in ours.columns:
        assert np.array_equal(ours[name], theirs[name]), name
