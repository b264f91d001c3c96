"""What differs between systems: each way of it that can be tried here is tried."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import pytest
from arm3r_cpp import verify
from arm3r_cpp.system import cpus, file_lock, processes, timed_pipe
from arm3r_cpp.system.patience import Patience, TooSlow
from arm3r_cpp.user_functions import python_process, start


@pytest.fixture(params=[timed_pipe.SelectedPipe, timed_pipe.PumpedPipe])
def pipe(request: pytest.FixtureRequest) -> Any:
    reading, writing = os.pipe()
    with os.fdopen(writing, "wb", buffering=0) as stream:
        pipe = request.param(reading)
        yield pipe, stream
        pipe.close()


def soon() -> Patience:
    return Patience(os.getpid(), 30)


def test_a_pipe_gives_what_is_asked_for_however_it_comes(pipe: Any) -> None:
    pipe, stream = pipe
    stream.write(b"abc")
    stream.write(b"defgh")
    assert [pipe.read(n, soon()) for n in (2, 4, 1)] == [b"ab", b"cdef", b"g"]
    with pytest.raises(TooSlow):
        pipe.read(2, Patience(os.getpid(), 0.0))


def test_a_pipe_whose_writer_is_gone_has_an_end(pipe: Any) -> None:
    pipe, stream = pipe
    stream.write(b"ab")
    stream.close()
    assert pipe.read(2, soon()) == b"ab"
    for _ in range(2):
        with pytest.raises(EOFError):
            pipe.read(1, soon())


def test_formulas_are_judged_through_either_pipe(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(start, "COPIES", False)  # of another process, which reads all through the first pipe
    monkeypatch.setattr(start, "TimedPipe", timed_pipe.PumpedPipe)
    file = tmp_path / "gravity.py"
    file.write_text("def gravity(q):\n    return [0, 0, q[0]]\n")
    verdict = verify.gravity(str(file))
    assert not verdict.ok and {tuple(finding.entry) for finding in verdict.findings} == {(2,), (3,)}
    file.write_text("def gravity(q):\n    while True: pass\n")
    monkeypatch.setattr(python_process, "ANSWER_TIME", 0.5)
    with pytest.raises(arm3r.UnjudgedError, match="takes too long"):
        verify.gravity(str(file))


def test_a_lock_ends_with_its_process(tmp_path: Path) -> None:
    begin = "import sys; from arm3r_cpp.system.file_lock import try_lock; f = open(sys.argv[1], 'ab', 0)"
    call = [sys.executable, "-c", f"{begin}; print(try_lock(f), flush=True); input()", str(tmp_path / "lock")]
    with subprocess.Popen(call, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout and other.stdout.readline() == "True\n"
        with (tmp_path / "lock").open("ab", 0) as file:
            assert not file_lock.try_lock(file)
            other.kill()
            other.wait()
            assert file_lock.try_lock(file)


def test_a_process_ends_with_all_that_it_started() -> None:
    code = "import subprocess, sys; subprocess.Popen(['sleep', '60']); print('.', flush=True); input()"
    call = [sys.executable, "-c", code]
    with subprocess.Popen(
        call, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, start_new_session=True
    ) as started:
        assert started.stdout and started.stdout.readline() == ".\n"
        processes.end_with_descendants(started.pid)
        assert started.stdout.read() == ""  # `sleep` had it open, too


def test_this_process_may_use_a_processor() -> None:
    assert 1 <= cpus.usable_cpus() <= (os.cpu_count() or 1)
