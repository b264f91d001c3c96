"""Every method that takes a scenario gives the same motion, rows and contacts, however the scenario is made.

A failure prints the seed of its scenario and its YAML; ARM3R_SEED sets another seed. rk4 has no tolerance and loses its
order where a contact changes within a step: it is compared in the gate.
"""

from __future__ import annotations

import numpy as np
import pytest
from agreement import ADAPTIVE, Band, Gap, changes_on_grid, disturbed, rk4, run_of
from random_scenarios import Keys, random_scenario, sample_seed, yaml_of

SEED = sample_seed()
WITH_TOLERANCE = ("rodas4", "auto", "taylor")


def band_of(scenario: Keys, number: int, disturbances: int = 2) -> Band | None:
    """The run by dopri5 and how a disturbance grows in it; None where it does not come to its end."""
    run = run_of(scenario, ADAPTIVE["dopri5"])
    assert run is not None
    if run.outcome != "ok":
        return None
    others = (disturbed(scenario, np.random.default_rng([SEED, number, i])) for i in range(disturbances))
    return Band(run, [run_of(other, ADAPTIVE["dopri5"]) for other in others])


def worst_gap(scenario: Keys, band: Band, method: str) -> Gap | None:
    """Where a method leaves the band most; None where it does not take the scenario.

    rk4 knows no tolerance: its band is widened by what larger steps change. These are no multiples of one another, for
    a contact that begins just before the end of a step begins just before that of half the step too. A change between
    two of its steps costs rk4 its order, so that it takes only scenarios whose changes lie on its grid.
    """
    wider = 0.0
    if method == "rk4":
        solvers = [rk4(scenario, 1e-3 / parts) for parts in (4, 7, 11)]
        if not all(changes_on_grid(scenario, solver["step"]) for solver in solvers):
            return None
        runs = [run_of(scenario, solver) for solver in solvers]
        other = runs[-1]
        if all(run is not None and run.outcome == "ok" for run in runs):
            wider = 5 * max(band.state_gap(other, run) for run in runs[:-1])
    else:
        other = run_of(scenario, ADAPTIVE[method])
    if other is None:
        return None
    if other.outcome != "ok":
        return Gap(np.inf, f"outcome {other.outcome}: {other.summary['message']}", other.t[-1])
    return max(band.gap(other, wider=wider), band.event_gap(other, wider=wider))


def disagreements(number: int, longest: float, methods: tuple[str, ...]) -> list[str]:
    """What is wrong in a scenario, one text for each method that leaves the band."""
    scenario = random_scenario(np.random.default_rng([SEED, number]), longest=longest)
    band, found = band_of(scenario, number), []
    for method in methods if band else []:
        gap = worst_gap(scenario, band, method)
        if gap and gap.ratio > 1:  # two disturbances may miss what an encoder or a grazing contact makes of others
            gap = worst_gap(scenario, band_of(scenario, number, disturbances=12), method)
        if gap and gap.ratio > 1:
            found.append(f"# seed {SEED}, scenario {number}: {method} against dopri5: {gap}\n{yaml_of(scenario)}")
    return found


def check(numbers: range, longest: float, methods: tuple[str, ...]) -> None:
    found = [text for number in numbers for text in disagreements(number, longest, methods)]
    assert not found, f"{len(found)} disagreements in {len(numbers)} scenarios\n" + "\n".join(found[:10])


def test_methods_agree() -> None:
    check(range(300), longest=0.3, methods=WITH_TOLERANCE)


@pytest.mark.gate
@pytest.mark.parametrize("part", range(10))
def test_methods_agree_in_many(part: int) -> None:
    check(range(1000 + 500 * part, 1500 + 500 * part), longest=1.2, methods=(*WITH_TOLERANCE, "rk4"))
