"""Attacks on the process that holds the library: its end, signals, floating-point environment and callbacks."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

LONG = "format: 1\ntime: {stop: 1e5, log_every: 1}\nsolver: {method: rk4, step: 1e-4, max_steps: 1000000000}\n"
START = f"""
import os, signal, sys, threading, time
import arm3r_cpp as a
s = a.Scenario({LONG!r})
law = lambda t, state: [0.0, 0.0, 0.0]
def forever(work):
    while True:
        work()
def batch():
    s.batch({{"initial.q[1]": [0.1] * 200}}, threads=2)
def simulation():
    run = a.Simulation(a.Scenario("format: 1\\ntime: {{stop: 1e4, log_every: 1}}\\n"))
    while True:
        run.step([0.0, 0.0, 0.0])
def sweep():
    scenario = {{"time": {{"stop": 1e3, "log_every": 10}}, "solver": {{"method": "rk4", "step": 1e-3}}}}
    plan = {{"format": 1, "scenario": scenario,
            "axes": [{{"key": "initial.q[1]", "linspace": [0.1, 0.2, 1000]}}], "shard": 10}}
    a.sweep(plan, out=sys.argv[1], jobs=2)
def start(*works, daemon=True):
    for work in works:
        threading.Thread(target=work, daemon=daemon).start()
    time.sleep(0.3)
"""
ENDS = {
    "run": "start(s.run)",
    "many": "start(*[s.run] * 8)",
    "law": "start(lambda: s.run(controller=law))",
    "sleeping_law": "start(lambda: s.run(controller=lambda t, state: time.sleep(100)))",
    "batch": "start(batch)",
    "simulation": "start(simulation)",
    "sweep": "start(sweep)",
    "one_after_the_other": "start(lambda: forever(lambda: s.run(time_limit=0.01)))",
    "exit": "start(s.run); sys.exit(0)",
    "progress": "start(lambda: s.run(progress=lambda *_: False))",
    "fork": "start(s.run); child = os.fork(); child and os._exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))",
}


def end_of(code: str, *arguments: object, seconds: float = 60.0) -> subprocess.CompletedProcess[str]:
    call = [sys.executable, "-c", START + code, *map(str, arguments)]
    begun = time.monotonic()
    done = subprocess.run(call, capture_output=True, text=True, timeout=600)
    assert time.monotonic() - begun < seconds, done
    return done


@pytest.mark.sample(4)
@pytest.mark.parametrize("code", ENDS.values(), ids=ENDS)
def test_the_interpreter_ends_while_a_daemon_thread_runs(code: str, tmp_path: Path) -> None:
    done = end_of(code, tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert "FATAL" not in done.stderr and "terminate called" not in done.stderr


def test_what_is_no_daemon_runs_to_its_end() -> None:
    code = "start(lambda: print(len(a.Scenario('format: 1\\ntime: {stop: 300}').run()), flush=True), daemon=False)"
    assert end_of(code).stdout == "30001\n"


@pytest.mark.parametrize("work", ["s.run", "batch", "lambda: s.run(controller=law)"])
def test_ctrl_c_in_the_main_thread_while_a_daemon_thread_runs(work: str) -> None:
    done = end_of(f"start({work}); os.kill(os.getpid(), signal.SIGINT); time.sleep(10)")
    assert done.returncode == -signal.SIGINT and "KeyboardInterrupt" in done.stderr, done
    assert "FATAL" not in done.stderr and "terminate called" not in done.stderr


def test_a_sub_interpreter_is_refused_at_import() -> None:
    code = (
        "try:\n    import _xxsubinterpreters as interpreters\n"
        "except ImportError:\n    import _interpreters as interpreters\n"
        "interpreters.run_string(interpreters.create(), 'import arm3r_cpp; arm3r_cpp.Scenario')\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=600)
    assert done.returncode >= 0 and "main interpreter" in done.stderr, done


# ---- F9, D14: the floating-point environment of the host ------------------------------------------------------------

ENVIRONMENT = """
import ctypes, ctypes.util, sys
import numpy as np
import arm3r_cpp as a
libm = ctypes.CDLL(ctypes.util.find_library("m"))
TRAPS = 0x1D  # invalid, division by zero, overflow, underflow
text = '''
format: 1
wall: {point: [1.75, 0, 0], motion: {type: constant, velocity: 0.1}, acts_on_arm: true}
controller: {type: hybrid}
sampling: {rate: 1000}
time: {stop: 0.3}
'''
stiffness, q = np.geomspace(1e2, 1e4, 200), np.array([[0.3, -0.7, 1.1]])
def results():
    s = a.Scenario(text)
    batch = s.batch({"wall.contact.stiffness": stiffness}, threads=2)
    M = s.arm.mass_matrix(q)
    return s.run().summary["hash"], batch["peak_force"].tobytes(), M.tobytes(), s["arm.link2.mass"]
expected = results()
kind = sys.argv[1]
if kind == "rounding":
    for mode in (0x400, 0x800, 0xC00):
        libm.fesetround(mode)
        found = results()
        assert libm.fegetround() == mode
        libm.fesetround(0)
        assert found == expected, hex(mode)
else:
    libm.feenableexcept(TRAPS)
    s = a.Scenario(text)
    assert s.run().summary["hash"] == expected[0]
    assert libm.fegetexcept() == TRAPS
    law = lambda t, state: (libm.fedisableexcept(TRAPS), libm.fesetround(0x400), [0.1, 0.2, 0.3])[-1]
    quiet = a.Scenario(text).run(controller=lambda t, state: [0.1, 0.2, 0.3]).summary["hash"]
    assert s.run(controller=law).summary["hash"] == quiet
print("same")
"""


@pytest.mark.parametrize("kind", ["rounding", "traps"])
def test_the_hosts_rounding_and_traps_change_nothing_and_stay(kind: str) -> None:
    done = subprocess.run([sys.executable, "-c", ENVIRONMENT, kind], capture_output=True, text=True, timeout=600)
    assert (done.returncode, done.stdout) == (0, "same\n"), done.stderr


# ---- F7: the command arm3r ------------------------------------------------------------------------------------------


@pytest.fixture
def long_scenario(tmp_path: Path) -> Path:
    path = tmp_path / "long.yaml"
    path.write_text(LONG)
    return path


def test_the_command_is_a_program_not_a_script(scripts: Path, executable: Path) -> None:
    assert (scripts / "arm3r").read_bytes().startswith(b"\x7fELF")

    def cpu_seconds(program: Path) -> float:
        process = subprocess.Popen([program, "--version"], stdout=subprocess.DEVNULL)
        used = os.wait4(process.pid, 0)[2]
        return used.ru_utime + used.ru_stime

    took, alone = (min(cpu_seconds(program) for _ in range(20)) for program in (scripts / "arm3r", executable))
    assert took < alone + 0.01  # an interpreter takes more


def test_an_early_ctrl_c_ends_the_command_by_the_signal(scripts: Path, long_scenario: Path) -> None:
    for k in range(20):
        process = subprocess.Popen([scripts / "arm3r", "run", long_scenario], stderr=subprocess.PIPE)
        try:
            time.sleep(0.002 * k)
            process.send_signal(signal.SIGINT)
            errors = process.communicate(timeout=600)[1]
        finally:
            process.kill()  # where it does not end
        assert process.returncode == -signal.SIGINT and b"Traceback" not in errors, (k, errors)


@pytest.mark.parametrize("command", ["sweep", "plot", "animate"])
def test_ctrl_c_while_a_command_loads_its_modules_ends_it_by_the_signal(command: str) -> None:
    code = (
        "import builtins, os, signal, time\n"
        "from arm3r_cpp.commands import entry_points\n"
        "load = builtins.__import__\n"
        "def late(name, *rest):\n"
        "    if name == 'argparse': os.kill(os.getpid(), signal.SIGINT); time.sleep(5)\n"
        "    return load(name, *rest)\n"
        "builtins.__import__ = late\n"
        f"entry_points._call({command!r})\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=600)
    assert (done.returncode, done.stderr) == (-signal.SIGINT, "")


def test_the_command_is_found_through_links_and_says_what_is_missing(scripts: Path, tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(scripts / "arm3r")
    assert subprocess.run([tmp_path / "link", "--version"], capture_output=True).returncode == 0
    alone = tmp_path / "bin" / "arm3r"
    alone.parent.mkdir()
    alone.write_bytes((scripts / "arm3r").read_bytes())
    alone.chmod(0o755)
    done = subprocess.run([alone, "--version"], capture_output=True, text=True)
    assert done.returncode == 2 and "no package arm3r_cpp is installed" in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_the_command_finds_the_programs_beside_it(scripts: Path, tmp_path: Path) -> None:
    done = subprocess.run(["arm3r", "plot", "--help"], capture_output=True, text=True,
                          env={**os.environ, "PATH": str(scripts)})  # fmt: skip
    assert done.returncode == 0 and "usage: arm3r-plot" in done.stdout


def test_a_controller_from_a_file_without_the_package(cli: Any, root: Path) -> None:
    done = cli("run", "s.yaml", "--controller", "x.m", env={"PATH": "/nonexistent"})
    named = re.search(r"install the package: (`pip install \S+`)", done.stderr)
    assert done.returncode == 2 and "no program arm3r-run" in done.stderr
    assert named and named[1] in (root / "README.md").read_text()


# ---- F10: small stacks, functions that are called back --------------------------------------------------------------


def test_a_stack_of_64_kib_is_enough(executable: Path, moving_wall: Path) -> None:
    call = ["bash", "-c", f"ulimit -s 64; exec {executable} check {moving_wall}"]
    done = subprocess.run(call, capture_output=True, text=True)
    assert done.returncode == 0, done


def native_law(tmp_path: Path, source: str, *flags: str) -> Any:
    """The function `law` of a small C++ library."""
    import ctypes

    (tmp_path / "law.cpp").write_text(source)
    call = ["g++", "-shared", "-fPIC", *flags, "law.cpp", "-o", "law.so"]
    subprocess.run(call, check=True, cwd=tmp_path)
    return ctypes.CDLL(str(tmp_path / "law.so"))


THROWS = """
#include <stdexcept>
#include <pthread.h>
struct arm3r_law_state;
extern "C" int law(void *user, const arm3r_law_state *, double *) {
    if (user == nullptr) throw std::runtime_error("no user");
    if (user == (void *)1) throw 5;
    pthread_exit(nullptr);
}
extern "C" int progress(void *, double, double, long) { throw std::runtime_error("enough"); }
"""
CALLS_BACK = """
import ctypes, sys, threading, time
import arm3r_cpp as a
library = ctypes.CDLL(sys.argv[1])
address = ctypes.cast(library.law, ctypes.c_void_p).value
s = a.Scenario("format: 1\\ntime: {stop: 1}\\n")
for user, says in ((0, "threw an exception: no user"), (1, "threw an unknown exception")):
    try:
        s.run(controller=a.NativeLaw(address, user))
    except a.ControllerError as error:
        assert says in str(error), error
    else:
        raise AssertionError
from arm3r_cpp._native import ffi, lib
options, run = ffi.new("arm3r_batch_options *"), ffi.new("arm3r_run **")
p = s.params
progress = ffi.cast("arm3r_batch_progress", ctypes.cast(library.progress, ctypes.c_void_p).value)
options.struct_size, options.progress = ffi.sizeof("arm3r_batch_options"), progress
import numpy as np
values, results = np.full(20000, 0.3), np.empty((lib.arm3r_summary_count(), 20000))
at = ffi.new("size_t[]", [a.param_index("initial.q[1]")])
double = lambda array: ffi.from_buffer("double[]", array)
status = lib.arm3r_batch_run(double(p), p.size, at, 1, double(values), 20000, options, double(results))
assert status == lib.ARM3R_E_CALLBACK, status
threading.Thread(target=lambda: s.run(controller=a.NativeLaw(address, 2)), daemon=True).start()
time.sleep(0.3)
print("alive")
sys.stdout.flush()
import os
os._exit(0)  # the thread that ended itself left the interpreter's lock and state behind
"""


def test_a_function_called_back_may_throw_and_may_end_its_thread(tmp_path: Path) -> None:
    native_law(tmp_path, THROWS)
    call = [sys.executable, "-c", CALLS_BACK, str(tmp_path / "law.so")]
    done = subprocess.run(call, capture_output=True, text=True, timeout=600)
    assert (done.returncode, done.stdout) == (0, "alive\n"), done.stderr
