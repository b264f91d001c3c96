"""The scenarios of contact and control, to be varied."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
from conftest import scenario_files

OTHERS = ("scenarios", "lecture", "robots")
FILES = {path.stem: path for path in scenario_files() if path.parent.name not in OTHERS}
"""The file of each scenario of contact and control, by its name."""
D = np.array([1, -1, -1])


def read(name: str, changes: Mapping[str, Any] | None = None) -> arm3r.Scenario:
    """The scenario of that name without its checks, in the convention `slide`, in which the oracles count angles; then
    its values are changed in their order."""
    return changed(mirrored(changed(arm3r.Scenario.load(FILES[name]), {"checks": []})), changes or {})


def mirrored(scenario: arm3r.Scenario) -> arm3r.Scenario:
    """The same motion in the other convention (1.1)."""
    here = scenario["arm.convention"]
    joints = ("initial.q", "initial.qd", "reference.q", "reference.q_amplitude", "controller.torque")
    values = {key: D * scenario[key] for key in joints if key in scenario}
    other = {"simscape": "slide", "slide": "simscape"}[here]
    return changed(scenario.copy(), {"arm.convention": other, **values})


def changed(scenario: arm3r.Scenario, changes: Mapping[str, Any]) -> arm3r.Scenario:
    for key, value in changes.items():
        scenario[key] = value
    return scenario
