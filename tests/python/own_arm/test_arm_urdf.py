"""`arm.urdf` in a scenario: the keys of the file under those given beside it, in Python and in the executable."""

from __future__ import annotations

import json
import os
import pickle
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arm3r_cpp import Arm, ScenarioError
from arm3r_cpp.core.scenario import Scenario
from test_import_messages import ARM

Q = [0.3, -0.5, 0.9]
TEXT = """format: 1
arm:
  urdf: arm.urdf
  lock: {wrist: 10 deg}
  payload: {mass: 0.5}
  link2: {mass: 2.5}
initial: {q: [0.3, -0.5, 0.9]}
controller: {type: gravity_compensation}
time: {stop: 0.2}
"""


@pytest.fixture
def scenario(tmp_path: Path) -> Path:
    (tmp_path / "arm.urdf").write_text(ARM)
    (tmp_path / "own.yaml").write_text(TEXT)
    return tmp_path / "own.yaml"


def called(program: Path, *words: object, **options: Any) -> subprocess.CompletedProcess[str]:
    return subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=100, **options)


def test_keys_beside_the_file_replace_its_own(scenario: Path) -> None:
    read = Scenario.load(scenario)
    alone = Arm.from_urdf(scenario.parent / "arm.urdf", lock={"wrist": "10 deg"})
    assert read["arm.link2.mass"] == 2.5 and read["arm.payload.mass"] == 0.5
    assert np.array_equal(read.arm.tip_position(Q), alone.tip_position(Q))
    assert not np.allclose(read.arm.mass_matrix(Q), alone.mass_matrix(Q))


def test_the_resolved_scenario_stands_alone_and_has_the_same_bits(scenario: Path) -> None:
    read = Scenario.load(scenario)
    text = read.to_yaml(annotate=True)
    assert "\n  urdf:" not in text and "# arm.urdf: fore, hand, tool" in text
    again = Scenario(text)
    (scenario.parent / "arm.urdf").unlink()
    assert np.array_equal(again.params, read.params, equal_nan=True)
    assert again.run().summary["hash"] == Scenario(read.to_yaml()).run().summary["hash"]


def test_the_executable_asks_the_package_beside_it(scenario: Path, scripts: Path) -> None:
    told = called(scripts / "arm3r", "run", scenario, "--json")
    assert told.returncode == 0, told.stderr
    assert json.loads(told.stdout)["hash"] == Scenario.load(scenario).run().summary["hash"]


def test_without_the_package_it_says_which_command_helps(scenario: Path, executable: Path) -> None:
    told = called(executable, "run", scenario, env={**os.environ, "PATH": os.devnull})
    assert told.returncode == 2 and told.stdout == ""
    assert "own.yaml:3:9: error[scenario.arm_file]: arm.urdf: a URDF is read by the Python package" in told.stderr
    assert "arm3r import arm.urdf > my_arm.yaml" in told.stderr


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("arm.urdf", "no.urdf", "no.urdf: this file cannot be read"),
        ("wrist:", "wrst:", "there is no joint 'wrst'; did you mean wrist?"),
        ("  lock: {wrist: 10 deg}\n", "", "wrist moves, too"),
        ("  urdf: arm.urdf\n", "", "`lock` belongs to a URDF, and there is no arm.urdf"),
        ("urdf: arm.urdf", "urdf: [arm.urdf]", "expects what is said of a URDF"),
        ("payload: {mass: 0.5}", "base_height: 0.3", "`base_height` belongs to model planar"),
        ("payload: {mass: 0.5}", "axis_tolerance: wide", "an angle is needed, in rad or such as -90 deg, got 'wide'"),
    ],
)
def test_what_is_wrong_is_said_at_its_line(
    scenario: Path, scripts: Path, old: str, new: str, words: str, refusal: Callable[[Path], str]
) -> None:
    assert old in TEXT
    scenario.write_text(TEXT.replace(old, new))
    assert words in refusal(scenario)
    told = called(scripts / "arm3r", "run", scenario)
    assert told.returncode == 3 and words in told.stderr and "own.yaml:" in told.stderr
    assert "Traceback" not in told.stderr


def test_a_file_of_which_nothing_is_used_is_refused(scenario: Path) -> None:
    """A resolved scenario gives all keys: another file beside them would change nothing, without a word."""
    resolved = Scenario(Scenario.load(scenario).to_yaml())
    for text in (resolved, pickle.loads(pickle.dumps(Scenario.load(scenario)))):
        text["arm.urdf"], text["arm.lock"] = str(scenario.parent / "arm.urdf"), {"wrist": 0}
        with pytest.raises(ScenarioError, match="nothing of this file is used: all that it says of the arm is given"):
            text.validate()


@pytest.fixture
def refusal() -> Callable[[Path], str]:
    def call(path: Path) -> str:
        with pytest.raises(ScenarioError) as raised:
            Scenario.load(path).validate()
        return str(raised.value)

    return call


def test_a_reader_that_says_nothing_is_told_by_its_status(scenario: Path) -> None:
    """In a process of its own: the reader stays for all that follows."""
    program = (
        "from arm3r_cpp.core.scenario import Scenario\n"
        "from arm3r_cpp._native.arm_files import read_arms_with\n"
        "read_arms_with(lambda request: (7, ''))\n"
        f"Scenario.load({str(scenario)!r}).validate()\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=100)
    assert done.returncode == 1
    assert "own.yaml:3:" in done.stderr and "the reader ended with 7, without a text" in done.stderr
