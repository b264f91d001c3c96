"""Python as it is written: right programs in every idiom are right, wrong ones are wrong, the others say what to do."""

from __future__ import annotations

from pathlib import Path

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp import verify
from arm3r_cpp.blocks.block import Block
from arm3r_cpp.errors import UnjudgedError, UsageError

FILES = {path.stem: path.read_text() for path in (Path(__file__).parents[1] / "formulas/python_idioms").glob("*.py")}
ROBOT = FILES["jacobian_method"].replace("l2=1.0, l3=1.0", "l2, l3")
FILES["jacobian_object"] = f"{ROBOT}robot = Robot(l2=1.0, l3=1.0)\n"
LINEAR = "np.cross(T[:3, 2], p - T[:3, 3])"
FILES["jacobian_six_rows"] = FILES["jacobian_reduce"].replace(LINEAR, f"np.r_[{LINEAR}, T[:3, 2]]")
OF_EXTRAS = {"scipy": "scipy", "sympy": "sympy", "lambdify": "sympy", "dynamicsymbols": "sympy"}


def need(name: str) -> None:
    for word, module in OF_EXTRAS.items():
        if word in name:
            pytest.importorskip(module)


@pytest.fixture
def judged(tmp_path: Path):
    """judged(text, kind, function, file): the verdict on a file."""

    def call(text: str, kind: str | None, function: str = "", file: str = "robot.py") -> verify.Verdict:
        (tmp_path / file).write_text(text)
        return verify.formula_verdict(f"{tmp_path / file}{function and ':'}{function}", kind)

    return call


@pytest.mark.sample(4)
@pytest.mark.parametrize("name", sorted(FILES))
def test_a_right_program_is_right(name: str, judged) -> None:
    need(name)
    verdict = judged(FILES[name], name.partition("_")[0])
    assert verdict.ok, str(verdict)


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", sorted(FILES))
def test_a_mistake_in_it_is_found(name: str, judged) -> None:
    need(name)
    changes = (
        ("cos(", "cos(0.1+"),
        ('"y", -q', '"y", q'),
        ("st*ca", "st*sa"),
        ("sin(", "sin(0.1+"),
        ("exp(-1j", "exp(1j"),
    )
    right, wrong = next(one for one in changes if one[0] in FILES[name])
    before, _, behind = FILES[name].rpartition(right)
    text = before + wrong + behind
    verdict = judged(text, name.partition("_")[0])
    assert not verdict.ok and all(one.entry for one in verdict.findings), str(verdict)


def test_the_function_of_a_kind_is_found_among_others(judged) -> None:
    assert judged(FILES["jacobian_method"] + "\ndef rotation(q): return q\n", "jacobian").ok
    assert judged(FILES["jacobian_method"], "kinematics").ok
    assert judged(ROBOT + "robot = Robot(1.0, 1.0)\n", None, "Robot.jacobian").ok
    assert judged(ROBOT + "robot = Robot(1.0, 1.0)\n", None, "robot.jacobian").ok
    assert judged(ROBOT + "robot = Robot(1.0, 2.0)\n", None, "Robot.jacobian").findings


@pytest.mark.parametrize(
    ("text", "function", "words"),
    [
        (ROBOT, "", "Robot takes l2, l3: make one in the file, robot = Robot(...), and name robot.jacobian"),
        (ROBOT, "Robot.jacobi", "there is no function Robot.jacobi; it has Robot.fk, Robot.jacobian"),
        (
            "class A:\n    def jacobian(self):\n        return 1\n",
            "",
            "A.jacobian takes no joint angles: write a function",
        ),
        ("class A:\n    def set(self, q):\n        self.q = q\n", "", "name one of its methods: "),
        ("import numpy\nJ = numpy.zeros((3, 3))\n", "", ":2: J is neither a function nor an expression of sympy"),
        ("x = 1\n", "", "there is no function in this file"),
    ],
)
def test_what_is_no_function_of_the_state_says_what_to_write(judged, text: str, function: str, words: str) -> None:
    with pytest.raises(UsageError) as raised:
        judged(text, "jacobian", function)
    assert words in str(raised.value)


@pytest.mark.parametrize("head", ["import numba", "from torch import nn", "import nunpy as np"])
def test_what_is_not_installed_is_no_mistake(judged, head: str) -> None:
    with pytest.raises(UnjudgedError, match=r":1: cannot be judged: imports \w+, which is not installed here"):
        judged(f"{head}\ndef gravity(q):\n    return [0, 0, 0]\n", "gravity")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "open('out.txt', 'w')\ndef gravity(q): return q\n",
            r"robot.py:1: .*Operation not permitted|Permission denied",
        ),
        ("import subprocess\nsubprocess.run('ls')\ndef gravity(q): return q\n", r"robot.py:2: .*a process is started"),
        ("import socket\ndef gravity(q):\n    socket.socket()\n    return q\n", r"robot.py:3: .*a socket is opened"),
        ("x = float(input('angle? '))\ndef gravity(q): return q\n", r"robot.py:1: .*asks for input"),
        ("def gravity(*, q): return q\n", r"robot.py:1: .*takes q by keyword alone"),
    ],
)
def test_what_the_judge_bars_is_no_mistake(judged, text: str, words: str) -> None:
    with pytest.raises(UnjudgedError, match=words):
        judged(text, "gravity")


def test_what_needs_columns_gets_them(judged) -> None:
    verdict = judged(FILES["gravity_column"], "gravity")
    assert verdict.ok and "with vectors as columns" in str(verdict)


# ---- several results, states -----------------------------------------------------------------------------------------

DYNAMICS = """
import numpy as np
m, a, g = 0.785, 1.0, 9.80665
I, X = m*(a**2 + 1e-4)/12, m*2e-4/12
def mass(q):
    c2, c23, s2, s23, c3 = np.cos(q[1]), np.cos(q[1]+q[2]), np.sin(q[1]), np.sin(q[1]+q[2]), np.cos(q[2])
    m11 = m*a**2*(c2**2/4 + (c2 + c23/2)**2) + I*(c2**2 + c23**2) + X*(1 + s2**2 + s23**2)
    m33 = m*a**2/4 + I
    m23 = m33 + m*a**2*c3/2
    return np.array([[m11, 0, 0], [0, 2*m23 - m33 + m*a**2*5/4 + I, m23], [0, m23, m33]])
def bias(q, qd):
    e = 1e-5
    d = np.stack([(mass(q + e*k) - mass(q - e*k))/(2*e) for k in np.eye(3)], 2)
    return np.einsum("ijk,j,k->i", d, qd, qd) - np.einsum("jki,j,k->i", d, qd, qd)/2
def gravity(q):
    t3 = -m*g*a/2*np.cos(q[1]+q[2])
    return np.array([0, -1.5*m*g*a*np.cos(q[1]) + t3, t3])
"""


@pytest.mark.parametrize("result", ["mass(q), bias(q, qd), gravity(q)", "{'M': mass(q), 'G': gravity(q)}"])
def test_a_function_of_several_kinds_is_judged_by_each(judged, result: str) -> None:
    text = f"{DYNAMICS}\ndef dynamics(q, qd):\n    return {result}\n"
    assert judged(text, "mass", "dynamics").ok and judged(text, "gravity", "dynamics").ok
    assert judged(text.replace("c3/2", "c3"), "mass", "dynamics").findings
    if "bias(q" in result:
        assert judged(text, "coriolis", "dynamics").ok


def test_a_state_and_its_derivative_are_forward_dynamics(judged) -> None:
    right = "np.linalg.solve(mass(x[:3]), u - bias(x[:3], x[3:]) - gravity(x[:3]))"
    text = f"{DYNAMICS}\ndef f(t, x, u):\n    return np.concatenate([x[3:], {right}])\n"
    assert judged(text, "forward", "f").ok
    assert judged(text.replace("- bias", "+ bias"), "forward", "f").findings
    swapped = judged(text.replace("[x[3:], ", "[x[:3], "), "forward", "f")
    assert not swapped.ok and "the first half is not qd" in str(swapped)
    assert judged(text.replace("f(t, x, u):", "f(t, x):\n    u = 0"), "forward", "f").ok


@pytest.mark.parametrize("arguments", ["t, q", "q, t", "q, qd, t", "time, q1, q2, q3"])
def test_a_time_beside_the_state_is_no_parameter(judged, arguments: str) -> None:
    q = "q1, q2, q3" if "q1" in arguments else "*q"
    text = (
        f"from math import cos\ndef gravity({arguments}):\n    _, b, c = ({q},)\n    t3 = -0.785*9.80665/2*cos(b + c)\n"
    )
    assert judged(f"{text}    return [0, -1.5*0.785*9.80665*cos(b) + t3, t3]\n", "gravity").ok


@pytest.mark.parametrize("arguments", ["t, l", "t, w", "q, w"])
def test_what_may_mean_something_else_is_asked_for(judged, arguments: str) -> None:
    with pytest.raises(UsageError, match="is not understood"):
        judged(f"def gravity({arguments}):\n    return [0, 0, 0]\n", "gravity")


# ---- laws ------------------------------------------------------------------------------------------------------------

LAW = """
class Law:
    def __init__(self):
        self.calls = 0
    def __call__(self, q, qd):
        self.calls += 1
        return [self.calls, 0.0, 0.0]
"""


def test_an_object_that_is_called_is_a_law_and_starts_anew_in_each_run(tmp_path: Path) -> None:
    path = tmp_path / "law.py"
    path.write_text(LAW)
    assert str(Block.read(path)).endswith("Law(q, qd)") and Block.read(path).line == 5
    scenario = arm3r.Scenario()
    scenario["time"] = {"stop": 0.1, "log_every": 0.01}
    runs = [scenario.run(controller=path) for _ in range(2)]
    assert np.array_equal(runs[0]["tau"], runs[1]["tau"]) and runs[0]["tau"][0, 0] == 1 and runs[0]["tau"][-1, 0] > 5


@pytest.mark.parametrize("head", ["raise ValueError('no')", "self.calls = undefined"])
def test_a_law_whose_object_cannot_be_made_is_one_line(tmp_path: Path, head: str) -> None:
    (tmp_path / "law.py").write_text(LAW.replace("self.calls = 0", head))
    with pytest.raises(arm3r.ControllerError, match=r"law.py:\d+: .*(ValueError|NameError)"):
        arm3r.Scenario().run(controller=tmp_path / "law.py")


def test_what_partial_makes_is_a_law(tmp_path: Path) -> None:
    text = "from functools import partial\ndef f(q, qd, k):\n    return [k, 0.0, 0.0]\nlaw = partial(f, k=2.0)\n"
    (tmp_path / "law.py").write_text(text)
    scenario = arm3r.Scenario()
    scenario["time"] = {"stop": 0.05, "log_every": 0.01}
    assert scenario.run(controller=f"{tmp_path}/law.py:law")["tau"][0, 0] == 2


def test_a_text_that_fails_before_it_makes_a_law_says_why(tmp_path: Path) -> None:
    (tmp_path / "law.py").write_text("from functools import partial\nlaw = partial(undefined, k=2.0)\n")
    with pytest.raises(arm3r.ControllerError, match=r"law.py:2: .*NameError: name 'undefined' is not defined"):
        Block.read(tmp_path / "law.py")
