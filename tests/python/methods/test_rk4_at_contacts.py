"""rk4 does not split its steps at contacts (5.1): it warns where that costs it its order, and only there; with
solver.events: located its steps end there, and it keeps its order.
"""

from __future__ import annotations

import arm3r_cpp as arm3r
import numpy as np
import pytest
from random_scenarios import sample_seed

PRESSES = """format: 1
arm: {convention: slide, damping: [0.2, 0.1, 0.3]}
initial: {q: [0.3, 0.5, -1.2], qd: [0.1, -0.5, 1.2]}
wall:
  {point: [1.58, 0, 0], normal: [-1, 0, 0], size: [SIZE], motion: {type: fixed}, contact: {CONTACT}, acts_on_arm: true}
controller: {LAW}
reference: {type: hold, force: {value: 20}}
time: {stop: 0.4, log_every: 0.4}
"""
SPRING = "law: spring, stiffness: 2000"
DAMPED = "law: kelvin_voigt, stiffness: 2000, damping: 300"
HUNT_CROSSLEY = "law: hunt_crossley, stiffness: 2000, exponent: 1.5, dissipation: 0.3"
LARGE, SMALL = "4, 4", "1, 1"
COMPENSATES = "type: gravity_compensation"


def run_of(law: str, contact: str, size: str, solver: str) -> arm3r.Run:
    text = PRESSES.replace("LAW", law).replace("CONTACT", contact).replace("SIZE", size) + f"solver: {{{solver}}}\n"
    if "hybrid" not in law:
        text = text.replace(", force: {value: 20}", "")
    if law == COMPENSATES:
        text = text.replace("reference: {type: hold}\n", "")
    return arm3r.Scenario(text).quiet().run()


def order(law: str, contact: str, size: str, events: str = "grid", runs: int = 24) -> float:
    """By how many powers of the step the error at the end falls, from many steps that meet the contact anywhere."""
    right = run_of(law, contact, size, "rtol: 1.0e-12, atol: 1.0e-14")["q2"][-1]
    rng = np.random.default_rng(sample_seed())

    def error(about: float) -> float:
        steps = about * rng.uniform(0.8, 1.25, runs)
        ends = [
            run_of(law, contact, size, f"method: rk4, step: {step:.9e}, events: {events}")["q2"][-1] for step in steps
        ]
        return float(np.sqrt(np.mean(np.square(np.array(ends) - right))))

    return float(np.log(error(1e-3) / error(1e-3 / 16)) / np.log(16))


@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("law", "contact", "size", "jumps"),
    [
        (COMPENSATES, SPRING, LARGE, ""),
        (COMPENSATES, HUNT_CROSSLEY, LARGE, ""),
        (COMPENSATES, DAMPED, LARGE, "the wall's damping"),
        (COMPENSATES, SPRING, SMALL, "the edge of the plate"),
        (COMPENSATES, HUNT_CROSSLEY, SMALL, "the edge of the plate"),
        ("type: hybrid", SPRING, LARGE, "the law switches"),
        ("type: hybrid", HUNT_CROSSLEY, LARGE, "the law switches"),
        ("type: hybrid, switching: always", SPRING, LARGE, "the law switches"),
        ("type: impedance, stiffness: [1, 1, 1], damping: [1, 1, 1]", SPRING, LARGE, ""),
    ],
)
def test_rk4_warns_where_a_contact_costs_it_its_order(law: str, contact: str, size: str, jumps: str) -> None:
    run = run_of(law, contact, size, "method: rk4, step: 1.0e-3")
    told = [line for line in run.warnings if "within a step of rk4" in line]
    assert run.events and len(told) == bool(jumps) and all(jumps in line for line in told)
    assert not any("of rk4" in line for line in run_of(law, contact, size, "method: dopri5").warnings)
    found = order(law, contact, size)
    assert (found < 1.5) == bool(jumps), found


@pytest.mark.sample(5)
@pytest.mark.parametrize("contact", [SPRING, DAMPED, HUNT_CROSSLEY])
@pytest.mark.parametrize("size", [LARGE, SMALL])
@pytest.mark.parametrize("law", [COMPENSATES, "type: hybrid"])
def test_steps_that_end_at_contacts_keep_their_order(law: str, contact: str, size: str) -> None:
    run = run_of(law, contact, size, "method: rk4, step: 1.0e-3, events: located")
    assert run.events and not any("within a step" in line for line in run.warnings)
    # The force of Hunt and Crossley begins as the power 1.5 of the depth: no method has order 4 there.
    assert order(law, contact, size, "located", 6) > (2.2 if contact == HUNT_CROSSLEY else 2.9)


def test_a_contact_just_before_a_step_would_end_is_one_contact() -> None:
    for before in 10.0 ** np.arange(-12, -4):
        for steps in (2, 3, 5, 8):
            met = run_of(COMPENSATES, SPRING, LARGE, "method: dopri5").events[0].t
            for _ in range(5):  # where it is met depends on the step
                solver = f"method: rk4, step: {(met + before) / steps:.17g}, events: located"
                run = run_of(COMPENSATES, SPRING, LARGE, solver)
                met = run.events[0].t
            assert [event.type for event in run.events] == ["make", "break"], (before, steps)


def test_only_rk4_has_steps_of_one_length() -> None:
    with pytest.raises(arm3r.ScenarioError, match=r"solver\.events"):
        run_of(COMPENSATES, SPRING, LARGE, "method: dopri5, events: located")
