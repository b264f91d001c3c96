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
    parser = argparse.ArgumentParser(
        prog=PROGRAM,
        description="Exercises about the lecture's arm, with marking; `arm3r docs exercises` is the lab sheet.",
    )
    calls = parser.add_subparsers(title="calls", metavar="CALL", required=True)

    def call(name: str, do: Any, text: str, **more: Any) -> Any:
        one = calls.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".", **more)
        one.set_defaults(do=do)
        return one.add_argument

    call("list", list_tasks, "list the exercises, in the order of the lab sheet")
    add = call("show", show, "print an exercise: what is asked, and what is given")
    add("name", metavar="NAME")
    add("--given", action="store_true", help="print only what is given: the file to begin with")
    add = call("check", check, "judge a file: exit code 0 if it is right, 11 if it is wrong, 12 if that is unclear")
    add("name", metavar="NAME")
    add("file", metavar="FILE", type=Path, help="a function in Python or MATLAB, or a scenario")
    add("--hint", metavar="GRADE", type=int, choices=(1, 2, 3), default=0, help="say more: 1, 2 or 3")
    add = call("mark", mark, "mark a folder of submissions: a folder for each student, in it a file for each task")
    add("folder", metavar="DIR", type=Path)
    add("-o", dest="out", metavar="TABLE.csv", default="-", help="write the table there (default: standard output)")
    add("--task", metavar="NAME", action="append", help="mark only this task; may be given several times")
    add("--jobs", type=int, metavar="N", help="files judged at a time (default: one for each CPU allowed)")
    add("--forbid-import", action="store_true", help="a Python file cannot import or read arm3r_cpp, to copy from it")
    add("--trust-code", action="store_true", help="run Python files also where this system cannot confine them")
    return parser


def list_tasks(options: argparse.Namespace, _: list[str]) -> None:
    from ..exercises.tasks import TASKS

    width = max(map(len, TASKS)) + 2
    for name, task in TASKS.items():
        print_line(f"{name:{width}}{task.title}")


def show(options: argparse.Namespace, _: list[str]) -> None:
    from ..exercises.feedback import described

    task = task_of(options.name)
    if options.given and not task.given:
        raise UsageError(f"{task.name}: nothing is given; you write the whole file", code="usage")
    print_line(task.given.rstrip("\n") if options.given else described(task))


def check(options: argparse.Namespace, marks: list[str]) -> None:
    from ..exercises.feedback import answer
    from ..exercises.worker import Worker

    task = task_of(options.name)
    if not options.file.is_file():
        raise UsageError(f"{options.file}: is no file that can be read", code="usage")
    if options.file.suffix == ".py":
        say_what_is_not_barred()
    with closing(Worker()) as worker:
        mark = worker.mark(task, options.file, with_reading=options.hint == 3)
    print_line(answer(task, str(options.file), mark, options.hint))
    marks.append(mark.word)


def mark(options: argparse.Namespace, _: list[str]) -> None:
    from .._files import check_ending, check_folder, replacing
    from ..exercises.folder import marks, notes, runs_code, submissions
    from ..exercises.table import csv_of, summary
    from ..exercises.tasks import TASKS
    from ..system.cpus import usable_cpus

    if options.out != "-":
        check_ending(options.out, [".csv"], hint="- is standard output")
        check_folder(Path(options.out).parent)
    tasks = [task_of(name) for name in options.task] if options.task else list(TASKS.values())
    found = submissions(options.folder, tasks)
    for note in notes(options.folder, list(TASKS.values())):
        say(PROGRAM, note)
    if runs_code(found):
        ask_for_trust(options.trust_code)
    bar = Bar("mark", "files")
    try:
        jobs = usable_cpus() if options.jobs is None else options.jobs
        rows = marks(found, jobs=jobs, forbid_own_package=options.forbid_import, progress=bar.draw)
    finally:
        bar.clear()
    if options.out == "-":
        print_line(csv_of(rows).rstrip("\n"))
        return
    with replacing(Path(options.out)) as part:
        part.write_text(csv_of(rows), encoding="utf-8", newline="\n")
    print_line(f"{options.out}: {summary(rows)}")


def task_of(name: str) -> Task:
    from .._messages import did_you_mean
    from ..exercises.tasks import TASKS

    if name not in TASKS:
        hint = did_you_mean(name, TASKS) or "`arm3r exercise list` lists them"
        raise UsageError(f"{name}: there is no exercise of this name; {hint}", code="usage")
    return TASKS[name]


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
