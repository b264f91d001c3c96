"""`arm3r exercise`: marks of a folder, hostile submissions, hints, and what students and teachers read."""

from __future__ import annotations

import csv
import os
import shutil
import signal
import subprocess
import time
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from arm3r_cpp.commands import exercise
from arm3r_cpp.exercises import worker
from arm3r_cpp.exercises.mark import WORDS
from arm3r_cpp.exercises.tasks import TASKS
from arm3r_cpp.user_functions.start import COPIES

SUBMISSIONS = Path(__file__).parents[1] / "submissions"
SECONDS = str(10_000_000 + os.getpid())  # of this process: another one may run the same test

# For each task a file that does what no submission should, and what the table says of it.
HOSTILE = {
    "tip_position.py": ("import time\ndef tip_position(q):\n    return [time.time(), 0, 0]\n", "different numbers"),
    "minus_row.py": ("a2 = 1 << 99999999999\ndef jacobian(q):\n    return q\n", ""),
    "degrees.py": (
        "import os\ndef tip_velocity(q, qd):\n    try:\n        os.kill(os.getppid(), 9)\n"
        "    except OSError:\n        os._exit(0)\n",
        "ends its process",
    ),
    "tip_torque.py": ("def torque(q, f):\n    while True:\n        pass\n", "takes too long"),
    "mass_matrix.m": ("function M = f(q)\nM = f(q);\n", "cannot be evaluated in line 2"),
    "first_joint.py": ("x = " + "(" * 5000 + ")" * 5000 + "\n", ""),
    "half_link.m": ("\udcff\udcfe", "is not read"),
    "reversed_arguments.py": (
        "def gravity(q1, q2, q3):\n    raise ValueError('=cmd\\n\\x1b[31m' + str(id(object())))\n",
        "raises ValueError in line 2",
    ),
    "gravity_constant.yaml": ("format: 1\ntime: {stop: 1e9, log_every: 1e-9}\n", ""),
    "moon.yaml": ("&a [*a, *a]\n", "not a valid scenario"),
    "wall_force.py": (
        "import subprocess\ndef wall_force(x, x_E):\n"
        "    subprocess.Popen(['sleep', 'SECONDS'], start_new_session=True)\n"
        "    return [0, 0, 0, 0]\n",
        "",
    ),
    "plate_face.yaml": ("format: 1\nwall: {face_ofset: 1}\n", "wall.face_ofset: no such key"),
    "wall_torque.py": (  # finds nothing to remove
        "import os, glob\nfor name in glob.glob('FOLDER/*/*'):\n    os.remove(name)\n"
        "def torque(q, f):\n    return q\n",
        "every entry is wrong",
    ),
    "force_on_arm.yaml": ("", ""),
    "impedance.py": (
        "import os\nos.environ['PATH'] = ''\nopen('FOLDER/new', 'w').write('x')\n"
        "def controller(q, qd):\n    return q\n",
        "does what is barred",
    ),
    "admittance.py": ("def acceleration(*a):\n    return bytearray(8 << 30)\n", ""),
    "hybrid_selection.py": ("def command(x, v, x_d, f, f_d):\n    return [float('nan')] * 3\n", "returns NaN"),
    "steady_force.yaml": ("format: 1\n" + "name: " + "x" * 300_000 + "\n", "larger than"),
    "observer.py": (
        "E = type('=E,\\n', (BaseException,), {})\ndef momentum_rate(tau, c, g, r):\n    raise E\n",
        "raises an error of a kind",
    ),
}  # fmt: skip


def call(*arguments: object) -> int:
    return exercise.main([str(one) for one in arguments])


def hand_in(folder: Path, stem: str) -> None:
    """The solutions of this name, one for each task."""
    folder.mkdir(parents=True)
    for name in TASKS:
        (path,) = (SUBMISSIONS / name).glob(f"{stem}.*")
        shutil.copy(path, folder / f"{name}{path.suffix}")


def rows_of(table: Path) -> list[dict[str, str]]:
    with table.open(newline="") as file:
        return list(csv.DictReader(file))


def sleeping() -> list[str]:
    done = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True)
    return [line for line in done.stdout.splitlines() if SECONDS in line and "sleep" in line.split()[0]]


def test_a_folder_becomes_a_table(tmp_path: Path, capsys: Any) -> None:
    hand_in(tmp_path / "class/ben", "wrong")
    (tmp_path / "class/anna").mkdir()
    for name in ("observer", "moon", "minus_row"):
        (path,) = (SUBMISSIONS / name).glob("right.*")
        shutil.copy(path, tmp_path / f"class/anna/{name}{path.suffix}")
    (tmp_path / "class/anna/first_join.m").write_text("function t = f(q)\n")
    one, other = tmp_path / "one.csv", tmp_path / "other.csv"
    assert call("mark", "--trust-code", tmp_path / "class", "-o", one) == 0
    printed = capsys.readouterr()
    assert "first_join.m: is not marked; did you mean first_joint?" in printed.err
    assert "2 students, 19 tasks: 3 right, 19 wrong, 16 missing" in printed.out
    rows = rows_of(one)
    assert [row["student"] for row in rows] == ["anna"] * len(TASKS) + ["ben"] * len(TASKS)
    assert [row["task"] for row in rows] == [*TASKS, *TASKS]
    right = [row["task"] for row in rows if row["mark"] == "right"]
    assert sorted(right) == ["minus_row", "moon", "observer"]
    assert all(row["reason"] for row in rows if row["mark"] == "wrong")
    assert call("mark", "--trust-code", tmp_path / "class", "-o", other, "--jobs", 1) == 0
    assert one.read_bytes() == other.read_bytes()
    text = one.read_text()
    assert text.startswith("student,task,mark,reason,points\n") and "\r" not in text and str(tmp_path) not in text


def test_hostile_submissions_change_nothing_and_no_other_mark(tmp_path: Path) -> None:
    """Each is one clear line; no process, file or changed environment stays behind."""
    if worker.what_is_not_barred():
        pytest.skip("this system cannot bar files")
    folder = tmp_path / "class"
    hand_in(folder / "anna", "right")
    hand_in(folder / "zoe", "right")
    mallory = folder / "=mallory\n"
    mallory.mkdir()
    for name, (text, _) in HOSTILE.items():
        filled = text.replace("SECONDS", SECONDS).replace("FOLDER", str(folder))
        (mallory / name).write_bytes(filled.encode("utf-8", "surrogateescape"))
    before, files = dict(os.environ), sorted(path for path in folder.rglob("*"))
    assert call("mark", "--trust-code", folder, "-o", tmp_path / "table.csv") == 0
    rows = rows_of(tmp_path / "table.csv")
    assert [row["mark"] for row in rows if row["student"] in ("anna", "zoe")] == ["right"] * 2 * len(TASKS)
    got = {row["task"]: row for row in rows if row["student"] == r"'=mallory\n"}
    for name, (_, words) in HOSTILE.items():
        row = got[name.partition(".")[0]]
        assert row["mark"] in ("wrong", "unclear") and words in row["reason"], row
        assert row["reason"].isprintable() and 0 < len(row["reason"]) <= 200
    assert dict(os.environ) == before and sorted(folder.rglob("*")) == files and sleeping() == []


def test_links_fifos_and_two_files_of_a_name_are_refused(tmp_path: Path) -> None:
    student = tmp_path / "class/eve"
    student.mkdir(parents=True)
    (student / "moon.yaml").symlink_to("/dev/zero")
    os.mkfifo(student / "plate_face.yaml")
    (student / "observer.m").write_text("")
    (student / "observer.py").write_text("")
    (student / "first_joint.csv").write_text("q1\n1\n")
    assert call("mark", "--trust-code", tmp_path / "class", "-o", tmp_path / "t.csv") == 0
    reasons = {row["task"]: row["reason"] for row in rows_of(tmp_path / "t.csv")}
    assert "is a link" in reasons["moon"] and "is not a readable file" in reasons["plate_face"]
    assert "there are 2 files of this name (.m, .py)" in reasons["observer"]
    assert "it should be .py or .m" in reasons["first_joint"]


def test_a_file_that_imports_the_package_can_be_refused(tmp_path: Path) -> None:
    student = tmp_path / "class/copy"
    student.mkdir(parents=True)
    text = "from arm3r_cpp.exercises.arms import LAB_ARM\n\ndef gravity(q):\n    return LAB_ARM.arm.gravity_torque(q)\n"
    (student / "first_joint.py").write_text(text)
    for option, words in (((), ""), (("--forbid-import",), "raises ModuleNotFoundError in line 1")):
        assert (
            call("mark", "--trust-code", tmp_path / "class", "--task", "first_joint", "-o", tmp_path / "t.csv", *option)
            == 0
        )
        (row,) = rows_of(tmp_path / "t.csv")
        assert row["reason"] == words and (row["mark"] == "right") == (not option)


def test_code_is_run_on_trust_only_where_the_system_cannot_bar_it(
    tmp_path: Path, monkeypatch: Any, capsys: Any
) -> None:
    monkeypatch.setattr(worker, "what_is_not_barred", lambda: ["files", "network"])
    student = tmp_path / "class/ann"
    student.mkdir(parents=True)
    shutil.copy(SUBMISSIONS / "moon/right.yaml", student / "moon.yaml")
    table = tmp_path / "t.csv"
    arguments = ("mark", tmp_path / "class", "--task", "moon", "--task", "observer", "-o", table)
    assert call(*arguments) == 0 and capsys.readouterr().err == ""  # a scenario is no code
    shutil.copy(SUBMISSIONS / "observer/wrong.py", student / "observer.py")
    table.unlink()
    assert call(*arguments) == 2 and not table.exists()
    printed = capsys.readouterr().err
    assert "this system cannot bar a submission from: files, network" in printed and "--trust-code" in printed
    assert call(*arguments, "--trust-code") == 0 and len(rows_of(table)) == 2
    assert "cannot bar" in capsys.readouterr().err


def test_hints_come_in_three_grades(tmp_path: Path, capsys: Any) -> None:
    task = TASKS["half_link"]
    file = tmp_path / "half_link.m"
    file.write_text(task.given)
    printed = []
    for grade in (0, 1, 2, 3):
        assert call("check", "half_link", file, *(("--hint", grade) if grade else ())) == 11
        printed.append(capsys.readouterr().out)
    cause = task.mistakes[0].sentence
    for grade, text in enumerate(printed):
        assert "wrong in t2, t3, right in the others" in text
        assert [hint in text for hint in task.hints] == [number < grade for number in range(3)]
        assert (cause in text) == (grade >= 2)
        assert ("line 8:" in text) == (grade == 3)
        assert ("--hint" in text) == (grade < 3)
    shutil.copy(SUBMISSIONS / "half_link/right.m", file)
    assert call("check", "half_link", file) == 0
    assert capsys.readouterr().out == f"{file}: right\n"


def test_list_and_show(cli: Any, scripts: Path, capsys: Any) -> None:
    assert call("list") == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == list(TASKS)
    for name, task in TASKS.items():
        assert call("show", name) == 0
        shown = capsys.readouterr().out
        assert task.title in shown and f"Hand in {name}." in shown
        assert not any(hint in shown for hint in task.hints)
        assert call("show", name, "--given") == (0 if task.given else 2)
        assert capsys.readouterr().out == task.given
    done = cli("exercise", "list", env={**os.environ, "PATH": f"{scripts}{os.pathsep}{os.environ['PATH']}"})
    assert done.stdout.startswith("tip_position")


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (("show", "first_join"), 2, "did you mean first_joint?"),
        (("show", "cake"), 2, "`arm3r exercise list` lists them"),
        (("check", "moon", "nothing.yaml"), 2, "nothing.yaml: is not a readable file"),
        (("mark", "nothing"), 2, "nothing: is not a folder"),
        (("mark", "empty"), 2, "empty: holds no folders"),
        (("mark", "class", "-o", "away/t.csv"), 6, "away: there is no such folder; create it first"),
    ],
)
def test_what_is_wrong_is_one_line(
    arguments: tuple[str, ...], code: int, words: str, tmp_path: Path, monkeypatch: Any, capsys: Any
) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "class/anna").mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    assert call(*arguments) == code
    printed = capsys.readouterr()
    assert words in printed.err and printed.err.count("\n") == 1 and not printed.out


def test_a_judge_that_does_not_end_is_ended(tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.setattr("arm3r_cpp.exercises.worker.MOST_SECONDS", 2.0)
    file, before = tmp_path / "observer.py", descendants(os.getpid())
    file.write_text("while True: pass\ndef momentum_rate(a, b, c, d):\n    return a\n")
    with closing(worker.Worker()) as judge:
        mark = judge.mark(TASKS["observer"], file)
    assert mark.word in WORDS and mark.reason == "takes too long"
    left = [pid for pid in descendants(os.getpid()) if pid not in before]
    for _ in range(600):  # what is killed may take a moment to end
        left = [pid for pid in left if is_running(pid)]
        if not left:
            break
        time.sleep(0.1)
    assert left == []


def descendants(ancestor: int) -> list[int]:
    """The processes that a process has started, directly or not, and that run."""
    done = subprocess.run(["ps", "-eo", "pid,ppid,stat,args"], capture_output=True, text=True)
    lines = [line.split(None, 3) for line in done.stdout.splitlines()[1:]]
    parents = {int(pid): int(parent) for pid, parent, state, words in lines if state[0] != "Z" and words[:3] != "ps "}
    found = {ancestor}
    while more := {pid for pid, parent in parents.items() if parent in found} - found:
        found |= more
    return sorted(found - {ancestor})


def test_ctrl_c_ends_the_marking_and_the_files_that_are_judged(scripts: Path, tmp_path: Path) -> None:
    student = tmp_path / "class/loop"
    student.mkdir(parents=True)
    (student / "observer.py").write_text("while True: pass\ndef momentum_rate(a, b, c, d):\n    return a\n")
    command = [scripts / "arm3r-exercise", "mark", "--trust-code", tmp_path / "class", "--task", "observer"]
    expected = 5 if COPIES else 2  # a judge, and the process that it judges; copies of others, and who looked for bars
    with subprocess.Popen(command, start_new_session=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        for _ in range(600):
            time.sleep(0.1)
            started = descendants(process.pid)
            if len(started) == expected:
                break
        assert len(started) == expected
        process.send_signal(signal.SIGINT)
        assert process.wait(600) == -signal.SIGINT
    for _ in range(600):
        if not any(is_running(pid) for pid in started):
            break
        time.sleep(0.1)
    assert not any(is_running(pid) for pid in started)


def is_running(pid: int) -> bool:
    done = subprocess.run(["ps", "-o", "stat=", "-p", str(pid)], capture_output=True, text=True)
    return bool(done.stdout.strip()) and not done.stdout.strip().startswith("Z")


def test_the_words_of_marks_are_those_of_the_page(root: Path) -> None:
    page = (root / "docs/exercises.md").read_text()
    assert all(f"`{word}`" in page for word in WORDS)
    assert all(f"`{name}`" in page for name in TASKS)
