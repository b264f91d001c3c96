"""The Python package: arrays, scenarios, runs, errors, and Ctrl-C."""

from __future__ import annotations

import copy
import decimal
import gc
import json
import math
import os
import pickle
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
import tracemalloc
import zipfile
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp._hash import fnv1a64
from timing import once_within

FALLING = "format: 1\ntime: {stop: 0.2, log_every: 0.1}\n"
LONG = "format: 1\nsolver: {method: rk4, step: 1e-5, max_steps: 1000000000}\ntime: {stop: 500, log_every: 0.1}\n"
POSE = np.array([0.3, -0.5, 0.9])
RATE = np.array([0.2, -0.1, 0.4])


@pytest.fixture(scope="module")
def arm() -> arm3r.Arm:
    return arm3r.Arm()


# ---- arm: shapes, broadcasting, agreement ---------------------------------------------------------------------------

SHAPES = {
    "tip_position": (["q"], [(3,)]),
    "elbow_position": (["q"], [(3,)]),
    "points": (["q"], [(7, 3)]),
    "centres": (["q"], [(3, 3)]),
    "jacobian": (["q"], [(3, 3)]),
    "geometric_jacobian": (["q"], [(6, 3)]),
    "jacobian_dot": (["q", "qd"], [(3, 3)]),
    "mass_matrix": (["q"], [(3, 3)]),
    "coriolis_matrix": (["q", "qd"], [(3, 3)]),
    "velocity_product": (["q", "qd"], [(3,)]),
    "gravity_torque": (["q"], [(3,)]),
    "operational_space_inertia": (["q"], [(3, 3)]),
    "effective_mass": (["q", "direction"], [()]),
    "manipulability": (["q"], [()]),
    "energy": (["q", "qd"], [(), ()]),
    "forward_dynamics": (["q", "qd", "tau", "f_on_tip"], [(3,)]),
    "inverse_dynamics": (["q", "qd", "qdd", "f_on_tip"], [(3,)]),
    "forward_dynamics_derivatives": (["q", "qd", "tau", "f_on_tip"], [(3, 3)] * 3),
    "inverse_dynamics_derivatives": (["q", "qd", "qdd", "f_on_tip"], [(3, 3)] * 3),
    "linearize": (["q", "qd", "tau", "f_on_tip"], [(6, 6), (6, 3)]),
    "recursion_forward_dynamics": (["q", "qd", "tau", "f_on_tip"], [(3,)]),
    "recursion_inverse_dynamics": (["q", "qd", "qdd", "f_on_tip"], [(3,)]),
    "tip_sensor": (["q", "qd"], [(3,), (3,)]),
}
each_function = pytest.mark.parametrize("name", SHAPES)


def _results(function: Any, *arguments: Any) -> list[np.ndarray]:
    results = function(*arguments)
    return [np.asarray(result) for result in (results if isinstance(results, tuple) else (results,))]


def test_every_function_is_in_the_table() -> None:
    public = {name for name in vars(arm3r.Arm) if not name.startswith("_")}
    assert public == SHAPES.keys() | {"inverse_kinematics", "params", "reach", "from_urdf"}


@each_function
@pytest.mark.parametrize("leading", [(), (1,), (5,), (2, 3), (0,), (4, 0)])
def test_leading_axes_are_kept(arm: arm3r.Arm, name: str, leading: tuple[int, ...]) -> None:
    names, shapes = SHAPES[name]
    values = [np.broadcast_to(POSE, (*leading, 3)) for _ in names]
    assert [result.shape for result in _results(getattr(arm, name), *values)] == [leading + shape for shape in shapes]


@each_function
def test_a_batch_equals_its_states_one_by_one(arm: arm3r.Arm, name: str) -> None:
    rng = np.random.default_rng(7)
    states = [rng.uniform(-2, 2, (19, 3)) for _ in SHAPES[name][0]]  # two groups of eight, and three more
    function = getattr(arm, name)
    for batch, *single in zip(
        _results(function, *states), *(_results(function, *s) for s in np.stack(states, 1)), strict=True
    ):
        assert np.array_equal(batch, np.stack(single))


@each_function
def test_arguments_broadcast(arm: arm3r.Arm, name: str) -> None:
    names, _ = SHAPES[name]
    rng = np.random.default_rng(8)
    values = [rng.uniform(-2, 2, (4, 1, 3) if i % 2 else (5, 3)) for i in range(len(names))]
    full = [np.array(v) for v in np.broadcast_arrays(*values)]
    for a, b in zip(_results(getattr(arm, name), *values), _results(getattr(arm, name), *full), strict=True):
        assert np.array_equal(a, b)


def test_the_lecture_arm(arm: arm3r.Arm) -> None:
    assert np.allclose(arm.tip_position([0, 0, 0]), [2, 0, 0], atol=1e-15)
    assert np.allclose(arm.tip_position([0, math.pi / 2, 0]), [0, 0, -2], atol=1e-15)
    assert isinstance(arm.manipulability(POSE), float)
    qdd = arm.forward_dynamics(POSE, RATE, [1, 2, 3], [4, 5, 6])
    assert np.allclose(arm.inverse_dynamics(POSE, RATE, qdd, [4, 5, 6]), [1, 2, 3], atol=1e-12)


def test_no_tip_force_is_zero_tip_force(arm: arm3r.Arm) -> None:
    assert np.array_equal(arm.forward_dynamics(POSE, RATE, RATE), arm.forward_dynamics(POSE, RATE, RATE, np.zeros(3)))


def test_arrays_are_read_where_they_lie(arm: arm3r.Arm) -> None:
    states = np.zeros((100_000, 3))
    tracemalloc.start()
    try:
        result = arm.forward_dynamics(states, states, states)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 1.1 * result.nbytes


def test_results_are_fresh_arrays(arm: arm3r.Arm) -> None:
    first = arm.jacobian(POSE)
    kept = first.copy()
    first[:] = 0
    assert np.array_equal(arm.jacobian(POSE), kept)


@pytest.mark.parametrize(
    "make",
    [
        lambda q: q.astype(">f8"),
        lambda q: np.asfortranarray(np.stack([q, q]))[0],
        lambda q: np.repeat(q, 2)[::2],
        lambda q: q[::-1].copy()[::-1],
        list,
        tuple,
        lambda q: np.frombuffer(b"x" + q.tobytes(), np.uint8)[1:].view(np.float64),
    ],
    ids=["big-endian", "fortran", "strided", "reversed", "list", "tuple", "misaligned"],
)
def test_any_layout_gives_the_same_numbers(arm: arm3r.Arm, make: Any) -> None:
    assert np.array_equal(arm.tip_position(make(POSE)), arm.tip_position(POSE))


def test_float32_is_converted_not_reinterpreted(arm: arm3r.Arm) -> None:
    single = POSE.astype(np.float32)
    assert np.array_equal(arm.tip_position(single), arm.tip_position(single.astype(np.float64)))
    assert np.array_equal(arm.tip_position([0, 1, 2]), arm.tip_position([0.0, 1.0, 2.0]))


@pytest.mark.parametrize(
    "bad",
    [
        [True, False, True],
        np.array([1, 2, 3], object),
        [1j, 0, 0],
        ["1", "2", "3"],
        [decimal.Decimal(1)] * 3,
        np.ma.masked_array([1.0, 2.0, 3.0], [0, 1, 0]),
        None,
        np.array(["2020"] * 3, "M8[Y]"),
    ],
    ids=["bool", "object", "complex", "text", "decimal", "masked", "none", "dates"],
)
def test_what_is_not_real_numbers_is_refused(arm: arm3r.Arm, bad: Any) -> None:
    with pytest.raises(TypeError):
        arm.tip_position(bad)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_named_by_index(arm: arm3r.Arm, bad: float) -> None:
    qd = np.zeros((4, 5, 3))
    qd[2, 3, 1] = bad
    with pytest.raises(ValueError, match=r"qd\[2\]\[3\]\[1\]:"):
        arm.energy(POSE, qd)


def test_what_is_not_finite_is_refused_for_no_states_too(arm: arm3r.Arm) -> None:
    with pytest.raises(ValueError, match=r"\bqd\[1\]: a finite number is needed, got nan"):
        arm.energy(np.zeros((0, 3)), [0, math.nan, 0])


@pytest.mark.parametrize("shape", [(), (2,), (4,), (3, 1), (3, 4)])
def test_wrong_shapes_are_named(arm: arm3r.Arm, shape: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match=r"q: the shape \(\.\.\., 3\) is needed"):
        arm.tip_position(np.zeros(shape))


def test_shapes_that_do_not_broadcast_are_named(arm: arm3r.Arm) -> None:
    with pytest.raises(ValueError, match=r"q \(4, 3\), qd \(5, 3\)"):
        arm.energy(np.zeros((4, 3)), np.zeros((5, 3)))


def test_inverse_kinematics_has_four_branches(arm: arm3r.Arm) -> None:
    p = [1.2, 0.4, 0.3]
    solutions = [arm.inverse_kinematics(p, front=f, elbow=e) for f in (True, False) for e in ("up", "down")]
    assert all(np.allclose(arm.tip_position(q), p, atol=1e-13) for q in solutions)
    assert len({tuple(np.round(q, 6)) for q in solutions}) == 4
    assert all(arm.elbow_position(q)[2] > arm.elbow_position(r)[2] for q, r in (solutions[:2], solutions[2:]))


def test_out_of_reach_is_named_by_index(arm: arm3r.Arm) -> None:
    points = np.full((2, 3, 3), 0.5)
    points[1, 2] = [3, 0, 0]
    with pytest.raises(arm3r.UsageError, match=r"p\[1\]\[2\]: the point is out of reach") as raised:
        arm.inverse_kinematics(points)
    assert raised.value.index == (1, 2)
    assert raised.value.problems[0]["path"] == "p[1][2]" and "tip" not in str(raised.value)
    with pytest.raises(ValueError, match=r" p: the point is out of reach"):
        arm.inverse_kinematics([3, 0, 0])


@pytest.mark.parametrize("far", [math.nan, 1e7], ids=["checked here", "checked by the library"])
@pytest.mark.parametrize(
    ("q", "qd", "place"),
    [((3,), (3,), (1,)), ((4, 3), (3,), (2, 1)), ((2, 4, 3), (4, 3), (1, 2, 1)), ((2, 1, 3), (4, 3), (1, 0, 1))],
)
def test_places_are_named_in_the_shape_that_was_given(
    arm: arm3r.Arm, far: float, q: tuple[int, ...], qd: tuple[int, ...], place: tuple[int, ...]
) -> None:
    values = np.zeros(q)
    values[place] = far
    with pytest.raises(ValueError, match=rf"\bq{re.escape(''.join(f'[{i}]' for i in place))}: "):
        arm.energy(values, np.zeros(qd))
    with pytest.raises(ValueError, match=rf"\bqd{re.escape(''.join(f'[{i}]' for i in place))}: "):
        arm.energy(np.zeros(qd), values * 1e100)


def test_singular_poses_are_named_by_index(arm: arm3r.Arm) -> None:
    poses = np.full((2, 3, 3), 0.5)
    poses[1, 0, 2] = 0
    with pytest.raises(arm3r.UsageError, match=r" q\[1\]\[0\]: .* singular") as raised:
        arm.operational_space_inertia(poses)
    assert raised.value.index == (1, 0)


@pytest.mark.parametrize("singular", [0, 7, 8, 511, 512, 1026])
def test_the_first_singular_pose_of_many_is_named(arm: arm3r.Arm, singular: int) -> None:
    poses = np.full((1027, 3), 0.5)
    poses[singular:, 2] = 0
    with pytest.raises(arm3r.UsageError, match=rf" q\[{singular}\]: .* singular"):
        arm.operational_space_inertia(poses)


@pytest.mark.parametrize(
    ("bad", "message"), [([0, 0, 0], "a direction needs a length"), ([0, 1, 0], "the tip cannot move along")]
)
def test_directions_without_a_mass_are_named_by_index(arm: arm3r.Arm, bad: list[float], message: str) -> None:
    poses, directions = np.full((20, 3), 0.5), np.ones((20, 3))
    poses[17] = [0, 0, math.pi]  # folded back onto the shoulder: no joint moves the tip sideways
    directions[17] = bad
    with pytest.raises(arm3r.UsageError, match=message) as raised:
        arm.effective_mass(poses, directions)
    assert raised.value.index == (17,)


def test_inverse_kinematics_options_are_checked(arm: arm3r.Arm) -> None:
    with pytest.raises(ValueError, match="'up' or 'down'"):
        arm.inverse_kinematics([1, 0, 0], elbow="left")
    with pytest.raises(TypeError, match="front: True or False is needed, got 'no'"):
        arm.inverse_kinematics([1, 0, 0], front="no")  # type: ignore[arg-type]
    assert np.array_equal(
        arm.inverse_kinematics([1, 0, 0], front=np.bool_(False)), arm.inverse_kinematics([1, 0, 0], front=False)
    )
    with pytest.raises(TypeError):
        arm.inverse_kinematics([1, 0, 0], True)  # type: ignore[misc]


def test_arms_survive_copies_and_threads(arm: arm3r.Arm) -> None:
    q = np.random.default_rng(3).uniform(-3, 3, (1000, 3))
    expected = arm.mass_matrix(q)
    assert np.array_equal(pickle.loads(pickle.dumps(arm)).mass_matrix(q), expected)
    assert np.array_equal(copy.deepcopy(arm).mass_matrix(q), expected)
    with ThreadPoolExecutor(4) as pool:
        assert all(np.array_equal(found, expected) for found in pool.map(arm.mass_matrix, [q] * 16))


def test_arm_of_wrong_parameters_is_refused() -> None:
    with pytest.raises(arm3r.UsageError):
        arm3r.Arm(np.zeros(3))


# ---- parameters -----------------------------------------------------------------------------------------------------


def test_parameters_have_names() -> None:
    names = [arm3r.param_name(i) for i in range(arm3r.param_count())]
    assert [arm3r.param_index(name) for name in names] == list(range(len(names)))
    assert {"solver.rtol", "initial.q[0]"} <= set(names)
    assert arm3r.param_index("wall.contact.stiffness") == names.index("wall.contact.stiffness[0]")
    assert len(arm3r.param_defaults()) == len(names)


def test_unknown_parameters_are_refused() -> None:
    with pytest.raises(arm3r.UsageError, match=r"wall\.contact\.stiffness"):
        arm3r.param_index("wall.contact.stifness")
    with pytest.raises(arm3r.UsageError):
        arm3r.param_name(arm3r.param_count())
    with pytest.raises(IndexError):
        arm3r.param_name(-1)
    with pytest.raises(TypeError, match="name: text"):
        arm3r.param_index(3)  # type: ignore[arg-type]


# ---- scenarios ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "value", "read"),
    [
        ("wall.contact.stiffness", 500, 500),
        ("wall.contact.stiffness", np.float32(0.5), 0.5),
        ("wall.contact.stiffness", np.int64(7), 7),
        ("wall.acts_on_arm", True, True),
        ("wall.acts_on_arm", np.bool_(False), False),
        ("initial.q", [0.1, -0.2, 1e-300], [0.1, -0.2, 1e-300]),
        ("initial.q", (1, 2, 3), [1, 2, 3]),
        ("initial.q", np.array([0.1, 0.2, 1 / 3]), [0.1, 0.2, 1 / 3]),
        ("initial.q[1]", "90 deg", math.pi / 2),
        ("arm.torque_limit", [1, math.inf, 2.5], [1, math.inf, 2.5]),
        ("wall.size", "infinite", "infinite"),
        ("name", "a: [strange] # name", "a: [strange] # name"),
        ("name", "ünïcode", "ünïcode"),
        (
            "controller",
            {"type": "constant", "torque": [1, 2, 3]},
            {"type": "constant", "torque": [1, 2, 3], "saturation": "clamp"},
        ),
    ],
)
def test_values_by_path(lecture: arm3r.Scenario, path: str, value: Any, read: Any) -> None:
    lecture[path] = value
    lecture.validate()
    assert lecture[path] == read


EVERY_KEY = """
format: 1
arm: {torque_limit: [inf, 5, inf], payload: {mass: 0.1}}
wall:
  motion: {type: sinusoid, amplitude: 0.01, frequency: 2}
  size: infinite
  contact: {law: diagonal, stiffness: [1, 2, 3]}
controller: {type: gravity_compensation, model: {link2: {density: 7000}}}
checks: [{name: "a: [strange] # name", column: q1, of: max, below: 1}]
"""


def _paths(value: Any, path: str) -> list[str]:
    if isinstance(value, dict):
        return [path, *(p for key, item in value.items() for p in _paths(item, f"{path}.{key}"))]
    if isinstance(value, list) and path != "checks":
        return [path, *(p for i, item in enumerate(value) for p in _paths(item, f"{path}[{i}]"))]
    return [path]


@pytest.mark.parametrize("text", ["format: 1\n", EVERY_KEY, "format: 1\nsolver: {method: rk4, step: 0.001}\n"])
def test_what_is_read_can_be_put_back(root: Path, text: str) -> None:
    scenario = arm3r.Scenario(text)
    keys = json.loads((root / "docs/scenario.schema.json").read_text())["properties"]
    names = [re.sub(r"\[\d\]$", "", arm3r.param_name(i)) for i in range(arm3r.param_count())]
    before, params = {key: scenario[key] for key in keys}, scenario.params
    paths = {path for key in keys for path in _paths(before[key], key)} | set(names)
    assert len(paths) > 100
    for path in sorted(paths):
        scenario[path] = scenario[path]
        assert {key: scenario[key] for key in keys} == before, path
    assert np.array_equal(scenario.params, params, equal_nan=True)


def test_whole_numbers_are_whole_and_absent_keys_absent() -> None:
    scenario = arm3r.Scenario("format: 1\n")
    assert isinstance(scenario["solver.max_steps"], int)
    assert "max_step" not in scenario["solver"] and "mass" not in scenario["arm.link2"]
    assert scenario["solver.max_step"] is None and scenario["wall"] is None


def test_none_takes_a_value_away(lecture: arm3r.Scenario) -> None:
    lecture["checks"] = lecture["wall"] = lecture["solver.rtol"] = None
    assert "wall" not in lecture and "wall.point" not in lecture
    assert lecture["solver.rtol"] == arm3r.Scenario()["solver.rtol"]


def test_paths_are_in_a_scenario_or_not(lecture: arm3r.Scenario) -> None:
    assert "wall.point" in lecture and "initial.q[2]" in lecture and "arm" in lecture
    assert "solver.max_step" not in lecture and "wall.pont" not in lecture and "initial.q[3]" not in lecture
    with pytest.raises(arm3r.UsageError, match=r"did you mean wall\.point"):
        lecture["wall.pont"]
    lecture["time.stop"] = -1
    with pytest.raises(arm3r.ScenarioError):
        "wall" in lecture  # noqa: B015


def test_what_is_not_text_is_refused(lecture: arm3r.Scenario, moving_wall: Path) -> None:
    for text in (None, b"format: 1", moving_wall, 3):
        with pytest.raises(TypeError, match=rf"text: text \(str\) is needed, got {type(text).__name__}"):
            arm3r.Scenario(text)  # type: ignore[arg-type]
    uses = (lambda: lecture[3], lambda: lecture.__setitem__(3, 3), lambda: 3 in lecture, lambda: list(lecture))
    for use in uses:
        with pytest.raises(TypeError, match=r"path: text \(str\) is needed, got int"):
            use()


def test_a_file_name_is_not_a_scenario(moving_wall: Path) -> None:
    with pytest.raises(arm3r.UsageError, match=r"Scenario\.load\('.*moving_wall\.yaml'\)"):
        arm3r.Scenario(str(moving_wall))


@pytest.mark.parametrize("value", [{1, 2}, object(), 1j, b"bytes", [1, object()]])
def test_values_that_yaml_cannot_say_are_refused(lecture: arm3r.Scenario, value: Any) -> None:
    with pytest.raises(TypeError, match=r"initial\.q"):
        lecture["initial.q"] = value


def test_values_are_validated_when_used(lecture: arm3r.Scenario) -> None:
    lecture["wall.contact.stiffness"] = -1
    for use in (lecture.validate, lecture.run, lecture.to_yaml):
        with pytest.raises(arm3r.ScenarioError, match="stiffness"):
            use()


def test_all_problems_are_listed() -> None:
    with pytest.raises(arm3r.ScenarioError) as raised:
        arm3r.Scenario("format: 1\nwal: {}\ntime: {stop: -1}\n", file="two.yaml").validate()
    error = raised.value
    assert isinstance(error, ValueError) and isinstance(error, arm3r.Arm3rError)
    assert [(p["file"], p["line"], p["path"]) for p in error.problems] == [
        ("two.yaml", 2, "wal"),
        ("two.yaml", 3, "time.stop"),
    ]
    assert error.status < 0 and error.code


def test_missing_files_are_usage_errors(tmp_path: Path) -> None:
    with pytest.raises(arm3r.UsageError, match="nowhere"):
        arm3r.Scenario.load(tmp_path / "nowhere.yaml")


def test_scenarios_of_other_formats_are_incompatible() -> None:
    with pytest.raises(arm3r.IncompatibleError):
        arm3r.Scenario("format: 2\n").validate()


def test_yaml_round_trip(lecture: arm3r.Scenario) -> None:
    lecture["initial.q[0]"] = 1 / 3
    for annotate in (False, True):
        again = arm3r.Scenario(lecture.to_yaml(annotate=annotate))
        assert np.array_equal(again.params, lecture.params, equal_nan=True)
        assert again.name == lecture.name


def test_parameters_of_a_scenario(lecture: arm3r.Scenario) -> None:
    lecture["wall.contact.stiffness"] = 123.5
    assert lecture.params[arm3r.param_index("wall.contact.stiffness")] == 123.5


def test_copies_are_independent(lecture: arm3r.Scenario) -> None:
    for make in (arm3r.Scenario.copy, copy.copy, copy.deepcopy, lambda s: pickle.loads(pickle.dumps(s))):
        other = make(lecture)
        other["wall.contact.stiffness"] = 1
        assert lecture["wall.contact.stiffness"] == 1000
        assert other.name == lecture.name


def test_the_arm_of_a_scenario() -> None:
    scenario = arm3r.Scenario("format: 1\narm: {link2: {length: 2.0}}\n")
    assert np.allclose(scenario.arm.tip_position([0, 0, 0]), [3, 0, 0])


# ---- runs -----------------------------------------------------------------------------------------------------------


def test_columns_are_read_only_views(lecture_run: arm3r.Run) -> None:
    q1 = lecture_run["q1"]
    assert q1.dtype == np.float64 and q1.shape == lecture_run.t.shape
    assert not q1.flags.owndata and lecture_run["q1"] is q1
    with pytest.raises(ValueError):
        q1[0] = 1
    with pytest.raises(ValueError):
        q1.flags.writeable = True


def test_columns_outlive_their_run() -> None:
    run = arm3r.Scenario(FALLING).run()
    column, kept = run["q2"][1:], run["q2"][1:].copy()
    del run
    gc.collect()
    for _ in range(20):
        arm3r.Scenario(FALLING).run()
    assert np.array_equal(column, kept)


def test_three_columns_at_once(lecture_run: arm3r.Run) -> None:
    rows = len(lecture_run)
    for name, first in {
        "q": "q1",
        "tau_g": "tau_g1",
        "tip": "tip_x",
        "tip_v": "tip_vx",
        "f_on_tip": "f_on_tip_x",
    }.items():
        assert lecture_run[name].shape == (rows, 3)
        assert np.array_equal(lecture_run[name][:, 0], lecture_run[first])


def test_unknown_columns_name_the_nearest(lecture_run: arm3r.Run) -> None:
    with pytest.raises(KeyError, match="tip_x"):
        lecture_run["tipx"]
    for name in (0, slice(2), None, ("q1", "q2")):
        with pytest.raises(TypeError, match=r"a column's name is needed"):
            lecture_run[name]  # type: ignore[index]


def test_runs_are_mappings_of_columns(lecture_run: arm3r.Run) -> None:
    assert list(lecture_run) == lecture_run.columns
    assert "q1" in lecture_run and "q" in lecture_run and "f_on_tip" in lecture_run
    assert "q4" not in lecture_run and 0 not in lecture_run and None not in lecture_run


def test_every_column_has_a_unit(lecture_run: arm3r.Run) -> None:
    assert list(lecture_run.units) == lecture_run.columns
    assert (lecture_run.units["t"], lecture_run.units["q1"], lecture_run.units["tip_x"]) == ("s", "rad", "m")


def test_the_lecture_in_python(lecture_run: arm3r.Run) -> None:
    assert lecture_run.outcome == "ok" and lecture_run.passed and lecture_run.checks
    (make,) = lecture_run.events
    assert make.type == "make" and make.t == pytest.approx(5.358984, abs=1e-6)
    assert (lecture_run.t[0], lecture_run.t[-1]) == (0, 10)
    assert lecture_run.summary["outcome"] == "ok" and lecture_run.report()
    assert "10" in repr(lecture_run)


def test_columns_agree_with_the_arm(lecture: arm3r.Scenario, lecture_run: arm3r.Run) -> None:
    assert np.array_equal(lecture.arm.gravity_torque(lecture_run["q"]), lecture_run["tau_g"])
    assert np.array_equal(lecture.arm.tip_sensor(lecture_run["q"], lecture_run["qd"])[0], lecture_run["tip"])


@pytest.mark.parametrize("suffix", [".csv", ".npz"])
def test_files_read_back_to_the_same_bits(lecture_run: arm3r.Run, tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"run{suffix}"
    {".csv": lecture_run.to_csv, ".npz": lecture_run.to_npz}[suffix](path)
    _equal(arm3r.Run.load(path), lecture_run)
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(
        {f"run{suffix}", "run.npz" if suffix == ".npz" else "run.json"}
    )


def test_runs_are_pickled(lecture_run: arm3r.Run) -> None:
    again = pickle.loads(pickle.dumps(lecture_run))
    _equal(again, lecture_run)
    assert again.report() == lecture_run.report()


def _equal(again: arm3r.Run, run: arm3r.Run) -> None:
    assert again.columns == run.columns and again.units == run.units
    for name in run.columns:
        assert np.array_equal(again[name].view(np.uint64), run[name].view(np.uint64)), name
        assert not again[name].flags.writeable
    assert (again.summary, again.events, again.outcome) == (run.summary, run.events, run.outcome)


def test_executable_and_python_give_the_same_bits(
    cli: Any, moving_wall: Path, lecture_run: arm3r.Run, tmp_path: Path
) -> None:
    assert cli("run", moving_wall, "-o", tmp_path / "run.csv").returncode == 0
    again = arm3r.Run.load(tmp_path / "run.csv")
    for name in lecture_run.columns:
        assert np.array_equal(again[name].view(np.uint64), lecture_run[name].view(np.uint64)), name
    assert again.summary["hash"] == lecture_run.summary["hash"]


def test_files_that_cannot_be_written(lecture_run: arm3r.Run, tmp_path: Path) -> None:
    with pytest.raises(arm3r.OutputError):
        lecture_run.to_csv(tmp_path / "no" / "such" / "folder.csv")
    with pytest.raises(OSError):
        lecture_run.to_npz(tmp_path / "no" / "such" / "folder.npz")


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The files of a small run, by suffix."""
    folder = tmp_path_factory.mktemp("written")
    run = arm3r.Scenario(FALLING).run()
    run.to_csv(folder / "run.csv")
    run.to_npz(folder / "run.npz")
    return {path.suffix: path.read_bytes() for path in folder.iterdir()}


def _edit(line: int, old: bytes, new: bytes) -> Callable[[bytes], bytes]:
    def change(data: bytes) -> bytes:
        lines = data.splitlines(keepends=True)
        assert old in lines[line - 1]
        lines[line - 1] = lines[line - 1].replace(old, new, 1)
        return b"".join(lines)

    return change


@pytest.mark.parametrize(
    ("suffix", "change", "why"),
    [
        (".csv", lambda data: b"".join(data.splitlines(keepends=True)[:-1]), r"run\.csv: .*rows: 3 in .*, 2 in"),
        (".csv", lambda data: data.splitlines(keepends=True)[0], r"run\.csv: .*rows: 3 in .*, 0 in"),
        (".csv", lambda data: b"", r"run\.csv:1: a line of column names"),
        (".csv", lambda data: b"\xff\xfe\0" + data, r"run\.csv:1: a line of column names"),
        (".csv", lambda data: data[:-40], r"run\.csv:4: a whole line of 42 numbers .* ends within it"),
        (".csv", lambda data: data[:-1], r"run\.csv:4: a whole line .* ends within it"),
        (".csv", _edit(3, b"0.1,", b"0.1,0,"), r"run\.csv:3: a whole line of 42 numbers is needed, got 43"),
        (".csv", _edit(3, b",-", b",minus "), r"run\.csv:3: q\w+: a number is needed, got 'minus "),
        (".csv", _edit(3, b"0.1,", b"0.1000000000000001,"), r"run\.csv: .*hash: fnv1a64:\w+ in .*, fnv1a64:\w+ in"),
        (".csv", _edit(3, b"0.1,", b"nan,"), r"run\.csv: .*hash"),
        (".csv", _edit(1, b"q1,", b"Q1,"), r"run\.csv: .*column: q1 in the summary, Q1 in"),
        (".json", lambda data: data[:80], r"run\.json:\d+:\d+: not JSON"),
        (".json", lambda data: b"[]", r"run\.json: not the summary of a run"),
        (".json", lambda data: b"{}", r"run\.json: not the summary of a run"),
        (".json", None, r"run\.json: cannot be read: No such file"),
        (".csv", None, r"run\.csv: cannot be read: No such file"),
        (".npz", None, r"run\.npz: cannot be read: No such file"),
        (".npz", lambda data: data[: len(data) // 2], r"run\.npz: not a run that to_npz wrote, or damaged"),
        (".npz", lambda data: b"", r"run\.npz: not a run"),
        (".npz", lambda data: b"text", r"run\.npz: not a run"),
    ],
)
@pytest.mark.filterwarnings("error")
def test_files_that_are_not_as_they_were_written(
    written: dict[str, bytes], tmp_path: Path, suffix: str, change: Callable[[bytes], bytes] | None, why: str
) -> None:
    for other, data in written.items():
        (tmp_path / "run").with_suffix(other).write_bytes(data)
    changed = (tmp_path / "run").with_suffix(suffix)
    changed.unlink() if change is None else changed.write_bytes(change(written[suffix]))
    with pytest.raises(arm3r.UsageError, match=why):
        arm3r.Run.load(tmp_path / ("run.npz" if suffix == ".npz" else "run.csv"))


def test_other_names_than_csv_and_npz_are_refused(tmp_path: Path) -> None:
    with pytest.raises(arm3r.UsageError, match=r"\.csv or \.npz"):
        arm3r.Run.load(tmp_path / "run.parquet")


def test_numbers_changed_in_an_npz_are_seen(lecture_run: arm3r.Run, tmp_path: Path) -> None:
    lecture_run.to_npz(tmp_path / "run.npz")
    with zipfile.ZipFile(tmp_path / "run.npz") as file:
        parts = {name: bytearray(file.read(name)) for name in file.namelist()}
    parts["q2.npy"][-30] ^= 1  # in the last numbers
    with zipfile.ZipFile(tmp_path / "run.npz", "w") as file:
        for name, data in parts.items():
            file.writestr(name, bytes(data))
    with pytest.raises(arm3r.UsageError, match="hash"):
        arm3r.Run.load(tmp_path / "run.npz")


def test_an_npz_is_the_same_by_python_and_by_the_library(cli: Any, lecture: arm3r.Scenario, tmp_path: Path) -> None:
    (tmp_path / "short.yaml").write_text(lecture.to_yaml())
    short = "time.stop=0.05", "checks=[]"
    cli("run", tmp_path / "short.yaml", *(word for edit in short for word in ("--set", edit)), "-o", tmp_path / "a.npz")
    lecture.update({"time.stop": 0.05, "checks": []})
    lecture.run().to_npz(tmp_path / "b.npz")
    with zipfile.ZipFile(tmp_path / "a.npz") as one, zipfile.ZipFile(tmp_path / "b.npz") as other:
        assert other.namelist() == [*one.namelist(), "report.txt"]
        for name in one.namelist():
            assert name == "summary.json" or one.read(name) == other.read(name), name


def test_an_npz_of_an_older_version_is_read(lecture_run: arm3r.Run, tmp_path: Path) -> None:
    data = np.stack([lecture_run[name] for name in lecture_run.columns])
    parts = {"columns": lecture_run.columns, "units": list(lecture_run.units.values()), "data": data}
    np.savez(tmp_path / "run.npz", **parts, summary=json.dumps(lecture_run.summary), report=lecture_run.report())
    _equal(arm3r.Run.load(tmp_path / "run.npz"), lecture_run)


def test_lines_may_end_as_on_other_systems(written: dict[str, bytes], tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_bytes(written[".csv"].replace(b"\n", b"\r\n"))
    (tmp_path / "run.json").write_bytes(written[".json"])
    assert len(arm3r.Run.load(tmp_path / "run.csv")) == 3


def test_partial_runs_are_read_back(tmp_path: Path) -> None:
    with pytest.raises(arm3r.BudgetError) as raised:
        arm3r.Scenario("format: 1\nsolver: {max_steps: 20}\n").run()
    raised.value.run.to_csv(tmp_path / "run.csv")
    _equal(arm3r.Run.load(tmp_path / "run.csv"), raised.value.run)


@pytest.mark.parametrize("sizes", [[], [0], [1], [8191, 3], [8192], [20000]])
def test_the_hash_is_fnv1a_byte_by_byte(sizes: list[int]) -> None:
    rng = np.random.default_rng(5)
    columns = [rng.integers(0, 2**64, size, np.uint64).view(np.float64) for size in sizes]
    state = 0xCBF29CE484222325
    for byte in b"".join(column.tobytes() for column in columns):
        state = (state ^ byte) * 0x100000001B3 % 2**64
    assert fnv1a64(columns) == f"fnv1a64:{state:016x}"


def test_failing_checks_do_not_raise() -> None:
    run = arm3r.Scenario(FALLING + "checks: [{name: never, column: t, at: 0, equals: 1, abs: 0.1}]\n").run()
    assert not run.passed and run.checks[0]["passed"] is False


# ---- outcomes and callbacks -----------------------------------------------------------------------------------------


def test_exhausted_budget_keeps_the_rows() -> None:
    with pytest.raises(arm3r.BudgetError) as raised:
        arm3r.Scenario(LONG + "name: budget\n").run(time_limit=0.05)
    assert raised.value.run.outcome == "budget"
    assert 0 < raised.value.run.t[-1] < 500
    assert raised.value.code == "run.budget"


@pytest.mark.parametrize("limit", [0, -1, math.nan, math.inf])
def test_time_limits_are_checked(limit: float) -> None:
    with pytest.raises(ValueError, match="time_limit"):
        arm3r.Scenario(FALLING).run(time_limit=limit)


def test_progress_is_reported_and_stops() -> None:
    seen: list[tuple[float, float, int]] = []

    def progress(t: float, stop: float, steps: int) -> bool:
        seen.append((t, stop, steps))
        return len(seen) == 3

    with pytest.raises(arm3r.Arm3rError) as raised:
        arm3r.Scenario(LONG).run(progress=progress)
    assert type(raised.value) is arm3r.Arm3rError and raised.value.run.outcome == "stopped"
    assert len(seen) == 3 and all(stop == 500 for _, stop, _ in seen)
    assert seen == sorted(seen) and seen[0] < seen[-1]


@pytest.mark.parametrize("error", [ZeroDivisionError("mine"), SystemExit(3), KeyboardInterrupt()])
def test_what_progress_raises_comes_out_unchanged(error: BaseException, capfd: Any) -> None:
    def progress(t: float, stop: float, steps: int) -> None:
        raise error

    with pytest.raises(type(error)) as raised:
        arm3r.Scenario(LONG).run(progress=progress)
    assert raised.value is error
    assert any(entry.name == "progress" for entry in raised.traceback)
    assert capfd.readouterr().err == ""


def test_runs_inside_progress_are_independent() -> None:
    inner: list[arm3r.Run] = []

    def progress(t: float, stop: float, steps: int) -> bool:
        inner.append(arm3r.Scenario(FALLING).run(progress=lambda *_: False))
        if len(inner) == 2:
            raise LookupError("outer")
        return False

    with pytest.raises(LookupError, match="outer"):
        arm3r.Scenario(LONG).run(progress=progress)
    assert [run.outcome for run in inner] == ["ok", "ok"]


def test_runs_in_threads_keep_their_own_errors() -> None:
    def go(number: int) -> object:
        def progress(t: float, stop: float, steps: int) -> None:
            raise LookupError(number)

        try:
            arm3r.Scenario(LONG).run(progress=progress)
        except LookupError as error:
            return error.args[0]

    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(go, range(8))) == list(range(8))


def test_the_interpreter_is_free_during_a_run() -> None:
    ticks = 0
    done = threading.Event()

    def tick() -> None:
        nonlocal ticks
        while not done.wait(0.001):
            ticks += 1

    thread = threading.Thread(target=tick)
    thread.start()
    with pytest.raises(arm3r.BudgetError):
        arm3r.Scenario(LONG).run(time_limit=0.2)
    done.set()
    thread.join()
    assert ticks > 20


@pytest.mark.timed
def test_ctrl_c_returns_within_100_ms() -> None:
    code = f"""
import sys, time, arm3r_cpp
scenario = arm3r_cpp.Scenario({LONG!r})
print("ready", flush=True)
try:
    scenario.run()
except KeyboardInterrupt:
    print(time.monotonic(), flush=True)
"""

    def delay() -> float:
        process = subprocess.Popen(
            [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        assert process.stdout and process.stdout.readline() == "ready\n"
        time.sleep(0.3)
        sent = time.monotonic()
        os.kill(process.pid, signal.SIGINT)
        output, errors = process.communicate(timeout=600)
        assert process.returncode == 0, errors
        assert errors == ""
        return float(output) - sent

    assert once_within(0.1, delay)


def test_errors_are_pickled() -> None:
    with pytest.raises(arm3r.ScenarioError) as raised:
        arm3r.Scenario("wal: {}\n").validate()
    again = pickle.loads(pickle.dumps(raised.value))
    assert (type(again), str(again), again.problems) == (type(raised.value), str(raised.value), raised.value.problems)
    output = pickle.loads(pickle.dumps(arm3r.OutputError("full", status=-501, code="output")))
    assert (str(output), output.status) == ("full", -501) and isinstance(output, OSError)


# ---- modules --------------------------------------------------------------------------------------------------------


def test_sources_that_are_not_built_say_so(python: Any, root: Path, tmp_path: Path) -> None:
    shutil.copytree(root / "python" / "arm3r_cpp", tmp_path / "arm3r_cpp", ignore=shutil.ignore_patterns("*.so"))
    for modules in ("arm3r_cpp.core.run", "arm3r_cpp; arm3r_cpp.Run", "arm3r_cpp.commands.plot, arm3r_cpp.core.arm"):
        done = python(f"import {modules}", PYTHONPATH=str(tmp_path))
        assert "not built; `pip install .`" in done.stderr.splitlines()[-1] and "circular" not in done.stderr
