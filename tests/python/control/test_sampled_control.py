"""Controllers in samples: holds, delays, filters, sensors, limits and noise against closed forms and recursions."""

from __future__ import annotations

from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from force_control_oracles import QA, XA, Arm, laws, linear, sampled
from force_scenarios import changed, read

PI = {"kP": 0.5, "kI": 5.0, "m_f": 1.0, "b": 70.0}
T = 1e-3  # s: the period of most of these

# An arm that nothing moves from its course: rotor inertias that its controller does not know.
RIGID = """
format: 1
arm: {convention: slide, armature: [1e12, 1e12, 1e12]}
controller: {type: joint_pd, model: {armature: [0, 0, 0]}}
sampling: {rate: 1000}
time: {stop: 0.2, log_every: 0.001}
"""
# That arm, against which a wall swings: 10 N +- 7 N at 10 Hz.
PRESSED = {
    "wall": {
        "point": [XA[0] - 0.002, 0, 0], "size": "infinite", "acts_on_arm": True,
        "motion": {"type": "sinusoid", "amplitude": 0.0014, "frequency": 10}, "contact": {"stiffness": 5000},
    },
    "controller": {"type": "hybrid", "switching": "always", "model": {"armature": [0, 0, 0]}},
}  # fmt: skip


def rigid(changes: dict[str, Any] | None = None) -> arm3r.Scenario:
    return changed(arm3r.Scenario(RIGID), changes or {})


def pressed(changes: dict[str, Any] | None = None) -> arm3r.Scenario:
    return rigid({**PRESSED, **(changes or {})})


def swing(t: Any) -> Any:
    """The force of PRESSED."""
    return 10 + 7 * np.sin(20 * np.pi * t)


# ---- rate and hold --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("zeta", "period"), [(1.0, 0.049), (1.0, 0.051), (0.3, 0.0588), (0.3, 0.0612), (0.5, 0.098)])
def test_computed_torque_on_a_hold_is_its_recursion(zeta: float, period: float) -> None:
    changes = {
        "controller.velocity_gain": 40 * zeta, "sampling.rate": 1 / period, "time.stop": 60 * period,
        "time.log_every": period,
    }  # fmt: skip
    run = read("sampling_period_stable", changes).run()
    A, e = sampled.held_recursion(400.0, 40.0 * zeta, period), np.array([1e-7, 0.0])
    largest = 0.0
    for row in range(61):
        largest = max(largest, abs(e[0]))
        assert run["q"][row] - QA == pytest.approx(np.full(3, e[0]), abs=1e-3 * largest)
        e = A @ e


@pytest.mark.parametrize("zeta", [1.0, 0.3])
def test_a_period_that_the_gains_do_not_bear_is_warned_of(zeta: float) -> None:
    limit = sampled.longest_period(400.0, 40.0 * zeta)
    for share, count in ((0.98, 0), (1.02, 1)):
        changes = {"controller.velocity_gain": 40 * zeta, "sampling.rate": 1 / (share * limit), "time.stop": 0.1}
        warnings = read("sampling_period_stable", changes).run().summary["warnings"]
        assert len([each for each in warnings if "stable" in str(each)]) == count, warnings


@pytest.mark.parametrize("delay", [0, 1, 2, 0.5, 2.25])
def test_a_torque_comes_late_and_is_held(delay: float) -> None:
    changes = {
        "initial.qd": [0.1, 0.05, -0.03], "sampling.delay": delay, "time.log_every": 0.00025, "time.stop": 0.02,
        "controller.joint_stiffness": [1, 2, 3], "controller.joint_damping": [0, 0, 0],
        "controller.compensate_gravity": False,
    }  # fmt: skip
    run = rigid(changes).run()
    samples = np.maximum(np.floor(run["t"] / T - delay + 1e-9), 0)
    expected = -np.multiply.outer(samples * T, [0.1, 0.1, -0.09])
    assert np.abs(run["tau"] - expected).max() < 1e-12


# ---- encoders and rates ---------------------------------------------------------------------------------------------

MOVING = {"initial.qd": [0.1, 0.07, -0.03], "controller.compensate_gravity": False, "sensors.encoder.counts": 4096}
STEP = 2 * np.pi / 4096
PLACES = {"controller.joint_stiffness": [1, 1, 1], "controller.joint_damping": [0, 0, 0]}
RATES = {"controller.joint_stiffness": [0, 0, 0], "controller.joint_damping": [1, 1, 1]}


def course(t: Any) -> Any:
    return np.asarray(QA) + np.multiply.outer(t, MOVING["initial.qd"])


def test_an_encoder_rounds_to_its_counts() -> None:
    run = rigid({**MOVING, **PLACES}).run()
    read_out = np.asarray(QA) - run["tau"]
    assert np.abs(read_out - STEP * np.round(course(run["t"]) / STEP)).max() < 1e-12
    assert 0.45 * STEP < np.abs(read_out - course(run["t"])).max() <= STEP / 2 * (1 + 1e-9)


def test_a_rate_from_differences_has_the_encoder_s_noise() -> None:
    swift = [np.sqrt(2) / 7 * STEP / T * share for share in (1, 0.731, -0.417)]
    changes = {**MOVING, **RATES, "initial.qd": swift, "sensors.velocity.estimate": "difference", "time.stop": 1.0}
    run = rigid(changes).run()
    told, t = -run["tau"], run["t"]
    counts = np.round((np.asarray(QA) + np.multiply.outer(t, swift)) / STEP)
    assert np.abs(told[1:] - STEP / T * np.diff(counts, axis=0)).max() < 1e-9
    assert told[0] == pytest.approx(swift)
    assert np.abs(told - swift).max() <= STEP / T


def test_the_errors_of_a_steady_rate() -> None:
    """A count more or less at each sample: with the share c of a count left over, variance c (1 - c) (D/T)^2."""
    counts, period = 2**24, 1e-4
    step, swift = 2 * np.pi / counts, [0.0123 * np.sqrt(2), 0.0345 * np.sqrt(3), -0.0231 * np.sqrt(5)]
    changes = {
        **MOVING, **RATES, "initial.qd": swift, "sensors.velocity.estimate": "difference", "time.stop": 0.4,
        "sensors.encoder.counts": counts, "sampling.rate": 1 / period, "time.log_every": period,
    }  # fmt: skip
    run = rigid(changes).run()
    error = -run["tau"][1:] - swift
    assert np.abs(error).max() <= step / period * (1 + 1e-6)
    share = np.abs(swift) * period / step % 1
    assert error.std(axis=0) == pytest.approx(step / period * np.sqrt(share * (1 - share)), rel=0.05)


def test_the_errors_of_a_changing_rate() -> None:
    """Of an arm that falls the errors of two places are independent: standard deviation D/(T sqrt 6)."""
    changes = {
        **MOVING, **RATES, "arm.armature": [1, 1, 1], "sensors.velocity.estimate": "difference", "time.stop": 0.5,
        "sampling.rate": 2000, "time.log_every": 5e-4, "sensors.encoder.counts": 65536,
    }  # fmt: skip
    step, period = 2 * np.pi / 65536, 5e-4
    run = rigid(changes).run()
    error = -run["tau"][1:] - np.diff(run["q"], axis=0) / period
    assert np.abs(error).max() <= step / period * (1 + 1e-9)
    assert error[:, 1:].std(axis=0) == pytest.approx(np.full(2, step / period / np.sqrt(6)), rel=0.1)


def test_a_filtered_rate_is_a_first_order_recursion() -> None:
    changes = {**MOVING, **RATES, "sensors.velocity": {"estimate": "filtered", "cutoff": 30}}
    run = rigid(changes).run()
    alpha, y = 1 - np.exp(-2 * np.pi * 30 * T), np.array(MOVING["initial.qd"])
    places = STEP * np.round(course(run["t"]) / STEP)
    for row, difference in enumerate(np.diff(places, axis=0) / T, 1):
        y = y + alpha * (difference - y)
        assert -run["tau"][row] == pytest.approx(y, abs=1e-10)


# ---- the force sensor -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("delay", [0, 1, 3, 0.5, 2.25, 100.75])
def test_a_force_comes_late(delay: float) -> None:
    run = pressed({"sensors.force.delay": delay}).run()
    whole, share = int(delay), delay % 1
    rows = np.arange(whole + 2, len(run["t"]))
    forces = swing(run["t"])
    assert np.abs(run["force"] - forces).max() < 1e-8
    expected = (1 - share) * forces[rows - whole] + share * forces[rows - whole - 1]
    assert np.abs(run["force_measured"][rows] - expected).max() < 1e-8
    assert run["force_measured"][0] == pytest.approx(10, abs=1e-9)


def test_a_force_is_rounded_to_the_resolution() -> None:
    run = pressed({"sensors.force.resolution": 0.25}).run()
    assert np.abs(run["force_measured"] - 0.25 * np.round(swing(run["t"]) / 0.25)).max() < 1e-12


def test_bias_comes_after_rounding() -> None:
    run = pressed({"sensors.force": {"resolution": 0.25, "bias": [-0.1, 7, 9]}}).run()
    assert np.abs(run["force_measured"] - 0.1 - 0.25 * np.round(swing(run["t"]) / 0.25)).max() < 1e-12


def test_a_digital_low_pass_is_a_recursion() -> None:
    run = pressed({"sensors.force.cutoff": 40}).run()
    alpha, y = 1 - np.exp(-2 * np.pi * 40 * T), 10.0
    for row, force in enumerate(swing(run["t"])):
        y = y + alpha * (force - y) if row else force
        assert run["force_measured"][row] == pytest.approx(y, abs=1e-8)


def test_an_analog_low_pass_is_first_order() -> None:
    run = pressed({"sensors.force.analog_cutoff": 25, "time.stop": 0.5}).run()
    w, s = 2 * np.pi * 25, 20 * np.pi
    gain = 7 * w / (s**2 + w**2)
    expected = 10 + gain * (w * np.sin(s * run["t"]) - s * np.cos(s * run["t"]) + s * np.exp(-w * run["t"]))
    assert np.abs(run["force_measured"] - expected).max() < 1e-7


@pytest.mark.parametrize("gravity", [9.80665, 1.6])
def test_a_tool_s_weight_is_read_as_the_arm_s_gravity_has_it(gravity: float) -> None:
    normal = np.array([-0.8, 0, 0.6])
    changes = {
        "wall.normal": normal.tolist(), "wall.point": (np.array(XA) + 0.002 * normal).tolist(),
        "controller.gravity": gravity, "sensors.force.tool_mass": 0.3,
    }  # fmt: skip
    run = pressed(changes).run()
    assert np.abs(run["force"] - swing(run["t"])).max() < 1e-8
    assert np.abs(run["force_measured"] - run["force"] + 0.6 * 0.3 * 9.80665).max() < 1e-12


def test_a_bias_shifts_the_force() -> None:
    changes = {
        "controller.ideal_cancellation": True, "sensors": {"force": {"bias": [-1.5, 0, 0]}},
        "sampling": {"rate": 1000, "seed": 1}, "time.log_every": 0.01,
    }  # fmt: skip
    run = read("sampled_with_sensors", changes).run()
    assert run["force"][-1] == pytest.approx(18.5, abs=1e-4)


# ---- noise ----------------------------------------------------------------------------------------------------------


def noise(changes: dict[str, Any], stop: float = 30.0) -> Any:
    fixed = {"wall.motion": {"type": "fixed"}, "time.stop": stop, "sensors.force.noise": 0.5}
    return pressed({**fixed, **changes}).run()["force_measured"] - 10


def test_noise_is_white_and_normal() -> None:
    w = noise({}) / 0.5
    n = len(w)
    assert abs(w.mean()) < 5 / np.sqrt(n)
    assert w.var() == pytest.approx(1, abs=5 * np.sqrt(2 / n))
    assert abs((w**3).mean()) < 5 * np.sqrt(15 / n)
    assert (w**4).mean() == pytest.approx(3, abs=5 * np.sqrt(96 / n))
    for lag in (1, 2, 7):
        assert abs((w[lag:] * w[:-lag]).mean()) < 5 / np.sqrt(n)


@pytest.mark.parametrize("cutoff", [20.0, 100.0])
def test_a_low_pass_leaves_alpha_over_two_minus_alpha_of_its_variance(cutoff: float) -> None:
    alpha = 1 - np.exp(-2 * np.pi * cutoff * T)
    y = noise({"sensors.force.cutoff": cutoff})[1000:]
    independent = len(y) * alpha / (2 - alpha)
    assert y.std() / 0.5 == pytest.approx(sampled.filtered_noise(alpha), rel=5 / np.sqrt(2 * independent))
    assert (y[1:] * y[:-1]).mean() / y.var() == pytest.approx(1 - alpha, abs=5 / np.sqrt(len(y)))


def test_the_seed_makes_the_noise() -> None:
    first, again, other = (noise({"sampling.seed": seed}, 1.0) for seed in (5, 5, 6))
    assert np.array_equal(first, again)
    assert abs(np.corrcoef(first, other)[0, 1]) < 5 / np.sqrt(len(first))
    assert not np.isclose(first, other).any()


# ---- limits ---------------------------------------------------------------------------------------------------------

HELD = Arm().at(QA)


def test_with_a_limit_below_the_weight_the_arm_sinks() -> None:
    holding = HELD.gravity[1]
    assert holding == pytest.approx(13.3337086009, abs=1e-10)
    for limit in (holding + 1e-6, holding - 1e-3):
        limits = {"arm.armature": [0, 0, 0], "arm.torque_limit": [50, limit, 50]}
        run = rigid({**limits, "controller": {"type": "gravity_compensation"}}).run()
        missing = np.array([0, min(limit - holding, 0), 0])
        expected = np.linalg.solve(HELD.M, missing)
        assert run["qdd"][0] == pytest.approx(expected, abs=1e-12)
        assert (run["saturated"] == (limit < holding)).all()


@pytest.mark.parametrize("saturation", ["clamp", "scale"])
def test_saturation(saturation: str) -> None:
    limits, qd = np.array([0.5, 12.0, 4.0]), np.array([0.9, -1.4, 2.1])
    changes = {
        "initial.qd": qd.tolist(), "arm.torque_limit": limits.tolist(), "controller.saturation": saturation,
        "controller.joint_stiffness": [40, 40, 20], "controller.joint_damping": [1, 2, 1],
    }  # fmt: skip
    run = rigid(changes).run()
    q = np.asarray(QA) + np.multiply.outer(run["t"], qd)
    asked = [np.multiply([40, 40, 20], QA - at) - [1, 2, 1] * qd + Arm().at(at).gravity for at in q]
    clamped = np.clip(asked, -limits, limits)
    scaled = asked / np.maximum(1, (np.abs(asked) / limits).max(axis=1))[:, None]
    assert np.abs(clamped - scaled).max() > 1
    assert np.abs(run["tau"] - (clamped if saturation == "clamp" else scaled)).max() < 1e-9
    assert np.array_equal(run["saturated"] == 1, (np.abs(asked) > limits).any(axis=1))


@pytest.mark.parametrize("anti_windup", ["none", "conditional", "back_calculation"])
@pytest.mark.parametrize("saturation", ["clamp", "scale"])
def test_anti_windup(anti_windup: str, saturation: str) -> None:
    """The integral, as the torque of the arm at rest shows it: 30 N too little for a while, then 8 N too much."""
    limits = np.array([30.0, 25.0, 15.0])
    changes = {
        "wall.motion": {"type": "fixed"}, "arm.torque_limit": limits.tolist(), "controller.saturation": saturation,
        "controller.anti_windup": anti_windup, "controller.force_integral_gain": 40,
        "reference.force": {"type": "step", "initial": 40, "value": 2, "start": 0.3}, "time.stop": 1.5,
    }  # fmt: skip
    if anti_windup == "back_calculation":
        changes["controller.tracking_time"] = 0.05
    run = pressed(changes).run()
    z, push = 0.0, np.array([-10.0, 0, 0])
    per_z = HELD.M @ np.linalg.solve(HELD.J, [40.0, 0, 0])
    shown = []
    for t in run["t"]:
        wanted = 40.0 if t < 0.3 - 1e-9 else 2.0
        law = laws.hybrid(f_d=wanted, kP=0.5, kI=40.0, m_f=1.0, b=70.0, K=400.0, D=40.0, x_d=HELD.x)
        asked = law(t, HELD, push, np.array([z]))[0]
        given = np.clip(asked, -limits, limits)
        if saturation == "scale":
            given = asked / max(1, (np.abs(asked) / limits).max())
        shown.append(given)
        rate, back = wanted - 10, per_z @ (given - asked)
        if anti_windup == "conditional" and back * rate < 0:
            rate = 0.0
        if anti_windup == "back_calculation":
            rate += back / (per_z @ per_z) / 0.05
        z += T * rate
    assert np.abs(run["tau"] - shown).max() < 1e-6
    at_limit = (np.abs(np.abs(shown) - limits) < 1e-9).any(axis=1)
    assert 0.05 < at_limit.mean() < 0.95
    assert np.array_equal(run["saturated"] == 1, at_limit)


def test_winding_up_lasts() -> None:
    """With either remedy the torque leaves its limit sooner."""
    base = {
        "wall.motion": {"type": "fixed"}, "arm.torque_limit": [30, 25, 15], "controller.force_integral_gain": 40,
        "reference.force": {"type": "step", "initial": 40, "value": 2, "start": 0.3}, "time.stop": 1.5,
    }  # fmt: skip
    runs = [
        pressed({**base, "controller.anti_windup": kind}).run() for kind in ("conditional", "back_calculation", "none")
    ]
    free = [np.flatnonzero((run["t"] > 0.301) & (run["saturated"] == 0))[0] for run in runs]
    assert runs[2]["saturated"][300] == 1
    assert max(free[:2]) < free[2] - 50, free


@pytest.mark.parametrize(("on", "off"), [(12.0, 6.0), (9.0, 9.0), (3.5, 16.0)])
def test_contact_is_judged_with_hysteresis(on: float, off: float) -> None:
    changes = {"controller.switching": "in_contact", "controller.contact_on": on, "controller.contact_off": off}
    if off > on:
        with pytest.raises(arm3r.ScenarioError, match="contact_o"):
            pressed(changes).run()
        return
    run, touching = pressed({**changes, "time.stop": 0.3, "wall.motion.phase": 0.1}).run(), False
    for row, t in enumerate(run["t"]):
        force = 10 + 7 * (np.sin(20 * np.pi * t + 0.1) - np.sin(0.1))
        touching = force > off if touching else force > on
        assert run["force_phase"][row] == touching, (t, force)
    assert 4 < np.abs(np.diff(run["force_phase"])).sum() < 8


# ---- delay and filter in the force loop -----------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["force_delay_stable", "force_delay_unstable"])
def test_a_late_force_grows_beyond_the_delay_margin(name: str) -> None:
    run, delay = read(name).run(), read(name)["sensors.force.delay"]
    margin = linear.delay_margin(**PI, k=5000)[2]
    assert margin == pytest.approx(24.826e-3, abs=5e-7)
    assert delay / 5000 / margin == pytest.approx(0.95 if name.endswith("_stable") else 1.05, abs=1e-6)
    forces = late_loop(delay, 1 / 5000, len(run["t"][1:]) * 50)
    assert np.abs(run["force"] - forces[::50]).max() < 0.01 * np.abs(forces - 20).max()
    early, late = (np.abs(forces[a:b] - 20).max() for a, b in ((5000, 7500), (15000, 17500)))
    assert (late > early) == name.endswith("unstable")


def late_loop(delay: float, period: float, ticks: int) -> Any:
    """The force loop of one degree of freedom in samples: the true force is cancelled at the tick and held, so that
    between ticks the mass swings on the spring about where it was."""
    mass, k = HELD.mass_along(np.array([1.0, 0, 0])), 5000.0
    w = np.sqrt(k / mass)
    c, s = np.cos(w * period), np.sin(w * period)
    u, v, z, forces = 0.0041, 0.0, 0.0, []
    for tick in range(ticks + 1):
        forces.append(k * u)
        place = max(0.0, tick - delay)
        before, share = int(place), place % 1
        e = 20 - ((1 - share) * forces[before] + share * forces[min(tick, before + 1)])
        a = (PI["kP"] * e + PI["kI"] * z - PI["b"] * v) / PI["m_f"]
        z += period * e
        u, v = u + a / w**2 * (1 - c) + v / w * s, v * c + a / w * s
    return np.array(forces)


@pytest.mark.parametrize("share", [0.8, 0.97, 1.03, 1.5])
def test_a_filtered_force_is_the_linear_loop(share: float) -> None:
    limit = linear.filter_limit(**PI, k=5000)
    assert limit == pytest.approx(21.434, abs=5e-4)
    run = read(
        "force_filter_unstable", {"sensors.force.analog_cutoff": share * limit / (2 * np.pi), "time.stop": 2}
    ).run()
    loop = linear.filtered_hybrid_loop(20.0, **PI, k=5000, rate=share * limit, u0=0.0041)
    started = linear.loop(loop.A, loop.c, [0.0041, 0, 0, -0.5], 5000)
    assert np.abs(run["force"] - started.forces(run["t"])).max() < 1e-6
    assert (loop.poles.real.max() > 0) == (share < 1)


# ---- a virtual wall -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("controlled", [False, True])
@pytest.mark.parametrize(("stiffness", "speed"), [(5000.0, 0.2), (20000.0, 0.1)])
def test_a_sampled_wall_gives_energy_unless_it_is_kept_passive(
    controlled: bool, stiffness: float, speed: float
) -> None:
    changes = {"controller.stiffness": stiffness, "initial.qd": [speed / np.sqrt(3), 0, 0], "time.stop": 0.05}
    run = read("virtual_wall_passive" if controlled else "virtual_wall", changes).run()
    wall = (stiffness, 0.5, T, 1e-3, speed, 51)
    free = sampled.foreseen_run(*wall) if controlled else sampled.passivity_run(*wall, controlled=False)
    assert np.abs(run["tip_y"] - (free[:, 0] + 1e-3)).max() < 2e-8
    assert np.abs(run["tip_vy"] - free[:, 1]).max() < 2e-5
    assert (-run["tip_vy"][-1] > 1.001 * speed) != controlled


# ---- lanes ----------------------------------------------------------------------------------------------------------


def test_lanes_are_single_runs() -> None:
    """Runs that differ in all that a sampled controller has, side by side, and each alone."""
    base = read("sampled_with_sensors", {"time.stop": 0.5, "time.log_every": 0.05, "solver": {"method": "rk4"}})
    base["sampling"] = {"rate": 1000}
    rng = np.random.default_rng(11)
    values = {
        "sampling.seed": np.arange(1, 12), "sensors.force.noise": rng.uniform(0, 0.5, 11),
        "sensors.force.bias": rng.uniform(-1, 1, (11, 3)), "sensors.force.delay": rng.uniform(0, 9, 11),
        "sensors.encoder.counts": rng.integers(2**16, 2**22, 11), "sensors.force.cutoff": rng.uniform(50, 400, 11),
    }  # fmt: skip
    batch = base.batch(values)
    assert batch.ok.all()
    assert len(set(batch["final_force"])) == 11
    for lane in range(11):
        alone = batch.run(lane)
        assert alone.summary["metrics"]["final_force"] == batch["final_force"][lane]
        assert alone["force"][-1] == pytest.approx(batch["final_force"][lane], abs=1e-11)
        assert np.array_equal(alone["q"][-1], [batch[f"q{i}"][lane] for i in (1, 2, 3)])


def test_reactions_in_lanes_are_single_runs() -> None:
    base = read("reaction_reflex", {"sampling.rate": 1000, "solver": {"method": "rk4"}, "time": {"stop": 0.4}})
    batch = base.batch({"observer.threshold": [0.2, 0.5, 1.0, 2.0, 5.0], "observer.reflex_gain": [0, 1, 2, 3, 1]})
    for lane in range(5):
        alone = batch.run(lane)
        assert alone.summary["peak_force"] == batch["peak_force"][lane]
        assert alone["q3"][-1] == batch["q3"][lane]
    assert len(set(batch["peak_force"])) == 5
