"""The benchmarks of force control in their variants: whole curves against closed forms, and against a simulation of
another make where there is none."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import arm3r_cpp as arm3r
import numpy as np
import pytest
from force_control_oracles import LECTURE_CONTACT, QA, SETTINGS, XA, Arm, Run, impact, linear, run_of, statics, varied
from force_scenarios import FILES, D, mirrored, read
from scipy.linalg import expm

PI = {"f_d": 20.0, "kP": 0.5, "kI": 5.0, "m_f": 1.0, "b": 70.0}
M_N = 0.5535415113

Changes = dict[str, Any]
in_both_conventions = pytest.mark.parametrize("convention", ["slide", "simscape"])


def scenario_of(name: str, changes: Changes, *, convention: str = "slide") -> arm3r.Scenario:
    """The scenario of this name with other values; its angles are those of the slide convention."""
    scenario = read(name, changes)
    return scenario if convention == "slide" else mirrored(scenario)


def finished(scenario: arm3r.Scenario) -> arm3r.Run:
    run = scenario.run()
    assert run.outcome == "ok"
    assert run.summary["ledger_residual"] <= 1e-7
    return run


def run_named(name: str, changes: Changes | None = None, *, convention: str = "slide") -> arm3r.Run:
    return finished(scenario_of(name, changes or {}, convention=convention))


def close(value: Any, abs: float) -> Any:
    return pytest.approx(value, abs=abs, rel=0)


@pytest.mark.parametrize("name", FILES)
def test_every_balance_of_energy_closes(name: str) -> None:
    run = finished(arm3r.Scenario.load(FILES[name]))
    assert np.abs(run["energy_residual"]).max() <= 1e-7


# ---- against a simulation of another make ---------------------------------------------------------------------------


def near_balance(k: float) -> Changes:
    """The tip 0.1 mm deeper than where the admittance balances on a wall k."""
    balance = [XA[0] + 10 / (200 + k), 0, 0]
    return {
        "initial.q": Arm().reach([balance[0] + 1e-4, 0, 0]),
        "wall.contact.stiffness": k,
        "reference.tip": balance,
        "reference.force.value": 10 * k / (200 + k),
    }


class Case(NamedTuple):
    file: str
    setting: str
    changes: Changes = {}  # noqa: RUF012
    tip: float = 1e-9  # m
    force: float = 1e-6  # N
    until: float | None = None  # s: where it has settled, and statics or closed forms say the rest


WITHOUT_INTEGRAL = {"controller.force_integral_gain": 0}
COMPENSATED = {
    "controller.compensate_gravity": True,
    "initial.q": [0.1, 0.4, -0.9],
    "reference": {"type": "point", "q": QA},
}
INSTABILITY_DYNAMIC = {"controller.variant": "dynamic", "controller.position_gain": 25, "controller.velocity_gain": 10}
CASES = [
    Case("energy_balance", "energy balance", tip=1e-7, force=1e-3),
    Case("restitution", "restitution", force=1e-4),
    Case("joint_pd_sag", "joint PD sag", until=2.0),
    Case("joint_pd_sag", "joint PD with gravity compensation", COMPENSATED, until=2.0),
    Case("computed_torque", "computed torque"),
    Case("computed_torque_push", "computed torque push", until=2.0),
    Case("stiffness_fixed_wall", "stiffness fixed wall", until=0.4),
    Case("stiffness_moving_wall", "stiffness moving wall", until=5.8),
    *(
        Case(
            "joint_stiffness_fixed_wall",
            f"joint stiffness {mm} mm",
            {"initial.q": Arm().reach([1.70 + mm / 1000, 0, 0])},
            force=1e-5,
            until=0.4,
        )
        for mm in (50.0, 5.0, 0.5)
    ),
    Case("shaped_impedance_step", "shaped impedance step"),
    Case("impedance_step", "impedance step"),
    Case("admittance_stability_limit", "admittance below the limit", until=1.0),
    Case("admittance_stability_limit", "admittance above the limit", near_balance(1483.2), until=1.0),
    Case("admittance_stability_limit", "admittance soft wall", near_balance(200.0), until=1.0),
    Case("hybrid_moving_wall", "hybrid moving wall", until=1.0),
    Case("hybrid_moving_wall", "hybrid moving wall, kI 0", WITHOUT_INTEGRAL, until=1.0),
    Case("hybrid_first_contact", "hybrid first contact", force=1e-5, until=6.4),
    Case("hybrid_first_contact", "hybrid first contact, kI 0", WITHOUT_INTEGRAL, force=1e-5, until=6.4),
    Case("hybrid_biased_sensor", "hybrid biased sensor", until=1.0),
    Case("hybrid_jacobian_transpose", "hybrid Jacobian transpose", until=1.0),
    Case("hybrid_kinematic_instability", "instability raibert_craig", tip=1e-10),
    Case("hybrid_kinematic_instability", "instability projected", {"controller.variant": "projected"}, tip=1e-13),
    Case("hybrid_kinematic_instability", "instability dynamic", INSTABILITY_DYNAMIC, tip=1e-13),
]


@cache
def simulated(setting: str, until: float | None) -> Run:
    loose = setting.startswith("energy balance")
    atol = 1e-16 if setting.startswith("instability") else 1e-12
    known = SETTINGS[setting]
    return run_of(varied(known, stop=until or known["stop"]), rtol=1e-8 if loose else 1e-10, atol=atol)


@pytest.mark.sample(8)
@in_both_conventions
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.setting)
def test_the_whole_run_is_that_of_another_simulation(case: Case, convention: str) -> None:
    run, other = run_named(case.file, case.changes, convention=convention), simulated(case.setting, case.until)
    first = SETTINGS[case.setting].get("start", 0.0)
    rows = np.flatnonzero((run.t >= first) & (run.t <= other.end))
    rows = rows[:: max(1, len(rows) // 100)]
    assert len(rows) >= 40
    assert run["tip"][rows] == close(other.tips(run.t[rows]), case.tip)
    if other.wall:
        forces = [other.force(t) for t in run.t[rows]]
        assert run["f_on_tip"][rows] == close(np.array(forces), case.force)
        assert np.abs(forces).max() > 1e-3


# ---- restitution, and the plate's edge ------------------------------------------------------------------------------

TURNING = """
format: 1
arm: {convention: slide, gravity: [0, 0, 0], armature: [0.3, 1e9, 1e9]}
initial: {q: [0.4, 0.5, -1.2]}
controller: {type: none}
solver: {rtol: 1e-12, atol: 1e-16}
time: {stop: 1, log_every: 1}
wall: {size: infinite, motion: {type: fixed}, acts_on_arm: true}
"""


def bounced(contact: Changes, speed: float) -> tuple[float, arm3r.Run]:
    """Only joint 1 turns, by 1e-5 rad: a mass on a line. Its speed after a wall over that before."""
    pose = [0.4, 0.5, -1.2]
    s = Arm().at(pose)
    across, reach = s.J[:, 0] / np.linalg.norm(s.J[:, 0]), np.linalg.norm(s.J[:, 0])
    scenario = arm3r.Scenario(TURNING)
    scenario["initial.qd"] = [speed / reach, 0, 0]
    scenario["wall.normal"] = -across
    scenario["wall.point"] = s.x + 1e-7 * across
    scenario["wall.contact"] = contact
    scenario["time.stop"] = 0.02
    run = finished(scenario)
    assert [event.type for event in run.events] == ["make", "break"]
    assert run.summary["peak_force"] > 0.1
    return -run["qd1"][-1] / run["qd1"][0], run


def mass_across() -> float:
    """kg, that the same arm shows across: its axis with the rotor 0.3 kg m^2, over the square of the reach."""
    s = Arm(armature=(0.3, 0, 0)).at([0.4, 0.5, -1.2])
    return s.M[0, 0] / (s.J[:, 0] @ s.J[:, 0])


@pytest.mark.parametrize("zeta", [0.02, 0.1, 0.3, 0.8, 1.0, 2.5])
def test_restitution_of_a_damped_spring(zeta: float) -> None:
    k = 1e7
    damping = 2 * zeta * np.sqrt(k * mass_across())
    e, run = bounced({"law": "kelvin_voigt", "stiffness": k, "damping": damping}, 0.1)
    assert e == close(impact.kelvin_voigt_restitution(zeta), 1e-8)
    assert run.summary["peak_force"] == pytest.approx(impact.kelvin_voigt_peak(zeta, k, mass_across(), 0.1), rel=1e-7)


@pytest.mark.parametrize("y", [0.05, 0.3, 1.0, 3.0])
@pytest.mark.parametrize("p", [1.0, 1.5, 2.2])
def test_restitution_of_hunt_and_crossley(y: float, p: float) -> None:
    k, speed = 10 ** (5.0 * p + 2.0), 0.1
    contact = {"law": "hunt_crossley", "stiffness": k, "exponent": p, "dissipation": y / speed}
    assert bounced(contact, speed)[0] == close(impact.hunt_crossley_restitution(y), 1e-8)


@pytest.mark.parametrize("e", [0.135335283, 0.45, 0.9])
@pytest.mark.parametrize(
    "law",
    [{"law": "kelvin_voigt", "stiffness": 1e7}, {"law": "hunt_crossley", "stiffness": 3e9, "impact_speed": 0.1}],
    ids=lambda law: law["law"],
)
def test_a_restitution_that_was_asked_for(law: Changes, e: float) -> None:
    assert bounced({**law, "restitution": e}, 0.1)[0] == close(e, 1e-8)


def leaving_over_coming(run: arm3r.Run) -> float:
    """Of the tip along x, relative to the lecture's wall."""
    before, after = (0.05 + Arm().at(event.q, event.qd).xd[0] for event in run.events)
    return -after / before


def test_an_arm_is_a_free_mass_to_a_hard_wall() -> None:
    gaps = []
    for k in (1e7, 1e9):
        e = leaving_over_coming(run_named("restitution", {"wall.contact.stiffness": k, "time.log_every": 0.1}))
        gaps.append(e - impact.hunt_crossley_restitution(0.3))
        if k == 1e7:
            assert e == close(0.833439, 1e-6)
    assert 1e-5 < gaps[1] < 0.2 * gaps[0] < 0.2e-3


HELD = {"arm.armature": [1e12, 1e12, 1e12], "wall.acts_on_arm": True}


@pytest.mark.parametrize("across", [[0, 1, 0], [0, 0, 1], [0, -0.6, 0.8]])
@pytest.mark.parametrize("acts", [False, True])
def test_a_plate_edge_takes_the_energy_of_the_dent(across: list[float], acts: bool) -> None:
    run = run_named("plate_edge", {"wall.motion.direction": across, **(HELD if acts else {})})
    leaves = 0.5 / max(np.abs(across)) / 0.1
    if leaves < 5.5:
        (make, leave) = run.events
        assert (make.t, leave.t) == (0, close(leaves, 1e-8))
    before, after = run.t < leaves - 1e-6, run.t > leaves + 1e-6
    force, elastic = np.linalg.norm(run["f_on_wall"], axis=1), 1e4 * 0.002**2 / 2 if acts else 0.0
    assert force[before] == close(20.0, 1e-5 if acts else 1e-9)
    assert run["energy_contact"][before] == close(elastic, 1e-7)
    if leaves < 5.5:
        assert not force[after].any()
        assert not run["energy_contact"][after].any()
        assert run["energy_dissipated"][after] == close(elastic, 1e-7)
    assert run["energy_dissipated"][before] == close(0.0, 1e-12)


# ---- joint PD, computed torque --------------------------------------------------------------------------------------


@in_both_conventions
def test_computed_torque_tracks_a_sine_after_a_rough_start(convention: str) -> None:
    """From rest where the sine is moving already: e = e'(0) t exp(-10 t), e'(0) its rate at first."""
    size, w = np.array([0.3, -0.2, 0.4]), 2 * np.pi * 0.7
    signs = D if convention == "simscape" else 1
    scenario = scenario_of(
        "computed_torque",
        {"reference": {"type": "sinusoid", "q_amplitude": size, "frequency": 0.7}},
        convention=convention,
    )
    run = finished(scenario)
    wanted = scenario["initial.q"] + np.multiply.outer(np.sin(w * run.t), signs * size)
    assert run["q_ref"] == close(wanted, 1e-12)
    left = np.multiply.outer(run.t * np.exp(-10 * run.t), signs * size * w)
    assert wanted - run["q"] == close(left, 1e-8)
    assert np.abs(left).max() > 0.03


@pytest.mark.parametrize("gain", [50.0, 100.0, 400.0])
@pytest.mark.parametrize("push", [[-10, 4, 3], [3, -5, 8]])
def test_computed_torque_yields_by_inertia_times_gain(push: list[float], gain: float) -> None:
    changes = {
        "controller.position_gain": gain,
        "controller.velocity_gain": 2 * np.sqrt(gain),
        "push.force": push,
        "time.stop": 8.0,
    }
    end = Arm().at(run_named("computed_torque_push", changes)["q"][-1])
    assert end.q == close(statics.computed_torque_rest(gain, QA, push).q, 1e-8)
    assert end.M @ (gain * (QA - end.q)) == close(-end.J.T @ push, 1e-6)


# ---- along an oblique wall, by an arm of unequal links: the linear loops --------------------------------------------

LINKS = (0.8, 0.55)
POSE = [0.4, 0.7, -1.3]
NORMAL = np.array([-0.8, -0.3, 0.52]) / np.linalg.norm([-0.8, -0.3, 0.52])
OBLIQUE = """
format: 1
arm: {convention: slide, base_height: 0.3, armature: [0.02, 0.03, 0.01],
  link2: {length: 0.8, section: [0.02, 0.03]}, link3: {length: 0.55, shape: cylinder, radius: 0.015}}
wall: {size: infinite, acts_on_arm: true}
solver: {rtol: 1e-10, atol: 1e-13}
time: {stop: 2, log_every: 0.01}
"""


def oblique(
    *, k: float, depth: float, v: float, law: Changes, reference: Changes, convention: str, stop: float = 2.0
) -> arm3r.Run:
    scenario = arm3r.Scenario(OBLIQUE)
    scenario["initial.q"] = POSE
    scenario["wall.point"] = start() + depth * NORMAL
    scenario["wall.normal"] = NORMAL
    scenario["wall.motion"] = {"type": "constant", "velocity": v}
    scenario["wall.contact.stiffness"] = k
    scenario["controller"] = law
    scenario["reference"] = reference
    scenario["time.stop"] = stop
    return finished(scenario if convention == "slide" else mirrored(scenario))


def start() -> np.ndarray:
    return np.add(Arm(lengths=LINKS).at(POSE).x, [0, 0, 0.3])


def assert_linear(run: arm3r.Run, loop: linear.Loop, *, k: float, depth: float, v: float) -> None:
    """The force is the loop's, and the tip moves along the normal only, as far as the force and the wall say."""
    forces = loop.forces(run.t)
    assert run["force"] == close(forces, 1e-6)
    assert run["f_on_tip"] == close(np.multiply.outer(forces, NORMAL), 1e-6)
    along = depth + v * run.t - forces / k
    assert run["tip"] - start() == close(np.multiply.outer(along, NORMAL), 1e-9)
    assert np.ptp(forces) > 1


HYBRIDS = {
    "as in the scenario": PI,
    "no integral": PI | {"kI": 0.0},
    "heavy": {"f_d": 35.0, "kP": 0.8, "kI": 12.0, "m_f": 2.5, "b": 90.0},
    "slow": {"f_d": 12.0, "kP": 0.1, "kI": 0.4, "m_f": 1.0, "b": 30.0},
}


def force_law(kind: str, gains: dict[str, float]) -> Changes:
    return {
        "type": kind,
        "force_mass": gains["m_f"],
        "force_damping": gains["b"],
        "force_gain": gains["kP"],
        "force_integral_gain": gains["kI"],
    }


@in_both_conventions
@pytest.mark.parametrize("v", [0.0, 0.05, -0.01])
@pytest.mark.parametrize("gains", HYBRIDS.values(), ids=HYBRIDS)
@pytest.mark.parametrize("kind", ["hybrid", "operational_space"])
def test_the_force_loop_of_hybrid_control(kind: str, gains: dict[str, float], v: float, convention: str) -> None:
    k, depth = 5000.0, 0.003
    loop = linear.hybrid_loop(**gains, k=k, v=v, u0=depth)
    reference = {"type": "hold", "force": {"value": gains["f_d"]}}
    law = force_law(kind, gains)
    run = oblique(k=k, depth=depth, v=v, law=law, reference=reference, convention=convention)
    assert_linear(run, loop, k=k, depth=depth, v=v)
    assert loop.settled == close(gains["f_d"] + (0 if gains["kI"] else gains["b"] * v / gains["kP"]), 1e-9)


@in_both_conventions
@pytest.mark.parametrize("gains", [(400.0, 40.0), (900.0, 20.0)])
@pytest.mark.parametrize("kind", ["hybrid", "operational_space"])
def test_across_the_wall_position_has_a_loop_of_its_own(kind: str, gains: tuple[float, float], convention: str) -> None:
    """The force does not notice that the tip goes 10 cm along the face meanwhile."""
    k, depth, v = 5000.0, 0.003, 0.05
    (K, damping), way = gains, 0.1 * np.cross(NORMAL, [0.6, 0.0, 0.8])
    loop = linear.hybrid_loop(**PI, k=k, v=v, u0=depth)
    law = force_law(kind, PI) | {"position_gain": K, "velocity_gain": damping}
    reference = {"type": "point", "tip": start() + way, "force": {"value": 20.0}}
    run = oblique(k=k, depth=depth, v=v, law=law, reference=reference, convention=convention)
    assert run["force"] == close(loop.forces(run.t), 1e-6)
    A = np.array([[0, 1], [-K, -damping]])
    left = np.array([(expm(A * t) @ [1, 0])[0] for t in run.t])
    off = run["tip"] - start()
    across = off - np.multiply.outer(off @ NORMAL, NORMAL)
    assert across == close(np.multiply.outer(1 - left, way), 1e-8)


@in_both_conventions
@pytest.mark.parametrize("gains", [(2.0, 40.0, 200.0), (0.7, 15.0, 900.0), (5.0, 250.0, 50.0)])
@pytest.mark.parametrize("kind", ["shaped_impedance", "admittance"])
def test_the_loop_of_a_shaped_impedance(kind: str, gains: tuple[float, float, float], convention: str) -> None:
    """An admittance over an exact inner loop is the same; it starts where it wants to be, pushed by a wanted force."""
    (M, B, K), k, ahead = gains, 1000.0, 0.05
    loop = linear.impedance_loop(M, B, K, k=k, ahead=ahead)
    law = {"type": kind, "mass": M, "damping": B, "stiffness": K}
    reference: Changes = {"type": "point", "tip": start() - ahead * NORMAL}
    if kind == "admittance":
        law["inner"], reference = "exact", {"type": "hold", "force": {"value": K * ahead}}
    run = oblique(k=k, depth=0.0, v=0.0, law=law, reference=reference, convention=convention)
    assert_linear(run, loop, k=k, depth=0.0, v=0.0)


@pytest.mark.parametrize(
    "slip",
    [
        {"gravity": 9.81},
        {"model": {"link3": {"mass": 3.1}}},
        {"model": {"link2": {"length": 0.801}}},
        {"model": {"armature": [0.02, 0.031, 0.01]}},
    ],
    ids=["gravity", "mass", "length", "rotor"],
)
def test_the_force_loop_sees_a_small_error_of_the_model(slip: Changes) -> None:
    loop = linear.hybrid_loop(**PI, k=5000.0, v=0.05, u0=0.003)
    law = force_law("hybrid", PI) | slip
    reference = {"force": {"value": 20.0}}
    run = oblique(k=5000.0, depth=0.003, v=0.05, law=law, reference=reference, convention="slide")
    assert np.abs(run["force"] - loop.forces(run.t)).max() > 1e-4
    off = run["tip"] - start()
    assert np.linalg.norm(off - np.outer(off @ NORMAL, NORMAL), axis=1).max() > 1e-8


@pytest.mark.parametrize(
    ("solver", "off"),
    [
        ({"method": "rodas4", "rtol": 1e-9, "atol": 1e-12}, 1e-6),
        ({"method": "auto", "rtol": 1e-10, "atol": 1e-13}, 1e-6),
        ({"method": "rk4", "step": 1e-4}, 1e-6),
        ({"method": "dopri5", "rtol": 1e-6, "atol": 1e-9}, 1e-2),
    ],
    ids=["rodas4", "auto", "rk4", "rough"],
)
def test_hybrid_control_by_every_method(solver: Changes, off: float) -> None:
    loop = linear.hybrid_loop(**PI, k=5000.0, v=0.05, u0=0.004)
    run = scenario_of("hybrid_moving_wall", {"solver": solver}).run()
    assert run["force"] == close(loop.forces(run.t), off)
    assert run.summary["peak_force"] == close(loop.peak(0.5)[1], off)


# ---- Cartesian stiffness --------------------------------------------------------------------------------------------


@in_both_conventions
@pytest.mark.parametrize("ahead", [0.001, 0.01, 0.05, 0.15])
@pytest.mark.parametrize("K", [200.0, 500.0])
@pytest.mark.parametrize("kind", ["stiffness", "impedance"])
def test_stiffness_control_is_series_springs_at_any_displacement(
    kind: str, K: float, ahead: float, convention: str
) -> None:
    law = {"type": kind, "stiffness": K, "damping": 100}
    reference = {"type": "point", "tip": start() - ahead * NORMAL}
    k = 5000.0
    run = oblique(k=k, depth=0.0, v=0.0, law=law, reference=reference, convention=convention, stop=8.0)
    assert run["force"][-1] == close(statics.series_force(K, k, ahead), 1e-6)
    assert run["tip"][-1] - start() == close(-ahead * K / (K + k) * NORMAL, 1e-9)


@pytest.mark.parametrize("v", [0.05, 0.02])
@pytest.mark.parametrize("K, damping", [(500.0, 100.0), (200.0, 150.0)])
def test_stiffness_control_on_a_wall_that_comes(K: float, damping: float, v: float) -> None:
    changes = {
        "wall.motion.velocity": v,
        "wall.point": [1.75, 0, 0],
        "controller.stiffness": K,
        "controller.damping": damping,
        "time.stop": 3.0,
    }
    run = run_named("stiffness_moving_wall", changes)
    ahead = XA[0] - (1.75 - v * run.t)
    late = run.t > 2
    expected = statics.moving_series_force(K, damping, 5000.0, v, ahead[late])
    assert run["force"][late] == pytest.approx(expected, rel=1e-4)
    assert run["force"][late] != pytest.approx(statics.series_force(K, 5000.0, ahead[late]), rel=1e-2)


@in_both_conventions
@pytest.mark.parametrize(("mm", "percent"), [(50.0, -10.236), (5.0, -0.9563), (0.5, -0.0950)])
def test_joint_stiffness_holds_near_its_pose(mm: float, percent: float, convention: str) -> None:
    q = Arm().reach([1.70 + mm / 1000, 0, 0])
    run = run_named("joint_stiffness_fixed_wall", {"initial.q": q}, convention=convention)
    force = run["force"][-1]
    assert 100 * (force / statics.series_force(500.0, 5000.0, mm / 1000) - 1) == close(percent, 0.01)
    rest = statics.joint_stiffness_rest(500.0, q, x_E=1.70, k=5000.0)
    assert force == close(5000.0 * (rest.x[0] - 1.70), 1e-6)


# ---- impedance and admittance ---------------------------------------------------------------------------------------


@in_both_conventions
@pytest.mark.parametrize("damping", [5.0, 40.0])
def test_the_energy_of_an_impedance_never_rises(damping: float, convention: str) -> None:
    run = run_named("impedance_step", {"controller.damping": damping}, convention=convention)
    off = run["tip"] - [XA[0] + 0.05, 0, 0]
    storage = run["energy_kinetic"] + 100 * (off**2).sum(axis=1) + run["energy_contact"]
    assert np.diff(storage).max() <= 1e-12
    assert storage[0] == close(0.25, 1e-12)
    assert storage[-1] < 0.25 - 0.04


@pytest.mark.parametrize("k, amplitude", [(1396.8, 2.7e-5), (1483.2, 1.59e-4)])
@in_both_conventions
def test_admittance_decays_or_grows(k: float, amplitude: float, convention: str) -> None:
    run = run_named("admittance_stability_limit", near_balance(k), convention=convention)
    loop = linear.admittance_loop(2, 40, 200, 50, 1, k=k, ahead=0.05, off=1e-4)
    assert run["force"] == close(loop.forces(run.t), 1e-6)
    late = np.abs(run["force"][run.t > 5] - loop.settled).max() / k
    assert late == pytest.approx(amplitude, rel=0.02)
    assert (late > 1e-4) == (k > linear.admittance_limit(2, 40, 200, 50, 1)[0])


def test_admittance_settles_on_a_soft_wall() -> None:
    changes = {"wall.contact.stiffness": 200, "reference": {"type": "point", "tip": [XA[0] + 0.05, 0, 0]}}
    run = run_named("admittance_stability_limit", {**changes, "initial.q": QA})
    assert run["force"][-1] == close(5.0, 1e-6)
    assert run["tip"][-1] == close([XA[0] + 0.025, 0, 0], 1e-8)


# ---- hybrid position/force ------------------------------------------------------------------------------------------


@in_both_conventions
@pytest.mark.parametrize(("kI", "settled", "poles"), [(0.0, 27.0, 2), (5.0, 20.0, 3)])
def test_hybrid_from_first_contact_on(kI: float, settled: float, poles: int, convention: str) -> None:
    run = run_named("hybrid_first_contact", {"controller.force_integral_gain": kI}, convention=convention)
    assert [event.t for event in run.events] == [close(LECTURE_CONTACT, 1e-9)]
    loop = linear.hybrid_loop(**PI | {"kI": kI}, k=5000.0, v=0.05, u0=0.0)
    after = run.t > LECTURE_CONTACT
    assert run["force"][after] == close(loop.forces(run.t[after] - LECTURE_CONTACT), 1e-6)
    assert not run["force"][~after].any()
    assert (loop.settled, len(loop.poles)) == (close(settled, 1e-9), poles)
    assert run["tip"][-1] == close([1.4 + settled / 5000, 0, 0], 1e-9)
    in_balance = run_named("hybrid_moving_wall", {"controller.force_integral_gain": kI})
    assert run.summary["peak_force"] == close(loop.peak(0.5)[1], 1e-6)
    assert run.summary["peak_force"] > in_balance.summary["peak_force"]


def test_hybrid_goes_for_the_wall_at_a_speed_of_its_own() -> None:
    """From the start on, `always`: kP f_d/b in free space, then the force loop from that speed."""
    gap, kP, b = 0.02, 0.5, 70.0
    changes = {"wall.point": [XA[0] + gap, 0, 0], "wall.motion": {"type": "fixed"}, "time.stop": 1.0}
    run = run_named(
        "hybrid_first_contact", {**changes, "controller.switching": "always", "controller.force_integral_gain": 0}
    )
    speed = kP * 20 / b
    come = speed * (run.t - (1 - np.exp(-b * run.t)) / b)
    (make,) = run.events
    before, after = run.t < make.t, run.t > make.t
    assert run["tip_x"][before] - XA[0] == close(come[before], 1e-9)
    arrived = speed * (make.t - (1 - np.exp(-b * make.t)) / b)
    assert arrived == close(gap, 1e-9)
    loop = linear.hybrid_loop(**PI | {"kI": 0.0}, k=5000.0, u0=0.0, sd0=speed * (1 - np.exp(-b * make.t)))
    assert run["force"][after] == close(loop.forces(run.t[after] - make.t), 1e-6)


@pytest.mark.parametrize("bias", [1.5, -4.0])
@pytest.mark.parametrize("ideal", [True, False])
def test_hybrid_with_a_biased_sensor(bias: float, ideal: bool) -> None:
    """The force is short of the bias; where the read force is cancelled, the tip yields across too."""
    changes = {"sensors.force.bias": [-bias, 0, 0], "controller.ideal_cancellation": ideal}
    run = run_named("hybrid_biased_sensor", changes)
    assert run["force"][-1] == close(20 - bias, 1e-6)
    assert run["force_measured"][-1] == close(20, 1e-6)
    end = Arm().at(run["q"][-1])
    aside = 0.0 if ideal else end.mobility[2, 0] * bias / 400
    assert run["tip_z"][-1] == close(aside, 1e-8)
    assert ideal or abs(aside) > 5e-3


@pytest.mark.parametrize("gains", [(1.0, 20.0, 70.0), (2.0, 30.0, 100.0)])
def test_hybrid_by_the_transposed_jacobian(gains: tuple[float, float, float]) -> None:
    kP, kI, b = gains
    changes = {
        "controller.force_gain": kP,
        "controller.force_integral_gain": kI,
        "controller.force_damping": b,
        "time.stop": 6.0,
    }
    run = run_named("hybrid_jacobian_transpose", changes)
    assert run["force"][-1] == close(20, 1e-3)
    assert np.abs(run["tip_z"]).max() > 1e-4
    moved = run["tip_x"][-1] - run["tip_x"][-101]
    assert moved == close(-0.05, 1e-6)


# ---- instability of J^-1 S_p, invariance ----------------------------------------------------------------------------


@in_both_conventions
def test_kinematic_instability_grows_at_the_linear_rate(convention: str) -> None:
    run = run_named("hybrid_kinematic_instability", convention=convention)
    pose = np.deg2rad([0, -75, 45])
    s = Arm().at(pose)
    stiff = np.linalg.solve(s.M, np.linalg.solve(s.J, np.diag([1, 1, 0]) @ s.J))
    assert np.linalg.eigvals(stiff).real.min() == close(-0.4323820891, 1e-10)
    A = np.block([[np.zeros((3, 3)), np.eye(3)], [-25 * stiff, -10 * stiff]])
    assert np.linalg.eigvals(A).real.max() == close(6.097, 1e-3)
    first = np.concatenate([run["q"][0] * (D if convention == "simscape" else 1) - pose, np.zeros(3)])
    off = run["tip"] - run["tip_ref"]
    for row in (10, 30, 50):
        linear_off = s.J @ (expm(A * run.t[row]) @ first)[:3]
        assert off[row] == close(linear_off, 1e-3 * np.abs(linear_off).max())
    assert np.linalg.norm(off[-1]) > 1000 * np.linalg.norm(off[0])


@in_both_conventions
@pytest.mark.parametrize("variant", ["projected", "dynamic"])
def test_other_variants_of_hybrid_control_decay(variant: str, convention: str) -> None:
    changes = INSTABILITY_DYNAMIC if variant == "dynamic" else {"controller.variant": variant}
    run = run_named("hybrid_kinematic_instability", changes, convention=convention)
    off = run["tip_x"] - run["tip_ref_x"]
    assert abs(off[-1]) < 0.1 * off[0]
    assert np.abs(off).max() == close(1e-6, 1e-12)
    if variant == "dynamic":
        assert off == close(1e-6 * (1 + 5 * run.t) * np.exp(-5 * run.t), 1e-14)


def turned(scenario: arm3r.Scenario, angle: float) -> arm3r.Scenario:
    """Arm, wall and whatever has a direction, turned about the vertical."""
    R = rotation(angle)
    scenario["initial.q"] = np.add(scenario["initial.q"], [angle, 0, 0])
    vectors = (
        "wall.point",
        "wall.normal",
        "wall.motion.direction",
        "reference.tip",
        "push.force",
        "sensors.force.bias",
    )
    for key in vectors:
        if key.split(".")[0] in scenario and key in scenario:
            scenario[key] = R @ scenario[key]
    if "reference.q" in scenario:
        scenario["reference.q"] = np.add(scenario["reference.q"], [angle, 0, 0])
    return scenario


def rotation(angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


TURNED = [
    "energy_balance",
    "restitution",
    "computed_torque",
    "computed_torque_push",
    "stiffness_fixed_wall",
    "stiffness_moving_wall",
    "joint_stiffness_fixed_wall",
    "shaped_impedance_step",
    "impedance_step",
    "admittance_stability_limit",
    "hybrid_moving_wall",
    "hybrid_first_contact",
    "hybrid_biased_sensor",
    "hybrid_jacobian_transpose",
]


@pytest.mark.sample(5)
@pytest.mark.parametrize("name", TURNED)
def test_turned_by_37_degrees(name: str) -> None:
    angle, R = np.deg2rad(37), rotation(np.deg2rad(37))
    run = finished(scenario_of(name, {}))
    other = finished(turned(scenario_of(name, {}), angle))
    assert other["q"] == close(run["q"] + [angle, 0, 0], 1e-9)
    assert other["tip"] == close(run["tip"] @ R.T, 1e-9)
    if "force" in run:
        assert other["force"] == close(run["force"], 1e-7)
    assert other["f_on_tip"] == close(run["f_on_tip"] @ R.T, 1e-4 if name == "energy_balance" else 1e-6)


@pytest.mark.sample(5)
@pytest.mark.parametrize("name", [*TURNED, "hybrid_kinematic_instability", "hybrid_rotated"])
def test_both_conventions_move_the_tip_alike(name: str) -> None:
    slide, simscape = run_named(name), run_named(name, convention="simscape")
    assert simscape["tip"] == close(slide["tip"], 4e-11)
    assert simscape["f_on_tip"] == close(slide["f_on_tip"], 1e-6)
    assert simscape["q"] == close(D * slide["q"], 1e-10)
    assert simscape["tau"] == close(D * slide["tau"], 1e-6)
