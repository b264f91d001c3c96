"""The page docs/derivation.md is what its script writes, and each of its formulas is the library's."""

from __future__ import annotations

from importlib.util import find_spec
from types import ModuleType
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from conftest import script
from page_runner import blocks_of
from random_scenarios import sample_seed

ARMS = 20

# Importing sympy takes seconds, in each process that collects tests.
pytestmark = pytest.mark.skipif(find_spec("sympy") is None, reason="sympy is not installed")


@pytest.fixture(scope="module")
def derivation() -> ModuleType:
    """tools/derivation.py"""
    return script("tools/derivation.py")


def random_numbers(rng: np.random.Generator) -> dict[str, float]:
    """Of an arm and its state, by their names on the page."""
    numbers = {name: rng.uniform(0.5, 2) for name in ("m_1", "m_2", "m_3", "a_2", "a_3", "m_p")}
    numbers |= {"l_2": rng.uniform(0.2, 0.6) * numbers["a_2"], "l_3": rng.uniform(0.2, 0.6) * numbers["a_3"]}
    numbers |= {"g": rng.uniform(1, 20), "d_1": rng.uniform(-0.5, 0.5), "z_{c1}": rng.uniform(-0.5, 0.5)}
    numbers |= {name: rng.uniform(0.01, 0.3) for name in ("I_1", "J_{a1}", "J_{a2}", "J_{a3}")}
    for link in (2, 3):
        x, y, z = rng.dirichlet([3, 3, 3]) * 0.2
        numbers |= {f"I_{{x{link}}}": y + z, f"I_{{y{link}}}": x + z, f"I_{{z{link}}}": x + y}
    return numbers | {name: rng.uniform(-3, 3) for i in "123" for name in (f"q_{i}", rf"\dot{{q}}_{i}")}


def arm_of(numbers: dict[str, float], convention: str, *, carries: bool) -> arm3r.Arm:
    """The library's arm of these numbers; `carries`: with payload and rotors."""

    def link(number: int) -> dict[str, Any]:
        inertia = [numbers[f"I_{{{axis}{number}}}"] for axis in "xyz"]
        names = {"length": "a", "mass": "m", "com": "l"}
        return {key: numbers[f"{letter}_{number}"] for key, letter in names.items()} | {"inertia": inertia}

    scenario = arm3r.Scenario()
    scenario["arm"] = {
        "convention": convention,
        "base_height": numbers["d_1"],
        "gravity": [0, 0, -numbers["g"]],
        "link1": {"mass": numbers["m_1"], "com": numbers["z_{c1}"], "inertia_axial": numbers["I_1"]},
        "link2": link(2),
        "link3": link(3),
        "armature": [numbers[f"J_{{a{i}}}"] * carries for i in "123"],
        "payload": {"mass": numbers["m_p"] * carries},
    }
    return scenario.arm


def differences(function: Any, q: np.ndarray) -> np.ndarray:
    """The derivative of f(q) -> (..., 3) by central differences of fourth order: (..., 3, 3)."""
    step = 1e-3
    weights = {-2: 1 / 12, -1: -2 / 3, 1: 2 / 3, 2: -1 / 12}
    columns = [sum(w * function(q + k * step * axis) for k, w in weights.items()) / step for axis in np.eye(3)]
    return np.stack(columns, axis=-1)


def truth_of(arm: arm3r.Arm, q: np.ndarray, qd: np.ndarray) -> dict[str, Any]:
    """What the library says, by the names of the page."""
    centres, geometric = differences(arm.centres, q), arm.geometric_jacobian(q)
    return {
        "c_2": arm.centres(q)[1],
        "c_3": arm.centres(q)[2],
        "x": arm.tip_position(q),
        "J": arm.jacobian(q),
        "J_{c2}": centres[1],
        "J_{c3}": centres[2],
        "J_{w2}": geometric[3:] * [1, 1, 0],
        "J_{w3}": geometric[3:],
        "M": arm.mass_matrix(q),
        "C": arm.coriolis_matrix(q, qd),
        "U": arm.energy(q, qd)[1],
        r"\tau_g": arm.gravity_torque(q),
    }


def state_of(numbers: dict[str, float]) -> tuple[np.ndarray, np.ndarray]:
    return tuple(np.array([numbers[name % i] for i in (1, 2, 3)]) for name in ("q_%d", r"\dot{q}_%d"))


def assert_near(values: Any, truth: Any, what: str) -> None:
    scale = max(1.0, np.abs(truth).max())
    assert np.abs(values - truth).max() < 1e-9 * scale, f"{what}: {values}, the library says {truth}"


@pytest.mark.gate
@pytest.mark.gate
def test_the_page_is_what_the_script_writes(derivation: ModuleType) -> None:
    assert derivation.PAGE.read_text() == derivation.page(), "`python tools/derivation.py` writes the page"


@pytest.mark.sample(1)
@pytest.mark.parametrize("convention", ["simscape", "slide"])
def test_every_formula_is_the_librarys(derivation: ModuleType, convention: str) -> None:
    """Evaluated from the top of the page to its foot, at random arms and states."""
    rng = np.random.default_rng(sample_seed())
    for _ in range(ARMS):
        numbers = random_numbers(rng)
        q, qd = state_of(numbers)
        values = derivation.evaluate(convention, numbers)
        truth = truth_of(arm_of(numbers, convention, carries=False), q, qd)
        for name, value in truth.items():
            assert_near(values[name], value, f"{convention}, {numbers}, {name}")
        assert_near(values["M_1"] + values["M_2"] + values["M_3"], truth["M"], "M, link by link")
        assert_near(values["R_2"][:, 2], truth["J_{w2}"][:, 1], "the axis of joint 2")
        elbow = truth["x"] - numbers["a_3"] * values["R_3"][:, 0]
        assert_near(values["R_2"][:, 0] * numbers["a_2"] + [0, 0, numbers["d_1"]], elbow, "the elbow")
        for frame in (values["R_2"], values["R_3"]):
            assert_near(np.cross(frame[:, 2], frame[:, 0]), frame[:, 1], "a right-handed frame")


@pytest.mark.sample(1)
@pytest.mark.parametrize("convention", ["simscape", "slide"])
def test_payload_and_rotors_are_the_librarys(derivation: ModuleType, convention: str) -> None:
    """The primed numbers in the place of those without."""
    rng = np.random.default_rng(sample_seed() + 1)
    for _ in range(ARMS):
        numbers = random_numbers(rng)
        q, qd = state_of(numbers)
        before = derivation.evaluate(convention, numbers)
        primed = {name[:-1]: before[name] for name in before if name.endswith("'") and name != "M'"}
        values = derivation.evaluate(convention, numbers | primed)
        truth = truth_of(arm_of(numbers, convention, carries=True), q, qd)
        for name, of_values in {"M": "M'", "C": "C", "U": "U", r"\tau_g": r"\tau_g"}.items():
            assert_near(values[of_values], truth[name], f"{convention}, {numbers}, {name}")


def test_every_formula_is_compared(derivation: ModuleType) -> None:
    """Each name of the page is compared itself, or stands in a formula that is."""
    for convention in derivation.TURNS:
        formulas = derivation.chain(convention)
        used = {str(symbol) for formula in formulas for symbol in formula.value.free_symbols}
        compared = {*truth_of(arm3r.Arm(), np.ones(3), np.ones(3)), "M'", "M_1", "M_2", "M_3", "R_2", "R_3"}
        primed = {"m_3'", "l_3'", "I_{y3}'", "I_{z3}'"}
        assert {formula.name for formula in formulas} <= used | compared | primed


@pytest.mark.parametrize("convention", ["simscape", "slide"])
def test_the_numbers_to_compare_with_are_those_of_the_scenario(derivation: ModuleType, convention: str) -> None:
    (block,) = (block for block in blocks_of(derivation.PAGE.read_text()) if block.language == "yaml")
    scenario = arm3r.Scenario(block.text)
    scenario["arm.convention"] = convention
    values = derivation.evaluate(convention, derivation.EXAMPLE)
    truth = truth_of(scenario.arm, *state_of(derivation.EXAMPLE))
    for name, value in truth.items():
        assert_near(values[name], value, name)
