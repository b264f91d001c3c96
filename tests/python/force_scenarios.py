"""The scenarios of force control, to be varied."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import arm3r_cpp as arm3r
from conftest import scenario_files

FILES = {path.stem: path for path in scenario_files() if path.parent.name not in ("scenarios", "lecture")}
"""The file of each scenario of contact and control, by its name."""


def read(name: str, changes: Mapping[str, Any] | None = None) -> arm3r.Scenario:
    """The scenario of that name with values changed in their order, without its checks."""
    return changed(arm3r.Scenario.load(FILES[name]), {"checks": [], **(changes or {})})


def changed(scenario: arm3r.Scenario, changes: Mapping[str, Any]) -> arm3r.Scenario:
    for key, value in changes.items():
        scenario[key] = value
    return scenario
