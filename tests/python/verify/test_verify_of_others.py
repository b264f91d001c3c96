"""What people write beside the lecture's way: names that mean another kind, idioms, and numbers that are the arm's."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arm3r_cpp import Scenario, UnjudgedError, UsageError, verify
from arm3r_cpp.commands.verify import main
from arm3r_cpp.verify.functions import formula_verdict
from arm3r_cpp.verify.kinds import KINDS

UNEQUAL = Scenario("""format: 1
arm:
  convention: slide
  link2: {length: 0.45, mass: 3.2, com: 0.2, inertia: [0.004, 0.06, 0.062]}
  link3: {length: 0.38, mass: 1.9, com: 0.15, inertia: [0.002, 0.025, 0.026]}
""")
GRAVITY = "t2 = -0.785*9.80665*1.5*cos(q(2)) - 0.785*9.80665/2*cos(q(2)+q(3));"
LAST = "t3 = -0.785*9.80665/2*cos(q(2)+q(3));"


# ---- which kind ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("output, is_told", [("tau", True), ("T", False)])
def test_an_output_tells_the_kind_with_the_arguments(output: str, is_told: bool, written: Any) -> None:
    torque = f"function {output} = f(q, qd, qdd)\n{output} = [0; qdd(1); 0] + qd(1);\nend\n"
    if is_told:
        assert formula_verdict(written("f.m", torque)).kind == "inverse"
    else:
        with pytest.raises(UsageError, match="not clear"):
            formula_verdict(written("f.m", torque))
    alone = written("f.m", f"function {output} = f(q)\n{LAST} {GRAVITY} {output} = [0; t2; t3];\nend\n")
    if is_told:
        assert formula_verdict(alone).ok and formula_verdict(alone).kind == "gravity"
    else:  # a transform, as often as a torque
        with pytest.raises(UsageError, match="not clear"):
            formula_verdict(alone)


@pytest.mark.parametrize("name", ["inverse_kinematics", "ik", "ik_solver", "kinetic_energy"])
def test_names_of_what_is_no_kind_tell_none(name: str, written: Any) -> None:
    with pytest.raises(UsageError, match="not clear"):
        formula_verdict(written(f"{name}.py", f"def {name}(p):\n    return [p[0], p[1], p[2]]\n"))


@pytest.mark.parametrize("name", ["urdf_fk", "end_effector_pose", "fk_deg", "EndEffector"])
def test_names_of_poses_tell_kinematics(name: str, written: Any) -> None:
    text = f"from math import cos, sin\n\n\ndef {name}(q):\n    r = cos(q[1]) + cos(q[1] + q[2])\n"
    text += "    return [r*cos(q[0]), r*sin(q[0]), -sin(q[1]) - sin(q[1] + q[2])]\n"
    verdict = formula_verdict(written("x.py", text))
    assert verdict.kind == "kinematics" and verdict.ok, str(verdict)


def test_of_several_outputs_those_that_are_left_are_named(written: Any) -> None:
    text = """from math import cos


def dynamics(q, qd):
    M = [[1.0, 0, 0], [0, 1, 0], [0, 0, 1]]
    C = M
    g3 = -0.785*9.80665/2*cos(q[1] + q[2])
    G = [0, g3 - 0.785*9.80665*1.5*cos(q[1]), g3]
    return M, C, G
"""
    verdict = verify.gravity(written("dynamics.py", text))
    assert verdict.ok, str(verdict)
    assert verdict.not_judged == {"M": "mass", "C": "coriolis"}
    assert "note: not judged here: M (--kind mass), C (--kind coriolis)" in str(verdict)


TEXTBOOK = """function [FIRST, C, G] = two_links(q, qd)
m1 = 1.5; m2 = 0.9; l1 = 0.4; lc1 = 0.22; lc2 = 0.13; I1 = 0.02; I2 = 0.01; g = 9.81;
h12 = m2*(lc2^2 + l1*lc2*cos(q(2))) + I2;
FIRST = [m1*lc1^2 + m2*(l1^2 + lc2^2 + 2*l1*lc2*cos(q(2))) + I1 + I2, h12; h12, m2*lc2^2 + I2];
h = m2*l1*lc2*sin(q(2));
C = [-h*qd(2), -h*(qd(1) + qd(2)); h*qd(1), 0];
G = [(m1*lc1 + m2*l1)*g*cos(q(1)) + m2*lc2*g*cos(q(1) + q(2)); m2*lc2*g*cos(q(1) + q(2))];
end
"""


@pytest.mark.parametrize("letter", ["M", "D", "B", "H", "A"])
def test_the_mass_matrix_has_the_letter_of_any_textbook(letter: str, written: Any) -> None:
    table = "standard\ntype,a,alpha,d,theta,mass,cx,cy,cz,Ixx,Iyy,Izz\nR,0.4,0,0,0,1.5,-0.18,0,0,0,0.02,0.02\n"
    rows = written("two_links.csv", f"{table}R,0.3,0,0,0,0.9,-0.17,0,0,0,0.01,0.01\n")
    arm = verify.Chain.from_dh(rows).placed(gravity=(0, -9.81, 0))
    path = written("two_links.m", TEXTBOOK.replace("FIRST", letter))
    for kind, left in {"mass": ("C", "G"), "coriolis": (letter, "G"), "gravity": (letter, "C")}.items():
        verdict = formula_verdict(path, None if kind == "mass" else kind, arm)
        assert verdict.ok and verdict.kind == kind, str(verdict)
        kinds = {letter: "mass", "C": "coriolis", "G": "gravity"}
        assert verdict.not_judged == {name: kinds[name] for name in left}


def test_the_command_judges_all_that_a_function_returns(written: Any, capsys: Any) -> None:
    table = "standard\ntype,a,alpha,d,theta,mass,cx,cy,cz,Ixx,Iyy,Izz\nR,0.4,0,0,0,1.5,-0.18,0,0,0,0.02,0.02\n"
    rows = written("two_links.csv", f"{table}R,0.3,0,0,0,0.9,-0.17,0,0,0,0.01,0.01\n")
    arm = ["--dh", str(rows), "--gravity=0,-9.81,0"]
    text = TEXTBOOK.replace("FIRST", "M")
    right, wrong = written("right.m", text), written("wrong.m", text.replace("h*qd(1), 0]", "2*h*qd(1), 0]"))
    assert main([str(right), *arm]) == 0
    heads = [line for line in capsys.readouterr().out.splitlines() if line.endswith(": right")]
    assert len(heads) == 3 and [word in head for word, head in zip(("M", "C", "G"), heads, strict=True)] == [True] * 3
    assert main([str(wrong), *arm]) == 11
    out = capsys.readouterr().out
    assert "h2 " in out and "1 mistake in 1 file" in out and "not judged here" not in out
    assert main([str(wrong), *arm, "--kind", "gravity"]) == 0
    assert "not judged here: M (--kind mass), C (--kind coriolis)" in capsys.readouterr().out


def test_an_output_that_fails_is_named_and_the_others_are_judged(written: Any, capsys: Any) -> None:
    path = written(
        "terms.m", f"function [C, G, M] = terms(q, qd)\n{LAST} {GRAVITY}\nG = [0; t2; t3]; M = 1; C = 0;\nend\n"
    )
    assert main([str(path)]) == 11
    out = capsys.readouterr().out
    assert (
        "its output C\n  the formula fails: returns 1 number, where" in out
        and "its output G, convention simscape: right" in out
    )
    assert "note: not judged here: M (--kind mass)" in out and "its output M" not in out


@pytest.mark.parametrize(
    ("head", "last", "left"),
    [
        ("gravity(q)", "G = 9.80665*eye(3);", ""),
        ("gravity(q)", "g = 9.80665;", ""),
        ("gravity(q)", "J = 0.1*cos(q);", "J (--kind jacobian)"),
        ("gravity(q, qd)", "C = cos(q);", ""),
    ],
)
def test_what_has_the_letter_of_a_kind_and_is_something_else_is_not_judged(
    head: str, last: str, left: str, written: Any, capsys: Any
) -> None:
    name = last[0]
    text = f"function [tau, {name}] = {head}\n{LAST} {GRAVITY}\ntau = [0; t2; t3]; {last}\nend\n"
    code, out = main([str(written("gravity.m", text))]), capsys.readouterr().out
    assert "gravity torque, its output tau, convention simscape: right" in out
    if name != "C":  # beside a gravity torque it is one of Coriolis
        assert code == 0 and out.count("its output") == 1 and (not left or f"not judged here: {left}" in out)


def test_an_output_that_no_name_tells_is_said_to_be_left(written: Any, capsys: Any) -> None:
    path = written(
        "dynamics.py", "def dynamics(q, qd):\n    M = [[1.0, 0, 0], [0, 1, 0], [0, 0, 1]]\n    return M, 2*qd, M\n"
    )
    main([str(path)])
    assert "not judged here: output 2, which no name tells" in capsys.readouterr().out


def test_other_functions_of_a_file_that_are_formulas_are_named(written: Any, capsys: Any) -> None:
    text = """from math import cos


def fk(q):
    return [0.0, 0.0, 0.0]


def mass_matrix(q):
    return [[1.0, 0, 0], [0, 1, 0], [0, 0, fk(q)[0]]]


def jacobian(q):
    return [[0.0] * 3] * 3


def gravity(q):
    t3 = -0.785*9.80665/2*cos(q[1] + q[2]) + fk(q)[2]
    return [0.0, t3 - 0.785*9.80665*1.5*cos(q[1]), t3]
"""
    path = written("formulas.py", text)
    assert main([str(path)]) == 0
    assert f"note: not judged here: mass_matrix, jacobian ({path}:mass_matrix)" in capsys.readouterr().out
    assert main([f"{path}:gravity"]) == main([str(path), "--kind", "gravity"]) == 0
    assert "not judged" not in capsys.readouterr().out


def test_a_vector_h_beside_gravity_is_no_mass_matrix(written: Any) -> None:
    path = written("terms.m", f"function [h, g] = terms(q, qd)\n{LAST} {GRAVITY} g = [0; t2; t3]; h = 0*q;\nend\n")
    assert formula_verdict(path).kind == "coriolis" and formula_verdict(path, "gravity").ok


# ---- lines that do not go on -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("comment", ["", "  # of link 3"])
@pytest.mark.parametrize("ending", ["py", "m"])
def test_a_line_that_is_not_continued_is_named(ending: str, comment: str, written: Any) -> None:
    if ending == "py":
        text = f"""from math import cos


def gravity(q):
    t3 = -0.785*9.80665/2*cos(q[1] + q[2])
    t2 = -0.785*9.80665*1.5*cos(q[1]){comment}
    + t3
    return [0, t2, t3]
"""
        lines = 7, 6
    else:
        text = f"function t = gravity(q)\n{LAST}\nt2 = -0.785*9.80665*1.5*cos(q(2)){comment.replace('#', '%')}\n"
        text += "   + t3;\nt = [0; t2; t3];\nend\n"
        lines = 4, 3
    verdict = verify.gravity(written(f"gravity.{ending}", text))
    said = (
        f"line {lines[0]} begins with a sign and is a statement of its own, which nothing uses: it does not go on with"
    )
    assert f"{said} line {lines[1]}" in verdict.warnings, str(verdict)
    assert [one.entry for one in verdict.findings] == [[2]]


def test_what_makes_a_function_is_no_formula(written: Any) -> None:
    text = """from math import cos


def gravity(scale):
    def torque(q):
        t3 = -0.785*9.80665/2*scale*cos(q[1] + q[2])
        return [0, t3 - 0.785*9.80665*1.5*scale*cos(q[1]), t3]
    return torque


model = gravity(1.0)
"""
    path = written("model.py", text.replace("gravity(scale)", "gravity(q)").replace("gravity(1.0)", "gravity([1])"))
    with pytest.raises(UnjudgedError, match="returns a function, torque: name an object that the file makes of it"):
        verify.gravity(written("other.py", path.read_text().replace("scale*", "")))
    assert verify.gravity(f"{written('model.py', text)}:model").ok


# ---- numbers ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("numbers", ["a2 = a3 = 1.0\nm2 = m3 = 0.785", "a2, a3 = 1.0, 1.0\nm2, m3 = 0.785, 0.785"])
def test_a_number_that_is_given_to_two_names_hides_no_mistake(numbers: str, written: Any) -> None:
    text = f"""from math import cos

{numbers}
g = 9.80665


def gravity(q):
    t3 = -m3*g*a3/2*cos(q[1] + q[2])
    return [0, -(m2/2 + m3)*g*a2*cos(q[1]) + t3, t3]
"""
    assert verify.gravity(written("right.py", text)).ok
    for old, new in (("-m3*g*a3/2", "-m3*g*a2/2"), ("-m3*g*a3", "-m2*g*a3")):
        verdict = verify.gravity(written("wrong.py", text.replace(old, new)))
        assert [one.line for one in verdict.findings] == [text[: text.index("t3 = -m3")].count("\n") + 1] * 2, str(
            verdict
        )


def test_a_number_of_two_names_that_is_not_the_arms_has_no_edit(written: Any) -> None:
    arm = Scenario("format: 1\narm: {convention: simscape, link3: {length: 0.8}}\n")
    text = "from math import sin, cos\na2 = a3 = 1.0\n\n\ndef fk(q):\n    r = a2*cos(q[1]) + a3*cos(q[1] + q[2])\n"
    text += "    return [r*cos(q[0]), r*sin(q[0]), -a2*sin(q[1]) - a3*sin(q[1] + q[2])]\n"
    verdict = verify.kinematics(written("fk.py", text), arm)
    assert {(one.line, one.old, one.new) for one in verdict.findings} == {(2, None, None)}, str(verdict)
    assert "a3 is 1 in line 2; the arm has 0.8" in verdict.findings[0].cause


def test_no_edit_takes_away_a_number_that_is_the_arms(written: Any) -> None:
    """With the mass of link 2 doubled the torque would be right, too; that mass is the arm's."""
    text = """from math import cos

m = [0.785, 0.785]


def gravity(q):
    t3 = -m[1]*9.80665*0.5*cos(q[1] + q[2])
    return [0, -m[1]*9.80665*cos(q[1]) - m[0]*9.80665*COM*cos(q[1]) + t3, t3]
"""
    assert verify.gravity(written("right.py", text.replace("COM", "0.5"))).ok
    verdict = verify.gravity(written("wrong.py", text.replace("COM", "0.25")))
    assert [one.entry for one in verdict.findings] == [[2]]
    assert verdict.findings[0].line != 3, str(verdict)
    assert not any("in line 3" in words for words in verdict.alternatives), str(verdict)


INERTIAS = """function M = mass(q)
m2 = 3.2; m3 = 1.9; l2 = 0.45; lc2 = 0.2; lc3 = 0.15;
Ix2 = 0.004; Iy2 = 0.06; Iz2 = 0.062; Ix3 = 0.002; Iy3 = 0.025; Iz3 = 0.026; I1 = 1.3083333333333334e-5;
s2 = sin(q(2)); c2 = cos(q(2)); s23 = sin(q(2)+q(3)); c23 = cos(q(2)+q(3)); c3 = cos(q(3));
r = l2*c2 + lc3*c23;
M = zeros(3);
M(1,1) = I1 + Ix2*s2^2 + (Iy2 + m2*lc2^2)*c2^2 + Ix3*s23^2 + Iy3*c23^2 + m3*r^2;
M(2,2) = Iz2 + m2*lc2^2 + Iz3 + m3*(l2^2 + lc3^2 + 2*l2*lc3*c3);
M(2,3) = Iz3 + m3*(lc3^2 + l2*lc3*c3);
M(3,2) = M(2,3);
M(3,3) = Iz3 + m3*lc3^2;
end
"""


def test_an_arm_whose_inertias_across_its_links_differ(written: Any) -> None:
    verdict = verify.mass(written("mass.m", INERTIAS), UNEQUAL)
    assert verdict.ok, str(verdict)
    verdict = verify.mass(written("mass.m", INERTIAS.replace("2*l2*lc3*c3", "l2*lc3*c3")), UNEQUAL)
    assert [one.entry for one in verdict.findings] == [[2, 2]], str(verdict)


def test_centres_that_a_scenario_gives_are_no_shares_of_lengths() -> None:
    verdict = verify.gravity(lambda q: 1.1 * UNEQUAL.arm.gravity_torque(q), UNEQUAL)
    assert {one.due for one in verdict.findings} == {"m3 g a2 C2 + m2 g l2 C2 + m3 g l3 C23", "m3 g l3 C23"}, str(
        verdict
    )


def test_a_letter_stands_only_where_its_units_do() -> None:
    """0.3 is twice this arm's I2, and no torque by a rate is an inertia."""
    links = "link2: {length: 0.8, mass: 1, com: 0.4, inertia: [0.1, 0.15, 0.15]}"
    arm = Scenario(f"format: 1\narm: {{convention: slide, {links}}}\n")
    verdict = verify.inverse(
        lambda q, qd, qdd: arm.arm.inverse_dynamics(q, qd, qdd) + np.array([0.3 * qd[0], 0, 0]), arm
    )
    assert [one.entry for one in verdict.findings] == [[1]]
    assert "3/10 qd1" in str(verdict.findings[0].reads) + verdict.findings[0].cause, str(verdict)


# ---- idioms of MATLAB ------------------------------------------------------------------------------------------------

TIP = "[r*cos(q(1)); r*sin(q(1)); -sin(q(2)) - sin(q(2)+q(3))]"
IDIOMS = {
    "all arguments at once": (
        f"function p = fk(varargin)\nq = [varargin{{:}}];\nr = cos(q(2)) + cos(q(2)+q(3));\np = {TIP};\nend\n"
    ),
    "a default by nargin": (
        "function p = fk(q, scale)\nif nargin < 2\n  scale = 1;\nend\nr = cos(q(2)) + cos(q(2)+q(3));\n"
        f"p = scale*{TIP};\nend\n"
    ),
    "a default by exist": (
        "function p = fk(q, scale)\nif ~exist('scale', 'var')\n  scale = 1;\nend\nr = cos(q(2)) + cos(q(2)+q(3));\n"
        f"p = scale*{TIP};\nend\n"
    ),
}


@pytest.mark.parametrize("idiom", IDIOMS)
def test_arguments_that_may_be_left_out(idiom: str, written: Any) -> None:
    verdict = verify.kinematics(written("fk.m", IDIOMS[idiom]))
    assert verdict.ok, str(verdict)
    assert not verify.kinematics(written("fk.m", IDIOMS[idiom].replace("r*sin", "r*cos"))).ok


@pytest.mark.parametrize(
    "value", ["real(1i*1i)", "real(sqrt(-1)^2)", "real(acos(2))", "real(log(-1))", "real((-8)^(1/3))"]
)
def test_complex_numbers_are_left_to_octave(value: str, written: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("arm3r_cpp.verify.formula.installed", lambda: None)
    text = f"function p = fk(q)\nr = cos(q(2)) + cos(q(2)+q(3)) + {value};\np = {TIP};\nend\n"
    with pytest.raises(UnjudgedError, match="complex number, and real ones are read; GNU Octave"):
        verify.kinematics(written("fk.m", text))


# ---- laws ------------------------------------------------------------------------------------------------------------

LAWS = {
    "in joints": (
        "controller: {type: joint_pd, joint_stiffness: [200, 200, 100], joint_damping: [20, 20, 10], "
        "compensate_gravity: false}\nreference: {type: point, q: [0.1, 0.5, -0.6]}\n",
        "def controller(q, qd, q_des, qd_des):\n    return K*(q_des - q) + D*(qd_des - qd)\n",
    ),
    "from where it starts": (
        "controller: {type: joint_pd, joint_stiffness: [200, 200, 100], joint_damping: [20, 20, 10], "
        "compensate_gravity: false}\nreference: {type: hold}\n",
        "def controller(q, qd, theta_ref):\n    return K*(theta_ref - q) - D*qd\n",
    ),
}


@pytest.mark.parametrize("law", LAWS)
def test_references_as_arguments_are_the_scenarios(law: str, written: Any) -> None:
    keys, function = LAWS[law]
    scenario = Scenario(f"format: 1\narm: {{convention: simscape}}\ninitial: {{q: [0.2, 0.4, -0.3]}}\n{keys}")
    text = "import numpy as np\n\nK, D = np.array([200, 200, 100]), np.array([20, 20, 10])\n\n\n" + function
    verdict = verify.controller(written("law.py", text), scenario)
    assert verdict.ok and " as given" in str(verdict), str(verdict)
    assert not verify.controller(written("law.py", text.replace("K*(", "-K*(")), scenario).ok


def test_a_law_is_judged_by_a_scenario_that_can_start_everywhere(written: Any) -> None:
    law = written("law.py", "def controller(q, qd):\n    return [0, 0, 0]\n")
    with pytest.raises(UsageError, match="a controller is judged by the law of a scenario: name one by --arm"):
        verify.controller(law, verify.Chain.from_dh(Path(__file__).parents[1] / "robots" / "ur5.csv"))
    scenario = Scenario.example("robots/ur5_hybrid")
    scenario["wall.normal"] = [0, 0, 1]  # all that is more than 0.1 m below it is too deep in it
    with pytest.raises(
        UnjudgedError, match="cannot start at each state that is tried: the tip starts deep inside the wall"
    ):
        verify.controller(law, scenario)


def test_of_frames_in_which_all_is_wrong_the_bases_is_meant() -> None:
    chain = verify.Chain.from_dh(Path(__file__).parents[1] / "robots" / "ur5.csv")

    def wrong(q: Any, shift: float = 0.0) -> Any:
        tip = chain.values(KINDS["kinematics"], "", {"q": np.atleast_2d(q)}, {})[0]
        return tip + 0.3 * np.cos(q[1]) - np.array([0, 0, shift])

    for shift in (0.0, 0.089159):  # with it the frame of joint 1 is the nearer one
        assert "the frame of joint 1" not in str(verify.kinematics(lambda q, by=shift: wrong(q, by), chain))
    moved = verify.kinematics(lambda q: wrong(q, 0.089159) - 0.3 * np.cos(q[1]), chain)
    assert moved.ok and "the frame of joint 1" in str(moved)


# ---- another arm -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("language", ["m", "py"])
def test_a_formula_of_more_joints_cannot_be_judged(language: str, written: Any) -> None:
    chain = verify.Chain.from_dh(written("one.csv", "standard\ntype,a,alpha,d,theta\nR,1,0,0,0\n"))
    text = {
        "m": "function J = jacobian(q)\nJ = [-sin(q(1)+q(2)); cos(q(1)+q(2))];\nend\n",
        "py": "from math import *\ndef jacobian(q):\n    return [-sin(q[0] + q[1]), cos(q[0] + q[1])]\n",
    }[language]
    with pytest.raises(UnjudgedError, match=r"cannot be judged: it reads q.[12]., where the arm has 1 joint; --urdf"):
        formula_verdict(written(f"two.{language}", text), "jacobian", chain)


PLANAR = {
    "mass.m": "function M = mass(q)\nM = [3 + 2*cos(q(2)), 1 + cos(q(2)); 1 + cos(q(2)), 1];\nend\n",
    "jacobian.py": "from math import *\ndef jacobian(q):\n    q1, q2 = q\n    return [[sin(q1), 0], [cos(q2), 0]]\n",
    "gravity.py": "from math import *\ndef gravity(q1, q2):\n    return [9.81*cos(q1), cos(q1 + q2)]\n",
    "kinematics.m": "function p = kinematics(q)\np = [cos(q(1)) + cos(q(1)+q(2)); sin(q(1)) + sin(q(1)+q(2))];\nend\n",
    "jacobian.m": "function J = jacobian(q)\nJ = [-sin(q(1)), 0, 0; cos(q(1)), 0, 0];\nend\n",
    "inverse.py": "import numpy as np\ndef inverse(q, qd, qdd):\n    return np.array(q)[:2] + np.array(qdd)[:2]\n",
}
"""Of an arm with two joints in a plane."""
SAYS = {
    "mass.m": "it returns 2x2 numbers, as a mass matrix of 2 joints, where the arm has 3 joints; --urdf",
    "jacobian.py": "line 3 takes 2 elements from a joint vector, where the arm has 3 joints; --urdf",
    "gravity.py": "it returns 2 numbers, as a gravity torque of 2 joints, where the arm has 3 joints; --urdf",
    "kinematics.m": "it returns 2 numbers, as a tip position in a plane, where the arm moves in space; --urdf",
    "jacobian.m": "it returns 2x3 numbers, as a jacobian in a plane, where the arm moves in space; --urdf",
    "inverse.py": "it returns 2 numbers, as inverse dynamics of 2 joints, where the arm has 3 joints; --urdf",
}


@pytest.mark.parametrize("name", PLANAR)
def test_a_formula_of_fewer_joints_cannot_be_judged(name: str, written: Any) -> None:
    with pytest.raises(UnjudgedError, match=re.escape(f"cannot be judged: {SAYS[name]}")):
        formula_verdict(written(name, PLANAR[name]), name.partition(".")[0])


def test_a_formula_of_three_joints_that_returns_two_numbers_is_wrong(written: Any) -> None:
    """It reads the third angle, and so is of this arm."""
    in_matlab = PLANAR["mass.m"].replace("3 + 2*cos(q(2))", "3 + 2*cos(q(3))")
    in_python = "def mass(q):\n    q1, q2, q3 = q\n    return [[q1, 0], [0, q2]]\n"
    of_state = "function dx = forward(t, x, tau)\ndx = [x(4); x(5); x(6); 1];\nend\n"
    wrong = formula_verdict(written("forward.m", of_state), "forward")
    assert not wrong.ok and "returns 4 numbers, where forward dynamics has 3 or 6" in str(wrong)
    for file, text in (("mass.m", in_matlab), ("mass.py", in_python)):
        verdict = formula_verdict(written(file, text), "mass")
        assert not verdict.ok and "returns 2x2 numbers, where a mass matrix has 3x3" in str(verdict)
