"""How nearly two runs of one scenario have to agree: by how much a disturbance of its numbers grows over the run.

A method's error is a small disturbance of the motion, and an unstable loop or a chattering contact makes it larger as
it makes any other. So the scenario is run again from slightly other numbers, and two methods agree where their rows
differ by no more than these runs do. No column needs a tolerance of its own.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import arm3r_cpp as arm3r
import numpy as np
from random_scenarios import Keys, yaml_of

SIZE = 1e-7
"""of the disturbance: rad, rad/s and m, and ten times as much in m/s^2 of gravity"""
FLOOR = SIZE
"""of what may differ, in a column's unit and relative to its largest value: some columns feel no disturbance"""
NOISY = {"tip_dv": 100.0, "f_estimate": 1000.0, "stiffness_sigma": 100.0}
"""times the floor: the error of an interpolant's slope, a residual over a Jacobian that is singular to 1e-3, and,
without noise, the rounding errors of a force over how little the depth has changed"""
MEASURED_BY = {"stiffness_sigma": "stiffness_estimate"}
"""whose size says how large a column is: without noise a standard deviation is nothing but rounding errors"""
TIMES_OWN_ERROR = 5.0
"""how much larger the error of a method of fixed steps may be than the differences between its runs with other steps"""

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
    """rk4 with a step of about this many seconds that parts evenly what it needs to have on its steps.

    These are the period and the delay of the controller's samples, else the period and the start of the estimator's.
    """
    if "sampling" in scenario:
        period, later = 1 / scenario["sampling"]["rate"], scenario["sampling"].get("delay", 0)
    elif "estimator" in scenario:
        period = 1 / scenario["estimator"].get("rate", 500)
        later = scenario["estimator"].get("start", 0) / period
    else:
        return {"method": "rk4", "step": about}
    fewest = max(1, round(period / about))
    fitting = (parts for parts in range(fewest, 2 * fewest + 5) if abs(parts * later - round(parts * later)) < 1e-9)
    return {"method": "rk4", "step": period / next(fitting, fewest)}


def disturbed(scenario: Mapping[str, Any], rng: np.random.Generator, by: float = SIZE) -> Keys:
    """The scenario from slightly other places, rates and gravity, beside a slightly moved wall."""

    def moved(values: Any, size: float = by) -> list[float]:
        return (np.array(values, float) + size * rng.choice([-1, 1], 3)).tolist()

    other = copy.deepcopy(dict(scenario))
    initial, arm = other["initial"], other["arm"]
    other["initial"] = {"q": moved(initial["q"]), "qd": moved(initial.get("qd", [0, 0, 0]))}
    arm["gravity"] = moved(arm.get("gravity", [0, 0, -9.80665]), 10 * by)
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
        size = max(abs(column).max(), abs(self.run[MEASURED_BY.get(name, name)]).max())
        return np.maximum.accumulate(spread) + floor * (1 + size)

    @property
    def growth(self) -> float:
        """By how much a disturbance of the joint angles has grown at the end."""
        return max(self.limits[name][-1] for name in ("q1", "q2", "q3")) / SIZE

    def gap(self, other: arm3r.Run, own: OwnError | None = None) -> Gap:
        """Where another run leaves the band most, which its own error, where it is known, widens."""
        worst = Gap(0.0, "", 0.0)
        for name, limit in self.limits.items():
            if name == "energy_residual":
                continue  # it is the error of the run itself, which no other run shares
            ratio = abs(other[name] - self.run[name]) / (limit + own.columns[name] if own else limit)
            if own:
                ratio = np.where(own.rows, ratio, 0.0)
            if name in ("contact", "force_phase"):
                ratio = np.where(self._tells_contact(other, own), ratio, 0.0)
            row = int(np.argmax(ratio))
            if not ratio[row] <= worst.ratio:
                worst = Gap(float(ratio[row]), name, float(self.run.t[row]))
        return worst

    def _tells_contact(self, other: arm3r.Run, own: OwnError | None) -> np.ndarray:
        """The rows whose depth says on which side of the face the tip is: it exceeds its own error.

        `contact` and `force_phase` are 0 or 1, and turn with the last bit of a depth of zero. The instants of contact
        events are compared by themselves.
        """
        if "depth" not in self.limits:
            return np.ones(len(self.run.t), bool)
        error = self.limits["depth"] + (own.columns["depth"] if own else 0.0)
        return np.minimum(abs(self.run["depth"]), abs(other["depth"])) > error

    def event_gap(self, other: arm3r.Run, own: OwnError | None = None) -> Gap:
        """The same of the instants of contact events; infinite where there are others."""
        if any(kinds(one) != kinds(self.run) for one in self.others) or (own and own.events is None):
            return Gap(0.0, "", 0.0)  # a disturbance makes or takes a contact: nothing can be said
        if kinds(other) != kinds(self.run):
            return Gap(np.inf, f"{len(other.events)} events for {len(self.run.events)}", 0.0)
        if not self.run.events:
            return Gap(0.0, "", 0.0)
        t = instants(self.run)
        spread = np.max([abs(instants(one) - t) for one in self.others], axis=0, initial=0.0)
        limit = np.maximum.accumulate(spread) + FLOOR
        ratio = abs(instants(other) - t) / (limit + own.events if own else limit)
        event = int(np.argmax(ratio))
        return Gap(float(ratio[event]), f"event {event}", float(t[event]))


class OwnError(NamedTuple):
    """What rk4 tells of its own error, by runs with other steps.

    The steps are no multiples of one another and none of a millisecond: a contact that begins just before the end of a
    step must not begin just before the end of a step in every run. Up to one step away from such an instant, and from
    an estimate that is due between two steps, the controller knows of it at the end of the step only: these rows say
    nothing. Nor do those after a step of first order, of which the run warns: where steps have to hold samples or
    estimates, runs with other steps may all be late by the same time. test_rk4_at_contacts.py measures that order.
    """

    columns: dict[str, np.ndarray]
    events: np.ndarray | None  # s, of the instants of contact events; None where other steps have other events
    rows: np.ndarray  # where a row says something

    @classmethod
    def of(cls, scenario: Mapping[str, Any], finest: arm3r.Run, others: Sequence[arm3r.Run], step: float) -> OwnError:
        """From the run with the smallest step and those with others, of which `step` is the longest."""
        late = [t for run in (finest, *others) for t in instants(run)] + estimates_between_steps(scenario)
        until = min(first_order_since(run) for run in (finest, *others)) - step
        rows = np.all([finest.t < until, *(abs(finest.t - t) > step for t in late)], axis=0)
        # An error may turn a rounded reading into the next one.
        quanta = {"force_measured": scenario.get("sensors", {}).get("force", {}).get("resolution", 0.0)}

        def error_of(name: str) -> np.ndarray:
            apart = np.max([abs(run[name] - finest[name]) for run in others], axis=0)
            return TIMES_OWN_ERROR * np.maximum.accumulate(np.where(rows, apart, 0.0)) + quanta.get(name, 0.0)

        events = None
        if until == np.inf and all(kinds(run) == kinds(finest) for run in others):
            apart = [abs(instants(run) - instants(finest)) for run in others]
            events = TIMES_OWN_ERROR * np.maximum.accumulate(np.max(apart, axis=0))
        return cls({name: error_of(name) for name in finest.columns}, events, rows)


def first_order_since(run: arm3r.Run) -> float:
    """The first jump or contact that costs rk4 its order, as the run warns, s; infinite where there is none."""
    return min(
        map(float, re.findall(r"at t = (\S+) s,? within a step of rk4", "\n".join(run.warnings))), default=np.inf
    )


def estimates_between_steps(scenario: Mapping[str, Any]) -> list[float]:
    """When the estimator beside a sampled controller is due, s: the steps of rk4 hold the samples of that alone."""
    if "estimator" not in scenario or "sampling" not in scenario:
        return []
    start, period = scenario["estimator"].get("start", 0), 1 / scenario["estimator"].get("rate", 500)
    return np.arange(start, scenario["time"]["stop"] + period, period).tolist()


def kinds(run: arm3r.Run) -> list[str]:
    """What happens to the contact, in order."""
    return [event.type for event in run.events]


def instants(run: arm3r.Run) -> np.ndarray:
    """When."""
    return np.array([event.t for event in run.events])
