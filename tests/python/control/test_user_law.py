"""A control law of your own: a callable, a function in machine code, and a simulation stepped by hand."""

from __future__ import annotations

import ctypes
import math
import os
import signal
import subprocess
import threading
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp import LawState, Simulation

START = [0.3, -0.4, 0.9]
TEXT = """
format: 1
initial: {q: [0.3, -0.4, 0.9], qd: [0.1, 0.2, -0.3]}
time: {stop: 0.4, log_every: 0.01}
wall: {point: [1.72, 0.5, -0.1], motion: {type: fixed}, acts_on_arm: true}
controller: {type: user}
sampling: {rate: 200}
"""
METHODS = ["{method: dopri5}", "{method: rk4, step: 1e-3}", "{method: taylor}", "{method: rodas4}", "{method: auto}"]
NOISY = "{encoder: {counts: 4096}, velocity: {estimate: difference}, force: {noise: 0.5, delay: 3.5}}"


@pytest.fixture
def scenario() -> arm3r.Scenario:
    return arm3r.Scenario(TEXT)


def damp(t: float, state: LawState) -> Any:
    """Towards the wall and along it, damped."""
    return state.tau_g + state.jacobian.T @ np.array([60.0, 9 * math.sin(9 * t), 3.0]) - 4 * state.qd


def _same(one: arm3r.Run, other: arm3r.Run) -> bool:
    return one.columns == other.columns and all(np.array_equal(one[name], other[name]) for name in one)


# ---- what it is asked, and when -------------------------------------------------------------------------------------


@pytest.mark.parametrize("solver", METHODS)
def test_it_is_asked_once_at_each_sample(scenario: arm3r.Scenario, solver: str) -> None:
    scenario.edit("solver", solver, "test")
    times: list[tuple[int, float]] = []

    def law(t: float, state: LawState) -> Any:
        assert t == state.t and state.period == 0.005
        times.append((state.tick, t))
        return damp(t, state)

    run = scenario.run(controller=law)
    ticks, instants = zip(*times, strict=True)
    assert run.outcome == "ok" and len(run.events) > 0
    assert ticks == tuple(range(81))
    assert np.allclose(instants, np.arange(81) / 200, rtol=1e-15, atol=0)
    assert np.all(np.diff(instants) > 0)


def test_it_is_never_asked_in_steps_that_are_taken_back(scenario: arm3r.Scenario) -> None:
    scenario["wall.contact.stiffness"] = 1e6
    calls = []
    run = scenario.run(controller=lambda t, state: calls.append(t) or [0, 0, 0])
    assert run.summary["steps"]["rejected"] > 0
    assert len(calls) == 81 and np.all(np.diff(calls) > 0)


def test_its_torque_is_held(scenario: arm3r.Scenario) -> None:
    scenario["time.log_every"] = 0.001
    run = scenario.run(controller=lambda t, state: (state.tick, 0.5, -2.0))
    inner = slice(0, 400)
    assert np.array_equal(run["tau1"][inner], np.repeat(np.arange(80.0), 5))
    assert set(run["tau2"]) == {0.5} and set(run["tau3"]) == {-2.0}


def test_a_rate_is_1_khz_unless_it_is_said(scenario: arm3r.Scenario) -> None:
    calls: list[float] = []
    law = lambda t, state: calls.append(t) or [0, 0, 0]  # noqa: E731
    scenario["sampling"] = None
    scenario.run(controller=law)
    assert len(calls) == 401
    calls.clear()
    scenario.run(controller=law, rate=50)
    assert len(calls) == 21 and calls[1] == 0.02


@pytest.mark.parametrize("convention", ["slide", "simscape"])
def test_the_state_agrees_with_the_functions_of_the_arm(scenario: arm3r.Scenario, convention: str) -> None:
    scenario["arm.convention"] = convention
    scenario["time.log_every"] = 0.005
    arm, seen = scenario.arm, []

    def law(t: float, state: LawState) -> Any:
        assert np.array_equal(state.tip, arm.tip_position(state.q))
        assert np.array_equal(state.tau_g, arm.gravity_torque(state.q))
        assert np.array_equal(state.jacobian, arm.jacobian(state.q))
        assert np.allclose(state.tip_velocity, state.jacobian @ state.qd, rtol=0, atol=1e-14)
        assert np.array_equal(state.q, state.q_true) and np.array_equal(state.f_on_tip, state.f_on_tip_true)
        assert np.array_equal(state.wall_normal, [-1, 0, 0]) and state.wall_point[0] == 1.72
        seen.append([*state.q, *state.qd, *state.f_on_tip, state.contact])
        return damp(t, state)

    run = scenario.run(controller=law)
    rows = np.array(seen)
    assert np.array_equal(rows[:, :3], run["q"]) and np.array_equal(rows[:, 3:6], run["qd"])
    assert np.allclose(rows[:, 6:9], run["f_on_tip"], rtol=0, atol=1e-9)
    assert rows[:, 9].any() and np.array_equal(rows[:, 9] > 0, run["f_on_tip"][:, 0] < -0.75)


def test_a_moving_wall_is_seen_moving(scenario: arm3r.Scenario) -> None:
    scenario["wall.motion"] = {"type": "constant", "velocity": [-0.2, 0, 0]}
    points = []

    def law(t: float, state: LawState) -> Any:
        assert np.array_equal(state.wall_velocity, [-0.2, 0, 0])
        points.append(state.wall_point[0])
        return state.tau_g

    scenario.run(controller=law)
    assert np.allclose(points, 1.72 - 0.2 * np.arange(81) / 200, rtol=0, atol=1e-14)


def test_sensors_stand_between(scenario: arm3r.Scenario) -> None:
    scenario.edit("sensors", "{encoder: {counts: 4096}, force: {noise: 0.5}}", "test")
    step, off = 2 * math.pi / 4096, []

    def law(t: float, state: LawState) -> Any:
        assert np.allclose(state.q / step, np.round(state.q / step), rtol=0, atol=1e-9)
        off.append([*(state.q - state.q_true), *(state.f_on_tip - state.f_on_tip_true)])
        return damp(t, state)

    scenario.run(controller=law)
    errors = np.array(off)
    assert 0 < np.abs(errors[:, :3]).max() <= 0.51 * step
    assert 0.4 < errors[:, 3:].std() < 0.6


def test_the_torque_limit_holds(scenario: arm3r.Scenario) -> None:
    scenario["arm.torque_limit"] = [5, 6, 7]
    run = scenario.run(controller=lambda t, state: [100, -100, 3])
    assert set(run["tau1"]) == {5.0} and set(run["tau2"]) == {-6.0} and set(run["tau3"]) == {3.0}


# ---- the same bits as the built-in laws ---------------------------------------------------------------------------


@pytest.mark.parametrize("convention", ["slide", "simscape"])
@pytest.mark.parametrize("solver", METHODS)
def test_gravity_compensation_written_by_hand(scenario: arm3r.Scenario, convention: str, solver: str) -> None:
    scenario["arm.convention"] = convention
    scenario.edit("solver", solver, "test")
    arm, marches = scenario.arm, "rk4" in solver  # whose sines and cosines come from a grid nearby
    own = scenario.run(controller=lambda t, state: state.tau_g if marches else arm.gravity_torque(state.q))
    scenario["controller.type"] = "gravity_compensation"
    built_in = scenario.run()
    assert all(np.array_equal(own[name], built_in[name]) for name in own)
    assert built_in.events == own.events


def test_joint_pd_written_by_hand(scenario: arm3r.Scenario) -> None:
    stiffness, damping, goal = np.array([50.0, 60, 40]), np.array([9.0, 8, 7]), np.array([0.2, -0.3, 0.8])
    scenario.edit("sensors", NOISY, "test")
    own = scenario.run(controller=lambda t, s: (stiffness * (goal - s.q) - damping * s.qd) + s.tau_g)
    scenario["controller"] = {"type": "joint_pd", "joint_stiffness": stiffness, "joint_damping": damping}
    scenario["reference"] = {"type": "point", "q": goal}
    built_in = scenario.run()
    assert all(np.allclose(own[name], built_in[name], rtol=1e-9, atol=1e-9) for name in ("q", "qd", "tau"))


def test_a_run_says_whose_controller_it_had(scenario: arm3r.Scenario) -> None:
    summary = scenario.run(controller=damp).summary
    assert summary["deterministic"] is False and "type: user" in summary["scenario"]
    scenario["controller.type"] = "gravity_compensation"
    assert "deterministic" not in scenario.run().summary


def test_the_scenarios_own_law_is_set_aside(scenario: arm3r.Scenario) -> None:
    own = scenario.run(controller=damp)
    scenario["controller"] = {"type": "stiffness", "stiffness": 300}
    scenario["reference"] = {"type": "point", "tip": [1.5, 0.2, 0.3]}
    assert _same(scenario.run(controller=damp), own)
    assert scenario["controller.type"] == "stiffness" and scenario["reference.tip"] == [1.5, 0.2, 0.3]


def test_without_a_law_there_is_no_run(scenario: arm3r.Scenario) -> None:
    with pytest.raises(arm3r.ScenarioError, match="controller=f"):
        scenario.run()
    with pytest.raises(arm3r.ScenarioError, match="function of your own"):
        scenario.batch({"time.stop": [0.1, 0.2]})
    with pytest.raises(arm3r.UsageError, match="rate"):
        scenario.run(rate=100)
    with pytest.raises(arm3r.UsageError, match="function of"):
        scenario.run(controller=3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="rate"):
        scenario.run(controller=damp, rate=math.nan)


# ---- what it returns -----------------------------------------------------------------------------------------------


class _Floats(list):  # a list of another name
    pass


@pytest.mark.parametrize(
    "torque",
    [
        [1, 2, 3],
        (1.0, 2, np.float32(3)),
        np.array([1, 2, 3]),
        np.array([1, 2, 3], np.float32),
        np.arange(1.0, 7)[::2] / 2 + 0.5,
        _Floats([1, 2, 3]),
    ],
    ids=repr,
)
def test_three_numbers_are_a_torque(scenario: arm3r.Scenario, torque: Any) -> None:
    run = scenario.run(controller=lambda t, state: torque)
    assert [run[f"tau{i}"][5] for i in (1, 2, 3)] == [1, 2, 3]


BAD = [
    None,
    "abc",
    b"abc",
    3.0,
    [1, 2],
    [1, 2, 3, 4],
    [[1, 2, 3]],
    [[1], [2], [3]],
    [1, 2, None],
    [1, 2, "3"],
    [1, 2, 3j],
    {1, 2, 3},
    {1: 0, 2: 0, 3: 0},
    iter([1, 2, 3]),
    np.zeros((3, 1)),
    np.zeros(3, complex),
    np.array(["a", "b", "c"]),
    [1, 2, math.nan],
    [math.inf, 2, 3],
    np.array([1, -math.inf, 3]),
    [1e300, 0, 0],
    [0, -1.1e12, 0],
    [10**400, 0, 0],
]


def in_words(bad: Any) -> str:
    """The same in every process, which an address is not."""
    return repr(bad).split(" object at ")[0]


@pytest.mark.parametrize("bad", BAD, ids=in_words)
@pytest.mark.parametrize("tick", [0, 37, 80])
def test_all_else_is_not(scenario: arm3r.Scenario, bad: Any, tick: int) -> None:
    calls: list[int] = []

    def law(t: float, state: LawState) -> Any:
        calls.append(state.tick)
        return bad if state.tick == tick else state.tau_g

    with pytest.raises(arm3r.ControllerError, match=rf"tick {tick}, t = .*returned") as caught:
        scenario.run(controller=law)
    error = caught.value
    assert (error.tick, error.received) == (tick, bad) or error.received is bad
    assert error.t == pytest.approx(tick / 200) and error.__cause__ is None
    assert calls == list(range(tick + 1))
    _check_partial(error.run, tick)


def _check_partial(run: arm3r.Run, tick: int) -> None:
    assert run.outcome == "controller"
    assert run.t[-1] <= tick / 200 and len(run) >= max(1, tick // 2)
    assert all(np.isfinite(run[name]).all() for name in run)


# ---- what it raises -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("tick", [0, 37, 80])
@pytest.mark.parametrize("solver", METHODS[:3])
def test_what_it_raises_comes_out_with_its_traceback(scenario: arm3r.Scenario, tick: int, solver: str) -> None:
    scenario.edit("solver", solver, "test")
    calls: list[int] = []

    def deep_inside() -> None:
        raise ZeroDivisionError("by my own fault")

    def law(t: float, state: LawState) -> Any:
        calls.append(state.tick)
        if state.tick == tick:
            deep_inside()
        return state.tau_g

    with pytest.raises(arm3r.ControllerError, match="ZeroDivisionError: by my own fault") as caught:
        scenario.run(controller=law)
    cause = caught.value.__cause__
    assert isinstance(cause, ZeroDivisionError)
    assert "deep_inside" in "".join(traceback.format_exception(cause))
    assert (caught.value.tick, caught.value.received) == (tick, None)
    assert calls == list(range(tick + 1))
    _check_partial(caught.value.run, tick)


@pytest.mark.parametrize("kind", [KeyboardInterrupt, SystemExit, GeneratorExit])
def test_what_ends_programs_passes_unchanged(scenario: arm3r.Scenario, kind: type[BaseException]) -> None:
    raised = kind("mine")

    def law(t: float, state: LawState) -> Any:
        if state.tick == 3:
            raise raised
        return state.tau_g

    with pytest.raises(kind) as caught:
        scenario.run(controller=law)
    assert caught.value is raised


def test_ctrl_c_reaches_a_law(scenario: arm3r.Scenario) -> None:
    scenario["time"] = {"stop": 1e4, "log_every": 10}
    timer = threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        scenario.run(controller=lambda t, state: state.tau_g - state.qd, rate=1000)


def test_a_failure_leaves_nothing_behind(scenario: arm3r.Scenario) -> None:
    before = scenario.run(controller=damp)
    for _ in range(3):
        with pytest.raises(arm3r.ControllerError):
            scenario.run(controller=lambda t, state: 1 / 0)
    assert _same(scenario.run(controller=damp), before)


def test_a_law_may_run_scenarios_itself(scenario: arm3r.Scenario) -> None:
    inner_text = TEXT.replace("stop: 0.4", "stop: 0.02")
    plain = scenario.run(controller=damp)

    def law(t: float, state: LawState) -> Any:
        if state.tick % 20 == 0:
            arm3r.Scenario(inner_text).run(controller=damp)
            with pytest.raises(arm3r.ControllerError):
                arm3r.Scenario(inner_text).run(controller=lambda t, state: None)
        return damp(t, state)

    assert _same(scenario.run(controller=law), plain)


@pytest.mark.parametrize(
    "law", [lambda t, s: time.sleep(1000), lambda t, s: [None for _ in iter(int, 1)]], ids=["sleep", "loop"]
)
def test_a_law_that_does_not_come_back_runs_out_of_time(scenario: arm3r.Scenario, law: Any) -> None:
    with pytest.raises(arm3r.BudgetError, match=r"controller .*tick 0"):
        scenario.run(controller=law, time_limit=0.2)


def test_a_slow_law_runs_out_of_time(scenario: arm3r.Scenario) -> None:
    def law(t: float, state: LawState) -> Any:
        time.sleep(0.02)
        return state.tau_g

    with pytest.raises(arm3r.BudgetError, match="time limit") as caught:
        scenario.run(controller=law, time_limit=0.3)
    assert len(caught.value.run) > 1


def test_a_law_in_a_thread(scenario: arm3r.Scenario) -> None:
    expected, runs = scenario.run(controller=damp), []
    threads = [threading.Thread(target=lambda: runs.append(scenario.copy().run(controller=damp))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert len(runs) == 4 and all(_same(run, expected) for run in runs)


# ---- the state is the law's during its tick -------------------------------------------------------------------------


def test_a_kept_state_is_over(scenario: arm3r.Scenario) -> None:
    kept: list[LawState] = []
    scenario.run(controller=lambda t, state: kept.append(state) or state.tau_g)
    for name in [name for name in dir(LawState) if not name.startswith("_")]:
        for state in (kept[0], kept[-1]):
            with pytest.raises(RuntimeError, match="this state is over"):
                getattr(state, name)


def test_a_state_of_a_simulation_stays_as_it_was(scenario: arm3r.Scenario) -> None:
    """Kept by the caller or not, by name or within something else, and also across a snapshot."""
    simulation, other = Simulation(scenario), Simulation(scenario)
    kept, seen = [], []
    start = simulation.snapshot()
    for step in range(6):
        state = simulation.state
        assert simulation.state is state and state.t == simulation.t == other.t
        if step % 2:
            kept.append(state)
            seen.append((state.tick, state.t, state.q, state.jacobian, state.contact))
        del state
        simulation.step(damp(simulation.t, simulation.state))
        other.step(damp(other.t, other.state))
    last = simulation.state
    simulation.restore(start)
    assert simulation.t == 0 and simulation.state.tick == 0 and last.tick == 6 and last.t == other.t
    for state, (tick, t, q, jacobian, contact) in zip(kept, seen, strict=True):
        assert (state.tick, state.t, state.contact) == (tick, t, contact)
        assert np.array_equal(state.q, q) and np.array_equal(state.jacobian, jacobian)
    assert [state.tick for state in kept] == [1, 3, 5]


def test_arrays_are_copies(scenario: arm3r.Scenario) -> None:
    kept: list[Any] = []

    def law(t: float, state: LawState) -> Any:
        kept.append((state.q, state.jacobian))
        state.q[:] = math.nan
        state.jacobian[:] = math.nan
        state.tau_g[:] = 1e9
        with pytest.raises(AttributeError):
            state.q = np.zeros(3)  # type: ignore[misc]
        return damp(t, state)

    run = scenario.run(controller=law)
    assert _same(run, scenario.run(controller=damp))
    assert np.array_equal(kept[0][0], START) and not np.array_equal(kept[0][1], kept[-1][1])


# ---- in machine code ------------------------------------------------------------------------------------------------

C_LAW = """
#include "arm3r/arm3r.h"
int32_t law(void *user, const arm3r_law_state *state, double *tau) {
    const double *damping = user;
    if (state->struct_size < sizeof *state) return 7;
    if (damping[3] >= 0 && state->tick == damping[3]) return -5;
    for (int i = 0; i < 3; ++i) tau[i] = state->tau_g[i] - damping[i] * state->qd[i];
    if (damping[4] >= 0 && state->tick == damping[4]) tau[1] = 0.0 / 0.0;
    return 0;
}
int32_t silent(void *user, const arm3r_law_state *state, double *tau) { return 0; }
"""


@pytest.fixture(scope="module")
def native(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., arm3r.NativeLaw]:
    folder = tmp_path_factory.mktemp("law")
    include = Path(arm3r.__file__).parent / "include"
    (folder / "law.c").write_text(C_LAW)
    command = ["cc", "-O1", "-shared", "-fPIC", "-ffp-contract=off", f"-I{include}", "law.c", "-o", "law.so"]
    subprocess.run(command, cwd=folder, check=True)
    library = ctypes.CDLL(str(folder / "law.so"))

    def law(*numbers: float, name: str = "law") -> arm3r.NativeLaw:
        user = (ctypes.c_double * 5)(*numbers)
        keep.append((library, user))
        return arm3r.NativeLaw(ctypes.cast(getattr(library, name), ctypes.c_void_p).value or 0, ctypes.addressof(user))

    keep: list[Any] = []
    return law


def test_a_law_in_c_is_the_same_law(scenario: arm3r.Scenario, native: Callable[..., arm3r.NativeLaw]) -> None:
    run = scenario.run(controller=native(1, 2, 3, -1, -1))
    assert _same(run, scenario.run(controller=lambda t, s: s.tau_g - np.array([1.0, 2, 3]) * s.qd))


@pytest.mark.parametrize(
    ("law", "words"),
    [
        ((1, 2, 3, 12, -1), "asked to stop with -5 at tick 12, t = 0.06 s"),
        ((1, 2, 3, -1, 12), r"gave the torque \[.*\] N m at tick 12, t = 0.06 s"),
    ],
)
def test_a_law_in_c_that_fails(scenario: arm3r.Scenario, native: Any, law: Any, words: str) -> None:
    for solver in METHODS[:3]:
        scenario.edit("solver", solver, "test")
        with pytest.raises(arm3r.ControllerError, match=words) as caught:
            scenario.run(controller=native(*law))
        _check_partial(caught.value.run, 12)


def test_a_law_in_c_that_writes_nothing_gives_no_torque(scenario: arm3r.Scenario, native: Any) -> None:
    with pytest.raises(arm3r.ControllerError, match="tick 0"):
        scenario.run(controller=native(name="silent"))


def test_the_state_as_an_array_of_doubles() -> None:
    index = arm3r.law_state_index()
    assert (index["tick"], index["t"], index["period"], index["q"], index["qd"]) == (1, 2, 3, 4, 7)
    assert set(index) == {name for name in dir(LawState) if not name.startswith("_")}


# ---- by hand --------------------------------------------------------------------------------------------------------


def _stepped(simulation: Simulation) -> arm3r.Run:
    while not simulation.is_over:
        simulation.step(damp(simulation.t, simulation.state))
    return simulation.run


@pytest.mark.parametrize("solver", METHODS)
@pytest.mark.parametrize("sensors", ["null", NOISY, "{force: {analog_cutoff: 50}}"])
def test_stepping_is_the_run(scenario: arm3r.Scenario, solver: str, sensors: str) -> None:
    scenario.edit("solver", solver, "test")
    has_series = "cutoff" not in sensors or "taylor" not in solver
    scenario.edit("sensors", sensors if has_series else "null", "test")
    run, stepped = scenario.run(controller=damp), _stepped(Simulation(scenario))
    assert stepped.outcome == "ok" and _same(run, stepped)
    differ = {"elapsed_s"}
    assert {k: v for k, v in run.summary.items() if k not in differ} == {
        k: v for k, v in stepped.summary.items() if k not in differ
    }


@pytest.mark.parametrize("delay", [0, 1.5])
def test_back_to_a_snapshot_bit_for_bit(scenario: arm3r.Scenario, delay: float) -> None:
    scenario["sampling.delay"] = delay
    scenario["solver"] = {"method": "auto"}
    scenario.edit("sensors", NOISY, "test")
    expected, simulation = scenario.run(controller=damp), Simulation(scenario)
    snapshots = []
    for tick in range(60):
        if tick in (0, 20, 40):
            snapshots.append(simulation.snapshot())
        simulation.step(damp(simulation.t, simulation.state))
    for snapshot in [*snapshots, *reversed(snapshots)]:
        simulation.restore(snapshot)
        for _ in range(7):  # a way that is given up
            simulation.step([30, -20, 5])
        simulation.restore(snapshot)
        before = simulation.t
        fresh = Simulation(scenario)
        fresh.restore(snapshot)
        copy = simulation.copy()
        assert simulation.t == before == fresh.t
        for one in (simulation, fresh, copy):
            assert _same(_stepped(one), expected)


def _told(run: arm3r.Run) -> dict[str, Any]:
    """All that a summary says but the time it took."""
    return {key: value for key, value in run.summary.items() if key != "elapsed_s"}


@pytest.mark.parametrize("method", ["dopri5", "rodas4", "auto"])
@pytest.mark.parametrize("sensors", ["null", NOISY])
def test_a_copy_forgets_nothing(root: Path, method: str, sensors: str) -> None:
    """In stiff contact, with a force filter, with events: the rows and every number of the summary are the run's."""
    path = root / "scenarios/contact/stiff_damping.yaml"
    scenario = arm3r.Scenario(path.read_text().split("checks:")[0])
    scenario["controller"] = {"type": "user"}
    scenario["sampling"] = {"rate": 100}
    scenario.edit("sensors", sensors, "test")
    scenario["solver.method"] = method
    expected, simulation = scenario.run(controller=damp), Simulation(scenario)
    assert ("rodas4 from" in expected.summary["solver"]["choices"]) == (method == "auto")
    while not simulation.is_over:
        simulation = simulation.copy()
        before = simulation.snapshot()
        simulation.step([5, -3, 2])
        simulation.restore(before)
        simulation.step(damp(simulation.t, simulation.state))
    assert _same(simulation.run, expected) and _told(simulation.run) == _told(expected)


def test_a_simulation_knows_its_time_and_its_end(scenario: arm3r.Scenario) -> None:
    simulation = Simulation(scenario, rate=100)
    assert simulation.t == 0 and np.array_equal(simulation.state.q, START)
    first = simulation.state
    assert len(simulation.run) == 0 or simulation.run.t[-1] == 0
    simulation.step([0, 0, 0])
    assert simulation.t == 0.01 and simulation.state.tick == 1
    assert np.array_equal(first.q, START) and not np.array_equal(simulation.state.q, START)
    partial = simulation.run
    assert partial.outcome == "stopped" and 0 <= partial.t[-1] <= 0.01
    for _ in range(40):
        simulation.step([0, 0, 0])
    assert simulation.is_over and simulation.run.outcome == "ok" and simulation.run.t[-1] == 0.4
    with pytest.raises(arm3r.UsageError, match="over"):
        simulation.step([0, 0, 0])


@pytest.mark.parametrize("bad", BAD, ids=in_words)
def test_a_bad_torque_changes_nothing(scenario: arm3r.Scenario, bad: Any) -> None:
    simulation = Simulation(scenario)
    for tick in range(5):
        with pytest.raises(arm3r.ControllerError, match=f"tick {tick}") as caught:
            simulation.step(bad)
        assert caught.value.received is bad
        simulation.step(damp(simulation.t, simulation.state))
    assert _same(_stepped(simulation), scenario.run(controller=damp))


def test_a_run_that_ends_early_is_reported(scenario: arm3r.Scenario) -> None:
    scenario["solver.max_steps"] = 50
    simulation = Simulation(scenario)
    with pytest.raises(arm3r.BudgetError) as caught:
        _stepped(simulation)
    assert simulation.is_over and caught.value.run.outcome == "budget" and len(caught.value.run) > 0


def test_what_a_simulation_refuses(scenario: arm3r.Scenario) -> None:
    simulation = Simulation(scenario)
    other = arm3r.Scenario(TEXT.replace("1.72", "1.73"))
    with pytest.raises(arm3r.UsageError, match="another scenario"):
        simulation.restore(Simulation(other).snapshot())


def test_a_simulation_in_use_is_busy(scenario: arm3r.Scenario) -> None:
    scenario["time.stop"] = 20
    simulation, refused, done = Simulation(scenario, rate=0.1), [], threading.Event()
    simulation.step([0, 0, 0])

    def intrude() -> None:
        while not done.is_set():
            try:
                simulation.snapshot()
            except arm3r.UsageError as error:
                refused.append(str(error))

    thread = threading.Thread(target=intrude)
    thread.start()
    try:
        for _ in range(200):
            try:
                simulation.restore(simulation.snapshot())
            except arm3r.UsageError as error:
                refused.append(str(error))
    finally:
        done.set()
        thread.join()
    assert all("in use" in text for text in refused)
