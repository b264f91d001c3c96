"""Formulas that leave something of the arm out, or take its links for rods: the cause is named, in every kind."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.verify.functions import formula_verdict

BOTH = """\
  payload: {mass: 0.4}
  armature: [0.02, 0.03, 0.01]
  damping: [0.4, 0.3, 0.2]
  friction: [0.3, 0.5, 0.2]
  friction_velocity: 0.1
"""
PLANAR = f"""\
format: 1
arm:
{BOTH}  base_height: 0.3
  link1: {{inertia_axial: 0.03}}
  link2: {{length: 0.9, section: [0.08, 0.08]}}
  link3: {{length: 0.7, section: [0.06, 0.06]}}
"""
ELBOW = f"""\
format: 1
arm:
{BOTH}  model: elbow
  shoulder_offset: 0.1
  link1: {{mass: 3, com: [0.02, 0.1, 0.01], inertia: [0.03, 0.04, 0.05, 0.001, 0.002, 0.003]}}
  link2: {{length: 0.9, offset: 0.05, mass: 2, com: [0.4, 0.02, 0.03], inertia: [0.01, 0.2, 0.21, 0.001, 0.002, 0.003]}}
  link3: {{mass: 1.2, tip: [0.7, 0.01, 0.02], com: [0.3, 0.01, 0.02], inertia: [0.01, 0.1, 0.11, 0.001, 0.002, 0.003]}}
  rotor2: {{inertia: 1.0e-4, ratio: 60}}
  rotor3: {{inertia: 1.0e-4, ratio: 80}}
"""
MASSES, INERTIAS, ALL = {"gravity", "mass", "inverse"}, {"mass", "inverse"}, {"inverse"}
LEFT_OUT: dict[str, tuple[dict[str, object], set[str]]] = {
    "the height of joint 2 above the base frame is left out": ({"arm.base_height": 0.0}, {"kinematics"}),
    "the payload is left out": ({"arm.payload.mass": 0.0}, MASSES),
    "the armature is left out": ({"arm.armature": [0.0] * 3}, INERTIAS),
    "the rotors are left out": ({"arm.rotor2.inertia": 0.0, "arm.rotor3.inertia": 0.0}, INERTIAS),
    "the damping is left out": ({"arm.damping": [0.0] * 3}, ALL),
    "the friction is left out": ({"arm.friction": [0.0] * 3}, ALL),
    "the inertia of link 1 about its axis is left out": ({"arm.link1.inertia_axial": 1e-9}, INERTIAS),
}
METHODS = {
    "kinematics": "tip_position",
    "gravity": "gravity_torque",
    "mass": "mass_matrix",
    "inverse": "inverse_dynamics",
}
CASES = [
    (text, kind, words)
    for text in (PLANAR, ELBOW)
    for words, (changes, kinds) in LEFT_OUT.items()
    for kind in sorted(kinds)
    if all(key in arm3r.Scenario(text) and np.any(arm3r.Scenario(text)[key]) for key in changes)
]


def formula_of(scenario: arm3r.Scenario, kind: str) -> Callable[..., np.ndarray]:
    method = getattr(scenario.arm, METHODS[kind])
    return {
        "kinematics": lambda q: method(q),
        "gravity": lambda q: method(q),
        "mass": lambda q: method(q),
        "inverse": lambda q, qd, qdd: method(q, qd, qdd),
    }[kind]


@pytest.mark.parametrize(("text", "kind", "words"), CASES)
def test_what_is_left_out_is_named(text: str, kind: str, words: str) -> None:
    scenario = arm3r.Scenario(text)
    verify = getattr(arm3r.verify, kind)
    assert verify(formula_of(scenario, kind), arm=scenario).ok
    other = scenario.copy()
    for key, value in LEFT_OUT[words][0].items():
        other[key] = value
    verdict = verify(formula_of(other, kind), arm=scenario)
    assert {one.cause for one in verdict.findings} == {f"{words[0].upper()}{words[1:]}."}, str(verdict)


def test_both_arms_have_cases_of_all_that_they_can_leave_out() -> None:
    assert {words for _, _, words in CASES} == set(LEFT_OUT)
    assert len(CASES) == 19


NO_ARM_WITHOUT = {  # links without width may point up: without the armature, or the width of link 2, M11 falls to 0
    "planar": """
  link1: {inertia_axial: 0}
  armature: [0.1, 0.1, 0.1]
  link2: {shape: slender, length: 0.9, mass: 1.2}
  link3: {shape: slender, length: 0.7, mass: 0.8}
""",
    "one width": """
  link1: {inertia_axial: 0}
  link2: {length: 0.9, mass: 1.2, section: [0.05, 0.05]}
  link3: {shape: slender, length: 0.7, mass: 0.8}
""",
    "elbow": """
  model: elbow
  armature: [0.1, 0.1, 0.1]
  link1: {mass: 0, com: [0, 0, 0], inertia: [0, 0, 0, 0, 0, 0]}
  link2: {length: 0.9, mass: 1.2, com: [0.45, 0, 0], inertia: [0, 0.08, 0.08, 0, 0, 0]}
  link3: {mass: 0.8, tip: [0.7, 0, 0], com: [0.35, 0, 0], inertia: [0, 0.03, 0.03, 0, 0, 0]}
""",
}


@pytest.mark.parametrize("name", NO_ARM_WITHOUT)
def test_what_no_arm_is_without_is_no_cause(name: str) -> None:
    scenario = arm3r.Scenario(f"format: 1\narm:{NO_ARM_WITHOUT[name]}")
    mass = scenario.arm.mass_matrix
    formula = (lambda q: mass(q) + 2 * np.eye(3)) if name == "elbow" else (lambda q, m2: mass(q) + m2 * np.eye(3))
    verdict = arm3r.verify.mass(formula, arm=scenario)
    assert not verdict.ok and not any("left out" in one.cause for one in verdict.findings), str(verdict)


RODS = """import numpy as np


def dynamics(q, qd, m2=1.3, m3=0.8, l2=0.9, l3=0.7, g=9.80665):
    c2, s2, c3, s3 = np.cos(q[1]), np.sin(q[1]), np.cos(q[2]), np.sin(q[2])
    c23, s23 = np.cos(q[1] + q[2]), np.sin(q[1] + q[2])
    I2, I3, r = m2*l2**2/12, m3*l3**2/12, l2*c2 + l3/2*c23
    M = np.zeros((3, 3))
    M[0, 0] = AXIAL + (m2*l2**2/4 + I2)*c2**2 + m3*r**2 + I3*c23**2
    M[1, 1] = m2*l2**2/4 + I2 + m3*(l2**2 + l3**2/4 + l2*l3*c3) + I3
    M[1, 2] = M[2, 1] = m3*(l3**2/4 + l2*l3*c3/2) + I3
    M[2, 2] = m3*l3**2/4 + I3
    h = m3*l2*l3*s3/2
    b = -m3*r*l3*s23 - 2*I3*c23*s23
    a = -2*(m2*l2**2/4 + I2)*c2*s2 - 2*m3*r*l2*s2 + b
    C = np.array([[(a*qd[1] + b*qd[2])/2, a*qd[0]/2, b*qd[0]/2],
                  [-a*qd[0]/2, -h*qd[2], -h*(qd[1] + qd[2])],
                  [-b*qd[0]/2, h*qd[1], 0]])
    return M, C
"""
BRICKS = """\
format: 1
arm:
  link1: {inertia_axial: 0.03}
  link2: {length: 0.9, mass: 1.3, section: [0.05, 0.05]}
  link3: {length: 0.7, mass: 0.8, section: [0.04, 0.04]}
"""
SLENDER = BRICKS.replace("section: [0.05, 0.05]", "shape: slender").replace("section: [0.04, 0.04]", "shape: slender")


@pytest.mark.sample(1)
@pytest.mark.parametrize("kind", ["mass", "coriolis"])
@pytest.mark.parametrize("axial", ["0.03", "0"])
def test_links_that_are_taken_for_rods_are_named(kind: str, axial: str, tmp_path: Path) -> None:
    """What most textbooks write, M = m l^2/3 and so on, of an arm whose links have a width."""
    path = tmp_path / "dynamics.py"
    path.write_text(RODS.replace("AXIAL", axial))
    sees_link1 = kind == "mass" and axial == "0"
    assert formula_verdict(path, arm=arm3r.Scenario(SLENDER), kind=kind).ok is not sees_link1
    verdict = formula_verdict(path, arm=arm3r.Scenario(BRICKS), kind=kind)
    rods = "Links 2 and 3 are slender rods; the arm's have a width (`shape: slender` makes them rods)"
    more = ", and the inertia of link 1 about its axis is left out" if sees_link1 else ""
    assert {one.cause for one in verdict.findings} == {f"{rods}{more}."}, str(verdict)
    assert not verdict.alternatives
