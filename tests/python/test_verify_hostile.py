"""Files that do what no formula should: each is one clear line, and nothing of them stays behind."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import pytest
from arm3r_cpp import verify
from arm3r_cpp.verify.program.python_process import PythonProcess

BODIES = {
    "open({path!r}, 'w').write('x')": "",
    "import os; os.remove({victim!r})": "",
    "import os; os.rename({victim!r}, {path!r})": "",
    "import shutil; shutil.rmtree({folder!r})": "",
    "import os; os.environ['PATH'] = ''; os.putenv('HOME', 'x')": "",
    "import os; os.kill(os.getppid(), 9)": "",
    "import os; os.killpg(0, 9)": "",
    "import os, signal; signal.raise_signal(signal.SIGSEGV)": "",
    "import ctypes; ctypes.string_at(0)": "ends its process",
    "import os; os.closerange(0, 1000)": "",
    "import os; [os.write(n, b'x' * 5000) for n in range(3, 12) if n < 64]": "",
    "import subprocess; subprocess.Popen(['sleep', '{seconds}'], start_new_session=True)": "",
    "import os\n    if os.fork() == 0:\n        os.setsid()\n        os.execvp('sleep', ['sleep', '{seconds}'])": "",
    "import socket; socket.create_connection(('127.0.0.1', 9), 1)": "raises",
    "x = bytearray(5 << 30)": "raises MemoryError",
    "import sys; sys.stdout.write('x' * 10**6); print('y')": "",
    "import sys; sys.modules['numpy'] = None; sys.exit(3)": "raises SystemExit",
    "raise KeyboardInterrupt": "",
    "raise type('E', (BaseException,), {{'__str__': lambda self: 1/0}})()": "",
    "return [[float('nan')] * 3] * 3": "returns NaN",
    "return [[1e400] * 3] * 3": "returns NaN or infinity",
    "return [[object()] * 3] * 3": "returns",
    "return [[1j] * 3] * 3": "returns complex numbers",
    "return [[[[1.0]]]]": "returns 1x1x1x1 numbers",
    "def more(n): return more(n + 1)\n    more(0)": "raises RecursionError",
    "return (row for row in [[1, 2, 3]] * 3)": "",
}
SECONDS = "987654"


def left_behind() -> list[str]:
    done = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True)
    return [line for line in done.stdout.splitlines() if SECONDS in line and "sleep" in line.split()[0]]


@pytest.mark.parametrize("body", BODIES)
def test_nothing_stays_behind(body: str, tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.setattr("arm3r_cpp.verify.program.python_process.ANSWER_TIME", 3.0)
    victim = tmp_path / "victim"
    victim.write_text("here")
    names = {"path": str(tmp_path / "new"), "victim": str(victim), "folder": str(tmp_path), "seconds": SECONDS}
    path = tmp_path / "jacobian.py"
    path.write_text(f"def jacobian(q):\n    {body.format(**names)}\n")
    before = dict(os.environ)
    verdict = verify.jacobian(path)
    assert not verdict.ok and verdict.findings[0].cause
    assert BODIES[body] in verdict.findings[0].cause
    assert len(verdict.findings[0].cause) < 400 and "\n" not in verdict.findings[0].cause
    del verdict
    assert victim.read_text() == "here" and sorted(one.name for one in tmp_path.iterdir()) == ["jacobian.py", "victim"]
    assert dict(os.environ) == before and left_behind() == []


def test_a_package_can_be_forbidden(tmp_path: Path, monkeypatch: Any) -> None:
    path = tmp_path / "jacobian.py"
    path.write_text("import arm3r_cpp\n\ndef jacobian(q):\n    return arm3r_cpp.Scenario().arm.jacobian(q)\n")
    assert verify.jacobian(path).ok
    monkeypatch.setattr(PythonProcess, "forbid_own_package", True)
    assert "raises ModuleNotFoundError" in verify.jacobian(path).findings[0].cause


def test_a_symbol_of_a_library(tmp_path: Path) -> None:
    source, library = tmp_path / "arm.c", tmp_path / "arm.so"
    text = """#include <math.h>
    void gravity(const double *q, double *out) {
        double g = 9.80665, c2 = cos(q[1]), c23 = cos(q[1] + q[2]);
        out[0] = EXTRA; out[2] = -0.785*g*0.5*c23; out[1] = -0.785*g*1.5*c2 + out[2];
    }
    """
    for extra, is_right in (("0", True), ("q[0]", False)):
        source.write_text(text.replace("EXTRA", extra))
        subprocess.run(["gcc", "-shared", "-fPIC", "-o", library, source, "-lm"], check=True)
        verdict = verify.gravity(f"{library}:gravity")
        assert verdict.ok == is_right, str(verdict)
        library.unlink()
    assert (verdict.findings[0].reads, verdict.findings[0].due) == ("q1", "0")
    with pytest.raises(arm3r.UsageError, match="name the function"):
        verify.gravity(tmp_path / "arm.so")
