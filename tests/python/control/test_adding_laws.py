"""The pages about adding laws, applied as they stand: their changes fit the sources and give laws that run."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sysconfig
from pathlib import Path

import pytest
from conftest import QUICK

DAMPED = """\
format: 1
arm: {convention: slide, link2: {length: 0.9}, link3: {length: 1.2}}
initial: {q: [0.2, 0.7, -1.1], qd: [0.4, -0.3, 0.9]}
controller: {type: tip_damper, damping: 60}
time: {stop: 2, log_every: 0.5}
"""
HERTZ = """\
format: 1
wall:
  point: [1.8, 0, 0]
  motion: {type: constant, velocity: 0.4}
  contact: {law: hertz, stiffness: 40000}
  acts_on_arm: true
controller: {type: gravity_compensation}
time: {stop: 0.6}
"""


def changes(page: str) -> list[tuple[str, str, str]]:
    """(file, old text, new text) of every change that the page shows; the old text of a new file is empty."""
    found = []
    for part in re.split(r"^\*\*\d\. ", page, flags=re.M)[1:]:
        file = re.search(r"`(cpp/[^`]+)`", part)
        for kind, block in re.findall(r"^```(\w+)\n(.*?)^```$", part, flags=re.M | re.S):
            assert file
            lines = block.splitlines(keepends=True)
            if kind == "cpp":
                found.append((file[1], "", block))
                continue
            old = "".join(line[1:] for line in lines if line[0] in " -")
            new = "".join(line[1:] for line in lines if line[0] in " +")
            found.append((file[1], old, new))
    return found


def apply(root: Path, page: str) -> set[str]:
    """Makes the changes; the names of the files."""
    for file, old, new in changes(page):
        path = root / file
        text = path.read_text() if old else ""
        assert text.count(old) == 1 or not old, f"{file} does not hold the lines that the page shows:\n{old}"
        path.write_text(text.replace(old, new) if old else new)
    return {file for file, _, _ in changes(page)}


@pytest.fixture
def tree(root: Path, tmp_path: Path) -> Path:
    for name in ("cpp", "cmake"):
        shutil.copytree(root / name, tmp_path / name)
    for name in ("CMakeLists.txt", "pyproject.toml"):
        shutil.copy(root / name, tmp_path / name)
    return tmp_path


def test_the_changes_fit_and_touch_few_files(root: Path, tree: Path) -> None:
    """Beside them stand the pages that describe the laws."""
    assert len(apply(tree, (root / "docs/adding_a_controller.md").read_text())) == 4
    assert len(apply(tree, (root / "docs/adding_a_contact_law.md").read_text())) == 3


@pytest.mark.gate
def test_the_new_laws_run(root: Path, tree: Path, scripts: Path) -> None:
    for page in ("adding_a_controller", "adding_a_contact_law"):
        apply(tree, (root / f"docs/{page}.md").read_text())
    environment = os.environ | {"PATH": f"{scripts}{os.pathsep}{os.environ['PATH']}"}
    settings = QUICK | {"ARM3R_PYTHON": "OFF", "CMAKE_PREFIX_PATH": sysconfig.get_path("purelib")}
    options = [f"-D{name}={value}" for name, value in settings.items()]
    build = tree / "build"
    for command in (
        ["cmake", "-S", str(tree), "-B", str(build), *options],
        ["cmake", "--build", str(build), "--target", "arm3r_cli", "--parallel", "2"],
    ):
        subprocess.run(command, check=True, env=environment, capture_output=True)

    def metrics_of(text: str) -> dict[str, float]:
        (tree / "scenario.yaml").write_text(text)
        done = subprocess.run(
            [build / "arm3r", "run", tree / "scenario.yaml", "--json"], capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)["metrics"]

    damped = metrics_of(DAMPED)
    assert max(abs(damped[name]) for name in ("qd1", "qd2", "qd3")) < 1e-3  # the tip has come to rest, and stays up
    assert damped["tip_z"] > -1
    # The contact of Hunt and Crossley without dissipation is the same law.
    new, known = metrics_of(HERTZ), metrics_of(HERTZ.replace("hertz", "hunt_crossley, dissipation: 0"))
    assert new["contacts"] == 1 and new["first_release"] > 0 and new["ledger_residual"] < 1e-6
    for name in ("peak_force", "impulse", "first_release", "q2"):
        assert new[name] == pytest.approx(known[name], rel=1e-6)
