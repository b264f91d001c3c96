"""Formulas of a scenario's elbow arm: what they are judged by, and the verdicts."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.verify.functions import truth_of
from arm3r_cpp.verify.kinds import KINDS
from elbow_arms import WITH_OFFSETS, random_arm, random_states, scenario_of
from elbow_truth import Truth
from random_scenarios import sample_seed, yaml_of

START = {"q": [0.4, -0.7, 1.1]}
SKEW = {"inertia": 1e-3, "ratio": 50, "axis": [1, 0.2, 0]}
GEARED = {
    **WITH_OFFSETS,
    "rotor1": {"inertia": 2e-4, "ratio": 80},
    "rotor2": {"inertia": 1e-4, "ratio": 100, "mass": 0.7, "axis": [1, 0.5, 0.3]},
    "rotor3": {"inertia": 3e-4, "ratio": -60, "mass": 0.4},
    "payload": {"mass": 0.9},
    "damping": [0.3, 0.2, 0.1],
    "friction": [0.5, 0.4, 0.3],
    "friction_velocity": 0.05,
}


@pytest.fixture
def geared() -> arm3r.Scenario:
    return scenario_of(GEARED, initial=START)


def wrong_mass(q: Any) -> Any:
    M = Truth(GEARED).mass_matrix(np.asarray(q, float))
    M[2, 1] = M[1, 2] = M[1, 2] + 3e-4 * 60  # without the coupling by rotor 3, that turns with link 2
    return M


def test_the_truth_of_an_elbow_arm() -> None:
    """Against elbow_truth.py, which sums over the bodies; of random arms whose rotor 3 spins about the joint's axis."""
    zero = np.zeros(3)
    for number in range(30):
        rng = np.random.default_rng([sample_seed(), number])
        arm, states = random_arm(rng), random_states(rng, 3)
        arm.get("rotor3", {}).pop("axis", None)
        truth, own = truth_of(scenario_of(arm, initial=START)), Truth(arm)
        q, qd, tau = states["q"], states["qd"], states["tau"]
        due = {
            "kinematics": own.tip_position(q),
            "jacobian": own.jacobian(q),
            "jacobian_dot": own.jacobian_dot(q, qd),
            "gravity": own.gravity_torque(q),
            "mass": own.mass_matrix(q),
            "coriolis": own.velocity_product(q, qd),
            "inverse": own.inverse_dynamics(q, qd, tau, zero),
            "forward": own.forward_dynamics(q, qd, tau, zero),
        }
        for kind, expected in due.items():
            found = truth.values(KINDS[kind], "", {"q": q, "qd": qd, "qdd": tau, "tau": tau}, {})
            error = np.abs(found - expected).max() / (1 + np.abs(expected).max())
            assert error < 1e-9, f"seed {sample_seed()}, arm {number}, {kind}\n{yaml_of({'arm': arm})}"


def test_formulas_of_an_elbow_arm_are_judged(geared: arm3r.Scenario) -> None:
    own = Truth(GEARED)
    assert arm3r.verify.jacobian(lambda q: own.jacobian(np.asarray(q)), geared).ok
    assert arm3r.verify.gravity(lambda q: own.gravity_torque(np.asarray(q)), geared).ok
    assert arm3r.verify.mass(lambda q: own.mass_matrix(np.asarray(q)), geared).ok
    verdict = arm3r.verify.mass(wrong_mass, geared)
    assert [finding.entry for finding in verdict.findings] == [[2, 3], [3, 2]]


def test_a_law_of_an_elbow_arm_is_judged(geared: arm3r.Scenario) -> None:
    geared["controller"] = {"type": "gravity_compensation"}
    assert arm3r.verify.controller(lambda q, qd: Truth(GEARED).gravity_torque(np.asarray(q)), geared).ok


def test_the_command_judges_by_the_scenario_of_an_elbow_arm(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from arm3r_cpp.commands import verify

    (tmp_path / "arm.yaml").write_text(yaml_of({"format": 1, "arm": GEARED, "initial": START}))
    formula = "import numpy as np\n\ndef gravity(q1, q2, q3):\n    return np.zeros(3)\n"
    (tmp_path / "gravity.py").write_text(formula)
    assert verify.main([str(tmp_path / "gravity.py"), "--arm", str(tmp_path / "arm.yaml")]) == 11
    (tmp_path / "weightless.yaml").write_text(
        yaml_of({"format": 1, "arm": {**GEARED, "gravity": [0, 0, 0]}, "initial": START})
    )
    assert verify.main([str(tmp_path / "gravity.py"), "--arm", str(tmp_path / "weightless.yaml")]) == 0


def test_what_is_not_known_of_a_skew_rotor_is_not_judged() -> None:
    arm = copy.deepcopy(GEARED) | {"rotor3": SKEW}
    scenario, own = scenario_of(arm, initial=START), Truth(arm)
    with pytest.raises(arm3r.UnjudgedError, match="whose rotor3 spins about an axis that is not parallel"):
        arm3r.verify.mass(lambda q: own.mass_matrix(np.asarray(q)), scenario)
    assert arm3r.verify.gravity(lambda q: own.gravity_torque(np.asarray(q)), scenario).ok


def test_an_elbow_arm_without_its_scenario_is_refused(geared: arm3r.Scenario) -> None:
    with pytest.raises(arm3r.UsageError, match="give the Scenario or its path"):
        arm3r.verify.mass(wrong_mass, geared.arm)
