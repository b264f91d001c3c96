"""Mistakes of understanding have a name: one sentence, first, for all entries that it explains, beside the edit."""

from __future__ import annotations

from pathlib import Path

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp import verify
from elbow_arms import WITH_OFFSETS, scenario_of
from formulas.outcomes import NUMBERS, arm_of

HEAD = """
import numpy as np
from numpy import cos, sin
a2, a3, l2, l3, m2, m3 = {a2}, {a3}, {l2}, {l3}, {m2}, {m3}
I2, I3, x2, x3, d1 = {I2}, {I3}, {axial2}, {axial3}, {d1}
""".format(**NUMBERS["unequal"])
GRAVITY = """
def gravity(q, g=9.80665):
    c2, c23 = cos(q[1]), cos(q[1] + q[2])
    return [0, m2*g*l2*c2 + m3*g*(a2*c2 + l3*c23), m3*g*l3*c23]
"""
MASS = """
def mass(q):
    c2, s2, c23, s23, c3 = cos(q[1]), sin(q[1]), cos(q[1] + q[2]), sin(q[1] + q[2]), cos(q[2])
    M11 = m2*l2**2*c2**2 + m3*(a2**2*c2**2 + 2*a2*l3*c2*c23 + l3**2*c23**2)
    M11 += I2*c2**2 + I3*c23**2 + x2*s2**2 + x3*s23**2 + 0.0
    M22 = I2 + m2*l2**2 + I3 + m3*l3**2 + m3*(a2**2 + 2*a2*l3*c3)
    M23 = I3 + m3*l3**2 + m3*a2*l3*c3
    return np.array([[M11, 0, 0], [0, M22, M23], [0, M23, I3 + m3*l3**2]])
"""
CORIOLIS = (
    MASS
    + """
def coriolis(q, qd):
    h = 1e-20
    D = np.array([mass(q + 1j*h*e).imag/h for e in np.eye(3)])
    C = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for k in range(3):
                C[i, j] += 0.5*(D[k][i, j] + D[j][i, k] - D[i][j, k])*qd[k]
    return C @ qd
"""
)
JACOBIAN = """
def jacobian(q):
    u, k = np.array([cos(q[0]), sin(q[0]), 0]), np.array([0, 0, 1.0])
    z = np.cross(u, k)
    o2 = d1*k
    o3 = o2 + a2*(cos(q[1])*u + sin(q[1])*k)
    p = o3 + a3*(cos(q[1] + q[2])*u + sin(q[1] + q[2])*k)
    return np.column_stack([np.cross(k, p), np.cross(z, p - o2), np.cross(z, p - o3)])
"""
TEXTS = {"gravity": GRAVITY, "mass": MASS, "coriolis": CORIOLIS, "jacobian": JACOBIAN}
CASES: list[tuple[str, list[tuple[str, str]], str]] = [
    ("gravity", [("l2*c2", "a2*c2"), ("l3*c23", "a3*c23")],
     "the centres of mass of links 2 and 3 are taken at the links' ends"),
    ("gravity", [("l2*c2", "a2/2*c2")], "the centre of mass of link 2 is taken at the link's middle"),
    ("gravity", [("l3*c23", "a3/2*c23")], "the centre of mass of link 3 is taken at the link's middle"),
    ("gravity", [("l3*c23", "l2*c23")], "the centre of mass of link 2 stands in the place of that of link 3"),
    ("gravity", [("m3*g*l3*c23]", "m3*g*(a2*c2 + l3*c23)]")],
     "the third moment is taken about joint 2; it should be about joint 3"),
    ("gravity", [("m2*g*l2*c2 + ", "")], "the mass m2 is missing"),
    ("gravity", [("cos(q[1] + q[2])", "cos(q[1])")], "q3 is left out of all angles: link 3 turns with link 2"),
    ("mass", [("I3 + m3*l3**2", "I3 + 2*m3*l3**2"), ("l3**2*c23**2", "2*l3**2*c23**2")],
     "the parallel-axis term m l^2 is counted twice: the inertia of link 3 is about the joint already"),
    ("mass", [("I3 + m3*l3**2", "I3"), ("+ l3**2*c23**2", "")],
     "the parallel-axis term m l^2 is missing: the inertia of link 3 is about the centre of mass"),
    ("mass", [("m2*l2**2*c2**2 + ", ""), ("m2*l2**2 + ", ""), ("I3 + m3*l3**2", "I3"), ("+ l3**2*c23**2", "")],
     "the parallel-axis term m l^2 is missing: the inertias are about the centres of mass"),
    ("mass", [("l2**2", "a2**2/4")], "the centre of mass of link 2 is taken at the link's middle"),
    ("coriolis", [("- D[i][j, k]", "+ D[i][j, k]")],
     "the Christoffel symbols have other indices or signs: the result is dM/dt qd + 1/2 d(qd^T M qd)/dq; "
     "it should be dM/dt qd - 1/2 d(qd^T M qd)/dq"),
    ("coriolis", [("- D[i][j, k]", "- D[j][i, k]")],
     "the Christoffel symbols have other indices or signs: the result is 1/2 dM/dt qd; "
     "it should be dM/dt qd - 1/2 d(qd^T M qd)/dq"),
    ("coriolis", [("+ D[j][i, k] - D[i][j, k]", "+ D[i][j, k] - D[j][i, k]")],
     "the Christoffel symbols have other indices or signs: the result is 1/2 d(qd^T M qd)/dq; "
     "it should be dM/dt qd - 1/2 d(qd^T M qd)/dq"),
    ("jacobian", [("np.cross(z, p - o3)", "np.cross(z, p)")],
     "the lever of column 3 begins at the base's origin; it should begin at joint 3"),
    ("jacobian", [("p - o2", "p"), ("p - o3", "p")],
     "the levers of columns 2 and 3 begin at the base's origin; they should begin at their joints"),
    ("jacobian", [("p - o3", "p - o2")], "the lever of column 3 begins at joint 2; it should begin at joint 3"),
    ("jacobian", [("p - o2", "p - o3")], "the lever of column 2 begins at joint 3; it should begin at joint 2"),
    ("jacobian", [("p = o3 + a3*(", "p = o3 + l3*(")],
     "the point is the centre of mass of link 3; it should be the tip"),
    ("jacobian", [("q[1] + q[2]", "q[1]")], "q3 is left out of all angles: link 3 turns with link 2"),
]  # fmt: skip


def own_arm() -> arm3r.Scenario:
    """That of the texts: link 1 has no inertia."""
    scenario = arm_of("unequal", "slide").copy()
    scenario["arm.link1.inertia_axial"] = 0.0
    return scenario


def text_of(kind: str, changes: list[tuple[str, str]]) -> str:
    text = TEXTS[kind]
    for old, new in changes:
        assert old in text, (kind, old)
        text = text.replace(old, new)
    return HEAD + text


@pytest.mark.parametrize("kind", TEXTS)
def test_the_formulas_are_right_before_they_are_changed(kind: str, tmp_path: Path) -> None:
    (tmp_path / "own.py").write_text(text_of(kind, []))
    assert verify.formula_verdict(tmp_path / "own.py", kind, own_arm()).ok


SLOW = ("coriolis",)
"""The kinds whose edits take ten seconds to try."""
PARAMETERS = [pytest.param(*case, marks=[pytest.mark.gate] * (case[0] in SLOW), id=case[2][:60]) for case in CASES]


@pytest.mark.sample(3)
@pytest.mark.parametrize(("kind", "changes", "words"), PARAMETERS)
def test_a_mistake_of_understanding_has_its_name(
    kind: str, changes: list[tuple[str, str]], words: str, tmp_path: Path
) -> None:
    file = tmp_path / "own.py"
    file.write_text(text_of(kind, changes))
    verdict = verify.formula_verdict(file, kind, own_arm())
    assert not verdict.ok and verdict.findings
    sentence = words if words[1].isdigit() else words[0].upper() + words[1:]
    assert {finding.cause for finding in verdict.findings} == {f"{sentence}."}, str(verdict)
    lines = str(verdict).split("\n")
    assert words in lines[1] and not any(words in line for line in lines[2:]), str(verdict)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("l2", "0.4", "0.4 is the link's middle"),
        ("l2", "0.8", "0.8 is the link's end"),
        ("l3", "0.37", "0.37 is that of link 2"),
        ("m2", "2.1", "2.1 is that of link 3"),
        ("I3", repr(0.043 + 2.1 * 0.21**2), "is its inertia about the joint, with m l^2"),
    ],
)
def test_a_number_of_something_else_has_its_name(name: str, value: str, words: str, tmp_path: Path) -> None:
    own = NUMBERS["unequal"][name]
    text = text_of("mass", []).replace(f"{own}", value, 1)
    (tmp_path / "own.py").write_text(text)
    verdict = verify.formula_verdict(tmp_path / "own.py", "mass", own_arm())
    assert not verdict.ok and all(words in one.cause and f"{name} is " in one.cause for one in verdict.findings), (
        verdict
    )


def test_a_length_far_below_the_arms_is_judged(tmp_path: Path) -> None:
    """The inertia that follows a length stays that of a body: else the arm itself is refused."""
    (tmp_path / "own.py").write_text(text_of("jacobian", []).replace("0.55", "0.1", 1))
    verdict = verify.formula_verdict(tmp_path / "own.py", "jacobian", own_arm())
    assert "a3 is 0.1" in str(verdict)


def test_mistakes_of_one_link_of_an_elbow_arm_have_their_names() -> None:
    """Its numbers are not varied: its links are changed one by one."""
    link = WITH_OFFSETS["link2"]
    x, y, z = link["com"]
    shift = link["mass"] * np.array([y * y + z * z, x * x + z * z, x * x + y * y, -x * y, -x * z, -y * z])
    end = [link["length"], 0, link["offset"]]
    for change, words in (
        ({"inertia": (link["inertia"] + shift).tolist()}, "counted twice: the inertia of link 2 is about the joint"),
        ({"com": end}, "centre of mass of link 2 is taken at the link's end"),
        ({"com": (np.array(end) / 2).tolist()}, "centre of mass of link 2 is taken at the link's middle"),
    ):
        other = scenario_of({**WITH_OFFSETS, "link2": {**link, **change}}).arm
        verdict = verify.mass(lambda q, other=other: other.mass_matrix(q), scenario_of(WITH_OFFSETS))
        assert not verdict.ok and all(words in one.cause for one in verdict.findings), str(verdict)


# ---- of the whole: functions without a text --------------------------------------------------------------------------


WHOLE = {
    "q2 is taken 90 degrees too large: it counts from another direction": lambda arm, q: arm.jacobian(
        np.add(q, [0, np.pi / 2, 0])
    ),
    "q3 is taken 90 degrees too small: it counts from another direction": lambda arm, q: arm.jacobian(
        np.add(q, [0, 0, -np.pi / 2])
    ),
    "q1 is taken 180 degrees off: it counts from the opposite direction": lambda arm, q: arm.jacobian(
        np.add(q, [np.pi, 0, 0])
    ),
    "q2 is taken half as large as it is": lambda arm, q: arm.jacobian(q * [1, 0.5, 1]),
    "q3 is taken twice as large as it is": lambda arm, q: arm.jacobian(q * [1, 1, 2]),
    "the matrix is the inverse of what it should be": lambda arm, q: np.linalg.inv(arm.jacobian(q)),
    "the result is pi/180 times what it should be: per degree?": lambda arm, q: np.deg2rad(arm.jacobian(q)),
}


@pytest.mark.parametrize("words", WHOLE)
def test_a_mistake_of_the_whole_is_named_without_a_text(words: str) -> None:
    scenario = arm_of("unequal", "simscape")
    verdict = verify.jacobian(lambda q: WHOLE[words](scenario.arm, np.asarray(q)), scenario)
    assert not verdict.ok and f"entries: {words}" in str(verdict), str(verdict)


def test_rows_in_the_frame_of_a_link_are_named() -> None:
    """A Jacobian of r and z before it is turned by q1 is in a frame that moves with link 1."""
    scenario = arm_of("unequal", "simscape")

    def jacobian(q, joints):
        pitch = sum(q[1:joints])
        c, s, cp, sp = np.cos(q[0]), np.sin(q[0]), np.cos(pitch), np.sin(pitch)
        turned = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ [[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]]
        return turned.T @ scenario.arm.jacobian(q)

    for link in (1, 2):
        verdict = verify.jacobian(lambda q, link=link: jacobian(q, link), scenario)
        assert f"the rows are in a frame that moves with link {link}; they should be in the base frame" in str(verdict)


def test_a_mass_matrix_in_the_place_of_its_inverse_is_named() -> None:
    scenario = arm_of("unequal", "simscape")
    arm = scenario.arm

    def forward(q, qd, tau):
        return arm.mass_matrix(q) @ (tau - arm.velocity_product(q, qd) - arm.gravity_torque(q))

    words = "the result is multiplied by the mass matrix; it should be by its inverse"
    assert f"qdd1, qdd2, qdd3: {words}" in str(verify.forward(forward, scenario))


def test_the_sign_of_the_result_is_named_before_that_of_all_angles() -> None:
    """Both are so of velocity products, which are odd."""
    scenario = arm_of("unequal", "simscape")
    verdict = verify.coriolis(lambda q, qd: -scenario.arm.velocity_product(q, qd), scenario)
    assert "h1, h2, h3: the result has the wrong sign" in str(verdict)
    assert "also possible: all joint angles have the wrong sign" in str(verdict)
