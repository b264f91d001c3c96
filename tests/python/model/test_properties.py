"""What must hold for any arm and any scenario: symmetries, invariances, and the conventions' own formulas."""

from __future__ import annotations

from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest

D = np.array([1, -1, -1])


def arm_of(convention: str, **keys: Any) -> tuple[arm3r.Scenario, arm3r.Arm]:
    """An arm of unequal links; keys with __ for the dots."""
    scenario = arm3r.Scenario(f"""
format: 1
arm:
  convention: {convention}
  base_height: 0.3
  gravity: [1, -2, -9]
  link1: {{mass: 0.6, com: 0.1, inertia_axial: 0.02}}
  link2: {{length: 0.8, shape: brick, section: [0.03, 0.02], density: 2700}}
  link3: {{length: 0.6, shape: cylinder, radius: 0.02, density: 2700, com: 0.25}}
  armature: [0.02, 0.03, 0.01]
  payload: {{mass: 0.4}}
initial: {{q: [0.4, 0.7, -0.9], qd: [0.5, -0.4, 0.3]}}
time: {{stop: 2.0}}
""")
    for key, value in keys.items():
        scenario[key.replace("__", ".")] = value
    return scenario, scenario.arm


@pytest.fixture
def states() -> dict[str, np.ndarray]:
    rng = np.random.default_rng(5)
    return {name: rng.uniform(-size, size, (200, 3)) for name, size in [("q", 4), ("qd", 5), ("u", 20), ("f", 30)]}


# ---- the two conventions ---------------------------------------------------------------------------------------------


def test_conventions_are_each_other_mirrored(states: dict[str, np.ndarray]) -> None:
    q, qd, u, f = states.values()
    slide, simscape = arm_of("slide")[1], arm_of("simscape")[1]
    same = np.array_equal
    assert same(simscape.tip_position(q), slide.tip_position(D * q))
    assert same(simscape.elbow_position(q), slide.elbow_position(D * q))
    assert same(simscape.centres(q), slide.centres(D * q))
    assert same(simscape.geometric_jacobian(q), slide.geometric_jacobian(D * q) * D)
    assert same(simscape.jacobian_dot(q, qd), slide.jacobian_dot(D * q, D * qd) * D)
    assert same(simscape.mass_matrix(q), D[:, None] * slide.mass_matrix(D * q) * D)
    assert same(simscape.coriolis_matrix(q, qd), D[:, None] * slide.coriolis_matrix(D * q, D * qd) * D)
    assert same(simscape.velocity_product(q, qd), D * slide.velocity_product(D * q, D * qd))
    assert same(simscape.gravity_torque(q), D * slide.gravity_torque(D * q))
    for name in ("inverse_dynamics", "forward_dynamics", "recursion_inverse_dynamics", "recursion_forward_dynamics"):
        ours, mirrored = getattr(simscape, name), getattr(slide, name)
        assert same(ours(q, qd, u, f_on_tip=f), D * mirrored(D * q, D * qd, D * u, f_on_tip=f)), name
    assert same(simscape.energy(q, qd), slide.energy(D * q, D * qd))
    regular = q[simscape.manipulability(q) > 0.02]
    assert same(simscape.operational_space_inertia(regular), slide.operational_space_inertia(D * regular))
    tip = slide.tip_position(q)
    for front in (True, False):
        for elbow in ("up", "down"):
            options = {"front": front, "elbow": elbow}
            assert same(simscape.inverse_kinematics(tip, **options), D * slide.inverse_kinematics(tip, **options))


def test_simscape_has_the_formulas_of_the_lectures_code(states: dict[str, np.ndarray]) -> None:
    """In its own angles: M and C as in the slide's, the Jacobian's third row negated, joint axes turned round."""
    q, qd = states["q"], states["qd"]
    slide, simscape = arm_of("slide")[1], arm_of("simscape")[1]

    def close(a: np.ndarray, b: np.ndarray) -> bool:
        return np.allclose(a, b, rtol=0, atol=1e-12)

    rows = np.array([1, 1, -1])[:, None]
    assert close(simscape.mass_matrix(q), slide.mass_matrix(q))
    assert close(simscape.coriolis_matrix(q, qd), slide.coriolis_matrix(q, qd))
    assert close(simscape.jacobian(q), rows * slide.jacobian(q))
    assert close(simscape.jacobian_dot(q, qd), rows * slide.jacobian_dot(q, qd))
    sideways = np.stack([-np.sin(q[:, 0]), np.cos(q[:, 0]), 0 * q[:, 0]], axis=-1)
    angular = np.stack([np.broadcast_to([0, 0, 1], q.shape), sideways, sideways], axis=-1)
    assert close(simscape.geometric_jacobian(q)[:, 3:], angular)
    a2, a3 = 0.8, 0.6
    reach = a2 * np.cos(q[:, 1]) + a3 * np.cos(q[:, 1] + q[:, 2])
    assert close(np.linalg.det(simscape.jacobian(q)), a2 * a3 * np.sin(q[:, 2]) * reach)
    assert close(simscape.tip_position(q)[:, 2], 0.3 - a2 * np.sin(q[:, 1]) - a3 * np.sin(q[:, 1] + q[:, 2]))


def test_conventions_negate_the_gravity_torque_only_where_gravity_is_vertical(states: dict[str, np.ndarray]) -> None:
    q = states["q"]
    vertical = [arm_of(c, arm__gravity=[0, 0, -9.8])[1].gravity_torque(q) for c in ("slide", "simscape")]
    oblique = [arm_of(c)[1].gravity_torque(q) for c in ("slide", "simscape")]
    assert np.array_equal(vertical[0], -vertical[1])
    assert abs(oblique[0] + oblique[1]).max() > 1


# ---- the model ------------------------------------------------------------------------------------------------------


def test_gravity_torque_is_the_slope_of_the_potential_energy(states: dict[str, np.ndarray]) -> None:
    _, arm = arm_of("simscape")
    q, h = states["q"], 1e-5
    rises = [arm.energy(q + h * e, 0 * q)[1] - arm.energy(q - h * e, 0 * q)[1] for e in np.eye(3)]
    slope = np.stack(rises, axis=-1) / (2 * h)
    assert np.allclose(arm.gravity_torque(q), slope, rtol=0, atol=1e-8)


def test_operational_space_equation_is_that_of_the_joints(states: dict[str, np.ndarray]) -> None:
    _, arm = arm_of("simscape")
    q, qd, tau, f = (x[arm.manipulability(states["q"]) > 0.02] for x in states.values())
    J, inertia = arm.jacobian(q), arm.operational_space_inertia(q)

    def lifted(torque: np.ndarray) -> np.ndarray:
        return np.linalg.solve(J.swapaxes(1, 2), torque[..., None])[..., 0]

    def apply(matrix: np.ndarray, vector: np.ndarray) -> np.ndarray:
        return (matrix @ vector[..., None])[..., 0]

    drift = apply(arm.jacobian_dot(q, qd), qd)
    acceleration = apply(J, arm.forward_dynamics(q, qd, tau, f_on_tip=f)) + drift
    bias = lifted(arm.velocity_product(q, qd)) - apply(inertia, drift) + lifted(arm.gravity_torque(q))
    assert np.allclose(apply(inertia, acceleration) + bias, lifted(tau) + f, rtol=0, atol=1e-8)


def test_turning_arm_and_gravity_about_the_vertical_changes_nothing_else(states: dict[str, np.ndarray]) -> None:
    turn = np.deg2rad(37)
    R = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    q, qd, u, f = states.values()
    _, here = arm_of("simscape")
    _, there = arm_of("simscape", arm__gravity=(R @ [1, -2, -9]).tolist())
    turned = q + np.array([turn, 0, 0])
    assert np.allclose(there.gravity_torque(turned), here.gravity_torque(q), rtol=0, atol=1e-12)
    assert np.allclose(there.tip_position(turned), here.tip_position(q) @ R.T, rtol=0, atol=1e-12)
    accelerations = there.forward_dynamics(turned, qd, u, f_on_tip=f @ R.T), here.forward_dynamics(q, qd, u, f_on_tip=f)
    assert np.allclose(*accelerations, rtol=1e-11, atol=1e-9)


# ---- runs -----------------------------------------------------------------------------------------------------------


def juggled(convention: str, turn: float = 0.0) -> arm3r.Scenario:
    """A wall throws the arm about; everything turned about the vertical by `turn`."""
    c, s = np.cos(turn), np.sin(turn)
    R = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    scenario, _ = arm_of(convention, arm__gravity=[0, 0, -9.80665])
    scenario["controller"] = {"type": "gravity_compensation"}
    up = {"slide": 1, "simscape": -1}[convention]
    scenario["initial.q"] = [0.4 + turn, 0.7 * up, -0.9 * up]
    scenario["initial.qd"] = [0.0, 0.0, 0.0]
    scenario["wall"] = {
        "point": (R @ [1.25, 0.5, 0.4]).tolist(),
        "normal": (R @ [-0.8, -0.5, 0.3]).tolist(),
        "motion": {"type": "sinusoid", "amplitude": 0.3, "frequency": 0.8},
        "contact": {"law": "spring", "stiffness": 2000},
        "acts_on_arm": True,
    }
    return scenario


def test_both_conventions_take_the_tip_along_the_same_path() -> None:
    slide, simscape = juggled("slide").run(), juggled("simscape").run()
    assert slide.events
    for column in ("tip", "tip_v", "f_on_wall", "depth", "work_wall"):
        assert np.array_equal(slide[column], simscape[column]), column


def test_turning_arm_and_wall_about_the_vertical_turns_the_run() -> None:
    here, there = juggled("simscape").run(), juggled("simscape", turn=np.deg2rad(37)).run()
    assert [event.type for event in here.events] == [event.type for event in there.events] != []
    assert np.allclose(here["q"] + np.array([np.deg2rad(37), 0, 0]), there["q"], rtol=0, atol=1e-8)
    assert np.allclose(here["depth"], there["depth"], rtol=0, atol=1e-8)
    force = [np.linalg.norm(run["f_on_wall"], axis=1) for run in (here, there)]
    assert np.allclose(*force, rtol=0, atol=1e-4)


def test_a_conservative_swing_runs_backwards_to_its_start() -> None:
    scenario, _ = arm_of("simscape", solver={"rtol": 1e-12, "atol": 1e-14}, time__stop=1.0)
    forward = scenario.run()
    scenario["initial.q"], scenario["initial.qd"] = forward["q"][-1].tolist(), (-forward["qd"][-1]).tolist()
    back = scenario.run()
    assert np.allclose(back["q"][-1], forward["q"][0], rtol=0, atol=1e-9)
    assert np.allclose(back["qd"][-1], -forward["qd"][0], rtol=0, atol=1e-8)


@pytest.mark.parametrize("factor", [0.5, 3.0])
def test_gravity_only_changes_the_clock_of_a_fall(factor: float) -> None:
    def fall(gravity: float, stop: float) -> arm3r.Run:
        scenario, _ = arm_of("simscape", arm__gravity=[0, 0, -gravity], initial__qd=[0, 0, 0], time__stop=stop)
        scenario["solver"] = {"rtol": 1e-12, "atol": 1e-14}
        return scenario.run()

    assert np.allclose(fall(9.0, 1.0)["q"][-1], fall(9.0 * factor, 1.0 / np.sqrt(factor))["q"][-1], rtol=0, atol=1e-8)


def test_masses_all_twice_as_large_change_no_fall() -> None:
    def fall(scale: float) -> np.ndarray:
        scenario, _ = arm_of("simscape", arm__payload={"mass": 0.4 * scale})
        scenario["arm.armature"] = (scale * np.array([0.02, 0.03, 0.01])).tolist()
        scenario["arm.link1.inertia_axial"] = 0.02 * scale
        for link in ("link2", "link3"):
            scenario[f"arm.{link}.density"] = 2700 * scale
        return scenario.run()["q"]

    assert np.array_equal(fall(1), fall(2))
