"""How long verdicts take: seconds of the processor, with all that the command starts."""

from __future__ import annotations

import resource
import subprocess
import sys
from collections.abc import Callable, Iterable
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


@pytest.mark.parametrize("kind", ["jacobian", "gravity"])
def test_an_edit_of_a_formula_of_seven_joints(kind: str, tmp_path: Path) -> None:
    text = program_of("panda").replace("d*ca], [0, 0, 0, 1]", "d*sa], [0, 0, 0, 1]")
    assert text != program_of("panda")
    (tmp_path / "arm.py").write_text(text)
    command = arm3r("verify", f"{tmp_path / 'arm.py'}:{kind}", "--dh", ROBOTS / "panda.csv", exits=11)
    assert once_within(10, lambda: computed(command), tries=3)


def test_an_export_of_five_thousand_terms(tmp_path: Path) -> None:
    """As matlabFunction writes it: temporaries, and sums of products of them; of the six joints of a UR5."""
    lines = ["function J = jacobian(in1)"]
    lines += [f"q{n} = in1({n},:);" for n in range(1, 7)]
    lines += [f"t{n + 1} = cos(q{n});\nt{n + 7} = sin(q{n});" for n in range(1, 7)]
    rows = expanded_jacobian()
    lines += [f"J = reshape([{','.join(rows)}],[3,6]);", "end"]
    text = "\n".join(lines)
    assert text.count(".*") > 5000
    (tmp_path / "jacobian.m").write_text(text)
    command = arm3r("verify", tmp_path / "jacobian.m", "--dh", ROBOTS / "ur5.csv")
    assert once_within(10, lambda: computed(command), tries=3)


def expanded_jacobian() -> list[str]:
    """The entries of a UR5's Jacobian, column by column, as sums of products of t2.. = cos q and t8.. = sin q."""
    table = [line.split(",") for line in (ROBOTS / "ur5.csv").read_text().splitlines()[2:] if line[0] == "R"]
    one = {(): 1.0}
    matrix = [[dict(one) if i == j else {} for j in range(4)] for i in range(4)]
    for joint, (_, a, alpha, d, _) in enumerate(row[:5] for row in table):
        turn = {"pi/2": 1, "-pi/2": -1}.get(alpha, 0)  # alpha is a right angle, or none
        c, s, ca, sa, a, d = (f"t{joint + 2}",), (f"t{joint + 8}",), float(turn == 0), float(turn), float(a), float(d)
        step = [
            [{c: 1.0}, {s: -ca}, {s: sa}, {c: a}],
            [{s: 1.0}, {c: ca}, {c: -sa}, {s: a}],
            [{}, {(): sa}, {(): ca}, {(): d}],
            [{}, {}, {}, dict(one)],
        ]
        matrix = [[_sum(_times(matrix[i][k], step[k][j]) for k in range(4)) for j in range(4)] for i in range(4)]
    tip = [matrix[row][3] for row in range(3)]
    return [_text(_derivative(one, joint)) for joint in range(6) for one in tip]


def _times(first: dict, second: dict) -> dict:
    return _sum({(*a, *b): x * y} for a, x in first.items() for b, y in second.items())


def _sum(terms: Iterable[dict]) -> dict:
    found: dict = {}
    for term in terms:
        for names, value in term.items():
            found[names] = found.get(names, 0.0) + value
    return {names: value for names, value in found.items() if value}


def _derivative(terms: dict, joint: int) -> dict:
    c, s = f"t{joint + 2}", f"t{joint + 8}"
    changed = {c: (s, -1.0), s: (c, 1.0)}
    return _sum(
        {tuple(changed[name][0] if name in changed else name for name in names): value * changed[names[place]][1]}
        for names, value in terms.items()
        for place in range(len(names))
        if names[place] in changed
    )


def _text(terms: dict) -> str:
    """With each product as many times, by parts of one, as an export that does not collect terms writes it."""
    parts = 40
    each = (f"{value / parts!r}.*{'.*'.join(names) or '1.0'}" for names, value in terms.items() for _ in range(parts))
    return "+".join(each).replace("+-", "-") or "0.0"


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
