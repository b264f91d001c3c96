"""The dissipated energy in parts: joints, contact, friction along the wall, edges of the plate; docs/model.md (4.9).

The parts are compared with an independent simulation, with quadratures over dense rows, and with their sum.
Random scenarios; a failure prints the seed and the YAML.
"""

from __future__ import annotations

from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from agreement import ADAPTIVE, rk4, run_of
from force_control_oracles import SETTINGS
from force_control_oracles import run_of as simulated
from force_scenarios import read
from random_scenarios import Keys, random_scenario, sample_seed, yaml_of

SEED = sample_seed()
PARTS = [f"energy_dissipated_{part}" for part in ("joints", "contact", "friction", "edges")]

DAMPED: Keys = {
    "format": 1,
    "arm": {"convention": "slide", "damping": [0.3, 0.2, 0.1], "friction": [0.2, 0.1, 0.3], "friction_velocity": 0.1},
    "initial": {"q": [0.2, 0.5, -1.1], "qd": [0.3, -0.2, 1.5]},
    "wall": {
        "point": [1.672, 0, 0],
        "size": "infinite",
        "motion": {"type": "fixed"},
        "contact": {
            "law": "kelvin_voigt",
            "stiffness": 2000,
            "damping": 15,
            "friction": {"coefficient": 0.3, "slip_velocity": 0.05},
        },
        "acts_on_arm": True,
    },
    "controller": {"type": "gravity_compensation"},
    "solver": {"method": "dopri5", "rtol": 1e-10, "atol": 1e-13},
    "time": {"stop": 0.2, "log_every": 2e-5},
}


def parts_of(run: arm3r.Run) -> np.ndarray:
    return np.column_stack([run[name] for name in PARTS])


def test_the_parts_are_those_of_an_independent_simulation() -> None:
    run = read("energy_balance").run()
    oracle = simulated(SETTINGS["energy balance"], energies=True, rtol=1e-8, atol=1e-11)
    _, state = oracle.piece(run["t"][-1])
    joints, contact, friction = state[-3:]
    assert parts_of(run)[-1] == pytest.approx([joints, contact, friction, 0], abs=1e-8)
    assert [run.summary["metrics"][name] for name in PARTS] == pytest.approx(list(parts_of(run)[-1]), abs=1e-12)
    assert min(joints, contact, friction) > 1e-3


def test_the_parts_are_quadratures_of_what_the_rows_show() -> None:
    run = arm3r.Scenario(yaml_of(DAMPED)).run()
    assert run.summary["metrics"]["contacts"] > 0
    rates = run["qd"]
    damping, friction = np.array(DAMPED["arm"]["damping"]), np.array(DAMPED["arm"]["friction"])
    joints = (damping * rates**2 + friction * np.tanh(rates / 0.1) * rates).sum(axis=1)
    along = run["f_on_tip"] - run["f_on_tip"][:, :1] * [1, 0, 0]
    sliding = -(along * run["tip_v"]).sum(axis=1)
    depth, rate = run["depth"], run["tip_v"][:, 0]
    contact = np.where(run["contact"] == 1, (run["f_on_tip"][:, 0] * -1 - 2000 * depth) * rate, 0)
    for name, power in zip(PARTS, (joints, contact, sliding), strict=False):
        expected = np.trapezoid(power, run["t"])
        assert expected > 1e-3, name
        assert run[name][-1] == pytest.approx(expected, rel=1e-3), name


def test_an_edge_takes_what_the_spring_holds() -> None:
    scenario = arm3r.Scenario(
        yaml_of(
            {
                "format": 1,
                "arm": {"convention": "slide"},
                "initial": {"q": [0.1, 0.4, -1.0], "qd": [2.5, 0, 0]},
                "wall": {
                    "point": [1.66, 0.2, 0],
                    "size": [0.3, 4],
                    "motion": {"type": "fixed"},
                    "contact": {"stiffness": 100},
                    "acts_on_arm": True,
                },
                "controller": {"type": "gravity_compensation"},
                "time": {"stop": 1.5, "log_every": 0.001},
            }
        )
    )
    for solver in (*ADAPTIVE.values(), {"method": "rk4", "step": 1e-4}):
        scenario["solver"] = solver
        run = scenario.run()
        lost = parts_of(run)
        assert lost[-1, 3] > 1e-3
        assert (lost[:, :3] == 0).all()
        assert np.array_equal(lost[:, 3], run["energy_dissipated"])


def test_only_what_can_lose_energy_has_columns_for_it() -> None:
    free = arm3r.Scenario(yaml_of({"format": 1, "time": {"stop": 0.1}}))
    assert not set(PARTS) & set(free.run().columns)
    free["arm.damping"] = [0, 0.1, 0]
    assert set(PARTS) <= set(free.run().columns)


def faults(scenario: Keys) -> list[str]:
    """What is wrong with the parts of a random scenario, by every method that takes it.

    Of runs that ended ok: in one that diverges the parts are differences of numbers without any accuracy. The rows of
    rk4 lie on its steps: what a fixed step gives is the state there, and the cubic between two of them may go back.
    """
    found = []
    wall = scenario.get("wall", {})
    has_friction = "friction" in wall.get("contact", {}) and wall.get("acts_on_arm")
    has_edges = wall.get("acts_on_arm") and wall.get("size") != "infinite"
    has_joint_loss = any(map(any, (scenario["arm"].get("damping", [0]), scenario["arm"].get("friction", [0]))))
    for name, solver in {**ADAPTIVE, "rk4": rk4(scenario, 1e-3)}.items():
        every = scenario["time"]["log_every"]
        if name == "rk4":
            every = solver["step"] * max(1, round(every / solver["step"]))
        logged = {**scenario, "time": {**scenario["time"], "log_every": every}}
        run = run_of(logged, {**solver, **({"rtol": 1e-7} if "rtol" in solver else {})})
        if run is None or run.outcome != "ok" or PARTS[0] not in run.columns:
            continue
        lost, total = parts_of(run), run["energy_dissipated"]
        size = np.maximum(1e-300, np.abs(lost).max() + np.abs(total).max())
        metrics = run.summary["metrics"]
        told, whole = np.array([metrics[part] for part in PARTS]), metrics["energy_dissipated"]
        checks = {
            "the sum is not the whole": np.abs(lost.sum(axis=1) - total).max() <= 1e-13 * size,
            "joints": has_joint_loss or not lost[:, 0].any(),
            "friction": has_friction or not lost[:, 2].any(),
            "edges": has_edges or not lost[:, 3].any(),
            "joints gain energy": (np.diff(lost[:, 0]) >= -1e-6 * size - 1e-12).all(),
            "edges give energy": (np.diff(lost[:, 3]) >= 0).all(),
            "the sum of the summary": abs(told.sum() - whole) <= 1e-13 * (np.abs(told).max() + abs(whole)),
        }
        checks["the summary"] = np.allclose(told, lost[-1], 0, 1e-12 * size)
        found += [f"{name}: {text}" for text, holds in checks.items() if not holds]
    return found


def check_random(count: int) -> str:
    texts = []
    for number in range(count):
        scenario = random_scenario(np.random.default_rng([SEED, 77, number]))
        texts += [f"# seed {SEED}, scenario {number}: {text}\n{yaml_of(scenario)}" for text in faults(scenario)]
    return "\n".join(texts[:10])


def test_the_parts_of_random_scenarios_add_up() -> None:
    assert not (text := check_random(40)), text


@pytest.mark.gate
@pytest.mark.random
def test_the_parts_of_many_random_scenarios_add_up() -> None:
    assert not (text := check_random(2000)), text


def test_a_batch_has_the_parts_of_its_runs() -> None:
    for method in ({"method": "rk4", "step": 1e-3}, {"method": "dopri5"}):
        scenario = arm3r.Scenario(yaml_of({**DAMPED, "solver": method}))
        values: dict[str, Any] = {"wall.contact.damping": [5.0, 10.0, 15.0, 20.0, 25.0]}
        batch = scenario.batch(values)
        for index, damping in enumerate(values["wall.contact.damping"]):
            scenario["wall.contact.damping"] = damping
            metrics = scenario.run().summary["metrics"]
            assert [batch[name][index] for name in PARTS] == [metrics[name] for name in PARTS]
