"""What a run says of its own accuracy holds: horizons, closed forms whatever the solver; docs/model.md, section 9."""

from __future__ import annotations

from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from numpy.testing import assert_allclose
from random_scenarios import sample_seed, yaml_of

SLACK = 1.5  # of a stated error: it is an estimate
EXACT = {"method": "dopri5", "rtol": 1e-12, "atol": 1e-15}


def quiet(drawn: dict[str, Any]) -> arm3r.Scenario:
    return arm3r.Scenario(yaml_of(drawn)).quiet()


def outcome_of(scenario: arm3r.Scenario, **options: Any) -> arm3r.Run:
    try:
        return scenario.run(**options)
    except arm3r.Arm3rError as error:
        assert error.run is not None
        return error.run


# ---- horizons


def random_jolt(rng: np.random.Generator) -> dict[str, Any]:
    """Fixed steps with a contact, a push or a jump of the reference at any place within one of them."""
    step = float(10 ** rng.uniform(-3.3, -2.3))
    at = step * (rng.integers(20, 60) + float(rng.choice([rng.uniform(), rng.uniform(0.88, 0.999)])))
    q = np.array([0.2, 0.5, -1.1]) + rng.uniform(-0.2, 0.2, 3)
    tip = arm3r.Scenario("format: 1\n").arm.tip_position(q)
    speed = rng.uniform(0.05, 0.3)
    wall = {
        "point": tip - [speed * at, 0, 0],
        "normal": [1, 0, 0],
        "size": "infinite",
        "acts_on_arm": True,
        "motion": {"type": "constant", "velocity": [speed, 0, 0]},
        "contact": {"stiffness": float(10 ** rng.uniform(3, 4))},
    }
    drawn: dict[str, Any] = {
        "format": 1,
        "initial": {"q": q},
        "controller": {"type": str(rng.choice(["impedance", "gravity_compensation", "joint_pd"]))},
        "solver": {"method": "rk4", "step": step},
        "time": {"stop": 0.4, "log_every": 0.01},
    }
    kind = rng.choice(["wall", "wall", "push"])
    if kind == "wall":
        return drawn | {"wall": wall}
    return drawn | {"push": {"force": rng.uniform(-20, 20, 3), "start": at, "duration": 0.05}}


@pytest.mark.parametrize("count", [25, pytest.param(400, marks=[pytest.mark.gate, pytest.mark.random])])
def test_no_horizon_is_later_than_the_error_allows_wherever_steps_end(count: int) -> None:
    rng = np.random.default_rng(sample_seed())
    early = 0
    for number in range(count):
        drawn = random_jolt(rng)
        run = outcome_of(quiet(drawn), trust=True)
        exact = outcome_of(quiet(drawn | {"solver": EXACT}))
        trust = run.trust
        place = f"seed {sample_seed()}, number {number}: {trust} of\n{yaml_of(drawn)}"
        assert trust is not None, place
        rows = min(len(run.t), len(exact.t))
        error = np.abs(run["q"][:rows] - exact["q"][:rows]).max(axis=1)
        right = run.t[:rows] <= trust.horizon
        assert error[right].max() <= SLACK * trust.error, place
        last = np.flatnonzero(run.t[:rows] == trust.end_error_at)
        assert last.size == 0 or error[last[0]] <= SLACK * trust.end_error + 1e-10, place
        wrong = np.flatnonzero(error > trust.error / SLACK)
        early += bool(wrong.size)
        assert wrong.size or trust.to_the_end, place  # nor does it end without need
    assert early > 0


def random_passage(rng: np.random.Generator, **solver: Any) -> dict[str, Any]:
    """A law that inverts the Jacobian moves a bent arm through its stretched pose."""
    bend = float(rng.choice([-1, 1]) * rng.uniform(0.05, 0.15))
    return {
        "format": 1,
        "arm": {"convention": "slide", "torque_limit": [20, 20, 15], "armature": [0.02, 0.02, 0.02]},
        "initial": {"q": [rng.uniform(-1, 1), rng.uniform(-0.2, 0.4), bend], "qd": [0, 0, -np.sign(bend) * 4]},
        "controller": {"type": str(rng.choice(["impedance", "resolved_acceleration"]))},
        "reference": {"type": "sinusoid", "tip_amplitude": [0.02, 0.02, 0.02], "frequency": 1},
        "solver": solver,
        "time": {"stop": 0.15, "log_every": 0.0005},
    }


def passage(run: arm3r.Run) -> int | None:
    """The first row behind a change of the sign of sin q3."""
    change = np.flatnonzero(np.diff(np.sign(np.sin(run["q3"]))))
    return int(change[0]) + 1 if change.size else None


@pytest.mark.parametrize("count", [4, pytest.param(80, marks=[pytest.mark.gate, pytest.mark.random])])
def test_steps_end_where_a_law_inverts_the_jacobian_of_a_singular_pose(count: int) -> None:
    """The torque is at its limit there for microseconds; steps of 10 us cannot pass over that.

    Where torques at their limits hold the arm at a singular pose, they turn to and fro without end: such a run is cut
    short, and nothing is compared.
    """
    rng = np.random.default_rng(sample_seed())
    passes = 0
    for number in range(count):
        drawn = random_passage(rng, method="dopri5", max_steps=100_000)
        exact = outcome_of(quiet(drawn | {"solver": {"rtol": 1e-11, "atol": 1e-13, "max_step": 1e-5}}), time_limit=20)
        values = drawn["initial"]["q"] + rng.uniform(-1e-3, 1e-3, (9, 3))
        place = f"seed {sample_seed()}, number {number} of\n{yaml_of(drawn)}"
        for method in ("dopri5", "rodas4", "auto"):
            solver = {"method": method, "max_steps": 100_000}
            run = outcome_of(quiet(drawn | {"solver": solver}), trust=method == "dopri5")
            if {exact.outcome, run.outcome} & {"budget", "stopped"}:
                continue
            assert_allclose(run["q"], exact["q"], rtol=0, atol=1e-6, err_msg=f"{method}, {place}")
            assert run.trust is None or run.trust.to_the_end, place
            passes += passage(exact) is not None
        batch = quiet(drawn).batch({"initial.q": values}, columns=["q3"])
        for place_in_batch, q in enumerate(values):
            alone = outcome_of(quiet(drawn | {"initial": drawn["initial"] | {"q": q.tolist()}}))
            assert np.array_equal(batch.rows["q3"][place_in_batch][: len(alone.t)], alone["q3"]), place
    assert passes > 0 or count < 10


@pytest.mark.parametrize("count", [4, pytest.param(80, marks=[pytest.mark.gate, pytest.mark.random])])
def test_the_horizon_ends_at_a_singular_pose_where_steps_do_not(count: int) -> None:
    """On the grid of rk4; and where a torque has no limit, so that nothing bounds it there."""
    rng = np.random.default_rng(sample_seed())
    passes = 0
    for number in range(count):
        drawn = random_passage(rng, **({"method": "rk4", "step": 1e-4} if number % 2 else {"method": "dopri5"}))
        if not number % 2:
            drawn["arm"]["torque_limit"] = [20, 20, "inf"]
        run = outcome_of(quiet(drawn), trust=True)
        behind = passage(run)
        if run.trust is None or behind is None:
            continue
        place = f"seed {sample_seed()}, number {number}: {run.trust} of\n{yaml_of(drawn)}"
        assert run.trust.horizon <= run.t[behind], place
        assert not run.trust.to_the_end, place
        if "singular pose" in run.trust.cause:
            passes += 1
            assert run.trust.cause in run.report(), place
        # whatever the rows: the passage lies within a step
        seldom = outcome_of(quiet(drawn | {"time": {"stop": 0.15, "log_every": 0.15}}), trust=True).trust
        assert seldom is None or not seldom.to_the_end, place
    assert passes > 0 or count < 10


def test_a_law_without_an_inverse_may_pass_singular_poses() -> None:
    drawn = random_passage(np.random.default_rng(1)) | {"controller": {"type": "none"}}
    drawn.pop("reference")
    run = quiet(drawn).run(trust=True)
    assert np.ptp(np.sign(np.sin(run["q3"]))) == 2
    assert run.trust is not None
    assert run.trust.to_the_end
    assert run.trust.cause == ""


REACHES_TOO_FAR = """format: 1
arm: {convention: slide, link1: {inertia_axial: 0.02}, link2: {length: 0.8427860486913628}, link3: {length: 0.7607958900353416}, armature: [0.02, 0.02, 0.02], torque_limit: [31.95278941535845, 14.743648706076542, 34.88883851786243]}
initial: {q: [0.744183013115622, 0.7139940749624081, 0.3486034061549025], qd: [-0.6071523898712587, 0.6385318332744749, -1.468865545292927]}
controller: {type: impedance}
time: {stop: 0.35, log_every: 0.01}
reference: {type: sinusoid, tip_amplitude: [0.05, 0.05, 0.05], frequency: 2}
solver: {method: dopri5}
"""  # noqa: E501


@pytest.mark.gate
def test_an_error_that_is_not_that_of_the_end_says_of_when_it_is() -> None:
    run = arm3r.Scenario(REACHES_TOO_FAR).quiet().run(trust=True)
    assert run.trust is not None
    assert run.trust.end_error_at < 0.2
    assert run.trust.cause != ""
    assert "error at the end" not in run.report()
    assert f"error at {run.trust.end_error_at:g} s" in run.report()


# ---- closed forms


SOLVERS: list[dict[str, Any]] = [
    {"method": "dopri5", "rtol": 1e-5},
    {"method": "dopri5", "rtol": 1e-12, "atol": 1e-15},
    {"method": "rodas4", "rtol": 1e-7},
    {"method": "taylor"},
    {"method": "rk4", "step": 1e-3},
    {"method": "rk4", "step": 3.7e-4},
]


def random_impact(rng: np.random.Generator) -> dict[str, Any]:
    """An arm at rest, whose weight is compensated, and a wall that comes; shifted in time and height."""
    q = rng.uniform([-2, -0.5, 0.5], [2, 1.0, 1.6])
    normal = rng.normal(size=3)
    normal /= np.linalg.norm(normal)
    start, height, speed = rng.choice([0, rng.uniform(-5, 5)]), rng.choice([0, rng.uniform(-3, 3)]), rng.uniform(0.1, 1)
    arm = {"convention": "slide", "base_height": height}
    tip = arm3r.Scenario(yaml_of({"format": 1, "arm": arm})).arm.tip_position(q)
    law = {"law": "kelvin_voigt", "restitution": rng.uniform(0.3, 0.9)} if rng.random() < 0.5 else {"law": "spring"}
    return {
        "format": 1,
        "arm": arm,
        "initial": {"q": q},
        "wall": {
            "point": tip - (speed * (0.01 + start)) * normal,
            "normal": normal,
            "size": "infinite",
            "motion": {"type": "constant", "velocity": speed * normal},
            "contact": {**law, "stiffness": 10 ** rng.uniform(5, 6.5)},
            "acts_on_arm": True,
        },
        "controller": {"type": "gravity_compensation"},
        "time": {"start": start, "stop": start + 0.03, "log_every": 0.01},
    }


@pytest.mark.parametrize("count", [12, pytest.param(150, marks=[pytest.mark.gate, pytest.mark.random])])
def test_a_closed_form_is_the_same_beside_every_solver(count: int) -> None:
    rng = np.random.default_rng(sample_seed())
    compared = 0
    for _ in range(count):
        drawn = random_impact(rng)
        speed = np.linalg.norm(drawn["wall"]["motion"]["velocity"])
        found: dict[str, float] = {}
        for solver in SOLVERS:
            if solver["method"] == "taylor" and drawn["wall"]["contact"]["law"] != "spring":
                continue
            run = outcome_of(quiet(drawn | {"solver": solver}))
            place = f"seed {sample_seed()}, {solver} of\n{yaml_of(drawn)}"
            if run.events:
                assert run.summary["closed_forms"]["approach_speed"] == pytest.approx(speed, rel=1e-9), place
            for one in run.closed_forms:
                form = one.closed_form - drawn["time"]["start"] * (one.name == "first_contact")
                assert found.setdefault(one.name, form) == pytest.approx(form, rel=1e-9), place
                exact = solver.get("rtol") == 1e-12
                assert not exact or abs(one.own - one.closed_form) <= one.allowed, place
                compared += one.name == "peak_force"
    assert compared > count


def random_small_gap(rng: np.random.Generator) -> dict[str, Any]:
    drawn = random_impact(rng)
    gap, speed = 10 ** rng.uniform(-8, -4), 10 ** rng.uniform(-2, 0)
    start = drawn["time"]["start"]
    wall = drawn["wall"]
    normal = np.asarray(wall["normal"])
    tip = arm3r.Scenario(yaml_of({"format": 1, "arm": drawn["arm"]})).arm.tip_position(drawn["initial"]["q"])
    wall["point"] = tip - (gap + speed * start) * normal
    wall["motion"] = {"type": "constant", "velocity": speed * normal}
    wall["contact"] = {"law": "spring", "stiffness": 10 ** rng.uniform(5, 6.5)}
    rtol = 10 ** rng.uniform(-12, -8)
    drawn["solver"] = {"method": "dopri5", "rtol": rtol, "atol": rtol / 1000}
    return drawn


@pytest.mark.parametrize("count", [60, pytest.param(1500, marks=[pytest.mark.gate, pytest.mark.random])])
def test_a_small_gap_raises_no_false_alarm(count: int) -> None:
    rng = np.random.default_rng(sample_seed())
    compared = 0
    for _ in range(count):
        drawn = random_small_gap(rng)
        run = outcome_of(quiet(drawn))
        for one in run.closed_forms:
            place = f"seed {sample_seed()}: {one} of\n{yaml_of(drawn)}"
            assert abs(one.own - one.closed_form) <= one.allowed, place
            if one.name == "first_contact":
                compared += 1
                speed = np.linalg.norm(drawn["wall"]["motion"]["velocity"])
                assert one.allowed < 1e-13 / speed + 1e-5 * (one.closed_form - drawn["time"]["start"]), place
    assert compared > count / 2


def test_a_wall_of_another_stiffness_is_found() -> None:
    """The peak on a wall that is a fifth stiffer lies outside what is allowed beside the closed form of this one."""
    rng = np.random.default_rng(sample_seed())
    found = 0
    while found < 5:
        drawn = random_impact(rng)
        drawn["wall"]["contact"] = {"law": "spring", "stiffness": 3e6}
        due = [one for one in quiet(drawn).run().closed_forms if one.name == "peak_force"]
        drawn["wall"]["contact"]["stiffness"] *= 1.2
        if due and due[0].allowed < 0.05 * due[0].closed_form:
            found += 1
            assert abs(quiet(drawn).run().summary["peak_force"] - due[0].closed_form) > due[0].allowed
