"""The derivatives of the dynamics against Pinocchio's and against differences of high order, and the linear model."""

from __future__ import annotations

from collections.abc import Callable

import arm3r_cpp as arm3r
import numpy as np
import pinocchio as pin
import pytest
from test_peers import our_arm, pinocchio_model, random_numbers, states

CONVENTIONS = ("simscape", "slide")
SEEDS = range(8)

RUBBING = """
format: 1
arm:
  convention: slide
  gravity: [1.5, -2, -9]
  link2: {length: 0.7, shape: cylinder, radius: 0.03, density: 2700}
  link3: {length: 0.45, shape: brick, section: [0.03, 0.02], density: 7850}
  payload: {mass: 0.6}
  armature: [0.02, 0.03, 0.05]
  damping: [0.1, 0.2, 0.3]
  friction: [0.4, 0.5, 0.6]
  friction_velocity: 0.5
"""


def rubbing(convention: str) -> arm3r.Arm:
    scenario = arm3r.Scenario(RUBBING)
    scenario["arm.convention"] = convention
    return scenario.arm


def agree(ours: np.ndarray, theirs: np.ndarray, limit: float) -> None:
    assert ours.shape == theirs.shape
    assert np.abs(ours - theirs).max() <= limit * (1 + np.abs(theirs).max())


def differences(f: Callable[[np.ndarray], np.ndarray], x: np.ndarray, h: float = 0.004) -> np.ndarray:
    """The derivatives of f by central differences of eighth order, as a matrix: a column for each number of x."""
    weights = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
    columns = [sum(w * (f(x + k * h * e) - f(x - k * h * e)) for k, w in weights.items()) / h for e in np.eye(x.size)]
    return np.stack(columns, -1)


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("seed", SEEDS)
def test_pinocchio_says_the_same(convention: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = random_numbers(rng, convention)
    arm, (model, _) = our_arm(n), pinocchio_model(n)
    data, damping = model.createData(), np.diag(n.damping)
    for q, qd, tau, _ in zip(*states(rng).values(), strict=True):
        qdd = arm.forward_dynamics(q, qd, tau)
        by_q, by_qd, mass = pin.computeRNEADerivatives(model, data, q, qd, qdd)[:3]
        ours = arm.inverse_dynamics_derivatives(q, qd, qdd)
        mass = np.triu(mass) + np.triu(mass, 1).T
        for found, due in zip(ours, (by_q, by_qd + damping, mass), strict=True):
            agree(found, due, 1e-9)
        pin.computeABADerivatives(model, data, q, qd, tau - n.damping * qd)
        inverse = np.triu(data.Minv) + np.triu(data.Minv, 1).T
        due = (data.ddq_dq, data.ddq_dv - inverse @ damping, inverse)
        for found, wanted in zip(arm.forward_dynamics_derivatives(q, qd, tau), due, strict=True):
            agree(found, wanted, 1e-9)


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("seed", SEEDS)
def test_differences_say_the_same_with_friction_and_a_force_on_the_tip(convention: str, seed: int) -> None:
    arm, rng = rubbing(convention), np.random.default_rng(seed)
    q, qd, third = rng.uniform(-3, 3, 3), rng.uniform(-2, 2, 3), rng.uniform(-9, 9, 3)
    force = rng.uniform(-20, 20, 3)
    for derivatives, function in (
        (arm.forward_dynamics_derivatives, arm.recursion_forward_dynamics),
        (arm.inverse_dynamics_derivatives, arm.recursion_inverse_dynamics),
    ):
        by_q, by_qd, by_third = derivatives(q, qd, third, force)
        agree(by_q, differences(lambda x: function(x, qd, third, force), q), 1e-8)  # noqa: B023
        agree(by_qd, differences(lambda x: function(q, x, third, force), qd), 1e-8)  # noqa: B023
        agree(by_third, differences(lambda x: function(q, qd, x, force), third, 1.0), 1e-8)  # noqa: B023


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_the_two_dynamics_are_inverse_to_each_other(convention: str) -> None:
    arm, rng = rubbing(convention), np.random.default_rng(3)
    q, qd, tau, force = rng.uniform(-3, 3, (4, 5, 3))
    qdd = arm.forward_dynamics(q, qd, tau, force)
    forward = arm.forward_dynamics_derivatives(q, qd, tau, force)
    inverse = arm.inverse_dynamics_derivatives(q, qd, qdd, force)
    mass = arm.mass_matrix(q)
    assert np.allclose(inverse[2], mass, rtol=1e-12, atol=1e-15)
    assert np.allclose(forward[2] @ mass, np.eye(3), rtol=0, atol=1e-12)
    for by_state, back in zip(forward[:2], inverse[:2], strict=True):
        assert np.allclose(mass @ by_state, -back, rtol=0, atol=1e-10 * np.abs(back).max())


def test_a_force_that_is_left_out_is_zero() -> None:
    arm, (q, qd, tau) = rubbing("simscape"), np.random.default_rng(5).uniform(-2, 2, (3, 3))
    for function in (arm.forward_dynamics_derivatives, arm.inverse_dynamics_derivatives, arm.linearize):
        for without, zero in zip(function(q, qd, tau), function(q, qd, tau, [0, 0, 0]), strict=True):
            assert np.array_equal(without, zero)


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_the_linear_model(convention: str) -> None:
    arm, rng = rubbing(convention), np.random.default_rng(11)
    q, qd, tau, force = rng.uniform(-2, 2, (4, 3))

    def rate(x: np.ndarray) -> np.ndarray:
        return np.concatenate([x[3:6], arm.forward_dynamics(x[:3], x[3:6], x[6:], force)])

    A, B = arm.linearize(q, qd, tau, force)
    due = differences(rate, np.concatenate([q, qd, tau]))
    agree(A, due[:, :6], 1e-8)
    agree(B, due[:, 6:], 1e-8)


def test_the_linear_model_predicts_a_small_motion_about_rest() -> None:
    """The modes of the arm held by a constant torque, from A, are those of a run."""
    scenario = arm3r.Scenario(RUBBING)
    scenario["arm.friction"] = [0, 0, 0]
    q = np.array([0.4, -1.2, -0.7])
    tau = scenario.arm.gravity_torque(q)
    A, _ = scenario.arm.linearize(q, [0, 0, 0], tau)
    small = 1e-6 * np.array([1.0, -2.0, 1.5])
    scenario.update(
        {
            "controller": {"type": "constant", "torque": tau},
            "initial": {"q": q + small},
            "time": {"stop": 0.3},
            "solver": {"method": "taylor"},
        }
    )
    run = scenario.run()
    values, vectors = np.linalg.eig(A)
    start = np.linalg.solve(vectors, np.concatenate([small, np.zeros(3)]))
    due = (vectors @ (np.exp(values * 0.3) * start)).real[:3]
    assert np.abs(due - small).max() > 1e-7
    assert np.allclose(run["q"][-1] - q, due, rtol=0, atol=1e-10)
