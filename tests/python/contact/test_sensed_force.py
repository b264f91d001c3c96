"""What sensors, laws and scores read of the contact: the same for every method, felt by the arm or not."""

from __future__ import annotations

import json
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest

# A plate that comes at an angle and reaches the tip after 12 ms, on a pose without symmetry.
BASE: dict[str, Any] = {
    "format": 1,
    "arm": {"link2": {"length": 1.1}, "link3": {"length": 0.85}},
    "initial": {"q": [0.12, -0.45, 0.95], "qd": [0.02, -0.03, 0.05]},
    "wall": {
        "point": [1.72, 0.2, -0.05], "normal": [-1, 0.1, 0.06], "size": "infinite", "acts_on_arm": False,
        "motion": {"type": "constant", "velocity": 0.1}, "contact": {"stiffness": 1000},
    },
    "sampling": {"rate": 500},
    "time": {"stop": 0.25, "log_every": 0.021},
}  # fmt: skip
FORCE = {"type": "point", "tip": [1.72, 0.2, -0.05], "force": {"value": 12.0}}
PATH = {"type": "point", "tip": [1.72, 0.2, -0.05]}
JOINTS = {"type": "point", "q": [0.12, -0.45, 0.95]}
LAWS: dict[str, dict[str, Any]] = {
    "hybrid": {"controller": {"type": "hybrid"}, "reference": FORCE},
    "hybrid_transpose": {"controller": {"type": "hybrid", "variant": "jacobian_transpose"}, "reference": FORCE},
    "operational_space": {"controller": {"type": "operational_space"}, "reference": FORCE},
    "parallel": {"controller": {"type": "parallel"}, "reference": FORCE},
    "adaptive_reference": {"controller": {"type": "adaptive_reference"}, "reference": FORCE},
    "admittance": {"controller": {"type": "admittance"}, "reference": PATH},
    "shaped_impedance": {"controller": {"type": "shaped_impedance"}, "reference": PATH},
    "impedance": {"controller": {"type": "impedance"}, "reference": PATH},
    "computed_torque": {"controller": {"type": "computed_torque", "cancel_force": True}, "reference": JOINTS},
    "joint_pd": {"controller": {"type": "joint_pd"}, "reference": JOINTS},
}
METHODS: dict[str, dict[str, Any]] = {
    "dopri5": {"method": "dopri5", "rtol": 1e-10},
    "rodas4": {"method": "rodas4", "rtol": 1e-10},
    "taylor": {"method": "taylor", "tol": 1e-12},
    "rk4": {"method": "rk4", "step": 2e-4},
    "rk4 to events": {"method": "rk4", "step": 2e-4, "events": "located"},
}
WALLS: dict[str, dict[str, Any]] = {
    "one_way": {},
    "acting": {"acts_on_arm": True},
    "diagonal": {"contact": {"law": "diagonal", "stiffness": [1000, 300, 200]}},
}


def scenario(law: str, wall: str, method: str) -> arm3r.Scenario:
    made = {**BASE, **LAWS[law], "wall": {**BASE["wall"], **WALLS[wall]}, "solver": METHODS[method]}
    return arm3r.Scenario(json.dumps(made))


# An unfelt force along the plate throws laws that yield to it out of the workspace.
PAIRS = [(law, wall) for law in LAWS for wall in WALLS if wall != "diagonal" or law in ("hybrid", "impedance")]


@pytest.mark.parametrize(("law", "wall"), PAIRS)
def test_every_method_senses_the_same_force(law: str, wall: str) -> None:
    runs = {method: scenario(law, wall, method).run() for method in METHODS}
    due = runs["dopri5"]
    assert due["force"].max() > 1, "the wall presses"
    for method, run in runs.items():
        assert run["q"] == pytest.approx(due["q"], abs=1e-7), method
        assert run["force_measured"] == pytest.approx(due["force_measured"], abs=1e-4), method
        touching = (run["force"] > 0) & (run["force_measured"] != 0)
        assert np.array_equal(touching, run["contact"] > 0), f"{method}: contact is sensed where there is contact"


@pytest.mark.parametrize("law", LAWS)
def test_one_way_walls_in_lanes_are_those_of_runs_alone(law: str) -> None:
    values = {"wall.contact.stiffness": [800.0, 1000.0, 1500.0], "wall.motion.velocity": [0.1, 0.001, 0.12]}
    for method in ("taylor", "rk4"):
        batch = scenario(law, "one_way", method).batch(values)
        for index in range(3):
            alone = batch.scenario((index,)).batch({})
            assert all(np.array_equal(batch[name][index], alone[name], equal_nan=True) for name in batch), method


def test_a_law_of_ones_own_is_shown_the_force() -> None:
    shown: dict[str, list[float]] = {"dopri5": [], "taylor": []}
    for method, forces in shown.items():

        def law(t: float, state: Any, forces: list[float] = forces) -> Any:
            forces.append(float(np.linalg.norm(state.f_on_tip)))
            return state.tau_g

        made = {**BASE, "controller": {"type": "user"}, "solver": METHODS[method]}
        arm3r.Scenario(json.dumps(made)).run(controller=law, rate=500)
    assert max(shown["dopri5"]) > 3
    assert shown["taylor"] == pytest.approx(shown["dopri5"], abs=1e-4)
