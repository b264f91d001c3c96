"""Whether another method would compute many runs much faster, found by a short trial of a few of them."""

from __future__ import annotations

import time

import numpy as np

from ..batch import run_batch
from ..errors import Arm3rError
from ..scenario import Scenario

ADAPTIVE = ("dopri5", "rodas4", "auto")  # one run after the other
IN_LANES = ("rk4", "taylor")  # several runs at once
AFTER = 1.0  # s of clock until a trial
WORTH = 10.0  # s left below which nothing is said
LEAST = 3.0  # times
RUNS = 8  # of a trial
SPAN = 0.25  # s, simulated in a trial
LONGEST = 1.0  # s of clock for one trial


class Advice:
    """Gives its sentence once: when the work has run for a second and much of it is left."""

    def __init__(self, scenario: Scenario) -> None:
        self._scenario, self._start = scenario, time.monotonic()
        self._is_given = scenario["solver.method"] not in ADAPTIVE

    def after(self, done: int, all_of_them: int) -> str:
        """The sentence, or "" where there is none at this time; done: runs."""
        seconds = time.monotonic() - self._start
        if self._is_given or seconds < AFTER:
            return ""
        self._is_given = True
        left = seconds * (all_of_them - done) / done if done else np.inf
        return sentence(self._scenario) if left > WORTH else ""


def sentence(scenario: Scenario) -> str:
    """Which method would be how many times faster; "" where none is, or none can be tried."""
    method = scenario["solver.method"]
    now = seconds_by(scenario, None)
    tried = {other: seconds_by(scenario, other) for other in IN_LANES}
    found = {other: now / seconds for other, seconds in tried.items() if now and seconds}
    best = max(found, key=found.__getitem__, default="")
    if not best or found[best] < LEAST:
        return ""
    step = f" with its step of {trial_of(scenario, best)['solver.step']:g} s" if best == "rk4" else ""
    times = f"about {found[best]:.1g}" if found[best] < 10 else f"about {float(f'{found[best]:.1g}'):.0f}"
    return (
        f"solver.method: {best}{step} computes such runs {times} times faster than {method}, in a trial of {RUNS} of them; "
        "compare a run by both before you rely on it"
    )


def trial_of(scenario: Scenario, method: str | None) -> Scenario:
    """A short part of the scenario by another method; None: by its own."""
    trial = scenario.copy()._quiet()
    trial["checks"] = []
    if method:
        trial["solver"] = {"method": method}
    trial["time.stop"] = min(trial["time.stop"], trial["time.start"] + SPAN)
    return trial


def seconds_by(scenario: Scenario, method: str | None) -> float:
    """s of one thread for a trial; 0: the method does not take this scenario, or is too slow."""
    start = time.perf_counter()
    try:
        trial = trial_of(scenario, method)
        again = {"initial.q[0]": np.full(RUNS, trial["initial.q[0]"])}
        batch = run_batch(trial, again, threads=1, progress=lambda *_: time.perf_counter() - start > LONGEST)
    except Arm3rError:
        return 0.0
    return time.perf_counter() - start if batch.ok.all() else 0.0
