"""Computed, put out, acting: who uses which torque under a delay, against a simulation in which every hold is a piece
of its own."""

from __future__ import annotations

import re
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from force_control_oracles import Arm, held, laws

DELAYS = [0.0, 0.4, 1.0, 1.4, 3.0]  # samples
PERIOD = 2e-3  # s
TICKS = 40
START, RATES = np.array([0.2, -0.4, 1.1]), np.array([0.3, -0.5, 0.4])
TARGET = np.array([0.3, -0.3, 1.2])
KP, KD = np.array([60.0, 50.0, 20.0]), np.array([6.0, 5.0, 1.5])
PUSH = np.array([6.0, -4.0, 5.0])  # N
GENERIC = Arm(
    lengths=(0.9, 0.7), masses=(1.3, 0.8), coms=(0.4, 0.3), column=0.02,
    inertias=((0.01, 0.05, 0.06), (0.005, 0.03, 0.035)), viscous=(0.1, 0.2, 0.05),
)  # fmt: skip
SCENARIO = f"""
format: 1
arm:
  convention: slide
  link1: {{inertia_axial: 0.02}}
  link2: {{length: 0.9, mass: 1.3, com: 0.4, inertia: [0.01, 0.06, 0.05]}}
  link3: {{length: 0.7, mass: 0.8, com: 0.3, inertia: [0.005, 0.035, 0.03]}}
  damping: [0.1, 0.2, 0.05]
initial: {{q: {START.tolist()}, qd: {RATES.tolist()}}}
controller: {{type: joint_pd, joint_stiffness: {KP.tolist()}, joint_damping: {KD.tolist()}}}
reference: {{type: point, q: {TARGET.tolist()}}}
sampling: {{rate: {1 / PERIOD}}}
solver: {{rtol: 1.0e-12, atol: 1.0e-14}}
time: {{stop: {TICKS * PERIOD}, log_every: {PERIOD}}}
"""


def scenario(**changes: Any) -> arm3r.Scenario:
    """Keys with __ for the dots."""
    made = arm3r.Scenario(SCENARIO)
    for key, value in changes.items():
        made[key.replace("__", ".")] = value
    return made


def pd(q_d: np.ndarray, s: Any) -> np.ndarray:
    return KP * (q_d - s.q) - KD * s.qd + s.gravity


# ---- the observer and the reactions ---------------------------------------------------------------------------------


@pytest.mark.sample(4)
@pytest.mark.parametrize("delay", DELAYS)
@pytest.mark.parametrize("push", [0 * PUSH, PUSH])
def test_the_observer_uses_the_torque_that_acts(delay: float, push: np.ndarray) -> None:
    run = scenario(sampling__delay=delay, observer={}, push={"force": push.tolist()}).run()
    observer = held.Observer(50.0, PERIOD)

    def law(tick: int, s: Any, past: held.Held) -> np.ndarray:
        observer.see(tick, s, past)
        return pd(TARGET, s)

    other = held.simulate_held(GENERIC, law, START, PERIOD, delay, TICKS, qd=RATES, push=push)
    assert np.abs(run["q"] - [s.q for s in other.states]).max() < 1e-9
    assert np.abs(run["residual"] - observer.residuals).max() < 1e-7
    if not push.any():
        assert np.abs(run["residual"]).max() < 0.03


@pytest.mark.parametrize("delay", DELAYS)
def test_without_contact_the_residual_is_as_small_with_a_delay(delay: float) -> None:
    """The smallest case: a residual of 1 N m and a false collision came of a delay of one sample."""
    text = """
    format: 1
    controller: {type: joint_pd}
    reference: {type: point, q: [0.2, -0.4, 1.2]}
    sampling: {rate: 500}
    observer: {}
    time: {stop: 1}
    """
    quiet = arm3r.Scenario(text)
    quiet["sampling.delay"] = delay
    run = quiet.run()
    assert np.abs(run["residual"]).max() < 0.05
    assert not run["collision"].any()


KEPT = {"joint_stiffness": KP.tolist(), "joint_damping": KD.tolist()}
OF_REACTION = {"stop": KEPT, "float": {}, "reflex": {"reflex_gain": 1.5}, "retreat": {**KEPT, "retreat_gain": 0.4}}


@pytest.mark.sample(6)
@pytest.mark.parametrize("delay", DELAYS)
@pytest.mark.parametrize("reaction", list(OF_REACTION))
def test_a_reaction_is_put_out_like_any_torque(delay: float, reaction: str) -> None:
    watched = {"threshold": 1e-6, "reaction": reaction, **OF_REACTION[reaction]}
    run = scenario(sampling__delay=delay, observer=watched, push={"force": PUSH.tolist()}).run()
    observer, kept = held.Observer(50.0, PERIOD), np.full(3, np.nan)

    def law(tick: int, s: Any, past: held.Held) -> np.ndarray:
        nonlocal kept
        r = observer.see(tick, s, past)
        if np.abs(r).max() <= 1e-6 and np.isnan(kept).all():
            return pd(TARGET, s)
        if np.isnan(kept).all():
            kept = s.q.copy()
        if reaction == "float":
            return s.gravity
        if reaction == "reflex":
            return s.gravity + 1.5 * r
        torque = pd(kept, s)
        if reaction == "retreat":
            kept = kept + PERIOD * 0.4 * r
        return torque

    other = held.simulate_held(GENERIC, law, START, PERIOD, delay, TICKS, qd=RATES, push=PUSH)
    assert np.abs(run["residual"] - observer.residuals).max() < 1e-7
    assert np.abs(run["q"] - [s.q for s in other.states]).max() < 1e-9


# ---- the energy tank ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("delay", DELAYS)
def test_the_tank_pays_for_the_torque_that_acts(delay: float) -> None:
    """A spring that varies, with the tank's level from the work of every hold by itself."""
    x_d = GENERIC.at(START).x + np.array([0.02, -0.03, 0.01])
    gains = {"stiffness": 150, "damping": 2, "stiffness_amplitude": 90, "stiffness_frequency": 6, "tank_energy": 0.5}
    law_keys = {"type": "energy_tank", **gains, "tank_low": 0.1, "tank_high": 0.3}
    made = scenario(sampling__delay=delay)
    made["controller"] = law_keys
    made["reference"] = {"type": "point", "tip": x_d.tolist()}
    run = made.run()
    tank = laws.tank(150.0, (90.0, 6.0), 2.0, x_d, 0.1, 0.3, 5.0)
    levels = []

    def spring(s: Any) -> float:
        return 75.0 * ((s.x - x_d) ** 2).sum()

    def law(tick: int, s: Any, past: held.Held) -> np.ndarray:
        if tick == 0:
            levels.append(0.5)
        else:
            levels.append(levels[-1] - held.given_out(s, past) - spring(s) + spring(past.states[-1]))
        return tank(tick * PERIOD, s, np.zeros(3), np.array([levels[-1]]))[0]

    other = held.simulate_held(GENERIC, law, START, PERIOD, delay, TICKS, qd=RATES)
    assert np.ptp(levels) > 0.02
    exact = delay == int(delay)  # else the controller foresees where the torque changes
    assert np.abs(run["tank_energy"] - levels).max() < (1e-9 if exact else 2e-6)
    assert np.abs(run["q"] - [s.q for s in other.states]).max() < (1e-9 if exact else 1e-7)


# ---- the estimator --------------------------------------------------------------------------------------------------

PRESSED = """
format: 1
wall: {point: [1.735, 0, 0], acts_on_arm: true, motion: {type: constant, velocity: 0.02},
       contact: {law: spring, stiffness: 1000}}
controller: {type: impedance}
sampling: {rate: 200}
estimator: {}
time: {stop: 3}
"""


@pytest.mark.parametrize(
    ("rate", "estimates", "delay"),
    [(200, 500, 0), (250, 500, 0.4), (333, 500, 1), (500, 170, 1.4), (200, 300, 3), (300, 100, 0)],
)
def test_the_estimator_pairs_force_and_place_of_one_instant(rate: float, estimates: float, delay: float) -> None:
    made = arm3r.Scenario(PRESSED)
    made["sampling"] = {"rate": rate, "delay": delay}
    made["controller.damping"], made["estimator.rate"], made["time.stop"] = 10, estimates, 2
    run = made.run()
    told = run["identifiable"] == 1
    assert told.any()
    assert run["stiffness_estimate"][told] == pytest.approx(np.full(told.sum(), 1000), rel=1e-7)
    assert run["wall_speed_estimate"][told] == pytest.approx(np.full(told.sum(), 0.02), rel=1e-6)


ONE_OF_ITS_OWN = """
format: 1
wall: {point: [1.735, 0, 0], acts_on_arm: true, motion: {type: constant, velocity: 0.02},
       contact: {law: spring, stiffness: 1000}}
controller: {type: impedance, damping: 10}
push: {force: [-8, 1, 2]}
estimator: {}
time: {stop: 1}
"""


@pytest.mark.parametrize("solver", [{}, {"method": "rodas4"}, {"method": "rk4", "step": 1e-3}])
def test_a_push_is_no_contact_with_the_wall(solver: dict[str, Any]) -> None:
    """It is as large wherever the tip is: what it presses with in front of the wall says nothing of the wall."""
    made = arm3r.Scenario(ONE_OF_ITS_OWN)
    made["solver"] = solver
    run = made.run()
    assert not run["identifiable"][run.t < run.events[0].t].any()
    assert run["identifiable"][-1] == 1
    assert run["stiffness_estimate"][-1] == pytest.approx(1000, rel=1e-6)
    assert run["wall_speed_estimate"][-1] == pytest.approx(0.02, rel=1e-6)
    batch = made.batch({})
    assert batch["stiffness_estimate"] == run.summary["metrics"]["stiffness_estimate"]


PUSHED = """
format: 1
arm: {convention: simscape, gravity: [1, -2, -9]}
initial: {q: [0.4, -0.7, 1.3], qd: [0.2, 0.3, -0.1]}
wall: {point: [-3, 0, 0], normal: [1, 0.3, 0.2], size: infinite, motion: {type: fixed}}
controller: {type: joint_stiffness, stiffness: 100, damping: 30}
reference: {type: point, q: [0.2, -0.9, 1.1]}
sampling: {rate: 500}
push: {force: [9, 4, -3], duration: 0.6}
estimator: {}
time: {stop: 1}
"""


@pytest.mark.parametrize("wall", ["moving", "fixed"])
@pytest.mark.parametrize("method", ["dopri5", "rk4"])
def test_a_sensed_force_that_does_not_depend_on_the_place_is_no_wall(method: str, wall: str) -> None:
    """A force sensor takes the push for contact. The best fit is a wall of 1e-12 N/m, which rounding errors make."""
    made = arm3r.Scenario(PUSHED)
    made["solver.method"], made["estimator.wall"] = method, wall
    run = made.run()
    assert run["force_measured"].max() > 8
    assert np.ptp(run["tip_x"]) > 0.05
    for column in ("identifiable", "stiffness_estimate", "wall_speed_estimate"):
        assert not run[column].any(), column


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"solver.step": 3e-4}, "the period of estimator.rate, 0.002 s, is no whole number of steps"),
        ({"solver.step": 0.003}, "the nearest is 0.002 s"),
        ({"estimator.start": 0.0123}, "the nearest is 0.012 s"),
    ],
)
def test_takes_the_estimators_samples_on_its_steps_or_not_at_all(changes: dict[str, float], told: str) -> None:
    made = arm3r.Scenario(ONE_OF_ITS_OWN)
    made["solver"] = {"method": "rk4", "step": 1e-3}
    made["estimator.start"] = 0.012
    made.validate()
    for path, value in changes.items():
        made[path] = value
    with pytest.raises(arm3r.ScenarioError, match=re.escape(told)):
        made.validate()


@pytest.mark.parametrize("velocity", [0.02, 0.05, 0.1, 0.2])
def test_a_controller_without_gains_judges_contact_as_any_other(velocity: float) -> None:
    """In samples contact begins above 1 N: the estimator's first eight samples come after that."""
    made = arm3r.Scenario(PRESSED)
    made["wall.motion.velocity"] = velocity
    made["controller"] = {"type": "gravity_compensation"}
    made["sampling.rate"], made["estimator"] = 1000, {"rate": 1000}
    made["time"] = {"stop": 0.2, "log_every": 0.001}
    run = made.run()
    pressed = np.flatnonzero(run["force_measured"] > 1)
    told = np.flatnonzero(run["identifiable"])
    assert (len(pressed) > 0) == (velocity > 0.03)
    assert [*told[:1]] == [*(pressed[:1] + 7)]


def test_an_estimate_between_two_samples_is_made_before_the_second() -> None:
    """Also where a step of rk4 passes over its instant. The first estimate takes the place of an assumption."""
    made = arm3r.Scenario(PRESSED)
    made["wall.motion.velocity"] = 0.05
    made["controller"] = {"type": "adaptive_reference", "adaptation": "indirect", "assumed_stiffness": 300}
    made["estimator"] = {"rate": 130, "forgetting": 0.8}
    made["sampling.rate"] = 100
    made["time"] = {"stop": 0.6, "log_every": 0.01}
    made["solver"] = {"rtol": 1e-10, "atol": 1e-13}
    due = made.run()
    made["solver"] = {"method": "rk4", "step": 2.5e-3}
    run = made.run()
    assert 0 < due["identifiable"].mean() < 1
    assert run["tau"] == pytest.approx(due["tau"], rel=1e-3, abs=1e-3)
    assert run["stiffness_estimate"] == pytest.approx(due["stiffness_estimate"], rel=1e-3, abs=1e-3)


def test_the_rows_of_rk4_show_the_torque_of_the_law_that_took_the_estimate() -> None:
    """A continuous one: a row at an estimate shows what holds after it, any other the last estimate."""
    made = arm3r.Scenario(ONE_OF_ITS_OWN)
    made["controller"] = {"type": "adaptive_reference", "adaptation": "indirect", "assumed_stiffness": 3000}
    made["wall.point"] = [1.73, 0, 0]  # in contact from the start
    made["push.force"] = [0, 1, 2]
    made["time"] = {"stop": 0.1, "log_every": 0.0015}
    due = made.run()
    made["solver"] = {"method": "rk4", "step": 2e-4}
    run = made.run()
    assert 0 < due["identifiable"].mean() < 1
    assert run["q"] == pytest.approx(due["q"], abs=1e-9)
    assert run["tau"] == pytest.approx(due["tau"], abs=1e-5)


def test_the_estimator_sees_what_the_encoder_reads() -> None:
    """Against a wall that moves, from the encoder's places and the sensor's forces alone. Coarse steps say nothing."""
    made = arm3r.Scenario(PRESSED)
    made["sensors.encoder.counts"] = 20000
    made["estimator.rate"] = 200
    assert not made.run()["identifiable"].any()  # least squares would give 264 N/m
    made["sensors.encoder.counts"] = 20000000
    made["estimator.rate"] = 200
    made["time"] = {"stop": 1.5, "log_every": 0.005}
    run = made.run()
    step = 2 * np.pi / 20000000
    told = made.arm.tip_position(step * np.round(run["q"] / step))[:, 0]
    inside = run["force_measured"] > 1
    t, f = run["t"][inside], run["force_measured"][inside]
    weight = 0.5 * np.log(0.995) * np.arange(len(t))[::-1]
    factor = np.exp(weight)
    columns = np.stack([told[inside], np.ones(len(t)), t], axis=1) * factor[:, None]
    k, _, kv = np.linalg.lstsq(columns, f * factor, rcond=None)[0]
    assert run["stiffness_estimate"][-1] == pytest.approx(k, rel=1e-6)
    assert run["wall_speed_estimate"][-1] == pytest.approx(kv / k, rel=1e-6)


# ---- what a sampled observer may know -------------------------------------------------------------------------------


def test_the_force_estimate_is_by_the_pose_that_the_encoder_reads() -> None:
    made = scenario(
        push={"force": [0, 0, -10]}, observer={}, sampling={"rate": 100}, sensors={"encoder": {"counts": 100}},
        time={"stop": 0.5, "log_every": 0.01},
    )  # fmt: skip
    run = made.run()
    read = 2 * np.pi / 100 * np.round(run["q"] * 100 / (2 * np.pi))
    transposed = made.arm.jacobian(read).transpose(0, 2, 1)
    expected = np.linalg.solve(transposed, run["residual"][..., None])[..., 0]
    assert np.abs(run["f_estimate"] - expected).max() < 1e-9
    assert np.abs(read - run["q"]).max() > 0.01
