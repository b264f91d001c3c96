"""No verdict and no mark hangs on the clock: it is the same beside busy processes, and when time passes by itself."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import pytest
from arm3r_cpp.commands import exercise
from arm3r_cpp.system.patience import Patience, TooSlow, Waits

HERE = Path(__file__).parents[1]
BUSY = "import os\nparent = os.getppid()\nwhile os.getppid() == parent: pass"  # until its parent ends
linux = pytest.mark.skipif(sys.platform != "linux", reason="other systems do not tell what a process computes")
COMPUTES = """
import time

def gravity(q1, q2, q3):
    end = time.process_time() + 0.002
    while time.process_time() < end:
        pass
    return [0, 0, q1]
"""


@contextmanager
def stopped_now_and_then(pid: int) -> Iterator[None]:
    """As on a busy machine: the process goes on for a tenth of the time."""
    over = threading.Event()

    def stop_and_go() -> None:
        while not over.is_set():
            os.kill(pid, signal.SIGSTOP)
            over.wait(0.18)
            os.kill(pid, signal.SIGCONT)
            over.wait(0.02)

    thread = threading.Thread(target=stop_and_go)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


@pytest.fixture
def process() -> Iterator[Any]:
    found = []

    def start(code: str) -> subprocess.Popen[bytes]:
        found.append(subprocess.Popen([sys.executable, "-c", code], start_new_session=True))
        return found[-1]

    yield start
    for one in found:
        one.kill()
        one.wait()


def seconds_until(error: type[TimeoutError], patience: Patience) -> float:
    begun = time.monotonic()
    with pytest.raises(error):
        while True:
            time.sleep(0.05)
            patience.check()
    return time.monotonic() - begun


@linux
def test_patience_counts_what_a_process_computes(process: Any) -> None:
    """Its clock, not ours: a tenth of the processor takes several times as long, and is no sooner too slow."""
    busy = process(BUSY)
    time.sleep(0.2)
    with stopped_now_and_then(busy.pid):
        assert seconds_until(TooSlow, Patience(busy.pid, 0.2)) > 0.5


@linux
def test_patience_counts_what_the_process_has_started(process: Any) -> None:
    starts = process(f"import subprocess, sys; subprocess.run([sys.executable, '-c', {BUSY!r}])")
    seconds_until(TooSlow, Patience(starts.pid, 0.3))


@linux
def test_patience_ends_with_a_process_that_sleeps(process: Any, monkeypatch: Any) -> None:
    monkeypatch.setattr("arm3r_cpp.system.patience.WAITING_TIME", 1.0)
    asleep = process("import time; time.sleep(1000)")
    seconds_until(Waits, Patience(asleep.pid, 50.0))


@linux
def test_patience_ends_with_a_process_that_sleeps_a_little_each_time(process: Any, monkeypatch: Any) -> None:
    """However often it answers: a formula that sleeps for a while would else take hours to judge."""
    monkeypatch.setattr("arm3r_cpp.system.patience.WAITING_TIME", 1.0)
    asleep = process("import time; time.sleep(1000)")
    patience = Patience(asleep.pid, 50.0)
    with pytest.raises(Waits):
        for _ in range(50):
            patience.renew(50.0)
            for _ in range(4):
                time.sleep(0.05)
                patience.check()


@linux
def test_a_formula_is_not_too_slow_where_time_passes_by_itself(tmp_path: Path, monkeypatch: Any) -> None:
    """The clock runs fifty times as fast: by it an evaluation takes longer than the limit, by the processor less."""
    path = tmp_path / "gravity.py"
    path.write_text(COMPUTES)
    monkeypatch.setattr("arm3r_cpp.verify.judge.REPAIR_EDITS", 0)
    quiet = str(arm3r.verify.gravity(path))
    clock = time.monotonic
    monkeypatch.setattr(time, "monotonic", lambda: 50 * clock())
    assert str(arm3r.verify.gravity(path)) == quiet


@contextmanager
def busy_processes(count: int) -> Iterator[None]:
    busy = [subprocess.Popen([sys.executable, "-c", BUSY]) for _ in range(count)]
    try:
        yield
    finally:
        for one in busy:
            one.kill()
            one.wait()


def verdicts_and_table(folder: Path, table: Path, texts: list[str]) -> list[str]:
    assert exercise.main(["mark", "--trust-code", str(folder), "-o", str(table)]) == 0
    return [
        table.read_text(),
        *(str(arm3r.verify.jacobian(text) if "jacobian" in text else judged(text)) for text in texts),
    ]


def judged(file: str) -> Any:
    return (arm3r.verify.mass if "mass" in Path(file).name else arm3r.verify.gravity)(file)


def of_students(*names: str) -> list[str]:
    return [str(HERE / "formulas/students" / name) for name in names]


@pytest.mark.gate
def test_every_verdict_and_table_is_the_same_beside_busy_processes(tmp_path: Path) -> None:
    folder = tmp_path / "class"
    for stem, tasks in (("right", ("impedance", "degrees", "wall_force")), ("wrong", ("mass_matrix", "tip_torque"))):
        for task in tasks:
            for path in (HERE / "submissions" / task).glob(f"{stem}.*"):
                (folder / stem).mkdir(parents=True, exist_ok=True)
                shutil.copy(path, folder / stem / f"{task}{path.suffix}")
    (folder / "right" / "observer.py").write_text("def momentum_rate(tau, c, g, r):\n    while True: pass\n")
    wrong = tmp_path / "gravity.py"
    wrong.write_text(Path(of_students("unequal/gravity_weights.py")[0]).read_text().replace("cos", "sin", 1))
    names = "unequal/mass_sympy_energy unequal/jacobian_sympy unequal/gravity_sympy_energy unequal/mass_energy"
    names = f"{names} lecture/mass_slender lecture/gravity_rod"
    texts = [*of_students(*(f"{name}.py" for name in names.split())), str(wrong)]
    quiet = verdicts_and_table(folder, tmp_path / "table.csv", texts)
    with busy_processes(8):
        assert verdicts_and_table(folder, tmp_path / "table.csv", texts) == quiet
