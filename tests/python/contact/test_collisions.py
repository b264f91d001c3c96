"""The momentum observer and the reactions to a collision against closed forms and the independent simulator."""

from __future__ import annotations

from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from force_control_oracles import QA, SETTINGS, Arm, estimation, laws, run_of, sampled, simulate, varied, wall_of
from force_scenarios import read

PUSH = np.array([-10.0, 4.0, 3.0])
MAKE = 0.05  # s: contact in the scenarios of reactions
M_N = 0.5535415113


def torque_of(force: Any) -> np.ndarray:
    return Arm().at(QA).J.T @ np.asarray(force, float)


# ---- the observer ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("gain", [[50.0, 50.0, 50.0], [20.0, 50.0, 120.0]])
def test_a_step_goes_through_a_first_order_filter(gain: list[float]) -> None:
    run = read("observer_force_step", {"observer.gain": gain, "time.stop": 0.1}).run()
    expected = torque_of(PUSH) * (1 - np.exp(-np.multiply.outer(run["t"], gain)))
    assert np.abs(run["residual"] - expected).max() < 1e-6
    forces = np.linalg.solve(Arm().at(QA).J.T, expected.T).T
    assert np.abs(run["f_estimate"] - forces).max() < 1e-5


@pytest.mark.parametrize(("rate", "gain"), [(1000, 50.0), (500, 90.0)])
def test_in_samples_it_is_a_recursion(rate: int, gain: float) -> None:
    changes = {"sampling.rate": rate, "observer.gain": gain, "time.log_every": 1 / rate, "time.stop": 60 / rate}
    run = read("observer_sampled", changes).run()
    shares = sampled.observer_samples(gain, 1 / rate, 60)
    assert np.abs(run["residual"] / torque_of(PUSH) - shares[:, None]).max() < 1e-12


def test_the_wall_is_felt_through_the_filter() -> None:
    run = read("observer_moving_wall").run()
    setting = SETTINGS["observer moving wall"]
    law = laws.observed(laws.joint_pd([400, 400, 200], [60, 60, 25], QA), 50.0)

    def with_filter(t: float, s: Any, force: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        torque, rate = law(t, s, force, z[:3])
        return torque, np.concatenate([rate, 50 * (s.J.T @ force - z[3:])])

    start = {"start": 5.3, "memory": np.zeros(6), "wall": wall_of(setting), "rtol": 1e-10}
    other = simulate(Arm(), with_filter, QA, 8.0, **start)
    late = np.flatnonzero(run["t"] > 5.3)[::5]
    assert np.abs(run["residual"][late] - [other.state(t)[9:12] for t in run["t"][late]]).max() < 1e-8
    assert np.abs(run["force"][late] - other.pressing(run["t"][late])).max() < 1e-6
    assert run.summary["energy_residual_max"] < 1e-7


def test_the_residual_is_the_filtered_torque_of_its_own_run() -> None:
    """By the trapezoidal rule between rows, which is exact to 1e-7 here."""
    run = read("observer_moving_wall", {"time.stop": 6, "time.log_every": 2e-4}).run()
    torques = np.einsum("kji,kj->ki", arm_of(run).jacobian(run["q"]), run["f_on_tip"])
    h, r = 2e-4, np.zeros(3)
    decay, slope = np.exp(-50 * h), (1 - np.exp(-50 * h)) / (50 * h)
    for before, now, told in zip(torques, torques[1:], run["residual"][1:], strict=False):
        r = decay * r + (slope - decay) * before + (1 - slope) * now
        assert np.abs(told - r).max() < 2e-5
    assert np.abs(r).max() > 5


def arm_of(run: arm3r.Run) -> Any:
    return arm3r.Scenario(run.summary["scenario"]).arm


@pytest.mark.parametrize(("newtons", "threshold"), [(100.0, 0.5), (40.0, 1.0), (300.0, 0.2)])
def test_a_ramp_is_seen_late(newtons: float, threshold: float) -> None:
    slope = abs(torque_of([-newtons, 0, 0])[2])
    expected = estimation.ramp_delay(slope, threshold, 50.0)
    changes = {
        "push.force": [-newtons, 0, 0], "push.rise": 1, "observer.threshold": [1e3, 1e3, threshold],
        "time.stop": 0.1,
    }  # fmt: skip
    run = read("observer_force_ramp", changes).run()
    seen = run["t"][np.flatnonzero(run["collision"])[0]]
    assert seen == pytest.approx(expected, abs=1.01e-4)


def test_a_collision_is_over_when_it_has_been_quiet() -> None:
    """A push of 20 ms on joint 3, 10 N m; 30 ms after r has fallen below half of the threshold it is over."""
    changes = {
        "push": {"force": [-20, 0, 0], "duration": 0.02}, "observer.hold": 0.03, "time.stop": 0.2,
        "observer.threshold": [1e3, 1e3, 0.5],
    }  # fmt: skip
    run = read("observer_force_ramp", changes).run()
    peak, decay = 10 * (1 - 0.995**200), -np.log(0.995) / 1e-4
    over = run["t"][np.flatnonzero(run["collision"])[-1]] + 1e-4
    assert over == pytest.approx(0.02 + np.log(peak / 0.25) / decay + 0.03, abs=1.01e-4)
    first = run["t"][np.flatnonzero(run["collision"])[0]]
    assert first == pytest.approx(-np.log(1 - 0.05) / 50, abs=1.01e-4)


@pytest.mark.parametrize("rate", [1000, 300, 450])
def test_a_collision_ends_at_the_same_sample_with_every_method_and_at_every_start(rate: int) -> None:
    """observer.hold is a whole number of periods: the sample at its end is not decided by rounding."""
    periods, lengths = 15, set()
    for start in (0.0, 0.7, 37.0, 1000.3):
        for solver in ({"method": "dopri5"}, {"method": "rodas4"}, {"method": "rk4", "step": 1 / (4 * rate)}):
            changes = {
                "push": {"force": [-20, 0, 0], "start": start, "duration": 0.02}, "observer.hold": periods / rate,
                "observer.threshold": [1e3, 1e3, 0.5], "sampling.rate": rate, "solver": solver,
                "time": {"start": start, "stop": start + 0.25, "log_every": 1 / rate},
            }  # fmt: skip
            run = read("observer_sampled", changes).run()
            is_loud = np.abs(run["residual"][:, 2]) > 0.25
            lengths.add(int(np.flatnonzero(run["collision"])[-1] - np.flatnonzero(is_loud)[-1]))
    assert lengths == {periods - 1}


# ---- reactions ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("gain", [0.0, 1.0, 3.0])
def test_a_reflex_lightens_the_arm(gain: float) -> None:
    run = read("reflex_apparent_mass", {"observer.reflex_gain": gain}).run()
    for row in (5, 10, 20):
        closed = -estimation.yielding_speed(0.01, M_N, gain, 50.0, run["t"][row])
        assert run["tip_vx"][row] == pytest.approx(closed, rel=3e-3)


@pytest.mark.parametrize("reaction", ["ignore", "stop", "float", "reflex"])
def test_reactions_are_those_of_the_simulator(reaction: str) -> None:
    run = read(f"reaction_{reaction}", {"time.stop": 0.5, "time.log_every": 1e-3}).run()
    changes = {"wall": {"point": [np.sqrt(3) + 0.0025, 0, 0]}, "start": MAKE, "stop": 0.5}
    other = run_of(varied(SETTINGS[f"reaction {reaction}"], **changes), rtol=1e-8)
    assert run["t"][np.flatnonzero(run["collision"])[0]] == pytest.approx(MAKE + 0.025419602, abs=1e-3)
    late = np.flatnonzero(run["t"] > MAKE)[::5]
    assert np.abs(run["force"][late] - other.pressing(run["t"][late])).max() < 0.03
    assert np.abs(run["tip"][late] - other.tips(run["t"][late])).max() < 2e-4


def test_a_retreat_moves_the_pose_with_the_residual() -> None:
    """From a collision that is there from the first sample on: memory of the model is that of the observer and q_d."""
    changes = {"observer.threshold": 1e-9, "wall": None, "push": {"force": [-2, 1, 0.5]}, "time": {"stop": 0.5}}
    run = read("reaction_retreat", changes).run()
    pd = {"Kp": [400, 400, 200], "Kd": [60, 60, 25]}

    def law(t: float, s: Any, force: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        hold = laws.joint_pd(**pd, q_d=z[3:])
        torque, rate = laws.observed(hold, 50.0)(t, s, force, z[:3])
        return torque, np.concatenate([rate, 0.5 * laws.reaction(s, z, 50.0)])

    other = simulate(Arm(), law, QA, 0.5, memory=[0, 0, 0, *QA], push=[-2, 1, 0.5], rtol=1e-9)
    poses = np.array([other.motion(t).q for t in run["t"]])
    assert np.abs(poses - QA).max() > 0.05
    assert np.abs(run["q"] - poses).max() < 1e-3 * np.abs(poses - QA).max()


def test_the_first_collision_latches_the_reaction() -> None:
    """Floating goes on after the push: the arm that it set moving coasts, where a PD would bring it back."""
    changes = {"wall": None, "push": {"force": [-5, 0, 0], "duration": 0.1}, "time": {"stop": 0.6}}
    floating = read("reaction_float", changes).run()
    held = read("reaction_ignore", changes).run()
    assert floating["tip_x"][-1] < np.sqrt(3) - 0.1
    assert held["tip_x"][-1] > np.sqrt(3) - 0.05
    assert floating["collision"][-1] == 0 and floating["collision"].max() == 1


def test_the_peaks_stand_in_order() -> None:
    peaks = [read(f"reaction_{name}").run().summary["peak_force"] for name in ("reflex", "float", "stop", "ignore")]
    assert peaks == sorted(peaks)
