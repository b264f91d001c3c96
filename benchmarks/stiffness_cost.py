"""What the stiffness of a wall costs by counts: steps and evaluations of a run, beside its time. CSV out.

python benchmarks/stiffness_cost.py

Two jobs of ten seconds each. The lecture run: the wall pushes the compensated arm once, which then flies ahead of it.
And the same on an arm with damped joints, which the wall keeps pushing: it vibrates in contact for half of the time.
Counts are those of the method itself, the same on every machine; they stand as medians over the runs.
"""

from __future__ import annotations

import time

import numpy as np
from ours import BUILD, PUSHED, SOLVERS, Batch, from_poses, known, poses
from table import Table

SETTINGS = {"taylor": (1e-8, 64), "dopri5": (1e-9, 4)}  # and the number of runs
STIFFNESSES = 10.0 ** np.arange(2, 9)  # N/m
JOBS = {"lecture run": PUSHED, "kept in contact": f"{PUSHED}arm: {{damping: [4, 4, 4]}}\n"}
COUNTS = {"steps": "steps.accepted", "evaluations": "steps.evaluations", "contacts": "contacts"}


def microseconds(batch: Batch) -> float:
    begun = time.process_time_ns()
    batch.run()
    return (time.process_time_ns() - begun) / batch.runs / 1000


table = Table()
for job, text in JOBS.items():
    for method, (setting, runs) in SETTINGS.items():
        for k in STIFFNESSES if known(method) else ():
            varied = from_poses(poses(runs)) | {"wall.contact.stiffness": np.full(runs, k)}
            batch = Batch(text, varied, solver={**SOLVERS[method](setting), "max_steps": 1_000_000})
            samples = [microseconds(batch) for _ in range(3)]
            for what, column in COUNTS.items():
                count = list(batch[column])
                table.row(f"{job}: {what}", f"arm3r {method}, {what}", BUILD, "1", count, setting=f"K={k:g}")
            table.row(f"{job}: processor time", f"arm3r {method}", BUILD, "us", samples, setting=f"K={k:g}")
