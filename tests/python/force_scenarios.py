"""The scenarios of force control, to be varied."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r

FOLDER = Path(__file__).parents[2] / "scenarios" / "force_control"


def read(name: str, changes: Mapping[str, Any] | None = None) -> arm3r.Scenario:
    """The scenario of that name with values changed in their order, without its checks."""
    return changed(arm3r.Scenario.load(FOLDER / f"{name}.yaml"), {"checks": [], **(changes or {})})


def changed(scenario: arm3r.Scenario, changes: Mapping[str, Any]) -> arm3r.Scenario:
    for key, value in changes.items():
        scenario[key] = value
    return scenario
