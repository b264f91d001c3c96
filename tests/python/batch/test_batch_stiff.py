"""Batches by the method for stiff equations, and by the automatic choice, which differs from run to run."""

from __future__ import annotations

import arm3r_cpp as arm3r
import numpy as np
import pytest
from test_batch_rows import check_every_run, same_tables

DAMPING = [0.0, 3.0, 47055.0, 100.0, 5e3, 1e5, 40.0, 2e4, 0.5, 8e4, 1e3]  # N s/m


@pytest.mark.parametrize("method", ["rodas4", "auto"])
def test_runs_side_by_side_have_the_bits_of_the_runs_alone(method: str) -> None:
    scenario = arm3r.Scenario.example("contact/stiff_damping")
    scenario.update({"checks": [], "solver.method": method, "time": {"stop": 0.05, "log_every": 1e-3}})
    batch = scenario.batch({"wall.contact.damping": DAMPING}, columns=["q2", "force"])
    assert batch.ok.all()
    check_every_run(batch)
    stiff = batch["steps.stiff"]
    if method == "auto":
        assert 0 < np.count_nonzero(stiff) < len(DAMPING), stiff
    else:
        assert (stiff == batch["steps.accepted"]).all()
    for index, alone in ((index, batch.run(index)) for index in range(len(DAMPING))):
        metrics = alone.summary["metrics"]
        assert [batch[name][index] for name in ("steps.stiff", "energy_dissipated", "impulse", "ledger_residual")] == [
            metrics[name] for name in ("steps.stiff", "energy_dissipated", "impulse", "ledger_residual")
        ]
    assert same_tables(batch, scenario.batch({"wall.contact.damping": DAMPING}, columns=["q2", "force"], threads=3))
