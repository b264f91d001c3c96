"""python page_runner.py PAGE [--clone]: runs the code blocks of a Markdown page in the current folder.

The blocks run in their order; one that fails ends the program with its traceback. The Python blocks of a page share
their names, and each of their print lines shows what it prints. A YAML block is a scenario or a sweep and is
validated. A console block shows commands after `$` and what they print. A block whose first line is a comment that
consists of a file name is written to this file.

A block under the line MARK is left out without --clone. With --clone the current folder is a clone of the
repository, and the shell blocks that run are those with the mark.
"""

from __future__ import annotations

import contextlib
import io
import re
import subprocess
import sys
import traceback
from dataclasses import dataclass
from pathlib import Path

MARK = "*In a clone, with a compiler:*"
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.M | re.S)
FILE_NAME = re.compile(r"\A(?:#|%|/\*|<!--) (\w+\.\w+)(?: \*/| -->)?\n")
# The suite does not start itself: make only has to know what to do.
MAKE = """make() {
    case "$1" in
        test|gates|seeds|docs|page|wheels|build/*) command make --dry-run "$@" > /dev/null;;
        *) command make "$@";;
    esac
}
"""


@dataclass
class Block:
    language: str
    text: str
    line: int  # of the page, where the text begins
    is_marked: bool


def blocks_of(page: str) -> list[Block]:
    """Every block of code of a page; formulas are none."""
    found = []
    for match in FENCE.finditer(page):
        before = page[: match.start()]
        if match[1] != "math":
            found.append(Block(match[1], match[2], before.count("\n") + 2, before.endswith(f"{MARK}\n\n")))
    return found


def run_python(block: Block, page: str, names: dict[str, object]) -> None:
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile("\n" * (block.line - 1) + block.text, page, "exec"), names)
    promised = re.findall(r"print\(.*\)  # (.*)", block.text)
    assert len(promised) == block.text.count("print("), "a print line does not show what it prints"
    assert printed.getvalue().splitlines() == promised, f"printed:\n{printed.getvalue()}"


def run_shell(block: Block) -> None:
    done = subprocess.run(
        ["bash", "-ec", MAKE + block.text], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    assert done.returncode == 0, done.stdout
    assert "FAIL" not in done.stdout, done.stdout


def run_console(block: Block) -> None:
    for command, promised in re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", block.text, re.M):
        printed = subprocess.run(
            command, shell=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        ).stdout
        assert printed == promised, f"printed:\n{printed}"


def run_yaml(block: Block) -> None:
    import arm3r_cpp as arm3r

    if re.search(r"^axes:", block.text, re.M):
        assert arm3r.Sweep(block.text, file="sweep.yaml").runs > 0
    else:
        arm3r.Scenario(block.text).validate()


def run(block: Block, page: str, names: dict[str, object], in_clone: bool) -> None:
    if block.is_marked and not in_clone:
        return
    if name := FILE_NAME.match(block.text):
        Path(name[1]).write_text(block.text)
    if block.language == "python":
        run_python(block, page, names)
    elif block.language == "sh" and block.is_marked == in_clone:
        run_shell(block)
    elif block.language == "console":
        run_console(block)
    elif block.language == "yaml":
        run_yaml(block)


def main(page: str, in_clone: bool) -> int:
    names: dict[str, object] = {"__name__": "__main__"}
    for block in blocks_of(Path(page).read_text()):
        try:
            run(block, page, names, in_clone)
        except BaseException:
            traceback.print_exc()
            print(f"{page}:{block.line}: this block fails", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], "--clone" in sys.argv[2:]))
