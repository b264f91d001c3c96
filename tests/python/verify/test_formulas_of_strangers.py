"""Formulas of other arms, as strangers write them: what is said of one mistake in them, and what is not."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from arm3r_cpp import UsageError, verify
from arm3r_cpp.commands.verify import main
from arm3r_cpp.verify.explain import budget
from arm3r_cpp.verify.functions import Chain, formula_verdict
from arm3r_cpp.verify.kinds import kind_of_name

HEAD = "standard\ntype,a,alpha,d,theta,mass,cx,cy,cz,Ixx,Iyy,Izz\n"
PLANAR = (
    HEAD + "R,0.5,0,0,0,3,-0.25,0,0,0,0,0.06\nR,0.4,0,0,0,2,-0.2,0,0,0,0,0.03\nR,0.2,0,0,0,0.8,-0.1,0,0,0,0,0.003\n"
)
CYLINDRICAL = HEAD + (
    "R,0,0,0.3,0,5,0,0,-0.1,0.05,0.05,0.03\n"
    "P,0,-pi/2,0.2,0,3,0,0.05,0,0.02,0.015,0.02\n"
    "P,0,0,0.1,0,1.5,0,0,-0.15,0.012,0.012,0.001\n"
)
PUMA = HEAD + (
    "R,0,-pi/2,0.6,0,10,0,0.2,0,0.3,0.05,0.31\n"
    "R,0.43,0,0.15,0,17.4,-0.36,0.006,0.0775,0.13,0.524,0.539\n"
    "R,0.35,0,0,0,4.8,-0.2,0,0.014,0.066,0.086,0.0125\n"
)


@pytest.fixture
def judged(tmp_path: Path) -> Any:
    """The verdict on a text, by the chain of a table."""

    def judge(name: str, text: str, table: str, kind: str | None = None, **placed: Any) -> verify.Verdict:
        (tmp_path / "arm.csv").write_text(table)
        file = tmp_path / name.partition(":")[0]
        file.write_text(text)
        path = f"{file}{name[len(file.name) :]}"
        return formula_verdict(path, kind, Chain.from_dh(tmp_path / "arm.csv").placed(**placed))

    return judge


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        *((one, "jacobian") for one in ("hand_jacobian", "world_jacobian", "end_jac", "stanfordJacobian", "jac_d")),
        *((one, "jacobian_dot") for one in ("d_jacobian", "djac", "my_djac", "robot_d_jac", "jacobian_dot", "Jdot")),
    ],
)
def test_a_word_that_ends_with_d_is_no_derivative(name: str, kind: str) -> None:
    assert kind_of_name(name) == kind


def test_terms_that_take_too_long_are_not_read(judged: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(budget, "SECONDS_READING", 0.0)
    text = "import numpy as np\ndef gravity(q):\n    return np.array([np.sin(q[0]), q[1]**7, np.exp(q[2])])\n"
    assert "its terms take too long to be read" in str(judged("g.py", text, PUMA))


# ---- letters ---------------------------------------------------------------------------------------------------------

COLUMN = """function B = mass(q)
rho = q(3) + 0.1 - 0.15;
B = [0.046 + 0.02 + 1.5*rho^2, 0, 0; 0, 4.5, 0; 0, 0, 1.5];
end
"""


def test_a_number_that_is_a_length_by_chance_has_no_letter(judged: Any) -> None:
    verdict = judged("mass.m", COLUMN, CYLINDRICAL)  # 2 * 1.5 * (0.1 - 0.15) is -d1/2
    (finding,) = verdict.findings
    assert "d1" not in f"{finding.reads} {finding.due}" and "3/20 q3" in str(finding.due), str(verdict)


JACOBIAN = """import numpy as np
L = np.array([0.5, 0.4, 0.2])
def jacobian(q):
    a = np.cumsum(q)
    J = np.ones((3, 3))
    for j in range(3):
        J[0, j] = -np.sum(L[j:]*np.sin(a[j:]))
        J[1, j] = np.sum(L[j:]*np.cos(a[j:]))
    J[1, 2] = 0.4*np.cos(a[2])
    return J
"""


def test_lengths_that_a_term_has_keep_their_letters(judged: Any) -> None:
    assert judged("jacobian.py", JACOBIAN, PLANAR).findings[0].due == "a3 C123"


def test_a_letter_that_the_text_gives_to_another_number_is_not_the_tables(judged: Any) -> None:
    verdict = judged("jacobian.py", JACOBIAN.replace("L = ", "a3 = 3.7*2\nL = "), PLANAR)
    assert verdict.findings[0].due == "1/5 C123", str(verdict)


# ---- frames and rows -------------------------------------------------------------------------------------------------

GEOMETRIC = """function J = geomJac(q)
d1 = 0.6; d2 = 0.15; a2 = 0.43; a3 = 0.35;
A1 = dh(q(1), d1, 0, -90); A2 = dh(q(2), d2, a2, 0); A3 = dh(q(3), 0, a3, 0);
T = {eye(4), A1, A1*A2, A1*A2*A3};
pe = T{4}(1:3,4);
J = zeros(6,3);
for k = 1:3
    z = T{k}(1:3,3);
    o = T{k}(1:3,4);
    J(1:3,k) = z;
    J(4:6,k) = cross(z, pe - o);
end
end
function A = dh(th, d, a, al)
A = [cos(th), -sin(th)*cosd(al),  sin(th)*sind(al), a*cos(th);
     sin(th),  cos(th)*cosd(al), -cos(th)*sind(al), a*sin(th);
     0, sind(al), cosd(al), d; 0 0 0 1];
end
"""


def test_one_mistake_beside_angular_rows_first_is_named(judged: Any) -> None:
    words = "the angular rows stand above the linear ones; the linear rows should be first"
    whole = judged("geomJac.m", GEOMETRIC, PUMA, "jacobian")
    assert f"18 entries: {words}." in str(whole)
    verdict = judged(
        "geomJac.m", GEOMETRIC.replace("sind(al), cosd(al), d;", "sind(al), cos(al), d;"), PUMA, "jacobian"
    )
    assert str(verdict).splitlines()[1].strip().startswith(words)
    assert {one.new for one in verdict.findings if one.entry} == {"cosd"}, str(verdict)


SPACE = """import numpy as np
W = np.array([[0, 0, 1], [0, 1, 0], [0, 1, 0]], float)
P = np.array([[0, 0, 0.6], [0, 0.15, 0.6], [0.43, 0.15, 0.6]])
def skew(w):
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
def turn(w, th):
    K = skew(w)
    return np.eye(3) + np.sin(th)*K + (1 - np.cos(th))*K @ K
def space_jacobian(q):
    R, p, J = np.eye(3), np.zeros(3), np.zeros((6, 3))
    for i in range(3):
        w = R @ W[i]
        J[:3, i] = w
        J[3:, i] = np.cross(p + R @ P[i], w)
        p, R = p + R @ (P[i] - turn(W[i], q[i]) @ P[i]), R @ turn(W[i], q[i])
    return J
"""


def test_one_mistake_in_a_space_jacobian_is_judged_in_its_frame(judged: Any) -> None:
    assert judged("s.py:space_jacobian", SPACE, PUMA).ok
    verdict = judged(
        "s.py:space_jacobian", SPACE.replace("np.cross(p + R @ P[i], w)", "np.cross(w, p + R @ P[i])"), PUMA
    )
    assert "a space Jacobian" in str(verdict) and {one.line for one in verdict.findings} == {14}, str(verdict)
    assert all(one.entry[0] > 3 for one in verdict.findings), str(verdict)


def test_a_matrix_that_is_no_transform_is_none(judged: Any) -> None:
    text = "import numpy as np\ndef fk(q):\n    T = np.eye(4)\n    T[3, 3] = 0\n    return T\n"
    assert "last row is not 0 0 0 1" in str(judged("fk.py", text, PLANAR))


def test_a_wrong_angle_of_a_plane_is_an_angle(judged: Any) -> None:
    text = "import numpy as np\nL = np.array([0.5, 0.4, 0.2])\ndef fk(q):\n    a = np.cumsum(q)\n"
    verdict = judged("fk.py", text + "    return np.array([L @ np.cos(a), L @ np.sin(a), q[-1]])\n", PLANAR)
    assert "third row about z" in str(verdict)
    assert sorted(str(verdict.findings[0].due).split(" + ")) == ["q1", "q2", "q3"], str(verdict)


@pytest.mark.parametrize(
    "angle", ["np.arctan2(np.sin(a[2]), np.cos(a[2]))", "(a[2] + np.pi) % (2*np.pi) - np.pi", "a[2]"]
)
def test_an_angle_of_a_plane_is_right_in_any_turn(angle: str, judged: Any) -> None:
    text = "import numpy as np\nL = np.array([0.5, 0.4, 0.2])\ndef fk(q):\n    a = np.cumsum(q)\n"
    assert judged("fk.py", f"{text}    return np.array([L @ np.cos(a), L @ np.sin(a), {angle}])\n", PLANAR).ok


def test_a_rotation_that_is_not_that_of_the_tip_is_not_judged(judged: Any) -> None:
    text = """import numpy as np
L = np.array([0.5, 0.4, 0.2])
def fk(q):
    a, T = np.cumsum(q), np.eye(4)
    c, s = np.cos(a[2]), np.sin(a[2])
    T[:2, :2] = [[c, -s], [s, c]]
    T[:2, 3] = L @ np.cos(a), L @ np.sin(a)
    return T
"""
    words = "its rotation is not that of the tip's frame, and is not judged"
    assert judged("fk.py", text, PLANAR).warnings == []
    assert judged("fk.py", text.replace("[c, -s], [s, c]", "[c, s], [-s, c]"), PLANAR).warnings == [words]


# ---- causes and edits ------------------------------------------------------------------------------------------------


def test_an_edit_that_leaves_nothing_but_zeros_is_none(judged: Any) -> None:
    verdict = judged(
        "geomJac.m", GEOMETRIC.replace("cross(z, pe - o)", "cross(z, pe - o) + 0.1*q(1)*k*z"), PUMA, "jacobian"
    )
    assert not any(one.old == "1:3" for one in verdict.findings), str(verdict)


def test_a_link_without_its_mass_is_named(judged: Any) -> None:
    text = """import numpy as np
def gravity(q):
    a, b, c = np.cos(q[0]), np.cos(q[0] + q[1]), np.cos(q.sum())
    m1, m2, m3, g = 3, MASS, 0.8, 9.81
    t3 = m3*g*0.1*c
    t2 = t3 + (m2*0.2 + m3*0.4)*g*b
    return np.array([t2 + (m1*0.25 + m2*0.5 + m3*0.5)*g*a, t2, t3])
"""
    down = {"gravity": (0, -9.81, 0)}
    assert judged("g.py", text.replace("MASS", "2"), PLANAR, **down).ok
    verdict = judged("g.py", text.replace("MASS", "0"), PLANAR, **down)
    assert "the mass of link 2 is left out" in str(verdict)


def test_what_slides_along_a_link_has_no_middle(judged: Any) -> None:
    verdict = judged("mass.m", COLUMN.replace("0.02 +", "").replace("0.1 - 0.15", "0.1"), CYLINDRICAL)
    assert "middle" not in str(verdict), str(verdict)


def test_transform_and_jacobian_of_one_function_are_both_judged(tmp_path: Path, capsys: Any) -> None:
    (tmp_path / "arm.csv").write_text(PLANAR)
    text = JACOBIAN.replace("def jacobian(q)", "def fk(q)").replace(
        "    return J", "    T = np.eye(4)\n    T[:2, 3] = L @ np.cos(a), L @ np.sin(a)\n    return T, J"
    )
    (tmp_path / "arm.py").write_text(text)
    assert main([str(tmp_path / "arm.py"), "--dh", str(tmp_path / "arm.csv")]) == 11
    out = capsys.readouterr().out
    assert "tip position, its output 1: right" in out and "jacobian, its output 2, third row about z, 1 of 9" in out


def test_an_output_without_a_name_leaves_the_others_theirs(judged: Any) -> None:
    text = "import numpy as np\ndef dynamics(q, qd):\n    M = np.eye(3)\n    G = np.zeros(3)\n    return M, M @ qd, G\n"
    verdict = judged("dynamics.py", text, PLANAR)
    assert verdict.kind == "mass" and verdict.not_judged == {"G": "gravity"}


def test_a_law_beside_a_chain_says_what_to_do(judged: Any) -> None:
    with pytest.raises(UsageError, match="name one by --arm, in the place of a chain"):
        judged("control.py", "def control(q, qd):\n    return -q\n", PLANAR)
