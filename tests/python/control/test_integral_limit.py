"""The integral of the force error stays within its limit, whatever the anti-windup, in samples and continuously."""

from __future__ import annotations

from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from random_scenarios import sample_seed

SEED = sample_seed()
KINDS = ("none", "conditional", "back_calculation")
PRESSED = """
format: 1
arm: {torque_limit: [50, 14, 8]}
wall: {point: [1.73, 0, 0], size: infinite, motion: {type: fixed}, acts_on_arm: true}
controller: {type: hybrid, variant: jacobian_transpose, integral_limit: 0}
reference: {type: line, tip: [1.7320508075688772, 0, 0.4], duration: 0.3, force: {value: 5}}
sampling: {rate: 1000}
time: {stop: 3}
"""
LIMITED = """
format: 1
arm:
  convention: slide
  link2: {length: 0.9, mass: 1.3}
  link3: {length: 0.7, mass: 0.8}
initial: {q: [0.3, 0.5, -1.1]}
wall: {point: [2, 0, 0], normal: [-1, 0, 0], size: infinite, motion: {type: fixed}, acts_on_arm: true,
       contact: {law: kelvin_voigt, stiffness: 800, damping: 10}}
controller: {type: hybrid, variant: jacobian_transpose, switching: always, force_damping: 40}
time: {stop: 0.6, log_every: 0.002}
"""


@pytest.mark.parametrize("anti_windup", KINDS)
def test_an_integral_that_may_not_grow_leaves_the_force_alone(anti_windup: str) -> None:
    made = arm3r.Scenario(PRESSED)
    made["controller.anti_windup"] = anti_windup
    assert made.run()["force"][-1] == pytest.approx(5, abs=1e-3)


def integral(made: Any, run: arm3r.Run, gains: dict[str, float], wanted: float) -> np.ndarray:
    """z, N s, as the torque shows it in rows where no actuator is at its limit and the tip is in contact."""
    seen = (run["saturated"] == 0) & (run["contact"] == 1)
    transposed = made.arm.jacobian(run["q"]).transpose(0, 2, 1)
    force = np.linalg.solve(transposed, (run["tau"] - run["tau_g"])[..., None])[:, 0, 0]
    error = wanted - run["force"]
    free = force - wanted - gains["force_gain"] * error + 40 * run["tip_v"][:, 0]
    return (free / gains["force_integral_gain"])[seen]


def random_hybrid(rng: np.random.Generator, *, sampled: bool) -> tuple[Any, dict[str, Any], float]:
    made = arm3r.Scenario(LIMITED)
    gains = {"force_gain": rng.uniform(0, 0.5), "force_integral_gain": rng.uniform(3, 15)}
    limit, wanted = rng.uniform(0, 0.4), rng.uniform(5, 30)
    made["wall.point"] = [made.arm.tip_position([0.3, 0.5, -1.1])[0] - rng.uniform(0, 0.01), 0, 0]
    made["arm.torque_limit"] = [rng.uniform(5, 30), rng.uniform(12, 30), rng.uniform(4, 15)]
    for key, value in {**gains, "integral_limit": limit, "anti_windup": rng.choice(KINDS)}.items():
        made[f"controller.{key}"] = str(value) if key == "anti_windup" else value
    if made["controller.anti_windup"] == "back_calculation":
        made["controller.tracking_time"] = rng.uniform(0.01, 0.2)
    made["reference"] = {"type": "hold", "force": {"value": wanted}}
    made["solver.max_steps"] = 100_000  # a hundred times what a stable loop takes
    if sampled:
        made["sampling.rate"] = 500
    return made, gains, limit


def check_random_hybrids(count: int, *, sampled: bool) -> None:
    rng, reached = np.random.default_rng(SEED), 0
    for number in range(count):
        made, gains, limit = random_hybrid(rng, sampled=sampled)
        try:
            run = made.run()
        except arm3r.BudgetError:  # an unstable loop, whose steps are used up
            continue
        z = integral(made, run, gains, made["reference.force.value"])
        if len(z) == 0:
            continue
        largest = np.abs(z).max()
        reached += largest > 0.999 * limit
        assert largest <= limit + 1e-6, f"seed {SEED}, number {number}: {largest} N s for {limit}\n{made.to_yaml()}"
    assert reached > 0.2 * count


@pytest.mark.parametrize("sampled", [False, True])
def test_random_integrals_stay_within_their_limit(sampled: bool) -> None:
    check_random_hybrids(8, sampled=sampled)


@pytest.mark.gate
@pytest.mark.random
@pytest.mark.parametrize("sampled", [False, True])
def test_many_random_integrals_stay_within_their_limit(sampled: bool) -> None:
    check_random_hybrids(200, sampled=sampled)
