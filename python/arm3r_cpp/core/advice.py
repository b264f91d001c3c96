"""Whether another method would compute many runs much faster, found by a short trial of a few of them."""

from __future__ import annotations

import time

import numpy as np

from ..errors import Arm3rError
from .protocols import AnyScenario

SLOW = ("rodas4", "auto", "dopri5")  # the first two compute one run after the other
IN_LANES = ("rk4", "taylor", "dopri5")  # several runs at once
AFTER = 1.0  # s of clock until a trial
WORTH = 10.0  # s left below which nothing is said
LEAST = 3.0  # times
RUNS = 8  # of a trial
SPAN = 0.25  # s, simulated in the first trial; it is doubled
ENOUGH = 0.3  # s of clock: a trial that takes so long tells enough
RESOLUTION = 1e-4  # s: of the times that are measured
LONGEST = 1.0  # s of clock for one trial


class Advice:
    """Gives its sentence once: when the work has run for a second and much of it is left."""

    def __init__(self, scenario: AnyScenario) -> None:
        self._scenario, self._start = scenario, time.monotonic()
        self._is_given = scenario["solver.method"] not in SLOW

    def after(self, done: int, all_of_them: int) -> str:
        """The sentence, or "" where there is none at this time; done: runs."""
        seconds = time.monotonic() - self._start
        if self._is_given or seconds < AFTER:
            return ""
        self._is_given = True
        left = seconds * (all_of_them - done) / done if done else np.inf
        return sentence(self._scenario) if left > WORTH else ""


def sentence(scenario: AnyScenario) -> str:
    """Which method would be how many times faster; "" where none is, or none can be tried."""
    method, span = scenario["solver.method"], SPAN
    whole = scenario["time.stop"] - scenario["time.start"]
    now = seconds_by(scenario, method, span)
    while 0 < now < ENOUGH and span < whole:
        span = min(2 * span, whole)
        now = seconds_by(scenario, method, span)
    others = [other for other in IN_LANES if other != method]
    times = {other: now / seconds for other in others if (seconds := seconds_by(scenario, other, span))}
    best = max(times, key=times.__getitem__, default="")
    if not best or times[best] < LEAST:
        return ""
    step = f" with its step of {trial_of(scenario, best, span)['solver.step']:g} s" if best == "rk4" else ""
    return (
        f"solver.method: {best}{step} computes such runs about {float(f'{times[best]:.1g}'):g} times faster "
        f"than {method}, by a trial of {span:.3g} s of {RUNS} runs; compare one run by both before you rely on it"
    )


def trial_of(scenario: AnyScenario, method: str, span: float) -> AnyScenario:
    """The first `span` s of a scenario by a method."""
    trial = scenario.copy().quiet()
    trial["checks"] = []
    if method != trial["solver.method"]:
        trial["solver"] = {"method": method}
    trial["time.stop"] = trial["time.start"] + span
    return trial


def seconds_by(scenario: AnyScenario, method: str, span: float) -> float:
    """s that one thread takes for a trial, without what a batch of no length takes.

    0: the method does not take this scenario, or it takes too long.
    """
    taken = [_seconds(scenario, method, one) for one in (0.0, span)]
    return max(taken[1] - taken[0], RESOLUTION) if all(taken) else 0.0


def _seconds(scenario: AnyScenario, method: str, span: float) -> float:
    start = time.perf_counter()
    try:
        trial = trial_of(scenario, method, span)
        again = {"initial.q[0]": np.full(RUNS, trial["initial.q[0]"])}
        batch = trial.batch(again, threads=1, progress=lambda *_: time.perf_counter() - start > LONGEST)
    except Arm3rError:
        return 0.0
    return time.perf_counter() - start if batch.ok.all() else 0.0
