"""arm3r-exercise: tasks with marking, for students and for teachers."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._progress_bar import Bar
from ..errors import UsageError
from .exit_codes import UNJUDGED, WRONG_FORMULA, attempt, print_line, say

if TYPE_CHECKING:
    from ..exercises.folder import Row, Submission
    from ..exercises.numbers import Numbers
    from ..exercises.task import Task

PROGRAM = "arm3r-exercise"
_CODES = {"right": 0, "wrong": WRONG_FORMULA, "unclear": UNJUDGED}


def main(argv: Sequence[str] | None = None) -> int:
    """Entry point of `arm3r-exercise`; argv without the program's name. Returns one of the exit codes of `arm3r`."""
    options = parser().parse_args(sys.argv[1:] if argv is None else argv)
    marks: list[str] = []
    code = attempt(PROGRAM, lambda: options.do(options, marks))
    return code or max((_CODES[word] for word in marks), default=0)


def parser() -> argparse.ArgumentParser:
    from ..exercises.gradebook import PLATFORMS

    parser = argparse.ArgumentParser(
        prog=PROGRAM,
        description="Exercises about the lecture's arm, with marking; `arm3r docs exercises` is the lab sheet.",
    )
    calls = parser.add_subparsers(title="calls", metavar="CALL", required=True)

    def call(name: str, do: Any, text: str, **more: Any) -> Any:
        one = calls.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".", **more)
        one.set_defaults(do=do)
        return one.add_argument

    add = call("list", list_tasks, "list the exercises; with a folder, judge the files in it")
    add("folder", metavar="DIR", nargs="?", type=Path, help="your folder: its files are judged")
    add_student(add)
    add = call("show", show, "print an exercise: what is asked, and what is given")
    add("name", metavar="NAME")
    add("--given", action="store_true", help="print only what is given: the file to begin with")
    add_student(add)
    add = call("check", check, "judge a file: exit code 0 if it is right, 11 if it is wrong, 12 if that is unclear")
    add("name", metavar="NAME")
    add("file", metavar="FILE", type=Path, help="a function in Python or MATLAB, or a scenario")
    add(
        "--hint",
        metavar="GRADE",
        type=int,
        choices=(1, 2, 3),
        default=0,
        help="print the hints up to this one: 1, 2 or 3",
    )
    add_student(add)
    add = call("mark", mark, "mark a folder of submissions: a folder for each student, in it a file for each task")
    add("folder", metavar="DIR", type=Path)
    add("-o", dest="out", metavar="TABLE.csv", default="-", help="write the table there (default: standard output)")
    add(
        "--lms",
        choices=PLATFORMS,
        help="write instead what this platform imports: a row for each student, with the total",
    )
    add("--seed", type=int, metavar="N", help="each student has numbers of their own, from N and the folder's name")
    add("--task", metavar="NAME", action="append", help="mark only this task; may be given several times")
    add("--jobs", type=int, metavar="N", help="files judged at the same time (default: the number of usable CPUs)")
    add("--forbid-import", action="store_true", help="Python files can neither import nor read arm3r_cpp")
    add("--trust-code", action="store_true", help="run Python files also where this system cannot confine them")
    add = call("sheet", sheet, "write the exercises for printing, on A4 pages")
    add(
        "-o",
        dest="out",
        type=Path,
        metavar="SHEET.pdf",
        default=Path("sheet.pdf"),
        help="write the sheet there (default: sheet.pdf)",
    )
    add_student(add)
    return parser


def add_student(add: Any) -> None:
    add("--seed", type=int, metavar="N", help="use numbers of your own, drawn from N and your name")
    add(
        "--student",
        metavar="NAME",
        default="",
        help="the name from which the numbers are drawn: that of the folder that is handed in",
    )


def numbers_of(options: argparse.Namespace) -> Numbers:
    """
    Raises:
        UsageError: of seed and name one is missing.
    """
    from ..exercises.numbers import Numbers

    if options.seed is not None and not options.student.strip():
        raise UsageError("--seed: numbers are drawn from a seed and a name; add --student NAME", code="usage")
    if options.seed is None and options.student:
        raise UsageError("--student: numbers are drawn from a seed and a name; add --seed N", code="usage")
    return Numbers(options.seed, options.student)


def list_tasks(options: argparse.Namespace, _: list[str]) -> None:
    from ..exercises.feedback import listed
    from ..exercises.folder import notes, runs_code, submissions
    from ..exercises.points import totals
    from ..exercises.tasks import TASKS, task_with
    from ..system.cpus import usable_cpus

    numbers = numbers_of(options)
    if not options.folder:
        print_line(listed([task_with(name, numbers) for name in TASKS]))
        return
    found = submissions(options.folder, list(TASKS), numbers)
    for note in notes(options.folder):
        say(PROGRAM, note)
    if runs_code(found):
        say_what_is_not_barred()
    rows = judged(found, jobs=usable_cpus())
    print_line(listed([row.task for row in rows], [row.mark for row in rows]))
    print_line(totals(rows)[0])


def show(options: argparse.Namespace, _: list[str]) -> None:
    from ..exercises.feedback import described

    task = task_of(options.name, numbers_of(options))
    if options.given and not task.given:
        raise UsageError(f"{task.name}: nothing is given; you write the whole file", code="usage")
    print_line(task.given.rstrip("\n") if options.given else described(task))


def check(options: argparse.Namespace, marks: list[str]) -> None:
    from ..exercises.feedback import answer
    from ..exercises.worker import Worker

    task = task_of(options.name, numbers_of(options))
    if not options.file.is_file():
        raise UsageError(f"{options.file}: is not a readable file", code="usage")
    if options.file.suffix == ".py":
        say_what_is_not_barred()
    with closing(Worker()) as worker:
        mark = worker.mark(task, options.file, with_reading=options.hint == 3)
    print_line(answer(task, str(options.file), mark, options.hint))
    marks.append(mark.word)


def mark(options: argparse.Namespace, _: list[str]) -> None:
    from .._files import check_ending, check_folder, replacing
    from ..exercises.folder import notes, runs_code, students, submissions
    from ..exercises.gradebook import PLATFORMS
    from ..exercises.numbers import LAB, Numbers
    from ..exercises.points import totals
    from ..exercises.table import csv_of, summary
    from ..exercises.tasks import TASKS
    from ..system.cpus import usable_cpus

    if options.out != "-":
        check_ending(options.out, [".csv"], hint="- is standard output")
        check_folder(Path(options.out).parent)
    names = [task_of(name, LAB).name for name in options.task] if options.task else list(TASKS)
    folders = students(options.folder)
    found = [one for folder in folders for one in submissions(folder, names, Numbers(options.seed, folder.name))]
    for note in (note for folder in folders for note in notes(folder)):
        say(PROGRAM, note)
    if runs_code(found):
        ask_for_trust(options.trust_code)
    jobs = usable_cpus() if options.jobs is None else options.jobs
    rows = judged(found, jobs=jobs, forbid_own_package=options.forbid_import)
    text = PLATFORMS[options.lms](totals(rows)) if options.lms else csv_of(rows)
    if options.out == "-":
        print_line(text.rstrip("\n"))
        return
    with replacing(Path(options.out)) as part:
        part.write_text(text, encoding="utf-8", newline="\n")
    print_line(f"{options.out}: {summary(rows)}")
    for total in totals(rows):
        print_line(f"  {total.student}: {total}")


def sheet(options: argparse.Namespace, _: list[str]) -> None:
    from .._files import check_ending, check_folder, replacing
    from ..exercises.sheet import write_sheet
    from ..exercises.tasks import TASKS, task_with

    numbers = numbers_of(options)
    check_ending(options.out, [".pdf"])
    check_folder(options.out.parent)
    with replacing(options.out) as part:
        pages = write_sheet(part, [task_with(name, numbers) for name in TASKS], numbers)
    print_line(f"{options.out}: {len(TASKS)} tasks on {pages} pages")


def judged(found: list[Submission], **options: Any) -> list[Row]:
    """The marks, with a bar on the terminal that says how far they are."""
    from ..exercises.folder import marks

    bar = Bar("mark", "files")
    try:
        return marks(found, **options, progress=bar.draw)
    finally:
        bar.clear()


def task_of(name: str, numbers: Numbers) -> Task:
    from .._messages import did_you_mean
    from ..exercises.tasks import TASKS, task_with

    if name not in TASKS:
        hint = did_you_mean(name, TASKS) or "`arm3r exercise list` lists them"
        raise UsageError(f"{name}: there is no exercise of this name; {hint}", code="usage")
    return task_with(name, numbers)


def ask_for_trust(is_given: bool) -> None:
    """Before the first file: say what the system cannot bar, and go on only where that is wanted.

    Raises:
        UsageError: it cannot bar everything, and --trust-code is not given.
    """
    if say_what_is_not_barred() and not is_given:
        raise UsageError("Python files are among the submissions; --trust-code runs them all the same", code="usage")


def say_what_is_not_barred() -> list[str]:
    from ..exercises.worker import what_is_not_barred

    unbarred = what_is_not_barred()
    if unbarred:
        say(PROGRAM, f"this system cannot bar a submission from: {', '.join(unbarred)}")
    return unbarred


if __name__ == "__main__":
    sys.exit(main())
