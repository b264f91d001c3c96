"""How nearly two runs of one scenario have to agree: by how much a disturbance of its numbers grows over the run.

A method's error is a small disturbance of the motion, and an unstable loop or a chattering contact makes it larger as
it makes any other. So the scenario is run again from slightly other numbers, and two methods agree where their rows
differ by no more than these runs do. No column needs a tolerance of its own.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import arm3r_cpp as arm3r
import numpy as np
from random_scenarios import Keys, yaml_of

SIZE = 1e-7
"""of the disturbance: rad, rad/s and m, and ten times as much in m/s^2 of gravity"""
FLOOR = SIZE
"""of what may differ, in a column's unit and relative to its largest value: some columns feel no disturbance"""
NOISY = {"tip_dv": 100.0, "f_estimate": 10.0}
"""times the floor: the error of an interpolant's slope, and a residual divided by a nearly singular Jacobian"""

ADAPTIVE: dict[str, Keys] = {
    "dopri5": {"method": "dopri5", "rtol": 1e-10, "atol": 1e-13},
    "rodas4": {"method": "rodas4", "rtol": 1e-10, "atol": 1e-13},
    "auto": {"method": "auto", "rtol": 1e-10, "atol": 1e-13},
    "taylor": {"method": "taylor", "tol": 1e-11},
}
MAX_STEPS = 50000


class Gap(NamedTuple):
    """Where two runs differ most, in units of what they may differ by."""

    ratio: float
    column: str
    t: float


def run_of(scenario: Mapping[str, Any], solver: Mapping[str, Any]) -> arm3r.Run | None:
    """The run with this solver, as far as it came; None where the method does not take the scenario."""
    text = yaml_of({**scenario, "solver": {**solver, "max_steps": MAX_STEPS}})
    try:
        return arm3r.Scenario(text).run()
    except arm3r.ScenarioError:
        return None
    except arm3r.Arm3rError as error:
        return error.run


def rk4(scenario: Mapping[str, Any], about: float) -> Keys:
    """rk4 with a step of about this many seconds that parts the period and the delay of the samples evenly."""
    if "sampling" not in scenario:
        return {"method": "rk4", "step": about}
    period, delay = 1 / scenario["sampling"]["rate"], scenario["sampling"].get("delay", 0)
    parts = max(1, round(period / about))
    while abs(parts * delay - round(parts * delay)) > 1e-9:
        parts += 1
    return {"method": "rk4", "step": period / parts}


def changes_on_grid(scenario: Mapping[str, Any], step: float) -> bool:
    """Whether every instant at which something begins or ends, or the estimator samples, is a whole number of steps."""
    reference, motion = scenario.get("reference", {}), scenario.get("wall", {}).get("motion", {})
    instants = [*motion.get("t", []), *reference.get("t", [])]
    for section in (scenario.get("push", {}), reference, reference.get("force", {}), motion):
        start = section.get("start", 0)
        instants += [start, start + section.get("duration", 0), start + section.get("rise", 0)]
    if (estimator := scenario.get("estimator")) is not None:
        instants += [estimator.get("start", 0), 1 / estimator.get("rate", 500)]
    return all(abs(t / step - round(t / step)) < 1e-6 for t in instants)


def disturbed(scenario: Mapping[str, Any], rng: np.random.Generator) -> Keys:
    """The scenario from slightly other places, rates and gravity, beside a slightly moved wall."""

    def moved(values: Any, size: float = SIZE) -> list[float]:
        return (np.array(values, float) + size * rng.choice([-1, 1], 3)).tolist()

    other = copy.deepcopy(dict(scenario))
    initial, arm = other["initial"], other["arm"]
    other["initial"] = {"q": moved(initial["q"]), "qd": moved(initial.get("qd", [0, 0, 0]))}
    arm["gravity"] = moved(arm.get("gravity", [0, 0, -9.80665]), 10 * SIZE)
    if "wall" in other:
        other["wall"]["point"] = moved(other["wall"]["point"])
    return other


class Band:
    """How far from a run its scenario's other runs may lie, row by row, and at its contact events."""

    def __init__(self, run: arm3r.Run, others: Iterable[arm3r.Run | None]) -> None:
        self.run = run
        self.others = [other for other in others if other is not None]
        self.limits = {name: self._limit(name) for name in run.columns if name != "t"}

    def _limit(self, name: str) -> np.ndarray:
        column = self.run[name]
        spread = np.zeros(len(column))
        for other in self.others:
            rows = min(len(other.t), len(column))
            spread[:rows] = np.maximum(spread[:rows], abs(other[name][:rows] - column[:rows]))
        floor = FLOOR * next((factor for stem, factor in NOISY.items() if name.startswith(stem)), 1.0)
        return np.maximum.accumulate(spread) + floor * (1 + abs(column).max())

    @property
    def growth(self) -> float:
        """By how much a disturbance of the joint angles has grown at the end."""
        return max(self.limits[name][-1] for name in ("q1", "q2", "q3")) / SIZE

    def gap(self, other: arm3r.Run, *, wider: float = 0.0) -> Gap:
        """Where another run leaves the band most; `wider`: by how many of its own widths the band is widened."""
        worst = Gap(0.0, "", 0.0)
        for name, limit in self.limits.items():
            if name == "energy_residual":
                continue  # it is the error of the run itself, which no other run shares
            ratio = abs(other[name] - self.run[name]) / (limit * (1 + wider))
            row = int(np.argmax(ratio))
            if not ratio[row] <= worst.ratio:
                worst = Gap(float(ratio[row]), name, float(self.run.t[row]))
        return worst

    def state_gap(self, a: arm3r.Run, b: arm3r.Run) -> float:
        """The largest difference of two other runs in angles and rates, in units of the band."""
        names = [f"{kind}{i}" for kind in ("q", "qd") for i in (1, 2, 3)]
        return max(float((abs(a[name] - b[name]) / self.limits[name]).max()) for name in names)

    def event_gap(self, other: arm3r.Run, *, wider: float = 0.0) -> Gap:
        """The same of the instants of contact events; infinite where there are others."""
        if any(kinds(one) != kinds(self.run) for one in self.others):
            return Gap(0.0, "", 0.0)  # a disturbance makes or takes a contact: nothing can be said
        if kinds(other) != kinds(self.run):
            return Gap(np.inf, f"{len(other.events)} events for {len(self.run.events)}", 0.0)
        if not self.run.events:
            return Gap(0.0, "", 0.0)
        t = instants(self.run)
        spread = np.max([abs(instants(one) - t) for one in self.others], axis=0, initial=0.0)
        ratio = abs(instants(other) - t) / ((np.maximum.accumulate(spread) + FLOOR) * (1 + wider))
        event = int(np.argmax(ratio))
        return Gap(float(ratio[event]), f"event {event}", float(t[event]))


def kinds(run: arm3r.Run) -> list[str]:
    """What happens to the contact, in order."""
    return [event.type for event in run.events]


def instants(run: arm3r.Run) -> np.ndarray:
    """When."""
    return np.array([event.t for event in run.events])
