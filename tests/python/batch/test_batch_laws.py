"""Batches with a law of your own: each row has the bits of the run alone, and errors name the run."""

from __future__ import annotations

import ctypes
import math
import os
import pickle
import signal
import subprocess
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp import LawState, NativeLaw

TEXT = """
format: 1
initial: {q: [0.3, -0.4, 0.9], qd: [0.1, 0.2, -0.3]}
time: {stop: 0.2}
wall: {point: [1.72, 0.5, -0.1], motion: {type: fixed}, acts_on_arm: true}
controller: {type: user}
sampling: {rate: 200, delay: 0.4}
sensors: {force: {noise: 0.5}}
"""
METHODS = ["{method: dopri5}", "{method: rk4, step: 1e-3}", "{method: taylor}", "{method: rodas4}", "{method: auto}"]
STIFFNESS = [1e2, 3e3, 1e5]


@pytest.fixture
def scenario() -> arm3r.Scenario:
    return arm3r.Scenario(TEXT)


def press(t: float, state: LawState) -> Any:
    """Towards the wall and along it, damped."""
    return state.tau_g + state.jacobian.T @ np.array([60.0, 9 * math.sin(9 * t), 3.0]) - 4 * state.qd


class Integral:
    """A law with a memory: it must be a new one in each run."""

    def __init__(self, gain: float) -> None:
        self.gain, self.sum = gain, np.zeros(3)

    def __call__(self, t: float, state: LawState) -> Any:
        self.sum += self.gain * state.period * (np.array([0.3, -0.4, 0.9]) - state.q)
        return state.tau_g + self.sum


def assert_rows_are_the_runs(batch: arm3r.Batch, run: Callable[[tuple[int, ...]], arm3r.Run] | None = None) -> None:
    assert batch.ok.all() and len(np.unique(batch["q2"])) == len(batch)
    for index in np.ndindex(batch.shape):
        alone = (run or batch.run)(index)
        metrics = alone.summary["metrics"]
        assert len(metrics) > 20
        for name, value in metrics.items():
            due = np.nan if value is None else value
            if name != "outcome":
                assert np.array_equal(batch[name][index], due, equal_nan=True), (index, name)
        assert [batch[f"q{i}"][index] for i in (1, 2, 3)] == alone["q"][-1].tolist()


# ---- laws in Python -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("solver", METHODS)
def test_a_row_has_the_bits_of_the_run_alone(scenario: arm3r.Scenario, solver: str) -> None:
    scenario.edit("solver", solver, "test")
    batch = scenario.batch({"wall.contact.stiffness": STIFFNESS}, controller=press)
    assert_rows_are_the_runs(batch)
    assert_rows_are_the_runs(batch, lambda index: batch.scenario(index).run(controller=press))


def test_a_law_with_a_memory_is_made_for_each_run(scenario: arm3r.Scenario) -> None:
    gains, made = np.array([[50.0, 80.0], [120.0, 160.0]]), []

    def make(index: tuple[int, ...]) -> Integral:
        made.append(index)
        return Integral(gains[index])

    batch = scenario.batch({"initial.q[0]": [0.2, 0.3], "time.stop": [0.1, 0.2]}, grid=True, make_controller=make)
    assert made == list(np.ndindex(2, 2))
    assert_rows_are_the_runs(batch)
    assert_rows_are_the_runs(batch, lambda index: batch.scenario(index).run(controller=Integral(gains[index])))


def test_words_vary_and_the_rate_is_that_of_run(scenario: arm3r.Scenario) -> None:
    scenario["controller"] = {"type": "gravity_compensation"}
    scenario["sampling"] = scenario["sensors"] = None
    values = {"solver.method": ["rk4", "dopri5", "rk4"], "initial.q[0]": [0.1, 0.2, 0.3]}
    batch = scenario.batch(values, controller=press, rate=250)
    assert_rows_are_the_runs(batch)
    assert batch.scenario(1)["sampling.rate"] == 250 and scenario["controller.type"] == "gravity_compensation"


def test_runs_that_are_not_valid_and_batches_of_none_and_one(scenario: arm3r.Scenario) -> None:
    batch = scenario.batch({"wall.contact.stiffness": [-1.0, 1e3]}, controller=press)
    assert batch.outcomes.tolist() == ["invalid", "ok"]
    assert scenario.batch({"time.stop": []}, controller=press).shape == (0,)
    assert_rows_are_the_runs(scenario.batch({}, make_controller=lambda index: press if index == () else None))


def test_the_law_is_called_in_the_callers_thread_for_one_run_after_the_other(scenario: arm3r.Scenario) -> None:
    seen: list[tuple[int, int]] = []

    def law(t: float, state: LawState) -> Any:
        seen.append((threading.get_ident(), state.tick))
        return press(t, state)

    scenario.batch({"initial.q[0]": [0.1, 0.2]}, controller=law, threads=8)
    assert seen == [(threading.get_ident(), tick) for _ in range(2) for tick in range(41)]


def test_an_error_of_the_law_names_the_run(scenario: arm3r.Scenario) -> None:
    calls = []

    def law(t: float, state: LawState) -> Any:
        calls.append(t)
        if len(calls) == 2 * 41 + 11:
            raise ZeroDivisionError("by nothing")
        return press(t, state)

    with pytest.raises(
        arm3r.ControllerError, match=r"run \(1, 0\), at tick 10, t = 0\.05 s: .*law raised ZeroDiv"
    ) as raised:
        scenario.batch({"initial.q[0]": [0.1, 0.2], "initial.q[1]": [-0.4, -0.5]}, grid=True, controller=law)
    error = raised.value
    assert (error.index, error.tick, error.t) == ((1, 0), 10, 0.05) and isinstance(error.__cause__, ZeroDivisionError)
    assert len(calls) == 2 * 41 + 11


@pytest.mark.parametrize("answer", [None, [1, 2], "no", [1, 2, "x"]])
def test_no_torque_names_the_run(scenario: arm3r.Scenario, answer: Any) -> None:
    with pytest.raises(arm3r.ControllerError, match=r"run 0, at tick 0, .*three finite numbers") as raised:
        scenario.batch({"initial.q[0]": [0.1, 0.2]}, controller=lambda t, state: answer)
    assert raised.value.received == answer and raised.value.__cause__ is None


def test_a_torque_that_is_not_finite_ends_its_run_alone(scenario: arm3r.Scenario) -> None:
    made = lambda index: (lambda t, state: [math.nan, 0, 0]) if index == 1 else press  # noqa: E731
    batch = scenario.batch({"initial.q[0]": [0.1, 0.2, 0.3]}, make_controller=made)
    assert batch.outcomes.tolist() == ["ok", "controller", "ok"]
    with pytest.raises(arm3r.ControllerError, match="nan"):
        batch.run(1)


def test_errors_of_the_maker_name_the_run(scenario: arm3r.Scenario) -> None:
    values = {"initial.q[0]": [0.1, 0.2]}
    with pytest.raises(arm3r.ControllerError, match=r"run 1: .*maker raised KeyError: 5") as raised:

        def maker(index: int) -> Any:
            return {0: press}[5 * index]

        scenario.batch(values, make_controller=maker)
    assert isinstance(raised.value.__cause__, KeyError) and raised.value.index == (1,)
    with pytest.raises(arm3r.ControllerError, match=r"run 0: .*it made 3; a function of \(t, state\) is needed"):
        scenario.batch(values, make_controller=lambda index: 3)  # type: ignore[arg-type,return-value]


def test_what_is_no_law_is_refused(scenario: arm3r.Scenario) -> None:
    for options in ({"controller": 3}, {"make_controller": 3}, {"rate": 100.0}, {"controller": press, "rate": -1}):
        with pytest.raises((arm3r.UsageError, ValueError)):
            scenario.batch({}, **options)  # type: ignore[arg-type]
    with pytest.raises(arm3r.UsageError, match="not both"):
        scenario.batch({}, controller=press, make_controller=lambda index: press)
    with pytest.raises(arm3r.UsageError, match=r"NativeLaw\.stride"):
        scenario.batch({}, make_controller=NativeLaw(1))  # type: ignore[arg-type]
    with pytest.raises(arm3r.ScenarioError, match=r"scenario\.run"):
        scenario.batch({})


@pytest.mark.parametrize("error", [KeyboardInterrupt(), SystemExit(3)])
def test_ctrl_c_in_the_law_ends_the_batch_unchanged(scenario: arm3r.Scenario, error: BaseException) -> None:
    def law(t: float, state: LawState) -> Any:
        calls.append(t)
        raise error

    calls: list[float] = []
    with pytest.raises(type(error)):
        scenario.batch({"initial.q[0]": np.linspace(0, 1, 100)}, controller=law)
    assert len(calls) == 1


def test_ctrl_c_ends_a_batch(scenario: arm3r.Scenario) -> None:
    def law(t: float, state: LawState) -> Any:
        if len(calls) == 300:
            os.kill(os.getpid(), signal.SIGINT)
        calls.append(t)
        return press(t, state)

    calls: list[float] = []
    with pytest.raises(KeyboardInterrupt):
        scenario.batch({"initial.q[0]": np.linspace(0, 1, 10_000)}, controller=law)
    assert len(calls) < 10_000


def test_progress_counts_runs_and_stops(scenario: arm3r.Scenario) -> None:
    told: list[tuple[int, int]] = []

    def progress(done: int, runs: int) -> bool:
        told.append((done, runs))
        return done >= 10

    batch = scenario.batch({"initial.q[0]": np.linspace(0, 1, 2000)}, controller=press, progress=progress)
    assert told == sorted(told) and told[-1][0] >= 10 and {runs for _, runs in told} == {2000}
    assert {"ok", "stopped"} <= set(batch.outcomes.tolist()) and (batch.outcomes == "stopped").sum() > 100


def test_what_progress_raises_comes_out(scenario: arm3r.Scenario) -> None:
    def progress(done: int, runs: int) -> None:
        raise LookupError("no more")

    with pytest.raises(LookupError, match="no more"):
        scenario.batch({"initial.q[0]": np.linspace(0, 1, 5000)}, controller=press, progress=progress)


def test_a_law_may_run_batches_itself(scenario: arm3r.Scenario) -> None:
    inner = scenario.batch({"initial.q[0]": [0.1, 0.2]}, controller=press)

    def law(t: float, state: LawState) -> Any:
        if state.tick == 3:
            again = scenario.batch({"initial.q[0]": [0.1, 0.2]}, controller=press)
            assert np.array_equal(again["q2"], inner["q2"])
        return press(t, state)

    assert np.array_equal(scenario.batch({"initial.q[0]": [0.1, 0.2]}, controller=law)["q2"], inner["q2"])


def test_a_pickled_batch_has_no_law(scenario: arm3r.Scenario) -> None:
    batch = pickle.loads(pickle.dumps(scenario.batch({"initial.q[0]": [0.1, 0.2]}, controller=press)))
    with pytest.raises(arm3r.ScenarioError, match=r"scenario\.run\(controller=f\)"):
        batch.run(0)
    assert batch.scenario(0).run(controller=press)["q2"][-1] == batch["q2"][0]


# ---- laws in machine code -------------------------------------------------------------------------------------------

SOURCE = """
#include <math.h>
#include "arm3r/arm3r.h"
struct memory { double gain, fail_at, calls, sum[3]; };
int32_t integral(void *user, const arm3r_law_state *state, double *tau) {
    struct memory *m = user;
    if (state->tick == 0) m->calls = m->sum[0] = m->sum[1] = m->sum[2] = 0;
    m->calls += 1;
    for (int i = 0; i < 3; ++i) {
        m->sum[i] += m->gain * state->period * (0.4 - state->q[i]);
        tau[i] = state->tau_g[i] + m->sum[i];
    }
    return state->t >= m->fail_at ? 7 : 0;
}
"""
FIELDS = 6


@pytest.fixture(scope="module")
def integral(tmp_path_factory: pytest.TempPathFactory, package: Path) -> Iterator[int]:
    """The address of a law in C whose memory is six doubles: gain, time of failure, calls, three sums."""
    folder = tmp_path_factory.mktemp("law")
    (folder / "law.c").write_text(SOURCE)
    call = ["cc", "-O1", "-ffp-contract=off", "-shared", "-fPIC", "law.c", "-o", "law.so", f"-I{package / 'include'}"]
    subprocess.run(call, cwd=folder, check=True)
    library = ctypes.CDLL(str(folder / "law.so"))
    yield ctypes.cast(library.integral, ctypes.c_void_p).value or 0


def memories(gains: Any) -> np.ndarray:
    records = np.zeros((np.size(gains), FIELDS))
    records[:, 0], records[:, 1] = np.ravel(gains), np.inf
    return records


def native(address: int, records: np.ndarray, **options: Any) -> NativeLaw:
    return NativeLaw(address, records.ctypes.data, records.strides[0], **options)


@pytest.mark.parametrize("solver", METHODS[:3])
@pytest.mark.parametrize(("reentrant", "threads"), [(False, None), (True, 1), (True, 3)])
def test_a_law_in_c_has_a_memory_for_each_run(
    scenario: arm3r.Scenario, integral: int, solver: str, reentrant: bool, threads: int | None
) -> None:
    scenario.edit("solver", solver, "test")
    records = memories(np.linspace(10, 300, 12))
    law = native(integral, records, reentrant=reentrant)
    batch = scenario.batch({"wall.contact.stiffness": np.geomspace(1e2, 1e5, 12)}, controller=law, threads=threads)
    assert (records[:, 2] == 41).all()
    assert_rows_are_the_runs(batch)
    alone = memories([10.0])
    run = batch.scenario(0).run(controller=NativeLaw(integral, alone.ctypes.data))
    assert run["q"][-1].tolist() == [batch[f"q{i}"][0] for i in (1, 2, 3)]


def test_memories_stay_with_their_runs_where_words_vary(scenario: arm3r.Scenario, integral: int) -> None:
    records = memories([10, 60, 200, 350])
    values = {"solver.method": ["rk4", "dopri5", "dopri5", "rk4"]}
    batch = scenario.batch(values, controller=native(integral, records, reentrant=True))
    assert (records[:, 2] == 41).all()
    assert_rows_are_the_runs(batch)


@pytest.mark.parametrize("reentrant", [False, True])
def test_a_law_in_c_that_fails_ends_its_run_alone(scenario: arm3r.Scenario, integral: int, reentrant: bool) -> None:
    records = memories([10, 20, 30])
    records[1, 1] = 0.1
    batch = scenario.batch({"initial.q[0]": [0.1, 0.2, 0.3]}, controller=native(integral, records, reentrant=reentrant))
    assert batch.outcomes.tolist() == ["ok", "controller", "ok"] and batch["t_end"][1] == pytest.approx(0.1)


@pytest.mark.parametrize("reentrant", [False, True])
def test_a_stopped_batch_of_laws_in_c(scenario: arm3r.Scenario, integral: int, reentrant: bool) -> None:
    records = memories(np.full(4000, 10.0))
    told: list[int] = []
    batch = scenario.batch(
        {"initial.q[0]": np.linspace(0, 1, 4000)},
        controller=native(integral, records, reentrant=reentrant),
        progress=lambda done, runs: told.append(done) or True,
    )
    assert len(told) >= 1 and (batch.outcomes == "stopped").any()


def test_a_law_that_ends_its_thread_ends_the_batch(python: Any) -> None:
    """pthread_exit within a re-entrant law: the call fails, and the process goes on."""
    code = f"""
import ctypes, numpy as np, arm3r_cpp as arm3r
address = ctypes.cast(ctypes.CDLL(None).pthread_exit, ctypes.c_void_p).value
scenario = arm3r.Scenario({TEXT!r})
law = arm3r.NativeLaw(address, reentrant=True)
try:
    scenario.batch({{"initial.q[0]": np.linspace(0, 1, 9)}}, controller=law, threads=3)
except arm3r.ControllerError as error:
    print(error)
"""
    done = python(code)
    assert done.returncode == 0 and "the law ended the thread" in done.stdout, done.stderr


@pytest.mark.parametrize(
    "law",
    [NativeLaw(-1), NativeLaw(1, -1), NativeLaw(1, 0, -8), NativeLaw(1, 0, 8, 3), NativeLaw(1, 0, 1.5)],  # type: ignore[arg-type]
)
def test_addresses_are_checked(scenario: arm3r.Scenario, law: NativeLaw) -> None:
    with pytest.raises((TypeError, ValueError), match=r"NativeLaw\.(address|user|stride|reentrant)"):
        scenario.batch({}, controller=law)
