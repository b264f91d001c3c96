"""`arm3r exercise` for teachers: own numbers for each student, points, tables for platforms, and a sheet to print."""

from __future__ import annotations

import csv
import io
import re
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arm3r_cpp import Scenario
from arm3r_cpp.commands import exercise
from arm3r_cpp.exercises import sheet
from arm3r_cpp.exercises.arms import arm_of
from arm3r_cpp.exercises.folder import Row
from arm3r_cpp.exercises.function_judge import THRESHOLD
from arm3r_cpp.exercises.gradebook import PLATFORMS
from arm3r_cpp.exercises.loop import at_one_state
from arm3r_cpp.exercises.mark import RIGHT, UNCLEAR, WRONG, Mark
from arm3r_cpp.exercises.numbers import LAB, Numbers
from arm3r_cpp.exercises.points import totals
from arm3r_cpp.exercises.scenario_judge import judge_scenario
from arm3r_cpp.exercises.task import FunctionTask
from arm3r_cpp.exercises.tasks import TASKS, task_with
from arm3r_cpp.exercises.tasks.scenarios.force_on_arm import contact_time
from arm3r_cpp.exercises.tasks.scenarios.moon import height

SUBMISSIONS = Path(__file__).parents[1] / "submissions"
STUDENTS = [Numbers(seed, student) for seed in range(5) for student in ("anna", "ben", "zoë")]
EVERYONES = ("gravity_constant", "observer")  # tasks without a number that could be another one


def call(*arguments: object) -> int:
    return exercise.main([str(one) for one in arguments])


def own_task(name: str, numbers: Numbers) -> FunctionTask:
    task = task_with(name, numbers)
    assert isinstance(task, FunctionTask)
    return task


# ---- own numbers ----------------------------------------------------------------------------------------------------


def test_numbers_are_those_of_seed_and_name_on_every_machine() -> None:
    arm = arm_of(Numbers(7, "anna"))
    assert (arm.a2, arm.a3, arm.m2, arm.m3, arm.i1) == (0.7, 0.52, 1.9, 0.67, 0.03)
    assert arm_of(Numbers(7, " ANNA ")) == arm
    assert arm_of(Numbers(1, "Jose\u0301")) == arm_of(Numbers(1, "Jos\u00e9"))
    assert len({arm_of(numbers) for numbers in STUDENTS}) == len(STUDENTS)
    assert arm_of(Numbers(7, "\udcff")) != arm  # a name that is no text


@pytest.mark.parametrize("name", TASKS)
def test_a_student_gets_another_task_of_the_same_form(name: str) -> None:
    texts = {task_with(name, numbers).text + task_with(name, numbers).given for numbers in STUDENTS}
    assert len(texts) == 1 if name in EVERYONES else len(texts) > 3
    assert (TASKS[name].text + TASKS[name].given in texts) == (name in EVERYONES)
    for numbers in STUDENTS:
        task = task_with(name, numbers)
        lengths = [len(line) for line in task.text.splitlines()]
        assert max(lengths) <= 110 and task.points == TASKS[name].points
        decimals = re.findall(r"(?<![\d.])\d+\.\d+", task.text)
        human = [number for number in decimals if number != "9.80665" and name != "plate_face"]
        assert all(len(number) <= 5 for number in human), decimals


def test_no_length_or_mass_of_an_arm_hides_behind_another() -> None:
    for numbers in STUDENTS:
        arm = arm_of(numbers)
        assert len({arm.a2, arm.a3, arm.a2 / 2, arm.a3 / 2}) == 4 and len({arm.m2, arm.m3, arm.m2 / 2}) == 3


@pytest.mark.parametrize("name", [name for name, task in TASKS.items() if isinstance(task, FunctionTask)])
def test_the_mistakes_of_a_student_differ_clearly(name: str) -> None:
    """So does the answer with the lab sheet's numbers."""
    for numbers in STUDENTS:
        task = own_task(name, numbers)
        states = task.samples()
        functions = [task.right, *(mistake.values for mistake in task.mistakes)]
        values = [one(**states) for one in (functions[:-1] if name in EVERYONES else functions)]
        for number, one in enumerate(values):
            for other in values[:number]:
                assert np.abs(one - other).max() > 1e4 * THRESHOLD * np.abs(values[0]).max(), numbers


@pytest.mark.parametrize("name", ["impedance", "hybrid_selection"])
def test_a_students_law_reaches_its_goal(name: str) -> None:
    task = own_task(name, STUDENTS[4])
    assert task.loop
    assert task.loop.judged(at_one_state(task.right)) == (RIGHT, "")


MENDED: dict[str, dict[str, Any]] = {
    "gravity_constant": {"controller.gravity": 9.80665},
    "plate_face": {"wall.face_offset": 0},
    "force_on_arm": {"wall.acts_on_arm": True},
    "steady_force": {"controller.force_integral_gain": 5},
    "moon": {"controller": {"type": "none"}},
}


@pytest.mark.parametrize("name", MENDED)
def test_a_students_scenario_is_right_once_it_is_mended(name: str, tmp_path: Path) -> None:
    file = tmp_path / f"{name}.yaml"
    for numbers in (LAB, *STUDENTS[:4]):
        task: Any = task_with(name, numbers)
        file.write_text(task.given)
        assert judge_scenario(task, file).word == WRONG
        mended = Scenario(task.given)
        mended.update(MENDED[name])
        if name == "moon":
            (gravity,) = re.findall(r"g = ([\d.]+) m", task.text)
            mended.update({"arm.gravity": [0, 0, -float(gravity)]})
        file.write_text(mended.to_yaml())
        assert judge_scenario(task, file) == Mark(RIGHT), numbers


@pytest.mark.parametrize(
    ("name", "changes", "measures", "due"),
    [
        (
            "force_on_arm",
            {},
            (lambda run: run.summary["peak_force"], contact_time),
            (1.176036954945614, 0.0737604245674),
        ),
        ("moon", {"arm.gravity": [0, 0, -1.62]}, (lambda run: 0.0, height), (0.0, -0.2546941903632)),
    ],
)
def test_what_is_right_on_the_lab_sheet_is_what_was_computed_apart(
    name: str, changes: dict[str, Any], measures: tuple[Any, ...], due: tuple[float, ...]
) -> None:
    task: Any = TASKS[name]
    scenario = Scenario(task.given)
    scenario.update({**MENDED[name], **changes})
    run = scenario.quiet().run()
    for condition, measure, number in zip(task.conditions, measures, due, strict=True):
        assert abs(measure(run) - number) < condition.threshold / 100
        assert abs(condition.measure(run) - condition.due) < condition.threshold / 100


# ---- the command ----------------------------------------------------------------------------------------------------


def mended_listing(capsys: Any, *options: object) -> str:
    assert call("show", "first_joint", "--given", *options) == 0
    return str(capsys.readouterr().out.replace("t1 = q1;", "t1 = 0;"))


def test_the_marker_knows_the_numbers_of_each_student(tmp_path: Path, capsys: Any) -> None:
    for student, whose in (("anna", "anna"), ("ben", "anna"), ("cleo", "")):
        options = ("--seed", 7, "--student", whose) if whose else ()
        (tmp_path / "class" / student).mkdir(parents=True)
        (tmp_path / "class" / student / "first_joint.m").write_text(mended_listing(capsys, *options))
    table = tmp_path / "t.csv"
    assert call("mark", tmp_path / "class", "--seed", 7, "--task", "first_joint", "--task", "moon", "-o", table) == 0
    rows = [row for row in csv.DictReader(io.StringIO(table.read_text())) if row["task"] == "first_joint"]
    assert [(row["student"], row["mark"], row["points"]) for row in rows] == [
        ("anna", "right", "2"), ("ben", "wrong", "0"), ("cleo", "wrong", "0"),
    ]  # fmt: skip
    assert "right for the lab sheet's numbers" in rows[2]["reason"]
    printed = capsys.readouterr().out
    assert "  anna: 1 of 2 right, 2 of 5 points\n  ben: 0 of 2 right, 0 of 5 points\n" in printed
    file = tmp_path / "class/anna/first_joint.m"
    assert call("check", "first_joint", file, "--seed", 7, "--student", "anna") == 0
    assert call("check", "first_joint", file, "--seed", 7, "--student", "ben") == 11
    assert call("check", "first_joint", file) == 11
    capsys.readouterr()
    assert call("show", "first_joint", "--seed", 7, "--student", "anna") == 0
    assert capsys.readouterr().out.endswith("These are the numbers of anna, seed 7.\n")


def test_the_list_of_a_folder_says_what_is_done(tmp_path: Path, capsys: Any) -> None:
    (tmp_path / "first_joint.m").write_text(mended_listing(capsys))
    (tmp_path / "wall_torque.m").write_text(TASKS["wall_torque"].given)
    (tmp_path / "moons.yaml").write_text("")
    assert call("list", tmp_path) == 0
    out, error = capsys.readouterr()
    lines = {line.split()[0]: line.split()[3] for line in out.splitlines()[:-1]}
    assert lines == {name: "open" for name in TASKS} | {"first_joint": "right", "wall_torque": "wrong"}
    assert out.endswith("\n1 of 19 right, 2 of 60 points\n") and "did you mean moon?" in error


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (("show", "moon", "--seed", "1"), 2, "add --student NAME"),
        (("show", "moon", "--seed", "1", "--student", " "), 2, "add --student NAME"),
        (("check", "moon", "moon.yaml", "--student", "anna"), 2, "add --seed N"),
        (("list", "away"), 2, "away: cannot be read"),
        (("sheet", "-o", "sheet.png"), 2, ".pdf is written there, got .png"),
        (("sheet", "-o", "away/sheet.pdf"), 6, "away: there is no such folder; create it first"),
    ],
)
def test_what_is_wrong_is_one_line(
    arguments: tuple[str, ...], code: int, words: str, tmp_path: Path, monkeypatch: Any, capsys: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    assert call(*arguments) == code
    printed = capsys.readouterr()
    assert words in printed.err and printed.err.count("\n") == 1 and not printed.out


# ---- points and platforms -------------------------------------------------------------------------------------------

ROWS = [
    Row("anna", TASKS["moon"], Mark(RIGHT)),
    Row("anna", TASKS["observer"], Mark(UNCLEAR, "takes too long")),
    Row("=cmd", TASKS["moon"], Mark(RIGHT)),
    Row("=cmd", TASKS["observer"], Mark(RIGHT)),
]


def test_only_what_is_right_has_points() -> None:
    assert [row.points for row in ROWS] == [3, 0, 3, 5]
    assert [str(total) for total in totals(ROWS)] == [
        "1 of 2 right, 1 unclear, 3 of 8 points",
        "2 of 2 right, 8 of 8 points",
    ]
    assert sum(task.points for task in TASKS.values()) == 60


def test_each_platform_gets_the_columns_that_it_reads() -> None:
    moodle, canvas = (list(csv.reader(io.StringIO(PLATFORMS[name](totals(ROWS))))) for name in ("moodle", "canvas"))
    assert moodle == [["Username", "arm3r exercises"], ["anna", "3"], ["'=cmd", "8"]]
    assert canvas == [
        ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", "arm3r exercises"],
        ["    Points Possible", "", "", "", "", "8"],
        ["anna", "", "", "anna", "", "3"],
        ["'=cmd", "", "", "'=cmd", "", "8"],
    ]


def test_the_marker_writes_for_a_platform(tmp_path: Path, capsys: Any) -> None:
    (tmp_path / "class/anna").mkdir(parents=True)
    shutil.copy(SUBMISSIONS / "moon/right.yaml", tmp_path / "class/anna/moon.yaml")
    options = ("--task", "moon", "--lms", "moodle")
    assert call("mark", tmp_path / "class", *options, "-o", tmp_path / "m.csv") == 0
    assert (tmp_path / "m.csv").read_text() == "Username,arm3r exercises\nanna,3\n"
    assert "anna: 1 of 1 right, 3 of 3 points" in capsys.readouterr().out
    assert call("mark", tmp_path / "class", *options) == 0
    assert capsys.readouterr().out == "Username,arm3r exercises\nanna,3\n"


# ---- the sheet ------------------------------------------------------------------------------------------------------


def words_of(figure: Any) -> list[str]:
    return [text.get_text() for text in figure.texts]


def test_a_sheet_holds_every_task_within_its_margins() -> None:
    numbers = Numbers(7, "Åsa")
    tasks = [task_with(name, numbers) for name in TASKS]
    figures = sheet.pages(tasks, numbers)
    printed = " ".join(word for figure in figures for word in words_of(figure))
    for task in tasks:
        listing = [line for line in task.given.splitlines() if line]
        assert all(line in printed for line in listing) and f"{task.name}{task.suffixes[0]}" in printed
        assert " ".join(task.text.replace("`", "").split()[:6]) in " ".join(printed.split())
    for number, figure in enumerate(figures, start=1):
        words = words_of(figure)
        assert f"page {number} of {len(figures)}, numbers of Åsa, seed 7" in words and {"Name", "Date", "Åsa"} <= {
            *words
        }
    lines = [line for task in tasks for line in sheet.lines_of(1, task)]
    ends = [x + fragment.width for line in lines for x, fragment in line.fragments]
    assert max(ends) <= sheet.WIDTH - sheet.MARGIN + 0.1
    for filled in sheet.broken([lines]):  # a task that is longer than a page goes on on the next one
        assert sheet.height_of(filled) <= sheet.TOP - sheet.BOTTOM


def test_the_widths_of_text_are_those_of_the_page() -> None:
    from matplotlib.textpath import text_to_path

    for text, font, size in (("The lecture compares", sheet.SERIF, 10.5), ("J = [-sin(q1)*r, 0];", sheet.MONO, 8.0)):
        properties = sheet.properties(font, size)
        width = text_to_path.get_text_width_height_descent(text, properties, ismath=False)[0]
        assert abs(sheet.Fragment(text, font, size).width - width) < 0.02 * width


def test_a_sheet_is_written_with_the_same_bytes_each_time(tmp_path: Path, monkeypatch: Any, capsys: Any) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("arm3r_cpp.exercises.tasks.TASKS", {"moon": TASKS["moon"]})
    assert call("sheet") == call("sheet", "-o", "other.pdf") == 0
    assert capsys.readouterr().out == "sheet.pdf: 1 tasks on 1 pages\nother.pdf: 1 tasks on 1 pages\n"
    assert (tmp_path / "sheet.pdf").read_bytes() == (tmp_path / "other.pdf").read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["other.pdf", "sheet.pdf"]


def test_a_name_that_the_font_does_not_have_is_left_to_be_written() -> None:
    numbers = Numbers(1, "王小明")
    (figure,) = sheet.pages([task_with("moon", numbers)], numbers)
    assert "王小明" not in words_of(figure)
