"""Verdicts on formulas of arms of every shape (rods, bricks, cylinders, explicit inertias), and on C sources."""

from __future__ import annotations

import warnings
from pathlib import Path

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.commands import verify as verify_cli
from arm3r_cpp.verify.functions import formula_verdict
from random_scenarios import sample_seed

MASS = """import numpy as np
a2, a3, m2, m3 = {a2}, {a3}, {m2}, {m3}
I1, I2, I3 = {I1}, {I2}, {I3}
X2, X3 = {X2}, {X3}
def mass_matrix(q):
    l2, l3 = a2 / 2, a3 / 2
    c2, s2, c23, s23, c3 = np.cos(q[1]), np.sin(q[1]), np.cos(q[1] + q[2]), np.sin(q[1] + q[2]), np.cos(q[2])
    m11 = I1 + X2 * s2**2 + X3 * s23**2 + (I2 + m2 * l2**2) * c2**2 + I3 * c23**2 + m3 * (a2 * c2 + l3 * c23)**2
    m22 = I2 + m2 * l2**2 + I3 + m3 * (a2**2 + l3**2 + 2 * a2 * l3 * c3)
    m23 = I3 + m3 * (l3**2 + a2 * l3 * c3)
    return np.array([[m11, 0, 0], [0, m22, m23], [0, m23, I3 + m3 * l3**2]])
"""


def link(shape: str, length: float, mass: float, width: float) -> tuple[str, float, float]:
    """The keys of a link, its inertia across and that about its own axis."""
    rod = mass * length**2 / 12
    if shape == "slender":
        return f"{{shape: slender, length: {length}, mass: {mass}}}", rod, 0.0
    if shape == "brick":
        square = f"section: [{width}, {width}]"
        return (
            f"{{shape: brick, length: {length}, mass: {mass}, {square}}}",
            rod + mass * width**2 / 12,
            (mass * width**2 / 6),
        )
    if shape == "cylinder":
        across, axial = rod + mass * width**2 / 4, mass * width**2 / 2
        return f"{{shape: cylinder, length: {length}, mass: {mass}, radius: {width}}}", across, axial
    across, axial = 1.1 * rod, 0.3 * rod
    own = f"com: {length / 2}, inertia: [{axial}, {across}, {across}]"
    return f"{{length: {length}, mass: {mass}, {own}}}", across, axial


@pytest.mark.sample(1)
@pytest.mark.parametrize("shape", ["slender", "brick", "cylinder", "explicit"])
def test_a_right_mass_matrix_is_right_whatever_the_shape_of_the_links(shape: str, tmp_path: Path) -> None:
    rng = np.random.default_rng(sample_seed())
    a2, a3, m2, m3, width2, width3 = (round(float(x), 4) for x in rng.uniform(0.5, 1.5, 6) * [1, 1, 2, 2, 0.2, 0.2])
    (link2, I2, X2), (link3, I3, X3) = link(shape, a2, m2, width2), link(shape, a3, m3, width3)
    scenario = f"format: 1\narm:\n  link1: {{inertia_axial: 0.03}}\n  link2: {link2}\n  link3: {link3}\n"
    numbers = {"a2": a2, "a3": a3, "m2": m2, "m3": m3, "I1": 0.03, "I2": I2, "I3": I3, "X2": X2, "X3": X3}
    program = tmp_path / "mass.py"
    program.write_text(MASS.format(**numbers))
    right = formula_verdict(program, arm=arm3r.Scenario(scenario))
    assert right.ok, f"{scenario}{numbers}\n{right}"
    program.write_text(MASS.format(**{**numbers, "I3": 1.2 * I3}))
    assert not formula_verdict(program, arm=arm3r.Scenario(scenario)).ok


def test_a_c_source_is_not_judged_but_says_how_to_compile_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source = tmp_path / "gravity.c"
    source.write_text("void gravity(const double *q, double *out) { out[0] = 0; }\n")
    assert verify_cli.main([str(source)]) == 12
    said = capsys.readouterr().err
    assert "cc -shared -fPIC" in said and "gravity.so:FUNCTION" in said and len(said.splitlines()) == 1


def test_a_controller_is_judged_without_warnings_of_states_that_nobody_chose(tmp_path: Path) -> None:
    scenario, law = tmp_path / "pd.yaml", tmp_path / "controller.py"
    scenario.write_text("format: 1\ncontroller: {type: stiffness}\n")
    law.write_text("def controller(q, qd):\n    return [0.0, 0.0, 0.0]\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error", arm3r.ScenarioWarning)
        assert not formula_verdict(law, "controller", scenario).ok


HOLDS = "{format: 1, initial: {q: [0.1, -0.5, 1.0]}, controller: GAINS}"
LAW = """import numpy as np


def controller(q, qd):
    error = np.array([0.1, -0.5, 1.0]) - q
    t3 = -0.785*9.80665*0.5*np.cos(q[1] + q[2])
    return np.array(STIFFNESS)*error - np.array(DAMPING)*qd + [0, t3 - 0.785*9.80665*1.5*np.cos(q[1]), t3]
"""


GAINS = "{type: joint_pd, joint_stiffness: [60, 50, 30], joint_damping: [6, 5, 3]}"


@pytest.mark.parametrize("reference", ["{type: hold}", "{type: minimum_jerk, q: [0.2, 0.1, 0.4], duration: 1}"])
def test_a_reference_that_begins_at_the_start_stays_there(reference: str, tmp_path: Path) -> None:
    text = HOLDS.replace("GAINS", f"{GAINS}, reference: {reference}")
    (tmp_path / "pd.yaml").write_text(text)
    text = LAW.replace("STIFFNESS", "[60, 50, 30]")
    (tmp_path / "pd.py").write_text(text.replace("DAMPING", "[6, 5, 3]"))
    verdict = arm3r.verify.controller(tmp_path / "pd.py", tmp_path / "pd.yaml")
    assert verdict.ok, str(verdict)
    (tmp_path / "pd.py").write_text(text.replace("DAMPING", "[6, 5, 4]"))
    verdict = arm3r.verify.controller(tmp_path / "pd.py", tmp_path / "pd.yaml")
    assert [one.entry for one in verdict.findings] == [[3]], str(verdict)


def test_a_reference_that_moves_at_once_is_not_judged(tmp_path: Path) -> None:
    moving = "{type: sinusoid, q_amplitude: [0.1, 0, 0], frequency: 1}"
    (tmp_path / "pd.yaml").write_text(HOLDS.replace("GAINS", f"{GAINS}, reference: {moving}"))
    (tmp_path / "pd.py").write_text(LAW.replace("STIFFNESS", "[60, 50, 30]").replace("DAMPING", "[6, 5, 3]"))
    with pytest.raises(arm3r.UnjudgedError, match="the reference `sinusoid` moves from where the arm starts"):
        arm3r.verify.controller(tmp_path / "pd.py", tmp_path / "pd.yaml")
