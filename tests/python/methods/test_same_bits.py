"""One scenario, one result: on any run, by either face, at any optimisation level, whatever the processor may do."""

from __future__ import annotations

import csv
import json
import os
import subprocess
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from conftest import CALLS, scenario_files

# Everything that computes: all methods, contact both ways, friction, the recursion, every motion of the wall.
TEXTS = {
    "bounce": """
format: 1
arm:
  link2: {length: 0.8}
  link3: {length: 0.6}
  payload: {mass: 0.2}
  damping: [0.1, 0.2, 0.1]
  armature: [0.02, 0.01, 0.01]
initial: {q: [20 deg, -40 deg, 70 deg], qd: [0.3, -0.2, 0.4]}
wall:
  point: [1.2, 0.3, 0]
  normal: [-0.9, -0.3, 0.2]
  size: infinite
  motion: {type: sinusoid, amplitude: 0.2, frequency: 1.3}
  contact: {law: spring, stiffness: 3000}
  acts_on_arm: true
controller: {type: gravity_compensation, gravity: 9.5}
time: {stop: 3.0}
""",
    "friction_by_recursion": """
format: 1
arm: {convention: slide, gravity: [1, -2, -9], friction: [0.3, 0.2, 0.1], friction_velocity: 0.05, link3: {length: 0.7}}
initial: {q: [0.4, 0.7, -0.9], qd: [2, 0.5, -1]}
controller: {type: gravity_compensation, gravity: 3, algorithm: recursion, model: {link2: {mass: 0.9}}}
time: {stop: 3.0}
""",
    "fixed_steps": """
format: 1
arm: {friction: [0.1, 0.1, 0.1], torque_limit: [inf, 5, 2], link3: {length: 0.7}}
initial: {q: [0.4, -0.7, 0.9]}
wall: {point: [1.6, 0.2, 0], motion: {type: constant, velocity: [-0.3, 0.1, 0.05]}, acts_on_arm: true}
controller: {type: constant, torque: [0.1, -9, -2]}
solver: {method: rk4, step: 0.001}
time: {stop: 3.0}
""",
    "series": """
format: 1
arm: {damping: [0.05, 0.1, 0.05], friction: [0, 0, 0.05], friction_velocity: 0.1, link3: {length: 0.7}}
initial: {q: [0.3, -0.5, 1.0], qd: [0.1, 0, 0.2]}
wall:
  point: [1.75, 0.1, 0]
  normal: [-1, 0.1, 0.2]
  size: infinite
  motion: {type: sinusoid, amplitude: 0.5, frequency: 0.7}
  contact: {stiffness: 2000}
  acts_on_arm: true
controller: {type: gravity_compensation, gravity: 9.7}
solver: {method: taylor, tol: 1e-10}
time: {stop: 3.0}
""",
}


@pytest.fixture(scope="module")
def files(root: Path, tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """The scenarios above, and all that ship."""
    folder = tmp_path_factory.mktemp("scenarios")
    for name, text in TEXTS.items():
        (folder / f"{name}.yaml").write_text(text)
    return sorted(folder.iterdir()) + scenario_files()


def hashes(executable: Path, files: list[Path], **environment: str) -> dict[str, str]:
    command = [executable, "run", "--json", *files]
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **environment})
    assert done.returncode in (0, 10), done.stderr
    return {summary["name"]: summary["hash"] for summary in json.loads(done.stdout)}


@pytest.fixture(scope="module")
def expected(executable: Path, files: list[Path]) -> dict[str, str]:
    return hashes(executable, files)


def test_the_scenarios_do_what_they_are_there_for() -> None:
    runs = {name: arm3r.Scenario(text).run() for name, text in TEXTS.items()}
    assert all(run["energy_contact"].max() > 0.01 for name, run in runs.items() if name != "friction_by_recursion")
    assert all(run["energy_dissipated"][-1] > 0.01 for run in runs.values())
    assert {event.type for event in runs["bounce"].events} == {"make", "break"}


def test_second_run_gives_the_same(executable: Path, files: list[Path], expected: dict[str, str]) -> None:
    assert len(set(expected.values())) > len(files) // 2
    assert hashes(executable, files) == expected


def test_python_gives_the_same(files: list[Path], expected: dict[str, str]) -> None:
    for file in files:
        summary = arm3r.Scenario.load(file).run().summary
        assert summary["hash"] == expected[summary["name"]], file


@pytest.mark.sample(1)
@pytest.mark.parametrize("hidden", ["-AVX512F,-AVX512VL", "-AVX2,-FMA,-AVX512F", "-AVX,-AVX2,-FMA,-AVX512F,-SSE4_2"])
def test_hidden_processor_features_change_nothing(
    executable: Path, files: list[Path], expected: dict[str, str], hidden: str
) -> None:
    assert hashes(executable, files, GLIBC_TUNABLES=f"glibc.cpu.hwcaps={hidden}") == expected


@pytest.mark.needs("qemu")
@pytest.mark.parametrize("processor", ["Nehalem", "Haswell"])
def test_a_lesser_processor_gives_the_same(
    executable: Path, files: list[Path], expected: dict[str, str], processor: str
) -> None:
    """Also where the build is for the wide registers of this one alone."""
    command = ["qemu-x86_64", "-cpu", processor, executable, "run", "--json", *files[: len(TEXTS)]]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert all(expected[summary["name"]] == summary["hash"] for summary in json.loads(done.stdout))


@pytest.mark.parametrize("name", TEXTS)
def test_csv_holds_the_bits_of_the_arrays(cli: Any, tmp_path: Path, name: str) -> None:
    scenario, output = tmp_path / f"{name}.yaml", tmp_path / "out.csv"
    scenario.write_text(TEXTS[name])
    assert cli("run", scenario, "-o", output).returncode == 0
    run = arm3r.Scenario.load(scenario).run()
    with output.open(newline="") as file:
        header, *rows = csv.reader(file)
    assert header == run.columns
    for index, column in enumerate(header):
        assert np.array([float(row[index]) for row in rows]).tobytes() == run[column].tobytes(), column


def cores_of_this_worker() -> int:
    """This test's share of the processor, where others run beside it."""
    return max(1, len(os.sched_getaffinity(0)) // int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", 1)))


@pytest.mark.gate
@pytest.mark.long
@pytest.mark.parametrize(
    ("flags", "lanes"),
    [(CALLS, "all"), ("-O1", "all")],
)
def test_other_optimisation_gives_the_same(
    root: Path, package: Path, scripts: Path, files: list[Path], expected: dict[str, str], tmp_path: Path,
    flags: str, lanes: str,
) -> None:  # fmt: skip
    environment = {**os.environ, "PATH": f"{scripts}{os.pathsep}{os.environ['PATH']}"}

    def cmake(*arguments: object) -> None:
        done = subprocess.run(["cmake", *map(str, arguments)], capture_output=True, text=True, env=environment)
        assert done.returncode == 0, done.stdout + done.stderr

    options = ["-DCMAKE_BUILD_TYPE=None", f"-DCMAKE_CXX_FLAGS={flags}", f"-DARM3R_LANES={lanes}"]
    cmake("-S", root, "-B", tmp_path, "-G", "Ninja", *options, f"-DCMAKE_PREFIX_PATH={package.parent}")
    cmake("--build", tmp_path, "--target", "arm3r_cli", "--parallel", cores_of_this_worker())
    assert hashes(tmp_path / "arm3r", files) == expected
    if flags != "-O1":
        return
    cmake("-S", root, "-B", tmp_path, "-DARM3R_TESTS=ON")  # batches of every width, which `make test` does not compile
    cmake("--build", tmp_path, "--target", "arm3r_tests", "--parallel", cores_of_this_worker())
    done = subprocess.run([tmp_path / "tests/cpp/arm3r_tests"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def table(batch: arm3r.Batch, order: np.ndarray | slice = slice(None)) -> bytes:
    return np.stack([batch[name][order] for name in batch]).tobytes()


@pytest.mark.parametrize("method", ["rk4", "dopri5", "taylor"])
def test_two_thousand_runs_in_any_company(method: str) -> None:
    """Threads, order and neighbours change nothing, and each run is what it is alone."""
    scenario = arm3r.Scenario(TEXTS["bounce"].replace("stop: 3.0", "stop: 0.4"))
    scenario["solver.method"] = method
    random, count = np.random.default_rng(5), 2000
    values = {
        "initial.q": random.uniform([0.3, -0.8, 1.1], [0.5, -0.6, 1.3], (count, 3)),
        "wall.contact.stiffness": np.geomspace(1e2, 1e5, count),
        "wall.motion.phase": random.uniform(-3, 3, count),
        "arm.link2.density": random.uniform(5e3, 9e3, count),
    }
    together = scenario.batch(values, threads=1)
    assert together.ok.all() and (together["contacts"] > 0).mean() > 0.2
    for threads in (2, 8):
        assert table(scenario.batch(values, threads=threads)) == table(together)
    order = random.permutation(count)
    shuffled = scenario.batch({key: value[order] for key, value in values.items()})
    assert table(shuffled, np.argsort(order)) == table(together)
    parts = [scenario.batch({key: value[i : i + 17] for key, value in values.items()}) for i in range(0, count, 17)]
    for name in together:
        assert np.concatenate([part[name] for part in parts]).tobytes() == together[name].tobytes(), name
    for index in range(0, count, 50):
        run = together.run(index)
        assert [run["q1"][-1], run["qd3"][-1]] == [together["q1"][index], together["qd3"][index]]
        assert run.summary["peak_force"] == together["peak_force"][index]
