"""Files that do what no formula should: each is one clear line, and nothing of them stays behind."""

from __future__ import annotations

import gc
import math
import os
import random
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp import verify
from arm3r_cpp.user_functions import start
from arm3r_cpp.user_functions.c_symbol import text_of
from arm3r_cpp.user_functions.programs import Call, Edit, ProgramError
from arm3r_cpp.user_functions.python_in_memory import PythonInMemory
from arm3r_cpp.user_functions.python_process import PythonProcess
from formulas.hostile import files

SEED = int(os.environ.get("ARM3R_SEED", random.randrange(10**6)))
FILES = files()
SECONDS = "987654"
RIGHT = "def jacobian(q):\n    import arm3r_cpp\n    return arm3r_cpp.Scenario().arm.jacobian(q)\n"


def processes() -> set[str]:
    """The descendants of this process, and what a file has started."""
    done = subprocess.run(["ps", "-eo", "pid,ppid,args"], capture_output=True, text=True)
    lines = [line.split(None, 2) for line in done.stdout.splitlines()[1:]]
    found, more = {str(os.getpid())}, {""}
    while more:
        more = {pid for pid, parent, _ in lines if parent in found} - found
        found |= more
    theirs = {pid for pid, _, words in lines if SECONDS in words and words.startswith("sleep")}
    return {pid for pid, _, words in lines if pid in found and not words.startswith("ps ")} | theirs


def state() -> dict[str, Any]:
    """What a file must not change."""
    return {
        "environment": dict(os.environ),
        "folder": os.getcwd(),
        "processes": processes(),
        "signals": [signal.getsignal(one) for one in signal.valid_signals()],
        "files": len(os.listdir("/proc/self/fd")) if os.path.isdir("/proc/self/fd") else 0,
        "threads": threading.active_count(),
        "modules": "socket" in sys.modules,
    }


@pytest.fixture
def judged(tmp_path: Path, monkeypatch: Any) -> Iterator[Any]:
    monkeypatch.setattr("arm3r_cpp.user_functions.python_process.ANSWER_TIME", 3.0)
    monkeypatch.setattr("arm3r_cpp.system.patience.WAITING_TIME", 10.0)
    start.prepare()  # it stays for the next files, and runs none
    victim, new = tmp_path / "victim", tmp_path / "new"
    victim.write_text("here")
    path, other = tmp_path / "jacobian.py", tmp_path / "other" / "jacobian.py"
    other.parent.mkdir()
    other.write_text(RIGHT)
    names = {"victim": str(victim), "new": str(new), "folder": str(tmp_path), "seconds": SECONDS}

    def judge(text: str) -> None:
        path.write_text(text.format(**names))
        before, written = state(), (victim.stat().st_mode, victim.stat().st_mtime_ns, path.read_bytes())
        try:
            verdict = verify.jacobian(path)
            assert not verdict.ok
            line = verdict.findings[0].cause
            if verdict.findings[0].entry is not None:
                line = str(len(verdict.findings))
        except arm3r.UsageError as error:
            line = str(error)
        assert 0 < len(line) < 600 and "\n" not in line and "Traceback" not in line, line
        assert state() == before
        assert (victim.stat().st_mode, victim.stat().st_mtime_ns, path.read_bytes()) == written
        assert victim.read_text() == "here"
        assert sorted(one.name for one in tmp_path.iterdir()) == ["jacobian.py", "other", "victim"]

    yield judge
    assert verify.jacobian(other).ok


def test_nothing_of_some_files_stays_behind(judged: Any) -> None:
    print(f"ARM3R_SEED={SEED}")
    choose = random.Random(SEED)
    for kind, text in choose.sample(FILES, 3):
        print(kind, text, sep="\n")
        judged(text)


def test_the_table_is_long_enough() -> None:
    assert len({text for _, text in FILES}) >= 100


@pytest.mark.gate
@pytest.mark.parametrize("number", range(len(FILES)))
def test_nothing_stays_behind(number: int, judged: Any) -> None:
    judged(FILES[number][1])


def test_a_package_can_be_forbidden(tmp_path: Path, monkeypatch: Any) -> None:
    path = tmp_path / "jacobian.py"
    path.write_text("import arm3r_cpp\n\ndef jacobian(q):\n    return arm3r_cpp.Scenario().arm.jacobian(q)\n")
    assert verify.jacobian(path).ok
    monkeypatch.setattr(PythonProcess, "forbid_own_package", True)
    assert "raises ModuleNotFoundError" in verify.jacobian(path).findings[0].cause


NUMBERS = "double q1, double q2, double q3"


@pytest.mark.parametrize(
    "order",
    [
        "const double *q, double *out",
        "double *out, const double *q",
        f"{NUMBERS}, double *out",
        f"double *out, {NUMBERS}",
    ],
)
def test_a_symbol_of_a_library(order: str, tmp_path: Path) -> None:
    source, library = tmp_path / "arm.c", tmp_path / "arm.so"
    text = """#include <math.h>
    void gravity(ORDER) {
        VECTOR
        double g = 9.80665, c2 = cos(q[1]), c23 = cos(q[1] + q[2]);
        out[0] = EXTRA; out[2] = -0.785*g*0.5*c23; out[1] = -0.785*g*1.5*c2 + out[2];
    }
    """
    vector = "double q[] = {q1, q2, q3};" if NUMBERS in order else ""
    for extra, is_right in (("0", True), ("q[0]", False)):
        source.write_text(text.replace("EXTRA", extra).replace("ORDER", order).replace("VECTOR", vector))
        subprocess.run(["gcc", "-shared", "-fPIC", "-o", library, source, "-lm"], check=True)
        verdict = verify.gravity(f"{library}:gravity")
        assert verdict.ok == is_right, str(verdict)
        library.unlink()
    assert (verdict.findings[0].reads, verdict.findings[0].due) == ("q1", "0")
    with pytest.raises(arm3r.UsageError, match="name the function"):
        verify.gravity(tmp_path / "arm.so")


def test_nine_numbers_are_arguments_of_a_symbol_of_a_library(tmp_path: Path) -> None:
    names = ", ".join(f"double {vector}{joint}" for vector in ("q", "qd", "qdd") for joint in (1, 2, 3))
    (tmp_path / "arm.c").write_text(f"void torque({names}, double *t) {{ t[0] = q1; t[1] = qd2; t[2] = qdd3; }}")
    subprocess.run(["gcc", "-shared", "-fPIC", "-o", tmp_path / "arm.so", tmp_path / "arm.c"], check=True)
    library = str(tmp_path / "arm.so")
    program = PythonProcess(text_of(library, "torque"), "torque", library)
    call = Call(((0, 1, 2), (3, 4, 5), (6, 7, 8)), {})
    assert program.evaluate(call, np.arange(9.0)[None]).tolist() == [[0.0, 4.0, 8.0]]


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        ("const double *q, const double *masses, double *out", "takes more vectors than 1 and its result"),
        (f"{NUMBERS}, double m2, double *out", "takes more numbers than those of its joints"),
    ],
)
def test_a_symbol_that_takes_more_cannot_be_judged(arguments: str, why: str, tmp_path: Path) -> None:
    body = "out[0] = 0; out[1] = masses[0]; out[2] = masses[1];" if "masses" in arguments else "out[0] = out[1] = m2;"
    (tmp_path / "arm.c").write_text(f"void gravity({arguments}) {{ {body} }}")
    subprocess.run(["gcc", "-shared", "-fPIC", "-o", tmp_path / "arm.so", tmp_path / "arm.c"], check=True)
    with pytest.raises(arm3r.UnjudgedError, match=f"{why}: name a function of these alone"):
        verify.gravity(f"{tmp_path / 'arm.so'}:gravity")


def test_an_entry_that_is_nan_is_said_to_be(tmp_path: Path) -> None:
    path = tmp_path / "gravity.py"
    path.write_text("import numpy as np\ndef gravity(q):\n    return [0, np.sqrt(-1 - q[1]**2), 1]\n")
    [cause] = [one.cause for one in verify.gravity(path).findings if one.entry == [2]]
    assert re.fullmatch(r"t2 is NaN, which is no number, at q = \[(-?\d\.\d+, ){2}-?\d\.\d+\]\.", cause), cause


# ---- functions in memory --------------------------------------------------------------------------------------------


def ends_the_process(number: float) -> float:
    if number == 0:
        os.kill(os.getpid(), signal.SIGSEGV)
    return 1.0


def hangs(number: float) -> float:
    while number == 0:
        pass
    return 1.0


def gravity_that_may_crash(q1: float, q2: float, q3: float) -> list[float]:
    a2, a3, m2, m3, g = 1.0, 1.0, 0.785, 0.785, 9.80665
    t3 = -m3 * g * a3 * math.cos(q2 + q3) * ends_the_process(2)
    return [0, t3 - (m2 / 2 + m3) * g * a2 * math.cos(q2), t3]


def gravity_that_may_hang(q1: float, q2: float, q3: float) -> list[float]:
    a2, a3, m2, m3, g = 1.0, 1.0, 0.785, 0.785, 9.80665
    t3 = -m3 * g * a3 * math.cos(q2 + q3) * hangs(2)
    return [0, t3 - (m2 / 2 + m3) * g * a2 * math.cos(q2), t3]


@pytest.mark.parametrize("function", [gravity_that_may_crash, gravity_that_may_hang])
def test_no_edit_of_a_function_in_memory_runs_in_this_process(function: Any, monkeypatch: Any) -> None:
    """An edit of `2` to `0` ends the process or hangs; the edit that mends the formula is found all the same."""
    monkeypatch.setattr("arm3r_cpp.user_functions.python_process.EDIT_TIME", 0.3)
    start.prepare()  # the process that is copied stays for others
    before = state()
    verdict = verify.gravity(function)
    assert {(one.old, one.new) for one in verdict.findings} == {("m3", "m3/2")}, str(verdict)
    del verdict
    gc.collect()
    assert state() == before


@pytest.mark.sample(1)
@pytest.mark.parametrize("make", [PythonProcess, PythonInMemory])
def test_edits_that_crash_the_interpreter_do_not_end_the_search(make: Any) -> None:
    """Some do, of a right interpreter; each costs a process and its seconds."""
    text = "import os\n\ndef gravity(q):\n    return [0.0, 1.0, 2.0]\n"
    program, call, table = make(text, "gravity", "arm.py"), Call(((0, 1, 2),), {}), np.zeros((2, 3))
    place = text.index("1.0")
    for _ in range(8):
        with pytest.raises(ProgramError, match="ends its process"):
            program.evaluate(call, table, Edit(place, place + 3, "os.abort()", 1))
        right = program.evaluate(call, table, Edit(place, place + 3, "7.0", 1))
        assert right.tolist() == [[0.0, 7.0, 2.0]] * 2
    before = program.seconds
    with pytest.raises(ProgramError, match="takes too long"):
        program.evaluate(call, table, Edit(place, place + 3, "[1 for _ in iter(int, 1)]", 1))
    assert program.seconds > before + 1.5


def test_edits_that_hang_end_the_search_however_many_answer_between_them(monkeypatch: Any) -> None:
    monkeypatch.setattr("arm3r_cpp.user_functions.python_process.EDIT_TIME", 0.2)
    text = "def gravity(q):\n    return [0.0, 1.0, 2.0]\n"
    program, call, table = PythonProcess(text, "gravity", "arm.py"), Call(((0, 1, 2),), {}), np.zeros((1, 3))
    place = text.index("1.0")
    for _ in range(4):
        with pytest.raises(ProgramError, match="takes too long"):
            program.evaluate(call, table, Edit(place, place + 3, "[1 for _ in iter(int, 1)]", 1))
        program.evaluate(call, table)
    with pytest.raises(ProgramError, match="too many edits"):
        program.evaluate(call, table, Edit(place, place + 3, "7.0", 1))
