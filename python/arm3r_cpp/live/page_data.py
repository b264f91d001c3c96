"""What the page is given: a scenario to simulate, or a run to show as it is."""

from __future__ import annotations

import gzip
import json
import math
from base64 import b64encode
from typing import Any

import numpy as np

from .. import _native
from .._native import Floats
from ..core.run import Run
from ..core.scenario import Scenario
from ..errors import UsageError
from .plain_text import plain_text


def of_text(text: str, name: str) -> dict[str, Any]:
    """A scenario, valid or not: the page says what is wrong. name: of its file, without the suffix."""
    return {"name": name, "scenario": text}


def of_run(run: Run) -> dict[str, Any]:
    """All rows and columns, to the last bit, with the scenario they came from.

    Raises:
        UsageError: the run's summary holds no scenario, or its log has not all columns.
    """
    text = run.summary.get("scenario")
    if not text:
        why = "the run's summary holds no scenario, so that its arm is not known; run it again"
        raise UsageError(why, code="usage")
    scenario = Scenario(text)
    if scenario["time.log_columns"]:
        raise UsageError("the page draws all columns: run it without time.log_columns", code="usage")
    arm, q = scenario.arm, run["q"]
    axes = arm.geometric_jacobian(q)[:, 3:].swapaxes(1, 2)
    data = {
        **of_text(plain_text(text), run.summary["name"]),
        "resolved": _resolved(scenario),
        "columns": run.columns,
        "units": run.units,
        "matrix": _packed(np.stack([run[name] for name in run.columns])),
        "arm": {"points": _packed(arm.points(q)), "axes": _packed(axes), "reach": arm.reach},
        "summary": {key: value for key, value in run.summary.items() if key != "scenario"},
        "report": run.report() if run.has_report else "",
    }
    plain: dict[str, Any] = _plain(data)
    return plain


def _packed(numbers: Floats) -> str:
    return b64encode(gzip.compress(numbers.astype("<f8").tobytes(), 6, mtime=0)).decode()


def _resolved(scenario: Scenario) -> dict[str, Any]:
    """Every section with its defaults."""
    schema = json.loads(_native.ffi.string(_native.lib.arm3r_schema_json()))
    return {section: scenario[section] for section in schema["properties"]}


def _plain(value: Any) -> Any:
    """JSON has no infinity and no NaN: "inf", "-inf" and null, as in the summary's file."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else ("inf" if value > 0 else "-inf")
    return value
