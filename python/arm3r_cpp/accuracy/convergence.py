"""The observed order of a method; docs/model.md (9.7)."""

from __future__ import annotations

import json
import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from .._messages import in_columns
from .._native import ffi, lib
from ..core.run import Run
from ..core.scenario import Scenario

LEVELS = 4
ORDERS = {"rk4": 4, "dopri5": 5, "rodas4": 4}
ROUNDING = 1e-13  # rad: an error below it tells nothing of the steps


class Level(NamedTuple):
    """One of the runs."""

    setting: float
    """Step, s, or tolerance of the method."""
    steps: int
    """That it took."""
    error: float
    """rad: the largest difference of a joint angle, over all rows, from the reference."""
    order: float | None
    """From the level before to this one; None: there is none before, or the errors are mere rounding."""


class Convergence(NamedTuple):
    """What `converge` returns. `print` shows it as a table."""

    name: str
    method: str
    key: str
    """Of the scenario: what the levels differ in."""
    reference: float
    """Its value in the run that the others are compared with."""
    levels: list[Level]
    order: float | None
    """The slope of all levels together; None: their errors are mere rounding."""

    def __str__(self) -> str:
        head = f"{self.name}: {self.method}, joint angles compared with a run with {self.key} = {self.reference:.3g}"
        rows = [[self.key, "steps", "error, rad", "order"], *map(_cells, self.levels)]
        return "\n".join([head, *(f"  {line}" for line in in_columns(rows, right=True)), self._verdict()])

    def _verdict(self) -> str:
        if self.order is None:
            same = len({level.steps for level in self.levels}) < len(self.levels)
            return "no order: " + ("runs take equally many steps" if same else "the errors are mere rounding")
        own = f"; that of the method is {ORDERS[self.method]}" if self.method in ORDERS else ""
        return f"observed order {self.order:.2f}{own}"


def _cells(level: Level) -> list[str]:
    order = "" if level.order is None else f"{level.order:.2f}"
    return [f"{level.setting:.3g}", f"{level.steps}", f"{level.error:.2e}", order]


def converge(scenario: Scenario) -> Convergence:
    """Run a scenario with smaller and smaller steps, and see how fast its error falls.

    >>> print(arm3r.converge(arm3r.Scenario.example("lecture/05_free_fall")))

    A fixed step is halved three times, a tolerance is divided by 16; one more run, more exact by far, is the reference.
    The order is the power of the number of steps with which the largest error of a joint angle falls. Where something
    jumps within a step, it is less than that of the method; that of `taylor` grows with the digits that are asked for.

    Raises:
        ScenarioError, NumericalError, BudgetError: as `Scenario.run`.
    """
    method = scenario["solver.method"]
    key = {"rk4": "solver.step", "taylor": "solver.tol"}.get(method, "solver.rtol")
    settings, reference = _settings(key, scenario[key])
    exact = _run(scenario, key, reference)
    runs = [_run(scenario, key, setting) for setting in settings]
    steps = [run.summary["steps"]["accepted"] for run in runs]
    errors = [float(np.abs(run["q"] - exact["q"]).max()) for run in runs]
    orders = [None, *(_order(steps[i : j + 1], errors[i : j + 1]) for i, j in pairwise(range(LEVELS)))]
    levels = [Level(*values) for values in zip(settings, steps, errors, orders, strict=True)]
    return Convergence(scenario.name, method, key, reference, levels, _order(steps, errors))


def _settings(key: str, own: float) -> tuple[list[float], float]:
    """Those of the levels, from the coarsest one; and that of the reference."""
    if key == "solver.step":
        return [own / 2**i for i in range(LEVELS)], own / 2 ** (LEVELS + 1)
    finest = max(own / 16, 64 * _least(key))
    return [finest * 16 ** (LEVELS - 1 - i) for i in range(LEVELS)], finest / 64


def _least(key: str) -> float:
    """The smallest value that the schema allows."""
    section, name = key.split(".")
    schema = json.loads(ffi.string(lib.arm3r_schema_json()))
    forms = (form["then"]["properties"] for form in schema["definitions"][section]["allOf"])
    return next(form[name]["minimum"] for form in forms if name in form)


def _run(scenario: Scenario, key: str, setting: float) -> Run:
    changed = scenario.copy().quiet()
    changed[key] = setting
    changed["checks"] = []
    if key == "solver.rtol":
        changed["solver.atol"] = scenario["solver.atol"] * setting / scenario[key]
    return changed.run()


def _order(steps: list[int], errors: list[float]) -> float | None:
    if min(errors) < ROUNDING or len(set(steps)) < len(steps):
        return None
    return -float(np.polyfit([math.log(n) for n in steps], [math.log(e) for e in errors], 1)[0])
