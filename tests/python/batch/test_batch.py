"""Batches: every number is that of the run alone, and every mistake is named."""

from __future__ import annotations

import copy
import multiprocessing
import os
import pickle
import signal
import threading
import time
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from timing import once_within

HIT = """
format: 1
wall: {point: [1.78, 0, 0], acts_on_arm: true}
controller: {type: gravity_compensation}
arm: {damping: [0.1, 0.1, 0.1]}
time: {stop: 2.5}
"""


@pytest.fixture
def hit() -> arm3r.Scenario:
    return arm3r.Scenario(HIT)


def expected(run: arm3r.Run) -> dict[str, float]:
    """The columns of a batch, from a run with all its rows."""
    summary, end = run.summary, {name: float(run[name][-1]) for name in run.columns}
    times = {kind: [event.t for event in run.events if event.type == kind] for kind in ("make", "break")}
    known = {
        "outcome": 0.0,
        "t_end": summary["t_end"],
        **{name: summary[name] for name in ("contacts", "contact_time", "peak_force", "final_force", "impulse")},
        "ledger_residual": summary["ledger_residual"],
        "first_contact": times["make"][0] if times["make"] else np.nan,
        "first_release": times["break"][0] if times["break"] else np.nan,
        **{name: end[name] for name in ("q1", "q2", "q3", "qd1", "qd2", "qd3")},
        **{name: end[name] for name in ("work_actuators", "work_wall", "energy_dissipated")},
        **{f"steps.{name}": float(number) for name, number in summary["steps"].items()},
    }
    told = {name: np.nan if value is None else value for name, value in summary["metrics"].items()}
    assert {name: told[name] for name in known if name != "outcome"} == pytest.approx(
        {name: value for name, value in known.items() if name != "outcome"}, abs=0, rel=0, nan_ok=True
    )
    return told | known


def assert_row_is_the_run(batch: arm3r.Batch, index: tuple[int, ...]) -> None:
    run, scenario = batch.run(index), batch.scenario(index)
    numbers = expected(run) | dict(zip(TIP, scenario.arm.tip_position(run["q"][-1]).tolist(), strict=True))
    alone = scenario.batch({})
    assert set(batch.names) == numbers.keys()
    for name in batch:
        assert np.array_equal(batch[name][index], numbers[name], equal_nan=True), name
        assert np.array_equal(batch[name][index], alone[name], equal_nan=True), name


TIP = ("tip_x", "tip_y", "tip_z")  # a run's rows have it from the transform sensor instead


VARIATIONS: list[dict[str, Any]] = [
    {"wall.contact.stiffness": [100.0, 1e5]},
    {"initial.q": [[0.1, -0.5, 1.0], [0, -0.6, 1.1]]},
    {"initial.q[1]": [-0.55, -0.5]},
    {"wall.normal": [[-2, 0.1, 0], [-1, 0, 0.2]]},
    {"arm.link2.mass": [0.5, 2], "arm.gravity[2]": [-1.62, -9.81]},
    {"arm.torque_limit": [[1, 5, 3], [np.inf, np.inf, np.inf]]},
    {"solver.method": ["rk4", "dopri5"], "wall.motion.velocity": [0.1, 0.2]},
    {"wall.acts_on_arm": [True, False], "initial.qd[0]": [-0.0, 0.3]},
    {"solver.max_steps": [3e5, 1e6]},
    {"wall.motion.velocity": [0.1, 0.15], "wall.motion.type": ["constant", "constant"]},
]


@pytest.mark.parametrize("values", VARIATIONS, ids=lambda values: ",".join(values))
def test_a_row_has_the_bits_of_the_run_alone(hit: arm3r.Scenario, values: dict[str, Any]) -> None:
    batch = hit.batch(values)
    assert batch.shape == (2,) and batch.ok.all()
    assert not np.array_equal(batch["q2"][:1], batch["q2"][1:]) or "solver.max_steps" in values
    for index in range(2):
        assert_row_is_the_run(batch, (index,))


def test_a_grid_is_the_outer_product(hit: arm3r.Scenario) -> None:
    poses = np.array([[0, -0.5, 1.0], [0, -0.52, 1.04]])
    batch = hit.batch({"wall.contact.stiffness": [1e2, 1e3, 1e4], "initial.q": poses, "time.stop": 2.0}, grid=True)
    assert batch.shape == (3, 2) and batch["peak_force"].shape == (3, 2)
    assert batch.axes["initial.q"].shape == (2, 3) and batch.axes["wall.contact.stiffness"].shape == (3, 1)
    assert_row_is_the_run(batch, (2, 1))
    assert (np.diff(batch["peak_force"], axis=0) > 0).all()


def test_arrays_broadcast_as_numpys_do(hit: arm3r.Scenario) -> None:
    batch = hit.batch({"wall.contact.stiffness": np.ones((4, 1)) * 500, "time.stop": np.linspace(1, 2, 3)})
    assert batch.shape == (4, 3)
    assert np.array_equal(batch["t_end"], np.broadcast_to([1, 1.5, 2], (4, 3)))


def test_what_is_empty_and_what_is_one(hit: arm3r.Scenario) -> None:
    assert hit.batch({"time.stop": []}).shape == (0,)
    alone = hit.batch({})
    assert alone.shape == () and alone["q2"] == hit.run()["q2"][-1]
    assert_row_is_the_run(alone, ())


def test_a_section_that_is_not_there_comes_with_its_key() -> None:
    base = arm3r.Scenario("{format: 1, controller: {type: gravity_compensation}, time: {stop: 7}}")
    batch = base.batch({"wall.contact.stiffness": [-1.0, 100.0]})
    assert batch.outcomes.tolist() == ["invalid", "ok"]
    assert batch["contacts"][1] == 1
    assert "wall" not in base


def test_a_failing_run_is_one_row(hit: arm3r.Scenario) -> None:
    batch = hit.batch({"solver.max_steps": [10, 1e6], "time.stop": [1.0, 1.0]})
    assert batch.outcomes.tolist() == ["budget", "ok"]
    assert batch.ok.tolist() == [False, True]
    with pytest.raises(arm3r.BudgetError):
        batch.run(0)
    refused = hit.batch({"solver.step": [1e-9, 1e-3], "solver.method": "rk4"})
    assert refused.outcomes.tolist() == ["budget", "ok"] and np.isnan(refused["q1"]).tolist() == [True, False]


def test_an_invalid_run_has_no_numbers(hit: arm3r.Scenario) -> None:
    batch = hit.batch({"wall.contact.stiffness": [1e3, -1.0], "solver.method": ["rk4", "dopri5"]}, grid=True)
    assert batch.outcomes.tolist() == [["ok", "ok"], ["invalid", "invalid"]]
    assert all(np.isnan(batch[name][1]).all() for name in batch.names if name != "outcome")
    with pytest.raises(arm3r.ScenarioError, match="stiffness"):
        batch.run((1, 0))


@pytest.mark.parametrize("threads", [1, 2, 7])
def test_threads_never_change_a_result(hit: arm3r.Scenario, threads: int) -> None:
    values = {"wall.contact.stiffness": np.geomspace(1e2, 1e6, 600), "time.stop": 1.0}
    alone, shared = hit.batch(values, threads=1), hit.batch(values, threads=threads)
    assert all(np.array_equal(alone[name], shared[name], equal_nan=True) for name in alone)


def test_columns_and_units(hit: arm3r.Scenario) -> None:
    batch = hit.batch({"time.stop": [1.0, 2.0]})
    assert list(batch) == batch.names == list(batch.units)
    assert batch.units["peak_force"] == "N" and len(batch) == 2
    assert "2 ok" in repr(batch)
    with pytest.raises(ValueError, match="read-only"):
        batch["q1"][0] = 1
    with pytest.raises(KeyError, match="peak_force"):
        batch["peak_forc"]
    with pytest.raises(IndexError, match="has 1 of them"):
        batch.run((0, 0))


MISTAKES: list[tuple[dict[str, Any], type[Exception], list[str]]] = [
    ({"wall.contact.stifness": [1.0]}, arm3r.UsageError, ["wall.contact.stifness", "wall.contact.stiffness"]),
    ({"initial.q": [1.0, 2.0]}, arm3r.UsageError, ["initial.q", "(..., 3)", "(2,)", "initial.q[0]"]),
    ({"initial.q[3]": [1.0]}, arm3r.UsageError, ["initial.q[3]", "initial.q[0]"]),
    ({"wall": [1.0]}, arm3r.UsageError, ["section", "wall.point"]),
    ({"solver.method": [1]}, arm3r.UsageError, ["solver.method", "words"]),
    ({"wall.acts_on_arm": [0, 1]}, arm3r.UsageError, ["wall.acts_on_arm", "true or false"]),
    ({"solver.method": ["rk5"]}, arm3r.ScenarioError, ["rk5", "rk4"]),
    ({"time.stop": [1.0, np.nan]}, arm3r.UsageError, ["time.stop[1]", "nan"]),
    ({"time.stop": [1j]}, TypeError, ["time.stop", "complex"]),
    ({"time.stop": [1.0, 2.0], "initial.q[0]": [0.0] * 3}, arm3r.UsageError, ["time.stop (2,)", "(3,)", "grid=True"]),
    ({"initial.q": [[0, 0, 0]], "initial.q[1]": [1.0]}, arm3r.UsageError, ["initial.q[1]", "twice", "as initial.q "]),
    ({"initial.q[1]": ["30 deg"], "initial.q": [[0, 0, 0]]}, arm3r.UsageError, ["initial.q[1]", "twice"]),
    ({"wall.contact.stiffness": [True, False]}, TypeError, ["wall.contact.stiffness", "bool"]),
    ({"wall.contact.stiffness": [[1.0], [1.0, 2.0]]}, arm3r.UsageError, ["wall.contact.stiffness", "one shape"]),
    ({"wall.contact.stiffness": ["1 kN"]}, arm3r.ScenarioError, ["wall.contact.stiffness", "1 kN"]),
    ({"wall.contact.stiffn\udcff": [1.0]}, arm3r.UsageError, ["UTF-8"]),
    ([1.0], TypeError, ["a map of arrays by key"]),
    ({"solver.step": [1e-3]}, arm3r.ScenarioError, ["solver.step", "rk4"]),
]


@pytest.mark.parametrize(("values", "error", "words"), MISTAKES, ids=lambda part: str(part))
def test_mistakes_are_named(
    hit: arm3r.Scenario, values: dict[str, Any], error: type[Exception], words: list[str]
) -> None:
    with pytest.raises(error) as raised:
        hit.batch(values)
    assert all(word in str(raised.value) for word in words), raised.value


@pytest.mark.parametrize("threads", [0, -1, 1.5, "2", 2**31, 10**30])
def test_threads_are_a_whole_number(hit: arm3r.Scenario, threads: Any) -> None:
    with pytest.raises(arm3r.UsageError, match="threads: a whole number from 1"):
        hit.batch({"time.stop": [1.0]}, threads=threads)


def test_a_table_that_is_too_large_is_refused_first(hit: arm3r.Scenario) -> None:
    many = np.broadcast_to(1.0, (10**7,))
    with pytest.raises(arm3r.BudgetError, match="100000000000000 runs are a table of"):
        hit.batch({"wall.contact.stiffness": many, "time.stop": many}, grid=True)


ARRAYS = [
    np.arange(1.0, 5.0)[::-1], np.arange(1.0, 12.0)[::3], np.asfortranarray(np.arange(1.0, 5.0).reshape(2, 2)),
    np.array([1, 2], np.uint8), np.array([1.5, 2.0], np.float32), np.array([1.0, 2.0], ">f8"), np.array(3.0),
    np.broadcast_to(2.0, (3,)), np.empty((0, 4)),
]  # fmt: skip


@pytest.mark.parametrize("array", ARRAYS, ids=lambda array: f"{array.dtype}{array.shape}{array.strides}")
@pytest.mark.parametrize("method", ["rk4", "dopri5", "taylor"])
def test_any_array_is_its_numbers(hit: arm3r.Scenario, array: Any, method: str) -> None:
    hit["solver.method"] = method
    batch = hit.batch({"initial.qd[0]": array, "time.stop": 0.01})
    assert batch.shape == array.shape
    plain = [hit.batch({"initial.qd[0]": float(number), "time.stop": 0.01})["q1"] for number in array.ravel()]
    assert batch["q1"].ravel().tolist() == plain


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda batch: pickle.loads(pickle.dumps(batch))])
def test_copies_are_batches(hit: arm3r.Scenario, copied: Any) -> None:
    batch = hit.batch({"time.stop": [0.5, 1.0], "initial.q": [[0, -0.5, 1.0]]})
    again = copied(batch)
    assert again["q2"].tolist() == batch["q2"].tolist() and again.run(1)["q2"][-1] == batch["q2"][1]
    for array in (again["q2"], again.axes["time.stop"], batch.axes["initial.q"]):
        assert not array.flags.writeable


@pytest.mark.parametrize("index", [None, True, slice(0, 1), [0], ..., 1.0, "0"])
def test_one_run_is_chosen_by_whole_numbers(hit: arm3r.Scenario, index: Any) -> None:
    batch = hit.batch({"time.stop": [0.5, 1.0]})
    with pytest.raises(IndexError, match="whole numbers"):
        batch.run(index)
    assert batch.run(np.int64(-1)).t[-1] == 1.0


def test_a_forked_child_makes_batches(hit: arm3r.Scenario) -> None:
    values = {"wall.contact.stiffness": np.geomspace(1e2, 1e4, 100)}
    assert hit.batch(values, threads=2).ok.all()
    child = multiprocessing.get_context("fork").Process(target=hit.batch, args=(values,))
    child.start()
    child.join(20)
    assert child.exitcode == 0


def test_the_base_is_validated() -> None:
    with pytest.raises(arm3r.ScenarioError, match=r"time\.stop"):
        arm3r.Scenario("{format: 1, time: {stop: -1}}").batch({"time.stop": [1.0]})


def test_progress_is_reported_and_can_stop(hit: arm3r.Scenario) -> None:
    told: list[tuple[int, int]] = []

    def stop_soon(done: int, runs: int) -> bool:
        told.append((done, runs))
        return len(told) > 2

    batch = hit.batch({"time.stop": np.linspace(2, 2.5, 20_000)}, threads=1, progress=stop_soon)
    assert told[0][1] == 20_000 and [done for done, _ in told] == sorted(done for done, _ in told)
    assert set(batch.outcomes) == {"ok", "stopped"}


def test_what_progress_raises_comes_out(hit: arm3r.Scenario) -> None:
    def fail(done: int, runs: int) -> None:
        raise mine

    for mine in (LookupError("mine"), StopIteration("mine"), SystemExit(3), GeneratorExit("mine")):
        with pytest.raises(type(mine)) as raised:
            hit.batch({"time.stop": np.linspace(2, 2.5, 20_000)}, progress=fail)
        assert raised.value is mine


@pytest.mark.timed
def test_interrupt_comes_back_within_100_ms(hit: arm3r.Scenario) -> None:
    def delay() -> float:
        sent: list[float] = []

        def interrupt() -> None:
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        timer = threading.Timer(0.3, interrupt)
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            hit.batch({"time.stop": np.linspace(40, 50, 100_000)})
        return time.monotonic() - sent[0]

    assert once_within(0.1, delay)


@pytest.mark.timed
def test_python_goes_on_meanwhile(hit: arm3r.Scenario) -> None:
    def seconds_a_turn() -> float:
        """Of a thread that wakes up each millisecond while a batch runs."""
        turns, finished = [0], threading.Event()

        def count() -> None:
            while not finished.wait(0.001):
                turns[0] += 1

        thread = threading.Thread(target=count)
        thread.start()
        start = time.monotonic()
        hit.batch({"time.stop": np.linspace(4, 5, 3_000)}, threads=1)
        seconds = time.monotonic() - start
        finished.set()
        thread.join()
        return seconds / max(turns[0], 1)

    assert once_within(0.01, seconds_a_turn)
