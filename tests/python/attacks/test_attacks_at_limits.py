"""Attacks of every kind that have no file of their own: contact at its limits, tiny numbers, copies of the library,
files that change while they are read, clocks, builds."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp._native import ffi, lib

HEAD = "format: 1\n"
ADAPTIVE = ["dopri5", "taylor", "rodas4", "auto"]


# ---- contact at its limits ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", ADAPTIVE)
@pytest.mark.parametrize(("gap", "events"), [(-1e-9, 4), (-1e-11, 4), (1e-11, 0), (1e-9, 0)])
def test_a_wall_that_grazes_the_tip_touches_it_or_does_not(method: str, gap: float, events: int) -> None:
    """The wall turns back where it has come `gap` (m) to the tip of an arm at rest; two turns in the run."""
    tip = np.sqrt(3)  # of the lecture's pose
    wall = f"point: [{float(tip) + 0.02 + gap!r}, 0, 0], motion: {{type: sinusoid, amplitude: 0.02, frequency: 0.5}}"
    rest = f"controller: {{type: gravity_compensation}}\nsolver: {{method: {method}}}\ntime: {{stop: 4}}\n"
    run = arm3r.Scenario(HEAD + rest + f"wall: {{{wall}}}\n").run()
    assert [event.type for event in run.events] == ["make", "break"] * (events // 2)


@pytest.mark.parametrize("restitution", [0.95, 0.5, 0.1])
@pytest.mark.parametrize("method", ["dopri5", "rodas4", "auto"])
def test_a_tip_that_bounces_ever_less_comes_to_rest_on_the_wall(method: str, restitution: float) -> None:
    contact = f"{{law: hunt_crossley, stiffness: 1e5, restitution: {restitution}, impact_speed: 0.1}}"
    text = f"""\
wall: {{point: [1.75, 0, 0], motion: {{type: fixed}}, acts_on_arm: true, contact: {contact}}}
controller: {{type: gravity_compensation}}
push: {{force: [20, 0, 0]}}
time: {{stop: 5}}
solver: {{method: {method}}}
"""
    run = arm3r.Scenario(HEAD + text).run(time_limit=20)
    assert run.outcome == "ok" and run["contact"][-1] == 1


# ---- times and tiny numbers -----------------------------------------------------------------------------------------


def test_steps_that_would_not_move_the_time_are_refused_before_the_run() -> None:
    text = "time: {stop: 1e9, log_every: 1e8}\nsolver: {method: rk4, step: 1e-9, max_steps: 1000000000}\n"
    with pytest.raises(arm3r.BudgetError, match="too many steps"):
        arm3r.Scenario(HEAD + text).run()


@pytest.mark.parametrize("start", [9e8, -9e8])
@pytest.mark.parametrize(
    ("method", "more", "path"),
    [
        ("dopri5", "", "time.log_every"),
        ("rk4, step: 1e-9", "", "solver.step"),
        ("taylor", "sampling: {rate: 1e6}\ncontroller: {type: joint_pd}", "sampling.rate"),
    ],
)
def test_a_start_so_late_that_periods_cannot_be_counted_is_refused(
    method: str, more: str, path: str, start: float
) -> None:
    every = 1e-8 if path == "time.log_every" else 0.01
    text = f"time: {{start: {start}, stop: {start + 0.5}, log_every: {every}}}\nsolver: {{method: {method}}}\n{more}\n"
    with pytest.raises(arm3r.ScenarioError, match="too late for so short a period") as raised:
        arm3r.Scenario(HEAD + text).validate()
    assert [problem["path"] for problem in raised.value.problems] == [path]


@pytest.mark.parametrize("method", ["rk4, step: 1e-3", "taylor"])
def test_rows_of_a_late_run_never_stand_still(method: str) -> None:
    text = f"time: {{start: 9e8, stop: {9e8 + 0.5}, log_every: 1e-5}}\nsolver: {{method: {method}}}\n"
    t = arm3r.Scenario(HEAD + text).run().t
    assert len(t) == 50_001 and np.all(np.diff(t) > 0)


@pytest.mark.parametrize("method", ["rk4, step: 1e-3", "dopri5", "taylor"])
def test_rates_that_fall_below_normal_numbers_take_no_longer_and_are_the_same_where_the_host_flushes_them(
    method: str, tmp_path: Path
) -> None:
    text = """\
arm: {gravity: [0, 0, 0], damping: [1, 1, 1]}
initial: {qd: [3e-308, 3e-308, 3e-308]}
"""
    code = (
        "import ctypes, sys, arm3r_cpp as a\n"
        "library = ctypes.CDLL(sys.argv[1])\n"
        "s = a.Scenario(sys.argv[2])\n"
        "expected = s.run(time_limit=5).summary['hash']\n"
        "library.flush()\n"
        "assert s.run().summary['hash'] == expected\n"
        "assert library.flushes()\n"
    )
    if not (compiler := shutil.which("gcc")) or os.uname().machine != "x86_64":
        pytest.skip("flush-to-zero is switched on for x86-64 by a small program in C")
    source = (
        "#include <xmmintrin.h>\nvoid flush(void) { _mm_setcsr(_mm_getcsr() | 0x8040); }\n"
        "int flushes(void) { return (_mm_getcsr() & 0x8040) == 0x8040; }\n"
    )
    library = tmp_path / "flush.so"
    subprocess.run([compiler, "-shared", "-fPIC", "-xc", "-", "-o", library], input=source, text=True, check=True)
    call = [sys.executable, "-c", code, library, HEAD + text + f"solver: {{method: {method}}}\n"]
    subprocess.run(call, check=True, timeout=600)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("controller: {type: hybrid, contact_on: 1, contact_off: 2}\nwall: {}", ["contact_off", "contact_on", "got 2"]),
        ("controller: {type: energy_tank, tank_low: 2, tank_high: 1}", ["tank_low", "tank_high", "got 2"]),
        ("controller: {type: energy_tank, tank_energy: 9, tank_capacity: 1}", ["tank_energy", "tank_capacity"]),
        ("checks: [{column: q1, of: max, above: 2, below: 1}]", ["above 2", "below 1"]),
    ],
)
def test_of_two_limits_in_the_wrong_order_both_are_named(text: str, words: list[str]) -> None:
    with pytest.raises(arm3r.ScenarioError) as raised:
        arm3r.Scenario(HEAD + text + "\n").validate()
    assert all(word in str(raised.value) for word in words)


# ---- the library ----------------------------------------------------------------------------------------------------


def test_two_copies_of_the_library_in_a_process_and_many_loads_of_it(package: Path, tmp_path: Path) -> None:
    for name in ("libarm3r.so", "libarm3r-yaml-cpp.so"):
        shutil.copy(package / "lib" / name, tmp_path / name)
    code = """
import _ctypes, ctypes, resource, sys
import arm3r_cpp as a
text = "format: 1\\ntime: {stop: 0.5}\\nwall: {point: [1.74, 0, 0]}\\n"
expected = a.Scenario(text).run().summary["hash"]
def run(library):
    scenario, run, summary = ctypes.c_void_p(), ctypes.c_void_p(), ctypes.c_char_p()
    data = text.encode()
    size = ctypes.c_size_t
    assert library.arm3r_scenario_create(data, size(len(data)), b"s", size(1), ctypes.byref(scenario)) == 0
    assert library.arm3r_scenario_run(scenario, None, ctypes.byref(run)) == 0
    assert library.arm3r_run_summary(run, ctypes.byref(summary)) == 0
    assert expected in summary.value.decode()
    library.arm3r_run_free(run)
    library.arm3r_scenario_free(scenario)
def memory():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
for k in range(300):
    library = ctypes.CDLL(sys.argv[1])
    run(library) if k % 10 == 0 else library.arm3r_abi_version()
    _ctypes.dlclose(library._handle)
    if k == 20: before = memory()
assert memory() < before + 20_000, (before, memory())
assert a.Scenario(text).run().summary["hash"] == expected
"""
    subprocess.run([sys.executable, "-c", code, tmp_path / "libarm3r.so"], check=True, timeout=600)


def test_a_message_outlives_what_it_is_about() -> None:
    scenario = ffi.new("arm3r_scenario **")
    text = b"format: 1\ntime: {stop: -1}\n"
    assert lib.arm3r_scenario_create(text, len(text), b"s", 1, scenario) == 0
    assert lib.arm3r_scenario_validate(scenario[0]) == lib.ARM3R_E_SCENARIO
    lib.arm3r_scenario_free(scenario[0])
    assert b"time.stop" in ffi.string(lib.arm3r_error_message())
    seen: list[bytes] = []
    thread = threading.Thread(target=lambda: seen.append(ffi.string(lib.arm3r_error_message())))
    thread.start()
    thread.join()
    assert seen == [b""]


# ---- files that change while they are used --------------------------------------------------------------------------

SWEEP = """\
format: 1
scenario: base.yaml
axes: [{key: "initial.q[1]", linspace: [0.1, 0.5, 40]}]
shard: 2
"""


def test_a_scenario_that_changes_while_its_sweep_runs_changes_nothing(tmp_path: Path) -> None:
    base, plan = tmp_path / "base.yaml", tmp_path / "sweep.yaml"
    base.write_text(HEAD + "time: {stop: 0.1}\n")
    plan.write_text(SWEEP)
    expected = arm3r.sweep(plan, out=tmp_path / "quiet").path.read_bytes()

    def change(done: int, runs: int) -> None:
        base.write_text(HEAD + f"time: {{stop: {0.2 + done / 100}}}\n")
        plan.write_text("nonsense")

    base.write_text(HEAD + "time: {stop: 0.1}\n")
    assert arm3r.sweep(plan, out=tmp_path / "changed", progress=change, jobs=1).path.read_bytes() == expected
    assert "stop: 0.1" in (tmp_path / "changed" / "sweep.json").read_text()


def test_who_reads_a_result_while_it_is_written_sees_the_whole_file(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    runs = [arm3r.Scenario(HEAD + f"time: {{stop: {stop}}}\n").run() for stop in (2, 4)]
    runs[0].to_csv(path)
    whole = {201, 401}
    is_over = threading.Event()

    def write() -> None:
        for k in range(40):
            runs[k % 2].to_csv(path)
        is_over.set()

    thread = threading.Thread(target=write)
    thread.start()
    while not is_over.is_set():
        text = path.read_text()
        assert text.endswith("\n") and text.count("\n") - 1 in whole
    thread.join()


def test_work_that_is_done_twice_is_stored_once(tmp_path: Path) -> None:
    from concurrent.futures import Executor, Future, ThreadPoolExecutor

    class Twice(Executor):
        """Computes every job twice, as a cluster does that takes a worker for dead."""

        def __init__(self) -> None:
            self.pool = ThreadPoolExecutor(2)

        def submit(self, work: Any, *arguments: Any) -> Future[Any]:  # type: ignore[override]
            first, second = self.pool.submit(work, *arguments), self.pool.submit(work, *arguments)
            assert first.result() == second.result()
            return second

    (tmp_path / "base.yaml").write_text(HEAD + "time: {stop: 0.1}\n")
    (tmp_path / "sweep.yaml").write_text(SWEEP)
    once = arm3r.sweep(tmp_path / "sweep.yaml", out=tmp_path / "once").path.read_bytes()
    twice = arm3r.sweep(tmp_path / "sweep.yaml", out=tmp_path / "twice", executor=Twice()).path.read_bytes()
    assert once == twice


@pytest.mark.parametrize("runs", [1, 3])
def test_a_table_of_one_run_is_a_table(runs: int, tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    plan = {"format": 1, "scenario": {"time": {"stop": 0}}, "axes": [{"key": "initial.q[1]", "values": [0.1] * runs}]}
    for parquet in (False, True):
        table = arm3r.sweep(plan, out=tmp_path / str(parquet), parquet=parquet)
        assert len(table) == runs and table.ok.all()


# ---- clocks and builds ----------------------------------------------------------------------------------------------


def test_no_duration_is_taken_from_a_clock_that_can_be_set(root: Path) -> None:
    sources = [*(root / "cpp" / "src").rglob("*.[ch]pp"), *(root / "python" / "arm3r_cpp").rglob("*.py")]
    assert len(sources) > 150
    for path in sources:
        assert not re.search(r"system_clock|\btime\.time\(|datetime\.now|gettimeofday\s*\(", path.read_text()), path


@pytest.mark.parametrize("flag", ["-Ofast", "-funsafe-math-optimizations", "-ffp-contract=fast"])
def test_flags_that_change_results_are_refused(root: Path, scripts: Path, tmp_path: Path, flag: str) -> None:
    environment = {**os.environ, "PATH": f"{scripts}{os.pathsep}{os.environ['PATH']}"}
    call = ["cmake", "-S", root, "-B", tmp_path, f"-DCMAKE_CXX_FLAGS={flag}"]
    done = subprocess.run(call, capture_output=True, text=True, env=environment)
    assert done.returncode != 0 and "would change results" in done.stderr


WITHOUT_AVX = """
#define _GNU_SOURCE
#include <cpuid.h>
#include <signal.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>
#define ARCH_CPUID 0x1012
int seen;
/* In place of a cpuid instruction: what the processor says, without xsave, AVX, FMA, AVX2 and AVX-512. */
static void answer(int number, siginfo_t *info, void *context) {
    greg_t *registers = ((ucontext_t *)context)->uc_mcontext.gregs;
    const unsigned char *at = (const unsigned char *)registers[REG_RIP];
    if (at[0] != 0x0f || at[1] != 0xa2) _exit(99);
    unsigned leaf = registers[REG_RAX], a, b, c, d;
    syscall(SYS_arch_prctl, ARCH_CPUID, 1);
    __cpuid_count(leaf, registers[REG_RCX], a, b, c, d);
    syscall(SYS_arch_prctl, ARCH_CPUID, 0);
    if (leaf == 1) c &= ~(1u << 12 | 1u << 26 | 1u << 27 | 1u << 28);
    if (leaf == 7) b &= ~(1u << 5 | 1u << 16 | 1u << 17 | 1u << 28 | 1u << 30 | 1u << 31);
    registers[REG_RAX] = a, registers[REG_RBX] = b, registers[REG_RCX] = c, registers[REG_RDX] = d;
    registers[REG_RIP] += 2;
    seen = 1;
}
int hide(void) {
    struct sigaction action = {.sa_sigaction = answer, .sa_flags = SA_SIGINFO};
    sigaction(SIGSEGV, &action, 0);
    return syscall(SYS_arch_prctl, ARCH_CPUID, 0);
}
"""


def test_a_processor_without_avx_gives_the_same_bits(python: Any, tmp_path: Path) -> None:
    """Every method, and batches and the arm's functions, whose widest variant the library chooses for the processor."""
    if not (compiler := shutil.which("gcc")) or os.uname().machine != "x86_64":
        pytest.skip("cpuid is a matter of x86-64, and hidden by a small program in C")
    library = tmp_path / "old.so"
    subprocess.run([compiler, "-shared", "-fPIC", "-xc", "-", "-o", library], input=WITHOUT_AVX, text=True, check=True)
    work = """
import arm3r_cpp as a, numpy as np
for method in ("dopri5", "rk4", "taylor", "rodas4"):
    s = a.Scenario("{format: 1, arm: {link3: {length: 0.7}}, wall: {point: [1.6, 0.1, 0], acts_on_arm: true}, "
                   "time: {stop: 0.5}, solver: {method: %s}}" % method)
    print(s.run().summary["hash"])
    batch = s.batch({"initial.q[1]": np.linspace(-0.8, -0.6, 19)})
    print([batch[name].tobytes().hex() for name in batch])
q = np.random.default_rng(3).uniform(-2, 2, (2, 21, 3))
print(s.arm.mass_matrix(q[0]).tobytes().hex(), s.arm.forward_dynamics(*q, 0 * q[0]).tobytes().hex())
"""
    hide = f"import ctypes\nold = ctypes.CDLL({str(library)!r})\nif old.hide(): raise SystemExit(42)\n"
    end = "assert ctypes.c_int.in_dll(old, 'seen').value\n"
    usual, hidden = python(work), python(hide + work + end)
    if hidden.returncode == 42:
        pytest.skip("this processor, or its kernel, does not let cpuid be hidden")
    assert usual.returncode == hidden.returncode == 0, usual.stderr + hidden.stderr
    assert usual.stdout == hidden.stdout


@pytest.mark.parametrize("offset", [0, 1, 8, 24])
def test_arrays_of_a_host_need_no_alignment(offset: int) -> None:
    """The C interface knows no type of Eigen, whose alignment depends on flags: doubles may lie anywhere."""
    q = np.random.default_rng(4).uniform(-1, 1, (37, 3))
    room = np.zeros(q.nbytes + 64 + offset, np.uint8)
    begin = -room.ctypes.data % 64 + offset
    moved = room[begin : begin + q.nbytes].view(float).reshape(q.shape)
    moved[:] = q
    assert moved.ctypes.data % 64 == offset
    scenario = arm3r.Scenario(HEAD + "arm: {link3: {length: 0.7}}\ntime: {stop: 0.1}\n")
    assert scenario.arm.mass_matrix(moved).tobytes() == scenario.arm.mass_matrix(q).tobytes()
    here, there = (scenario.batch({"initial.q": values}) for values in (q, moved))
    assert all(here[name].tobytes() == there[name].tobytes() for name in here)


def test_the_library_needs_nothing_but_the_run_time_of_c_and_cpp(package: Path) -> None:
    for part in ("lib/libarm3r.so", "bin/arm3r", "_arm3r.abi3.so"):
        text = subprocess.run(["readelf", "-d", package / part], check=True, capture_output=True, text=True).stdout
        needed = set(re.findall(r"\(NEEDED\).*\[(.*)\]", text))
        allowed = r"lib(arm3r.*|stdc\+\+|m|gcc_s|c|pthread)\.so.*|ld-linux.*"
        assert all(re.fullmatch(allowed, name) for name in needed), needed


@pytest.mark.gate
def test_without_a_compiler_nothing_is_half_installed(root: Path, tmp_path: Path) -> None:
    environment = {**os.environ, "CC": "/bin/false", "CXX": "/bin/false", "SKBUILD_BUILD_DIR": str(tmp_path / "build")}
    target = tmp_path / "target"
    call = [sys.executable, "-m", "pip", "install", "--no-build-isolation", "--no-deps", "--target", target, root]
    done = subprocess.run(list(map(str, call)), capture_output=True, text=True, env=environment)
    assert done.returncode != 0 and "/bin/false" in done.stdout + done.stderr
    assert not target.exists() or not list(target.iterdir())
