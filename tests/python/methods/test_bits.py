"""bits.c, which hashes what a build computes, and the script that compares the hashes of several builds."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp import _native

COMPARE = Path(__file__).parents[2] / "c" / "compare_bits.py"
SCENARIO = """
format: 1
name: {name}
initial: {{q: [0.1, -0.5, 1.0]}}
wall: {{point: [1.75, 0.1, 0], contact: {{stiffness: 700}}, acts_on_arm: true}}
solver: {{method: {method}}}
time: {{stop: 0.3, log_every: 0.01}}
"""
RUNS = 5


@pytest.fixture(scope="module")
def printed(bits: Path, tmp_path_factory: pytest.TempPathFactory) -> str:
    """Its output, of two scenarios."""
    folder = tmp_path_factory.mktemp("scenarios")
    files = [folder / f"{method}.yaml" for method in ("dopri5", "taylor")]
    for file in files:
        file.write_text(SCENARIO.format(name=file.stem, method=file.stem))
    done = subprocess.run([bits, "--batch", str(RUNS), *files], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def fnv1a(data: bytes) -> str:
    value = 14695981039346656037
    for byte in data:
        value = (value ^ byte) * 1099511628211 % 2**64
    return f"{value:016x}"


def bytes_of_run(run: arm3r.Run) -> bytes:
    events = b"".join(
        np.array([event.type == "break", 0], np.int32).tobytes()
        + np.concatenate([[event.t], event.q, event.qd, event.tip]).tobytes()
        for event in run.events
    )
    columns = b"".join(run[name].tobytes() for name in run.columns)
    summary = _native.text(_native.lib.arm3r_run_summary, run.handle)
    report = _native.text(_native.lib.arm3r_run_report, run.handle)
    texts = re.sub(r".*\"elapsed_s\": .*\n", "", summary) + re.sub(r".*  wall clock .*\n", "", report)
    return columns + events + texts.encode()


def random_parts() -> np.ndarray:
    """Of the numbers that vary, in turn, the random part of each run."""
    state, parts = 1, []
    for _ in range(4 * RUNS):
        state = (state + 0x9E3779B97F4A7C15) % 2**64
        z = (state ^ state >> 30) * 0xBF58476D1CE4E5B9 % 2**64
        z = (z ^ z >> 27) * 0x94D049BB133111EB % 2**64
        parts.append((((z ^ z >> 31) >> 49) - 2**14) / 2**20)
    return np.array(parts).reshape(4, RUNS)


def test_the_program_hashes_what_python_sees(printed: str) -> None:
    head, *lines = printed.splitlines()
    assert head == f"# {arm3r.__version__} | {_native.string(_native.lib.arm3r_build_info())}"
    assert [line.split()[0] for line in lines] == ["dopri5", "taylor"]
    for line in lines:
        name, run_hash, batch_hash = line.split()
        scenario = arm3r.Scenario(SCENARIO.format(name=name, method=name))
        run = scenario.run()
        assert len(run.events) > 0
        assert run_hash == fnv1a(bytes_of_run(run)), name
        *q, stiffness = random_parts()
        values: dict[str, Any] = {"initial.q": np.array([0.1, -0.5, 1.0]) + np.transpose(q)}
        values["wall.contact.stiffness"] = 700 * (1 + stiffness)
        batch = scenario.batch(values)
        assert batch_hash == fnv1a(b"".join(np.asarray(batch[column]).tobytes() for column in batch.names))


def test_errors_of_the_program(bits: Path, tmp_path: Path) -> None:
    usage = subprocess.run([bits], capture_output=True, text=True)
    assert (usage.returncode, usage.stderr) == (2, "usage: bits [--batch RUNS] SCENARIO.yaml...\n")
    missing = subprocess.run([bits, tmp_path / "missing.yaml"], capture_output=True, text=True)
    assert missing.returncode == 1 and "missing.yaml" in missing.stderr


def compare(*files: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, COMPARE, *files], capture_output=True, text=True)


def test_a_difference_is_named(printed: str, tmp_path: Path) -> None:
    native, equal, other = (tmp_path / f"{name}.txt" for name in ("native", "equal", "other"))
    native.write_text(printed)
    equal.write_text(printed)
    done = compare(native, equal)
    assert done.returncode == 0 and done.stdout.count("| 2 of 2 | 2 of 2 |") == 2
    batch = printed.split()[-1]
    other.write_text(printed.replace(batch, "0" * 16).replace("dopri5 ", "renamed "))
    done = compare(native, equal, other)
    assert done.returncode == 1 and "| other | 1 of 2 | 0 of 2 |" in done.stdout
    assert f"other: taylor: batch {'0' * 16}, not {batch}\n" in done.stdout
    assert "other: dopri5: run missing, not " in done.stdout and "other: renamed: not in native\n" in done.stdout
    other.write_text("not what bits prints\n")
    assert compare(native, other).returncode == 1
