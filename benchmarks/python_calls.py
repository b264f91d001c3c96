"""Calls from Python: forward dynamics of many states, and what importing costs. CSV out.

python benchmarks/python_calls.py
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable
from importlib.metadata import version

import arm3r_cpp as arm3r
import numpy as np
from peer_arms import mujoco_model, pinocchio_model
from table import Table, installed

STATES, PEER_STATES, ROUNDS, IMPORTS = 1_000_000, 10_000, 15, 15
IMPORT = "import time, numpy; begun = time.perf_counter(); import {}; print(time.perf_counter() - begun)"

Job = Callable[[], object]


def nanoseconds(job: Job, states: int) -> float:
    begun = time.perf_counter_ns()
    job()
    return (time.perf_counter_ns() - begun) / states


def pinocchio_job(q: np.ndarray, qd: np.ndarray, tau: np.ndarray) -> Job:
    import pinocchio

    model = pinocchio_model()
    data = model.createData()
    return lambda: [pinocchio.aba(model, data, *state) for state in zip(q, qd, tau, strict=True)]


def mujoco_job(q: np.ndarray, qd: np.ndarray, tau: np.ndarray) -> Job:
    import mujoco

    model = mujoco_model()
    data = mujoco.MjData(model)

    def acceleration(q: np.ndarray, qd: np.ndarray, tau: np.ndarray) -> np.ndarray:
        data.qpos[:], data.qvel[:], data.qfrc_applied[:] = q, qd, tau
        mujoco.mj_forward(model, data)
        return data.qacc

    return lambda: [acceleration(*state).copy() for state in zip(q, qd, tau, strict=True)]


def time_calls(table: Table) -> None:
    random = np.random.default_rng(1)
    q, qd, tau = (
        random.uniform(-3, 3, (STATES, 3)),
        random.uniform(-1, 1, (STATES, 3)),
        random.uniform(-1, 1, (STATES, 3)),
    )
    few = q[:PEER_STATES], qd[:PEER_STATES], tau[:PEER_STATES]
    arm = arm3r.Scenario("format: 1").arm
    peers = {"pin": ("pinocchio", pinocchio_job, "aba"), "mujoco": ("mujoco", mujoco_job, "mj_forward")}
    racers = {"arm3r_cpp": ("one call", lambda: arm.forward_dynamics(q, qd, tau), STATES)}
    for who, (package, job, function) in peers.items():
        if installed(package):
            racers[who] = f"{function} in a loop", job(*few), PEER_STATES
    expected = arm.forward_dynamics(*few)
    for _, job, _ in racers.values():
        np.testing.assert_allclose(np.asarray(job())[:PEER_STATES], expected, rtol=1e-9, atol=1e-9)

    samples: dict[str, list[float]] = {who: [] for who in ("arm3r_cpp", *peers)}
    for _ in range(ROUNDS):
        for who, (_, job, states) in racers.items():
            samples[who].append(nanoseconds(job, states))
    for who, figures in samples.items():
        build = f"{version(who)}, {racers[who][0]}" if figures else "not installed"
        table.row(f"forward dynamics of {STATES} states from Python", who, build, "ns", figures)


def time_imports(table: Table) -> None:
    # The first use loads what `import arm3r_cpp` puts off: that is counted.
    for who, module in {"arm3r_cpp": "arm3r_cpp._api", "pin": "pinocchio", "mujoco": "mujoco"}.items():
        if not installed(module.partition(".")[0]):
            table.row("import, over numpy's", who, "not installed", "ms", [])
            continue
        command = [sys.executable, "-c", IMPORT.format(module)]
        seconds = [
            float(subprocess.run(command, check=True, capture_output=True, text=True).stdout) for _ in range(IMPORTS)
        ]
        table.row("import, over numpy's", who, version(who), "ms", [1e3 * s for s in seconds])


table = Table()
time_calls(table)
time_imports(table)
