"""How long verdicts take: seconds of the processor, with all that the command starts."""

from __future__ import annotations

import resource
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from test_verify import LECTURE_JACOBIAN
from test_verify_chain import ROBOTS, program_of
from timing import once_within

pytestmark = pytest.mark.timed


def computed(command: Callable[[], None]) -> float:
    """The seconds that the processes of a command compute."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def arm3r(*arguments: object, exits: int = 0) -> Callable[[], None]:
    def run() -> None:
        done = subprocess.run([Path(sys.executable).parent / "arm3r", *map(str, arguments)], capture_output=True)
        assert done.returncode == exits, done.stderr

    return run


@pytest.mark.parametrize("mistake", ["", "q2"])
def test_a_verdict_on_a_formula_of_three_joints(mistake: str, tmp_path: Path) -> None:
    path = tmp_path / "jacobian.m"
    path.write_text(LECTURE_JACOBIAN.replace("j23 = -a3*sin(q2+q3)", f"j23 = -a3*sin({mistake or 'q2+q3'})"))
    assert once_within(1, lambda: computed(arm3r("verify", path, exits=11 if mistake else 0)), tries=3)


def test_a_verdict_on_a_formula_of_seven_joints(tmp_path: Path) -> None:
    (tmp_path / "arm.py").write_text(program_of("panda"))
    command = arm3r("verify", f"{tmp_path / 'arm.py'}:jacobian", "--dh", ROBOTS / "panda.csv")
    assert once_within(3, lambda: computed(command), tries=3)


@pytest.mark.gate
def test_a_class_of_sixty_with_three_files_each(tmp_path: Path) -> None:
    show = [Path(sys.executable).parent / "arm3r", "exercise", "show", "--given"]
    given = {task: subprocess.check_output([*show, task]) for task in ("first_joint", "half_link", "minus_row")}
    for student in range(60):
        folder = tmp_path / "class" / f"student{student}"
        folder.mkdir(parents=True)
        for task, text in given.items():
            (folder / f"{task}.m").write_bytes(text)
    assert once_within(60, lambda: computed(arm3r("exercise", "mark", tmp_path / "class")), tries=2)
