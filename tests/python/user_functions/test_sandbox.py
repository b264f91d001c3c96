"""The process that runs a user's file has no way out, as root, as an ordinary user, with namespaces and without."""

from __future__ import annotations

import contextlib
import ctypes
import json
import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import arm3r_cpp
import numpy as np
import pytest
from arm3r_cpp.commands import exercise
from arm3r_cpp.user_functions import start
from arm3r_cpp.user_functions.programs import Call, ProgramError
from arm3r_cpp.user_functions.python_process import PythonProcess
from formulas import ways_out

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="other systems bar little, and say so")
PACKAGE = Path(arm3r_cpp.__file__).parent
USERS = {"root": 0, "an ordinary user": 1000}
_NEWUSER = 0x10000000


class Judged(PythonProcess):
    forbid_own_package = True


@pytest.fixture
def class_of_two(tmp_path: Path) -> Iterator[tuple[str, ...]]:
    """What a submission looks for: a file, another one's, the marks, a FIFO and two Unix sockets that listen."""
    own, other, table = tmp_path / "class/own/gravity.py", tmp_path / "class/other/gravity.py", tmp_path / "marks.csv"
    fifo, path, name = tmp_path / "class/own/fifo", tmp_path / "s", f"arm3r_{os.getpid()}"
    for file in (own, other, table):
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("here\n")
    (own.parent / "link").symlink_to(other)
    (own.parent / ".hidden").write_text("secret")
    os.mkfifo(fifo)
    library = next(PACKAGE.rglob("libarm3r.so*"))
    with contextlib.ExitStack() as stack:
        reading = os.open(fifo, os.O_RDWR | os.O_NONBLOCK)
        stack.callback(os.close, reading)
        for address in (str(path), f"\0{name}"):
            server = stack.enter_context(socket.socket(socket.AF_UNIX))
            server.bind(address)
            server.listen()
        yield tuple(map(str, (own, other, table, fifo, path, name, PACKAGE, library)))
        with pytest.raises(BlockingIOError):
            os.read(reading, 1)
    assert {one.read_text() for one in (own, other, table)} == {"here\n"}
    assert sorted(one.name for one in own.parent.iterdir()) == [".hidden", "fifo", "gravity.py", "link"]


def open_ways(names: tuple[str, ...]) -> list[str]:
    """The ways that are open to the file `own`."""
    process = Judged(ways_out.text(names), "gravity", names[0])
    states = np.arange(float(len(ways_out.WAYS)))[:, None]
    try:
        found = process.evaluate(Call((0,), {}), states)
        assert process.unbarred == []
    finally:
        process.close()
    return [way for way, is_open in zip(ways_out.WAYS, found, strict=True) if is_open]


def become(user: int) -> None:
    """In a user namespace, if need be: root is there an ordinary user, and an ordinary user is root."""
    now, group = os.getuid(), os.getgid()
    if (now == 0) == (user == 0):
        return
    assert ctypes.CDLL(None).unshare(_NEWUSER) == 0
    for name, words in (("setgroups", "deny"), ("uid_map", f"{user} {now} 1"), ("gid_map", f"{user} {group} 1")):
        Path(f"/proc/self/{name}").write_text(words)


def without_namespaces() -> None:
    """The system refuses namespaces to this process from now on, as hardened systems and containers do."""
    limit = Path("/proc/sys/user/max_user_namespaces")
    assert ctypes.CDLL(None).unshare(_NEWUSER) == 0  # in which the limit is this process's own
    limit.write_text("0")


def tried(user: int, has_namespaces: bool, names: tuple[str, ...]) -> list[str]:
    words = json.dumps([user, has_namespaces, names])
    # No other process can enter a user namespace: one thread.
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, __file__, words], capture_output=True, text=True, env=environment)
    if done.returncode == 77:
        pytest.skip("this system has no user namespaces to try it in")
    assert done.returncode == 0, done.stderr[-2000:]
    return json.loads(done.stdout)


def main(user: int, has_namespaces: bool, names: list[str]) -> None:
    try:
        if not has_namespaces:
            without_namespaces()
        become(user) if has_namespaces else None
    except (AssertionError, OSError):
        sys.exit(77)
    print(json.dumps(open_ways(tuple(names))))


def test_the_table_is_long_enough() -> None:
    assert len(set(ways_out.WAYS.values())) >= 120


@pytest.mark.parametrize("user", USERS)
def test_no_way_out(user: str, class_of_two: tuple[str, ...]) -> None:
    assert tried(USERS[user], True, class_of_two) == []


def test_no_way_out_where_the_system_refuses_namespaces(class_of_two: tuple[str, ...]) -> None:
    assert tried(0, False, class_of_two) == []


def test_no_way_out_of_a_process_that_is_no_copy(class_of_two: tuple[str, ...], monkeypatch: Any) -> None:
    monkeypatch.setattr(start, "COPIES", False)
    assert open_ways(class_of_two) == []


def test_every_file_gets_a_copy_of_its_own_that_nothing_was_done_to() -> None:
    """What one file does to numpy, to the modules and to its own memory is not there for the next."""
    text = (
        "import numpy as np, sys\nfound = getattr(np, 'mark', 0.0)\nnp.mark = 1.0\ndef gravity(q):\n    return found\n"
    )
    assert [evaluated(text)[0] for _ in range(3)] == [0.0, 0.0, 0.0]


def test_a_copy_that_is_closed_has_ended() -> None:
    for _ in range(30):
        process = PythonProcess("def gravity(q): return 1.0", "gravity", "gravity.py")
        process.evaluate(Call((0,), {}), np.zeros((1, 1)))
        assert process._process
        pid = process._process.pid
        process.close()
        assert not Path(f"/proc/{pid}").exists()


def test_a_server_of_copies_that_has_ended_is_started_anew() -> None:
    text = "def gravity(q):\n    return 1.0\n"
    assert evaluated(text)[0] == 1.0
    server = start._servers[-1]._process
    server.kill()
    server.wait()
    assert evaluated(text)[0] == 1.0 and start._servers[-1]._process.pid != server.pid


def test_copies_of_a_process_use_the_server_that_it_has_prepared() -> None:
    text = """
import os, sys
import numpy as np
from arm3r_cpp.user_functions import start
from arm3r_cpp.user_functions.programs import Call
from arm3r_cpp.user_functions.python_process import PythonProcess
start.prepare()
for _ in range(3):
    if os.fork() == 0:
        process = PythonProcess("def gravity(q): return 7.0", "gravity", "gravity.py")
        value = process.evaluate(Call((0,), {}), np.zeros((1, 1)))[0]
        process.close()
        os._exit(int(value) if start._servers[-1]._owner == os.getppid() else 1)
print(sorted(os.wait()[1] >> 8 for _ in range(3)))
"""
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True)
    assert done.stdout == "[7, 7, 7]\n", done.stderr


def test_the_ways_are_open_outside(class_of_two: tuple[str, ...], tmp_path: Path) -> None:
    """What is refused in the confined process is no way that is closed to everybody."""
    opened = ("read: another submission", "read: processes", "truth: import", "sockets: connect", "sockets: FIFO read")
    names: dict[str, Any] = {"__name__": "ways"}
    exec(ways_out.text(class_of_two), names)
    numbers = {way: number for number, way in enumerate(ways_out.WAYS)}
    assert [names["gravity"](numbers[way]) for way in opened] == [1.0] * len(opened)


def evaluated(text: str, file: str = "gravity.py", *, forbid: bool = False) -> Any:
    process = (Judged if forbid else PythonProcess)(text, "gravity", file)
    try:
        return process.evaluate(Call((0,), {}), np.zeros((1, 1)))
    finally:
        process.close()


def test_what_formulas_need_is_open(tmp_path: Path) -> None:
    (tmp_path / "helper").mkdir()
    (tmp_path / "helper/__init__.py").write_text("from numbers_of_arm import a2\n")
    (tmp_path / "numbers_of_arm.py").write_text("a2 = 3.0\n")
    (tmp_path / "data.txt").write_text("4.0")
    text = """
import ctypes, hashlib, os, pathlib, random, scipy.linalg, sympy, threading, time
from helper import a2
os.chdir(os.path.dirname(__file__))
seen = []
thread = threading.Thread(target=seen.append, args=(float(open("data.txt").read()),))
thread.start()
thread.join()
time.sleep(0)
callback = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(lambda x: x + 1)
def gravity(q):
    return callback(a2 + seen[0] + float(sympy.diff(sympy.Symbol("x") ** 2).subs("x", 1)))
"""
    (tmp_path / "gravity.py").write_text(text)
    assert evaluated(text, str(tmp_path / "gravity.py"), forbid=True)[0] == 10.0


def test_a_file_that_imports_matplotlib_is_judged() -> None:
    """It looks for a folder that it can write to, and fails without one."""
    pytest.importorskip("matplotlib")
    assert evaluated("import matplotlib.pyplot as plt\n\ndef gravity(q):\n    return q\n")[0] == 0.0


def test_the_package_is_at_hand_unless_forbidden() -> None:
    text = "import arm3r_cpp\n\ndef gravity(q):\n    return arm3r_cpp.Scenario().arm.gravity_torque([0, 0, 0])\n"
    assert evaluated(text).shape == (1, 3)
    with pytest.raises(ProgramError, match="raises ModuleNotFoundError"):
        evaluated(text, forbid=True)


def test_processes_and_sockets_are_refused_in_words() -> None:
    for body, words in (("os.fork()", "a process is started"), ("socket.socket()", "a socket is opened")):
        with pytest.raises(ProgramError, match=words):
            evaluated(f"import os, socket\n\ndef gravity(q):\n    {body}\n")


def test_threads_are_bounded() -> None:
    text = """
import threading
threading.stack_size(32768)
stop = threading.Event()
def gravity(q):
    count = 0
    try:
        while count < 2000:
            threading.Thread(target=stop.wait, daemon=True).start()
            count += 1
    except RuntimeError:
        pass
    stop.set()
    return float(count)
"""
    assert evaluated(text)[0] < 100


def test_nothing_outlives_the_judge(tmp_path: Path) -> None:
    """A file that runs for ever ends with the process that has started it, whatever ends that."""
    text = """
import numpy as np, sys, threading, time
from arm3r_cpp.user_functions.programs import Call
from arm3r_cpp.user_functions.python_process import PythonProcess
process = PythonProcess("def gravity(q):\\n    while True: pass\\n", "gravity", "gravity.py")
threading.Thread(target=lambda: process.evaluate(Call((0,), {}), np.zeros((1, 1))), daemon=True).start()
while not (process._process and process.unbarred == []): time.sleep(0.01)
print(process._process.pid, flush=True)
time.sleep(600)
"""
    with subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE, text=True) as judge:
        assert judge.stdout
        child = int(judge.stdout.readline())
        judge.kill()
    for _ in range(600):
        if not Path(f"/proc/{child}").exists() or " Z " in Path(f"/proc/{child}/stat").read_text():
            break
        time.sleep(0.1)
    else:
        pytest.fail("it runs on")


def test_a_submission_changes_no_other_mark(tmp_path: Path) -> None:
    """The first of two makes its files writable, looks for the second one's and rewrites it through a mapping."""
    given = exercise_given("first_joint")
    for student in ("first", "second"):
        (tmp_path / "class" / student).mkdir(parents=True)
        (tmp_path / "class" / student / "first_joint.m").write_text(given.replace("t1 = q1;", "t1 = 0;"))
    (tmp_path / "class/first/degrees.py").write_text("""
import ctypes, mmap, os, sys
libc = ctypes.CDLL(None)
libc.mount(None, b"/", None, 32 | 4096, None)
own = [p for p in sys.path if p.endswith("/first")][0]
with open(os.path.join(os.path.dirname(own), "second", "first_joint.m"), "r+b") as f:
    m = mmap.mmap(f.fileno(), 0)
    at = m.find(b"t1 = 0;")
    m[at:at + 7] = b"t1 = 1;"
def tip_velocity(q_deg, qd_deg):
    return [0.0, 0.0, 0.0]
""")
    table = tmp_path / "marks.csv"
    assert (
        exercise.main(["mark", str(tmp_path / "class"), "--task", "degrees", "--task", "first_joint", "-o", str(table)])
        == 0
    )
    marks = [line.split(",")[:3] for line in table.read_text().splitlines()[1:]]
    assert ["first", "first_joint", "right"] in marks and ["second", "first_joint", "right"] in marks
    assert "first,degrees,unclear,does what is barred in line 6" in table.read_text()


def exercise_given(name: str) -> str:
    from arm3r_cpp.exercises.tasks import TASKS

    return TASKS[name].given


if __name__ == "__main__":
    main(*json.loads(sys.argv[1]))
