"""What a control law of your own costs a tick: called from the library, in machine code, and stepped by hand. CSV out.

python benchmarks/user_law.py

The law is gravity compensation, but where a constant is named; at 1 kHz, on a damped arm. Subtracted is the same
round's run with the built-in gravity compensation; the last row is what calling the law costs Python anyway.
"""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
import time
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

import arm3r_cpp as arm3r
import numpy as np
from peer_arms import mujoco_model
from table import Table, installed

TICKS, ROUNDS = 20_000, 7
SCENARIO = f"""
format: 1
initial: {{q: [0.3, -0.4, 0.9], qd: [0.1, 0.2, -0.3]}}
arm: {{damping: [4, 4, 4]}}
controller: {{type: gravity_compensation}}
sampling: {{rate: 1000}}
time: {{stop: {TICKS / 1000}, log_every: {TICKS / 1000}}}
"""
C_LAW = """
#include "arm3r/arm3r.h"
int32_t law(void *user, const arm3r_law_state *state, double *tau) {
    (void)user;
    for (int i = 0; i < 3; ++i) tau[i] = state->tau_g[i];
    return 0;
}
"""

Job = Callable[[], object]


def law(t: float, state: arm3r.LawState) -> np.ndarray:
    return state.tau_g


def constant(t: float, state: arm3r.LawState) -> tuple[float, float, float]:
    return 0.1, 0.2, 0.3


def native_law(folder: str) -> arm3r.NativeLaw:
    (Path(folder) / "law.c").write_text(C_LAW)
    include = Path(arm3r.__file__).parent / "include"
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", f"-I{include}", "law.c", "-o", "law.so"], cwd=folder, check=True)
    function = ctypes.CDLL(str(Path(folder) / "law.so")).law
    return arm3r.NativeLaw(ctypes.cast(function, ctypes.c_void_p).value or 0)


def stepped(scenario: arm3r.Scenario) -> None:
    simulation = arm3r.Simulation(scenario)
    while not simulation.is_over:
        simulation.step(law(simulation.t, simulation.state))


def mujoco_job() -> Job:
    import mujoco

    model = mujoco_model()
    data = mujoco.MjData(model)

    def run() -> None:
        mujoco.mj_resetData(model, data)
        data.qpos[:], data.qvel[:] = [0.3, -0.4, 0.9], [0.1, 0.2, -0.3]
        for _ in range(TICKS):
            mujoco.mj_step1(model, data)
            data.qfrc_applied[:] = data.qfrc_bias - 4 * data.qvel
            mujoco.mj_step2(model, data)

    return run


def microseconds(job: Job) -> float:
    begun = time.perf_counter_ns()
    job()
    return (time.perf_counter_ns() - begun) / TICKS / 1000


def main() -> None:
    scenario = arm3r.Scenario(SCENARIO)
    with tempfile.TemporaryDirectory() as folder:
        machine_code = native_law(folder)
        jobs: dict[str, Job] = {
            "built in": lambda: scenario.run(),
            "C function": lambda: scenario.run(controller=machine_code),
            "Python, constant": lambda: scenario.run(controller=constant),
            "Python, tau_g": lambda: scenario.run(controller=law),
            "Simulation.step, tau_g": lambda: stepped(scenario),
        }
        if installed("mujoco"):
            jobs["MuJoCo, mj_step1, mj_step2 in a loop"] = mujoco_job()
        samples: dict[str, list[float]] = {name: [] for name in jobs}
        for _ in range(ROUNDS):
            for name, job in jobs.items():
                samples[name].append(microseconds(job))
    own = [microseconds(lambda: [constant(0.0, None) for _ in range(TICKS)]) for _ in range(ROUNDS)]
    table = Table()
    for name, figures in samples.items():
        who = "mujoco" if name.startswith("MuJoCo") else "arm3r_cpp"
        table.row(f"a tick of 1 ms, {name}", who, version(who), "us", figures)
        if who == "arm3r_cpp" and name != "built in":
            above = [a - b for a, b in zip(figures, samples["built in"], strict=True)]
            table.row(f"the same above the built-in law, {name}", who, version(who), "us", above)
    table.row("calling the constant law from Python", "arm3r_cpp", version("arm3r_cpp"), "us", own)


if __name__ == "__main__":
    main()
