"""Scripts of MATLAB's symbolic toolbox: evaluated in numbers, with derivatives as sympy has them, and judged."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.user_functions.matlab.script import program_of
from arm3r_cpp.user_functions.programs import Call
from arm3r_cpp.verify.functions import formula_verdict
from numpy.testing import assert_allclose
from random_scenarios import sample_seed

HEAD = "syms q1 q2 q3 real\n"
POINT = """a2 = 1; a3 = 1;
x = cos(q1)*(a2*cos(q2) + a3*cos(q2+q3));
y = sin(q1)*(a2*cos(q2) + a3*cos(q2+q3));
z = a2*sin(q2) + a3*sin(q2+q3);
p = [x; y; z];
"""


def value_of(text: str, name: str, states: np.ndarray) -> np.ndarray:
    """A variable of a script at angles, a column each."""
    program = program_of(text, "script.m", name, None, lambda names: names[-1])
    used = tuple(["q1", "q2", "q3"].index(one) for one in program.arguments)
    return program.evaluate(Call(used, {}), states)


# ---- values ----------------------------------------------------------------------------------------------------------

EXPRESSIONS = [
    "cos(q1)*sin(q2+q3)^2",
    "q1^3*q2 - q3/(2+q1^2)",
    "sqrt(1+q1^2)*exp(q2*q3)",
    "atan2(q1+2, q2+3)*tan(q3)",
    "(a*cos(q1)+q2)^2*q3",
    "q1*q2*q3 + q1^2 + 7",
]
ASKED = {
    "jacobian(f,[q1 q2 q3])": lambda f, q: [[f.diff(one) for one in q]],
    "gradient(f,[q1;q2])": lambda f, q: [[f.diff(one)] for one in q[:2]],
    "hessian(f,[q1,q2,q3])": lambda f, q: [[f.diff(one).diff(two) for two in q] for one in q],
    "diff(f,q2)": lambda f, q: [[f.diff(q[1])]],
    "diff(f,q1,2)": lambda f, q: [[f.diff(q[0], 2)]],
    "diff(f,q1,q3)": lambda f, q: [[f.diff(q[0]).diff(q[2])]],
    "diff(diff(f,q3)*sin(q3),q3)": lambda f, q: [[(f.diff(q[2]) * __import__("sympy").sin(q[2])).diff(q[2])]],
    "subs(diff(f,q1),q2,0.3)": lambda f, q: [[f.diff(q[0]).subs(q[1], 0.3)]],
    "subs(f,{q1,q3},{q2,1})": lambda f, q: [[f.subs({q[0]: q[1], q[2]: 1}, simultaneous=True)]],
    "diff(simplify(f),q1)*vpa(2)": lambda f, q: [[2 * f.diff(q[0])]],
}


@pytest.mark.sample(8)
@pytest.mark.parametrize("asked", ASKED)
@pytest.mark.parametrize("expression", EXPRESSIONS)
def test_derivatives_are_those_of_sympy(expression: str, asked: str) -> None:
    sympy = pytest.importorskip("sympy")
    q = sympy.symbols("q1 q2 q3", real=True)
    f = sympy.sympify(expression.replace("^", "**"), locals={"a": 1.5, **{one.name: one for one in q}})
    states = np.random.default_rng(sample_seed()).uniform(-1, 1, (7, 3))
    text = f"{HEAD}a = 1.5;\nf = {expression};\nD = {asked};\n"
    got = value_of(text, "D", states)
    wanted = sympy.lambdify(q, sympy.Matrix(ASKED[asked](f, q)), "numpy")
    for row, state in zip(got, states, strict=True):
        assert_allclose(np.reshape(row, -1), np.reshape(wanted(*state), -1), rtol=1e-9, atol=1e-9)


def test_in_a_loop_and_in_cells() -> None:
    text = HEAD + POINT + "q = {q1, q2, q3};\nfor k = 1:3\n  J(:,k) = diff(p, q{k});\nend\n"
    states = np.random.default_rng(3).uniform(-2, 2, (5, 3))
    arm = arm3r.Scenario("{format: 1, arm: {convention: slide}}").arm
    for got, q in zip(value_of(text, "J", states), states, strict=True):
        assert_allclose(got, arm.jacobian(q), rtol=0, atol=1e-11)


def test_symbols_of_one_value_are_told_apart() -> None:
    text = HEAD + "f = q1 + 10*q2 + 100*q3;\ng = subs(f, q2, 7);\nh = diff(q1*q2^2*q3, q2);\n"
    alike = np.full((2, 3), 0.5)
    assert_allclose(value_of(text, "g", alike).ravel(), 0.5 + 70 + 50)
    assert_allclose(value_of(text, "h", alike).ravel(), 2 * 0.5**3)


def test_the_symbols_that_a_variable_needs_are_its_arguments() -> None:
    text = "syms a b c d real\nu = a + b;\nv = [u; c];\nw = jacobian(v, [a b]);\nb = 2;\nx = b*d;\n"
    needed = {"u": ["a", "b"], "v": ["a", "b", "c"], "w": ["c"], "x": ["d"]}
    for name, symbols in needed.items():
        assert program_of(text, "s.m", name, None, lambda names: names[-1]).arguments == symbols


@pytest.mark.parametrize("declared", ["q1 = sym('q1', 'real'); q2 = sym('q2'); q3 = sym('q3');\n", HEAD])
def test_symbols_are_declared_in_either_way(declared: str) -> None:
    states = np.random.default_rng(4).uniform(-2, 2, (3, 3))
    assert_allclose(
        value_of(declared + POINT, "z", states).ravel(), np.sin(states[:, 1]) + np.sin(states[:, 1:].sum(1))
    )


# ---- verdicts --------------------------------------------------------------------------------------------------------


def verdict_of(text: str, tmp_path: Path, name: str = "", **options: Any) -> Any:
    (tmp_path / "script.m").write_text(text)
    return formula_verdict(f"{tmp_path / 'script.m'}{name and ':'}{name}", **options)


JACOBIAN = "J = simplify(jacobian(p, [q1 q2 q3]), 'Steps', 50)\npretty(J)\nJn = double(subs(J, q1, 0.5));\n"


def test_the_jacobian_of_a_script_is_right(tmp_path: Path) -> None:
    verdict = verdict_of(HEAD + POINT + JACOBIAN, tmp_path)
    assert verdict.ok
    assert "its variable J" in str(verdict)


def test_a_mistake_in_it_is_found_in_its_line(tmp_path: Path) -> None:
    verdict = verdict_of(
        HEAD + POINT.replace("z = a2*sin(q2) + a3*sin(q2+q3)", "z = a2*sin(q2) + a3*sin(q3)") + JACOBIAN, tmp_path
    )
    assert not verdict.ok
    assert "J(3,2) reads a2 C2, should be a2 C2 + a3 C23" in str(verdict)
    assert "line 5:  z = a2*sin(q2) + a3*sin(q3);" in str(verdict)


def test_what_is_written_into_a_file_is_judged_before_what_follows(tmp_path: Path) -> None:
    after = "matlabFunction(J, 'File', 'J_arm', 'Vars', {[q1; q2; q3]});\nM = J.'*J;\n"
    assert "its variable J" in str(verdict_of(HEAD + POINT + JACOBIAN + after, tmp_path))
    assert "its variable M" in str(verdict_of(HEAD + POINT + JACOBIAN + "M = J.'*J;\n", tmp_path))


LAGRANGE = """syms q1 q2 q3 dq1 dq2 dq3 g real
m2 = 0.785; m3 = 0.785; a2 = 1; a3 = 1; l2 = 0.5; l3 = 0.5;
Ix2 = 1.308333333333e-05; Iy2 = 0.06542320833333; Iz2 = Iy2; Ix3 = Ix2; Iy3 = Iy2; Iz3 = Iy2;
q = [q1; q2; q3]; dq = [dq1; dq2; dq3];
pc2 = [l2*cos(q2)*cos(q1); l2*cos(q2)*sin(q1); l2*sin(q2)];
pc3 = [(a2*cos(q2)+l3*cos(q2+q3))*cos(q1); (a2*cos(q2)+l3*cos(q2+q3))*sin(q1); a2*sin(q2)+l3*sin(q2+q3)];
v2 = jacobian(pc2, q)*dq; v3 = jacobian(pc3, q)*dq;
w2 = [dq1*sin(q2); dq1*cos(q2); dq2]; w3 = [dq1*sin(q2+q3); dq1*cos(q2+q3); dq2+dq3];
K = (m2*(v2.'*v2) + m3*(v3.'*v3) + w2.'*diag([Ix2 Iy2 Iz2])*w2 + w3.'*diag([Ix3 Iy3 Iz3])*w3)/2;
M = hessian(K, dq);
U = m2*g*pc2(3) + m3*g*pc3(3);
G = jacobian(U, q).';
"""


def test_a_mass_matrix_by_the_kinetic_energy(tmp_path: Path) -> None:
    """The rates are differentiated away: it has the angles as arguments."""
    program = program_of(LAGRANGE, "s.m", "M", None, lambda names: names[-1])
    assert program.arguments == ["q1", "q2", "q3"]
    arm = arm3r.Scenario("{format: 1, arm: {convention: slide}}").arm
    states = np.random.default_rng(5).uniform(-2, 2, (4, 3))
    for got, q in zip(value_of(LAGRANGE, "M", states), states, strict=True):
        M = arm.mass_matrix(q)
        assert_allclose(got[1:, 1:], M[1:, 1:], rtol=0, atol=2e-5)  # M11 has that of link 1, too


def test_gravity_by_the_potential_energy(tmp_path: Path) -> None:
    verdict = verdict_of(LAGRANGE, tmp_path, "G")
    assert verdict.kind == "gravity"
    assert "its variable G" in str(verdict)


REFUSED = {
    "syms q1(t)\nx = diff(q1, t);\n": "script.m:1:6: a symbol that is a function or a matrix, such as q1.t., is not",
    HEAD + "x = diff(q1^2);\n": "script.m:2: cannot be judged: diff is read with the symbols",
    HEAD + "x = jacobian(q1^2, q1+q2);\n": "is no symbol that `syms` or sym",
    HEAD + "x = solve(q1^2 == 2, q1);\n": "'solve' is not known",
    HEAD + "x = 0;\nif q1 > 0\n  x = q2;\nend\n": "a condition or an index depends on a symbol",
    HEAD + "x = cos(q1);\n": "script.m: there is no variable y; it has x",
}


@pytest.mark.parametrize("text", REFUSED)
def test_what_is_not_read_is_said(text: str, tmp_path: Path) -> None:
    name = "y" if "there is no" in REFUSED[text] else "x"
    with pytest.raises(arm3r.Arm3rError, match=REFUSED[text]):
        verdict_of(text, tmp_path, name, kind="kinematics")


# ---- symbols that numbers are put for, and symbols at once -----------------------------------------------------------

SUBSTITUTED = """syms q1 q2 q3 m2 m3 g a2 l2 l3 h real
V = m2*g*(h + l2*sin(q2)) + m3*g*(h + a2*sin(q2) + l3*sin(q2+q3));
G = -[diff(V,q1); diff(V,q2); diff(V,q3)];
G = subs(G, %s, %s);
"""
LISTS = {
    "a row": ("[m2 m3 g a2 l2 l3 h]", "[0.785 0.785 9.80665 1 0.5 0.5 0.3]"),
    "cells": ("{m2, m3, g, a2, l2, l3, h}", "{0.785, 0.785, 9.80665, 1, 0.5, 0.5, 0.3}"),
}


@pytest.mark.parametrize("how", LISTS)
def test_symbols_that_numbers_are_put_for_are_no_arguments(how: str, tmp_path: Path) -> None:
    path = tmp_path / "gravity.m"
    path.write_text(SUBSTITUTED % LISTS[how])
    verdict = formula_verdict(path, "gravity")
    assert verdict.ok, str(verdict)
    path.write_text((SUBSTITUTED % LISTS[how]).replace("a2*sin(q2) +", "2*a2*sin(q2) +"))
    verdict = formula_verdict(path, "gravity")
    assert [one.entry for one in verdict.findings] == [[2]], str(verdict)


@pytest.mark.parametrize("size, separator", [("[3 1]", "column"), ("[1, 3]", "row")])
def test_symbols_are_made_at_once(size: str, separator: str, tmp_path: Path) -> None:
    path = tmp_path / "jacobian.m"
    text = f"q = sym('q', {size}, 'real');\n" + POINT.replace(
        "a2*sin(q2) + a3*sin(q2+q3)", "-a2*sin(q2) - a3*sin(q2+q3)"
    )
    for name in ("q1", "q2", "q3"):
        text = text.replace(name, f"q({name[1]})")
    path.write_text(text + "J = jacobian(p, q);\n")
    assert formula_verdict(path, "jacobian").ok
    path.write_text("q = sym('q', 3);\nJ = jacobian(q, q);\n")
    with pytest.raises(arm3r.UnjudgedError, match="a column or a row is read"):
        formula_verdict(path, "jacobian")


def test_a_script_of_many_derivatives_is_judged_without_its_terms(
    written: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To read them takes hundreds of evaluations, each of thousands of states."""
    file = written("slow.m", HEAD + POINT + "J = jacobian(2*p, [q1 q2 q3]);\n")
    arm = arm3r.Scenario()
    told = formula_verdict(f"{file}:J", "jacobian", arm)
    assert "take too long" not in str(told) and all(one.reads for one in told.findings)
    monkeypatch.setattr("arm3r_cpp.verify.explain.causes._MOST_STATES_READ", 10)
    slow = formula_verdict(f"{file}:J", "jacobian", arm)
    assert [one.entry for one in slow.findings] == [one.entry for one in told.findings]
    assert not any(one.reads for one in slow.findings) and "take too long" in str(slow)
