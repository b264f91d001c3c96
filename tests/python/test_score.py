"""The numbers that a run is judged by: what they mean, and that a dense log has the same (8.10)."""

from __future__ import annotations

import arm3r_cpp as arm3r
import pytest


@pytest.mark.parametrize("solver", ["{}", "{method: rk4}", "{method: rodas4}"])
def test_the_path_error_of_a_law_in_joints_is_that_of_the_true_arm(solver: str) -> None:
    """At rest with q = q_ref to the bit, the controller's wrong length moves no tip."""
    scenario = arm3r.Scenario(
        "{format: 1, arm: {gravity: [0, 0, 0]}, initial: {q: [0.1, -0.5, 1.1]},"
        " controller: {type: joint_pd, gravity: [0, 0, 0], model: {link2: {length: 0.8}}},"
        f" reference: {{type: point, q: [0.1, -0.5, 1.1]}}, time: {{stop: 0.1}}, solver: {solver}}}"
    )
    assert scenario.run().summary["metrics"]["tip_path_error_max"] == pytest.approx(0, abs=1e-15)
    assert scenario.batch({})["tip_path_error_rms"] == pytest.approx(0, abs=1e-15)
