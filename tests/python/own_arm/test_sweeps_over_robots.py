"""A sweep over files of arms: each run is that of its own arm, wherever the files and the workers are."""

from __future__ import annotations

import json
import pickle
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp import Arm3rError, ScenarioError
from arm3r_cpp.core.scenario import Scenario
from arm3r_cpp.sweeps.runner import _first_job
from arm3r_cpp.sweeps.shard import run_shard
from test_import_messages import ARM

BASE = """format: 1
arm: {urdf: ../robots/one.urdf, lock: {wrist: 10 deg}, payload: {mass: 0.5}}
initial: {q: [0.3, -0.5, 0.9]}
controller: {type: gravity_compensation, gravity: 9}
time: {stop: 0.1}
"""
SWEEP = """format: 1
scenario: scenarios/base.yaml
axes:
  - {key: arm.urdf, values: [robots/one.urdf, robots/other.urdf]}
  - {key: arm.payload.mass, values: [0, 0.5, 1]}
  - {key: solver.method, values: [dopri5, rk4]}
metrics: [work_actuators]
statistics: [{column: tau2, of: max_abs}]
shard: 5
"""
ARMS = {"one": ARM, "other": ARM.replace('mass value="2', 'mass value="3')}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("robots", "scenarios"):
        (tmp_path / name).mkdir()
    for name, text in ARMS.items():
        (tmp_path / f"robots/{name}.urdf").write_text(text)
    (tmp_path / "scenarios/base.yaml").write_text(BASE)
    (tmp_path / "sweep.yaml").write_text(SWEEP)
    return tmp_path


def test_each_run_is_that_of_its_own_arm(folder: Path) -> None:
    assert ARMS["one"] != ARMS["other"]
    table = arm3r.sweep(folder / "sweep.yaml", out=folder / "out")
    assert len(table["run"]) == 12 and set(table["outcome"]) == {"ok"}
    for i, name in enumerate(table["arm.urdf"]):
        one = Scenario.load(folder / "scenarios/base.yaml")
        one["arm.urdf"] = str(folder / name)
        one["arm.payload.mass"], one["solver.method"] = table["arm.payload.mass"][i], str(table["solver.method"][i])
        assert table["work_actuators"][i] == one.run().summary["metrics"]["work_actuators"]
    by_arm = table["work_actuators"].reshape(2, 6)
    assert (by_arm[0] != by_arm[1]).all()


def test_a_batch_in_memory_has_the_same_numbers(folder: Path) -> None:
    axes = {"arm.urdf": [str(folder / f"robots/{name}.urdf") for name in ARMS], "arm.payload.mass": [0, 0.5, 1],
            "solver.method": ["dopri5", "rk4"]}  # fmt: skip
    batch = Scenario.load(folder / "scenarios/base.yaml").batch(axes, grid=True)
    table = arm3r.sweep(folder / "sweep.yaml", out=folder / "out")
    assert np.array_equal(batch["work_actuators"].ravel(), table["work_actuators"])


def test_workers_need_no_files(folder: Path) -> None:
    sweep = arm3r.Sweep.load(folder / "sweep.yaml")
    here = arm3r.sweep(sweep, out=folder / "here").path.read_bytes()
    with ProcessPoolExecutor(2) as pool:
        assert arm3r.sweep(sweep, out=folder / "there", executor=pool).path.read_bytes() == here
    job = _first_job(sweep, "csv", None)
    job = replace(pickle.loads(pickle.dumps(job)), values=sweep.values(0, 5))
    for path in folder.rglob("*.*"):
        path.unlink()
    assert run_shard(job).data in here


def test_only_arms_may_vary(folder: Path) -> None:
    text = SWEEP[: SWEEP.index("  - {key: arm.payload")] + "mode: random\nruns: 7\nmetrics: [work_actuators]\n"
    (folder / "sweep.yaml").write_text(text)
    table = arm3r.sweep(folder / "sweep.yaml", out=folder / "out")
    found = {(name, work) for name, work in zip(table["arm.urdf"], table["work_actuators"], strict=True)}
    assert len(found) == 2 and np.isfinite(table["work_actuators"]).all()


RENAMED = ARM
for old, name in (("turn", "pan"), ("lift", "shoulder"), ("reach", "elbow"), ("wrist", "roll")):
    RENAMED = RENAMED.replace(f'"{old}"', f'"{name}"')
LOCKS = [{"wrist": 0.1}, {"roll": "10 deg"}]
JOINTS = [["turn", "lift", "reach"], ["pan", "shoulder", "elbow"]]


def _robots_with_names_of_their_own(folder: Path) -> Path:
    (folder / "robots/a, b.urdf").write_text(RENAMED)
    axes = [
        {"key": "arm.urdf", "values": ["robots/one.urdf", "robots/a, b.urdf"]},
        {"key": "arm.joints", "values": JOINTS},
        {"key": "arm.lock", "values": LOCKS},
    ]
    sweep = {
        "format": 1,
        "scenario": "scenarios/base.yaml",
        "mode": "list",
        "axes": axes,
        "metrics": ["work_actuators"],
    }
    (folder / "sweep.yaml").write_text(json.dumps(sweep))
    return folder / "sweep.yaml"


def test_the_names_of_joints_vary_with_the_robot(folder: Path) -> None:
    table = arm3r.sweep(_robots_with_names_of_their_own(folder), out=folder / "out")
    assert [json.loads(text) for text in table["arm.joints"]] == JOINTS
    assert list(table["arm.urdf"]) == ["robots/one.urdf", "robots/a, b.urdf"]
    for i, (file, joints, lock) in enumerate(zip(("one", "a, b"), JOINTS, LOCKS, strict=True)):
        one = Scenario.load(folder / "scenarios/base.yaml")
        one["arm.urdf"], one["arm.joints"], one["arm.lock"] = str(folder / f"robots/{file}.urdf"), joints, lock
        assert table["work_actuators"][i] == one.run().summary["metrics"]["work_actuators"]
    files = [str(folder / "robots/one.urdf"), str(folder / "robots/a, b.urdf")]
    batch = Scenario.load(folder / "scenarios/base.yaml").batch(
        {"arm.urdf": files, "arm.joints": JOINTS, "arm.lock": LOCKS}
    )
    assert np.array_equal(batch["work_actuators"], table["work_actuators"]) and len(set(table["work_actuators"])) == 2


def test_one_robot_is_locked_at_several_angles(folder: Path) -> None:
    base = Scenario.load(folder / "scenarios/base.yaml")
    batch = base.batch({"arm.lock": [{"wrist": 0}, {"wrist": "90 deg"}], "arm.payload.mass": [0, 1]}, grid=True)
    assert batch["work_actuators"].shape == (2, 2) and len(set(batch["work_actuators"].ravel())) == 4
    base["arm.lock"], base["arm.payload.mass"] = {"wrist": "90 deg"}, 1
    assert batch["work_actuators"][1, 1] == base.run().summary["metrics"]["work_actuators"]


@pytest.mark.parametrize("values", [[], [1, 2]])
def test_values_that_are_no_names_are_refused(folder: Path, values: Any) -> None:
    with pytest.raises(Arm3rError, match=r"arm\.joints"):
        Scenario.load(folder / "scenarios/base.yaml").batch({"arm.joints": values})


@pytest.mark.parametrize("values", ["turn", [["turn", "lift"]]])
def test_runs_without_three_joints_are_invalid(folder: Path, values: Any) -> None:
    batch = Scenario.load(folder / "scenarios/base.yaml").batch({"arm.joints": values})
    assert set(batch.outcomes.ravel()) == {"invalid"}


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            "robots/other.urdf",
            "robots/none.urdf",
            r"sweep.yaml:4:5: error\[scenario.arm_file\]: .*none.urdf.*No such file",
        ),
        (
            "[robots/one.urdf, robots/other.urdf]",
            "[1, 2]",
            r"sweep.yaml:4:5: error\[scenario.arm_file\]: .*1: this file cannot be read",
        ),
    ],
)
def test_what_is_no_arm_is_said_before_any_run(folder: Path, old: str, new: str, words: str) -> None:
    (folder / "sweep.yaml").write_text(SWEEP.replace(old, new))
    with pytest.raises(ScenarioError, match=words):
        arm3r.Sweep.load(folder / "sweep.yaml")
