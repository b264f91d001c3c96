"""What axes take on: spaces, chance, and that a run's values depend on nothing but its number."""

from __future__ import annotations

from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.sweeps.axes import SweepAxis, values_of

BASE: dict[str, Any] = {"format": 1, "scenario": {"time": {"stop": 0.1}}}
KEY = "wall.contact.stiffness"


def sweep(**keys: Any) -> arm3r.Sweep:
    return arm3r.Sweep({**BASE, **keys})


@pytest.mark.parametrize("count", [1, 2, 5, 41])
def test_spaces_are_numpys_to_fourteen_digits(count: int) -> None:
    places = np.arange(count, dtype=np.uint64)
    lin, geo = SweepAxis("a", "linspace", (-1.0, 0.3, count)), SweepAxis("b", "geomspace", (1e2, 1e6, count))
    assert np.allclose(lin.take(places), np.linspace(-1, 0.3, count), rtol=1e-13, atol=1e-15)
    assert np.allclose(geo.take(places), np.geomspace(1e2, 1e6, count), rtol=1e-13)
    assert lin.take(places)[0] == -1 and geo.take(places)[-1] == (1e6 if count > 1 else 1e2)


def test_round_numbers_come_out_round() -> None:
    plan = sweep(axes=[{"key": KEY, "geomspace": [1e2, 1e6, 5]}])
    assert plan.values()[KEY].tolist() == [1e2, 1e3, 1e4, 1e5, 1e6]


def test_a_grid_counts_like_a_clock() -> None:
    plan = sweep(axes=[{"key": "time.stop", "values": [1, 2]}, {"key": "solver.method", "values": ["rk4", "dopri5"]}])
    values = plan.values()
    assert plan.runs == 4 and values["time.stop"].tolist() == [1, 1, 2, 2]
    assert values["solver.method"].tolist() == ["rk4", "dopri5"] * 2


DRAWN = [
    {"key": "time.stop", "uniform": [1, 3]},
    {"key": KEY, "log_uniform": [1e2, 1e6]},
    {"key": "initial.q[0]", "normal": [0.5, 0.1]},
    {"key": "wall.acts_on_arm", "values": [True, False]},
]


@pytest.mark.parametrize("mode", ["random", "latin_hypercube"])
def test_row_i_depends_on_i_alone(mode: str) -> None:
    plan = sweep(axes=DRAWN, mode=mode, runs=5000, seed=3)
    whole = plan.values()
    for first, count in [(0, 1), (4999, 1), (123, 456)]:
        part = plan.values(first, count)
        assert all(np.array_equal(part[key], whole[key][first : first + count]) for key in whole)


@pytest.mark.parametrize("mode", ["random", "latin_hypercube"])
def test_draws_follow_their_distributions(mode: str) -> None:
    values = sweep(axes=DRAWN, mode=mode, runs=20_000).values()
    assert abs(values["time.stop"].mean() - 2) < 0.02 and 1 < values["time.stop"].min() < values["time.stop"].max() < 3
    logs = np.log10(values[KEY])
    assert abs(logs.mean() - 4) < 0.03 and abs(logs.std() - 4 / np.sqrt(12)) < 0.02
    assert abs(values["initial.q[0]"].mean() - 0.5) < 0.003 and abs(values["initial.q[0]"].std() - 0.1) < 0.003
    assert abs(values["wall.acts_on_arm"].mean() - 0.5) < 0.02
    correlations = np.corrcoef([values["time.stop"], logs, values["initial.q[0]"], values["wall.acts_on_arm"]])
    assert abs(correlations - np.eye(4)).max() < 0.03


@pytest.mark.parametrize("runs", [1, 2, 3, 100, 1025])
def test_a_latin_hypercube_has_one_run_in_every_slice(runs: int) -> None:
    axes = (SweepAxis("a", "uniform", (0.0, 1.0)), SweepAxis("b", "uniform", (0.0, 1.0)))
    values = values_of(axes, "latin_hypercube", 1, runs, 0, runs)
    for column in values.values():
        assert sorted((column * runs).astype(int).tolist()) == list(range(runs))
    assert runs < 3 or values["a"].tolist() != values["b"].tolist()


def test_seeds_and_keys_differ() -> None:
    one, two = (sweep(axes=DRAWN, mode="random", runs=100, seed=seed).values() for seed in (1, 2))
    assert not np.intersect1d(one["time.stop"], two["time.stop"]).size


def test_the_drawn_numbers_stay_the_same_from_release_to_release() -> None:
    axes = tuple(SweepAxis(name, rule, items) for name, rule, items in [
        ("a", "uniform", (0.0, 1.0)), ("b", "log_uniform", (1.0, 1e6)), ("c", "normal", (0.0, 1.0))])  # fmt: skip
    values = values_of(axes, "random", 1, 10, 3, 2)
    assert {key: column.tolist() for key, column in values.items()} == PINNED


PINNED = {
    "a": [0.93736286138882, 0.56453335311174],
    "b": [33.673069829377, 8.650110245025],
    "c": [-0.011233730682664, -0.53602436878426],
}
