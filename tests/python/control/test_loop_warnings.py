"""What is said of a loop before a run, compared with the run; and what a bad end says first."""

from __future__ import annotations

import json
import random
import re

import arm3r_cpp as arm3r
import numpy as np
import pytest
from random_scenarios import sample_seed

LAWS = ("joint_pd", "stiffness", "impedance", "computed_torque", "resolved_acceleration", "joint_stiffness")
SAMPLES = 600


def run_anyway(scenario: arm3r.Scenario) -> arm3r.Run:
    try:
        return scenario.run()
    except (arm3r.NumericalError, arm3r.BudgetError) as error:
        return error.run


def warnings_of(text: str) -> str:
    return "\n".join(run_anyway(arm3r.Scenario(text)).summary["warnings"])


def disturbed(chance: random.Random) -> str:
    """A sampled loop at rest, but for rates of 1e-6 rad/s, in a random pose."""
    rate = 10 ** chance.uniform(1.3, 3)
    law = chance.choice(LAWS)
    q = [chance.uniform(-1, 1), chance.uniform(0.1, 1), chance.uniform(-2, -0.6)]
    velocity = chance.choice(("exact", "difference", "filtered"))
    return f"""format: 1
arm: {{convention: slide, damping: [{chance.uniform(0, 1):.4f}, 0.1, 0.1]}}
initial: {{q: {[round(x, 4) for x in q]}, qd: [1.0e-6, -1.0e-6, 2.0e-6]}}
controller: {{type: {law}}}
sampling: {{rate: {rate:.4f}, delay: {chance.choice((0, 0, 1, 2.5))}}}
sensors: {{velocity: {{estimate: {velocity}}}}}
solver: {{rtol: 1.0e-10, atol: 1.0e-14, max_steps: 400000}}
time: {{stop: {SAMPLES / rate:.6f}, log_every: {2 / rate:.6f}}}
"""


def grows(run: arm3r.Run) -> bool | None:
    """None: too slowly to tell, within a factor of 2 from the second quarter to the last one.

    Nor is it told of a growth of less than 0.2 1/s: the warning leaves out what grows by less than 0.1 1/s.
    """
    if str(run.outcome) != "ok":
        return True
    rates = np.abs(np.stack([run["qd1"], run["qd2"], run["qd3"]])).max(axis=0)
    quarter = len(rates) // 4
    early, late = rates[quarter : 2 * quarter].max(), rates[-quarter:].max()
    if late > 1e-3:
        return True
    if early < 1e-9:
        return False
    if early < late < early * np.exp(0.2 * run.t[-1] / 2):
        return None
    return True if late > 2 * early else False if late < 0.5 * early else None


def disagreements(seed: int, count: int) -> tuple[list[str], int, int]:
    chance = random.Random(seed)
    wrong, growing, told = [], 0, 0
    for _ in range(count):
        text = disturbed(chance)
        run = run_anyway(arm3r.Scenario(text))
        answer, warns = (
            grows(run),
            any("unstable" in w or "are stable with periods" in w for w in run.summary["warnings"]),
        )
        told += answer is not None
        growing += answer is True
        if answer is not None and answer != warns:
            wrong.append(f"seed {seed}: grows {answer}, warned {warns}\n{text}")
    return wrong, growing, told


@pytest.mark.parametrize("count", [40, pytest.param(1000, marks=[pytest.mark.gate, pytest.mark.random])])
def test_a_sampled_loop_is_warned_of_where_the_run_grows_and_only_there(count: int) -> None:
    wrong, growing, told = disagreements(sample_seed(), count)
    assert told > 0.6 * count and 0 < growing < told
    assert wrong == [], "\n".join(wrong)


SAMPLED = """format: 1
controller: {type: stiffness}
reference: {type: minimum_jerk, tip: [1.5, 0.1, 0.1], duration: 1}
time: {stop: 2}
"""


@pytest.mark.parametrize("rate, warns", [(50, True), (100, True), (180, True), (210, False), (1000, False)])
def test_a_low_rate_is_warned_of_with_the_rate_that_would_do(rate: int, warns: bool) -> None:
    said = warnings_of(SAMPLED + f"sampling: {{rate: {rate}}}\nsolver: {{max_steps: 200000}}\n")
    assert ("is unstable" in said) == warns
    assert ("from about 197 Hz on it is stable" in said) == warns


def test_an_unstable_sampled_loop_ends_as_diverged_and_names_itself() -> None:
    run = run_anyway(arm3r.Scenario(SAMPLED + "sampling: {rate: 50}\n"))
    assert str(run.outcome) == "diverged"
    assert "the sampled loop of 50 Hz is unstable" in run.summary["message"]
    assert "stiff" not in run.summary["message"] and "singular" not in run.summary["message"]
    assert run.summary["steps"]["accepted"] < 100_000


def test_contact_through_a_delay_is_warned_of() -> None:
    text = """format: 1
arm: {convention: slide}
initial: {q: [0, 0.6, -1.2]}
wall: {point: [1.66, 0, 0], size: infinite, acts_on_arm: true, motion: {type: fixed}, contact: {stiffness: 20000}}
controller: {type: hybrid, switching: always}
reference: {force: {value: 10}}
time: {stop: 0.1}
"""
    assert "unstable" not in warnings_of(text + "sampling: {rate: 2000}\n")
    assert "is unstable in contact" in warnings_of(text + "sampling: {rate: 1000, delay: 12}\n")


FIXED = """format: 1
arm: {convention: slide}
initial: {q: [0, 0.6, -1.2]}
solver: {method: rk4, step: 0.001}
time: {stop: 0.01}
"""
WALL = "wall: {point: [1.67, 0, 0], acts_on_arm: true, contact: {%s}}\n"
RATES = {
    "sensors.force.analog_cutoff": (
        WALL % "stiffness: 1000" + "controller: {type: shaped_impedance}\nsampling: {rate: 500}\n",
        "sensors: {force: {analog_cutoff: %g}}\n",
        100,
    ),
    "observer.gain": ("controller: {type: gravity_compensation}\n", "observer: {gain: %g}\n", 100),
    "wall.contact.stiffness": ("", WALL % "stiffness: %g", 1e5),
    "wall.contact.damping": ("", WALL % "law: kelvin_voigt, stiffness: 100, damping: %g", 100),
    "controller": ("controller: {type: joint_pd, joint_stiffness: [10, 10, 10], ", "joint_damping: [0, 0, %g]}\n", 1),
}


@pytest.mark.parametrize("key", RATES)
def test_a_fixed_step_is_held_against_each_rate(key: str) -> None:
    before, line, usual = RATES[key]
    assert "solver.step times" not in warnings_of(FIXED + before + line % usual)
    said = warnings_of(FIXED + before + line % (usual * 1e4))
    assert f"solver.step times the rate of {key}" in said or (key == "controller" and "the gains of controller" in said)


def test_a_fixed_step_that_is_too_long_is_the_cause_of_a_bad_end() -> None:
    text = (
        FIXED.replace("stop: 0.01", "stop: 0.8")
        + """sampling: {rate: 500}
sensors: {force: {analog_cutoff: 500}}
controller: {type: shaped_impedance}
wall: {point: [1.67, 0, 0], size: infinite, acts_on_arm: true, motion: {type: constant, velocity: 0.05}}
"""
    )
    run = run_anyway(arm3r.Scenario(text))
    assert str(run.outcome) == "diverged"
    assert "sensors.force.analog_cutoff" in run.summary["message"] and "singular" not in run.summary["message"]


HELD = """format: 1
wall: {point: [1.74, 0, 0], motion: {type: fixed}, contact: {stiffness: 20000}, acts_on_arm: true}
reference: {type: hold, force: {value: 10}}
time: {stop: 4}
"""


def test_a_wanted_force_that_never_meets_a_wall_says_so() -> None:
    said = warnings_of(HELD + "controller: {type: adaptive_reference}\n")
    assert "no contact: reference.force wants 10 N" in said and "no nearer to the wall than 0.00" in said


FORCES = (
    "value: 10",
    "type: step, value: 10, initial: 5, start: 0.1",
    "type: sinusoid, value: 10, amplitude: 3, frequency: 1",
)


@pytest.mark.parametrize("force", FORCES)
@pytest.mark.parametrize("sampling", ["", "sampling: {rate: 1000}\n"])
@pytest.mark.parametrize("law", ["hybrid", "operational_space", "parallel", "adaptive_reference"])
def test_a_law_that_presses_into_free_space_has_no_unstable_loop_for_that(law: str, sampling: str, force: str) -> None:
    """It comes to no rest there; linearised where it does not rest, a good loop seems to grow."""
    q = random.Random(sample_seed()).choices([-0.7, -0.2, 0.5, 0.8], k=2)
    text = (
        f"format: 1\ninitial: {{q: [{q[0]}, {q[1]}, 1.0]}}\ntime: {{stop: 0.5}}\n"
        f"wall: {{point: [5, 0, 0], acts_on_arm: true, motion: {{type: fixed}}}}\n"
        f"controller: {{type: {law}, switching: always}}\nreference: {{type: hold, force: {{{force}}}}}\n{sampling}"
    )
    run = run_anyway(arm3r.Scenario(text))
    said = " ".join(run.summary["warnings"])
    assert "unstable" not in said + run.summary["message"]
    assert "no contact: reference.force wants 10 N" in said


def test_a_law_that_presses_into_free_space_until_it_is_stretched_is_told_that_there_is_no_contact() -> None:
    text = """format: 1
initial: {q: [0.2, -0.5, 1.0]}
wall: {point: [5, 0, 0], normal: [-1, 0, 0], acts_on_arm: true, motion: {type: fixed}}
controller: {type: hybrid, switching: always}
reference: {type: hold, force: {value: 10}}
time: {stop: 5}
"""
    run = run_anyway(arm3r.Scenario(text))
    assert str(run.outcome) == "diverged"
    assert "singular pose" in run.summary["message"] and "unstable" not in run.summary["message"]
    assert any("no contact: reference.force wants 10 N" in warning for warning in run.summary["warnings"])


def test_an_adaptive_reference_that_always_controls_the_force_leaves_for_the_wall() -> None:
    run = run_anyway(arm3r.Scenario(HELD + "controller: {type: adaptive_reference, switching: always}\n"))
    assert run.summary["contacts"] == 1
    assert run["f_on_wall_x"][-1] == pytest.approx(10, rel=0.01)
    assert not any("no contact" in warning for warning in run.summary["warnings"])


# ---- what a model does not know -------------------------------------------------------------------------------------

HOLDS = (
    "format: 1\narm: {convention: slide}\ninitial: {q: [0.2, 0.5, -1.1]}\nreference: {type: hold}\ntime: {stop: 0.1}\n"
)


@pytest.mark.parametrize(
    "law, warns",
    [
        ("{type: joint_pd, gravity: 9.80665}", False),
        ("{type: joint_pd, gravity: 19.6133}", True),
        ("{type: joint_pd, gravity: 0}", False),
        ("{type: joint_pd, gravity: [0, 3, -9]}", True),
        ("{type: gravity_compensation, gravity: 4}", False),
        ("{type: gravity_compensation, gravity: 19.6133}", True),
        ("{type: impedance, model: {payload: {mass: 2}}}", True),
        ("{type: impedance, model: {payload: {mass: 0.02}}}", False),
        ("{type: impedance, model: {link3: {mass: 3}}}", True),
    ],
)
def test_a_weight_that_is_compensated_wrongly_is_told_with_both_torques(law: str, warns: bool) -> None:
    text = HOLDS.replace("reference: {type: hold}\n", "") if "compensation" in law else HOLDS
    scenario = arm3r.Scenario(f"{text}controller: {law}\n")
    said = [line for line in scenario.quiet().run().warnings if "the weight of the arm takes torques of" in line]
    assert len(said) == warns
    if not warns:
        return
    needed, given = (np.array(json.loads(found)) for found in re.findall(r"(\[[^\]]*\]) N m", said[0]))
    arm = scenario.arm
    assert needed == pytest.approx(arm.gravity_torque([0.2, 0.5, -1.1]), rel=1e-4, abs=1e-4)
    assert np.linalg.norm(given - needed) > 0.2 * np.linalg.norm(needed)


OBSERVED = """format: 1
arm: {convention: slide, friction: [1.8, 1.2, 0.6]}
initial: {q: [0.1, 0.4, -0.9]}
reference: {type: minimum_jerk, q: [0.5, 0.1, -0.4], duration: 1}
sampling: {rate: 1000}
observer: {}
time: {stop: 1, log_columns: [t]}
"""


def test_a_residual_that_no_friction_explains_is_not_called_friction() -> None:
    """The model lacks a payload: the joints have friction, too, but a fraction of what the observer sees."""
    text = f"{OBSERVED}controller: {{type: joint_pd, model: {{payload: {{mass: 0}}}}}}\n"
    said = warnings_of(text.replace("friction: [1.8, 1.2, 0.6]", "payload: {mass: 2}, friction: [0.1, 0.1, 0.1]"))
    (line,) = [line for line in said.split("\n") if "the residual of the observer reached" in line]
    assert "more than its friction, 0.1 N m, explains" in line and "can be taken" not in line


@pytest.mark.parametrize("model, warns", [("", False), (", model: {friction: [0, 0, 0]}", True)])
def test_friction_that_an_observer_takes_for_contact_is_told_with_its_size(model: str, warns: bool) -> None:
    text = f"{OBSERVED}controller: {{type: joint_pd{model}}}\n"
    said = [line for line in warnings_of(text).split("\n") if "the residual of the observer reached" in line]
    assert len(said) == warns
    if warns:
        size = float(re.findall(r"reached (\S+) N m", said[0])[0])
        residual = arm3r.Scenario(text.replace("[t]", "[t, residual1, residual2, residual3]")).run()["residual"]
        assert size == pytest.approx(np.abs(residual).max(), rel=1e-3) and 1 < size < 2


def test_a_tip_beside_the_plate_is_not_said_to_be_before_the_wall() -> None:
    text = """format: 1
arm: {convention: slide}
initial: {q: [0, 0.5, -1.0]}
wall: {point: [1.6, 0.6, 0], normal: [-1, 0, 0], size: [0.1, 0.1], acts_on_arm: true, motion: {type: fixed}}
controller: {type: hybrid}
reference: {type: hold, force: {value: 10}}
time: {stop: 0.2}
"""
    said = warnings_of(text)
    assert "no contact: reference.force wants 10 N" in said and "nearer" not in said


def test_a_wanted_force_above_a_floor_that_is_not_reached_says_so() -> None:
    text = """format: 1
arm: {convention: slide}
initial: {q: [0, 0.5, -1.0]}
wall: {point: [1, 0, -0.3], normal: [0, 0, 1], size: infinite, acts_on_arm: true, motion: {type: fixed}}
controller: {type: hybrid}
reference: {type: hold, force: {value: 10}}
time: {stop: 0.2, log_columns: [t]}
"""
    assert "no nearer to the wall than 0.3 m" in warnings_of(text)
