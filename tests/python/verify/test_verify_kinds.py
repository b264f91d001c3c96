"""Every kind of formula, and every form in which it may come."""

from __future__ import annotations

import ast
import re
from functools import partial
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp import verify
from arm3r_cpp.robots.bodies import Joint, rotation_about, rotation_of
from arm3r_cpp.verify import Chain, kinds
from arm3r_cpp.verify.explain.frames import Pose, of_other_frames
from arm3r_cpp.verify.formula import Formula
from arm3r_cpp.verify.kinds import KINDS
from arm3r_cpp.verify.samples import Samples
from arm3r_cpp.verify.truth.three_r import ThreeR

ARM = arm3r.Scenario().arm
DYNAMICS = """
import numpy as np

a2, a3 = 1.0, 1.0
m2, m3, g = 0.785, 0.785, 9.80665
lc2, lc3 = 0.5, 0.5
I2, I3 = 0.06542320833333333, 0.06542320833333333
axial = 1.3083333333333334e-05

def inertias():
    return m2*lc2**2 + m3*a2**2, m3*lc3**2, m3*a2*lc3

def mass_matrix(q):
    A2, A3, B = inertias()
    c2, c23, c3 = np.cos(q[1]), np.cos(q[1] + q[2]), np.cos(q[2])
    m11 = 3*axial + (A2 + I2 - axial)*c2**2 + (A3 + I3 - axial)*c23**2 + 2*B*c2*c23
    m23 = I3 + A3 + B*c3
    return np.array([[m11, 0, 0], [0, I2 + I3 + A2 + A3 + 2*B*c3, m23], [0, m23, I3 + A3]])

def coriolis_matrix(q, qd):
    A2, A3, B = inertias()
    A2, A3 = A2 + I2 - axial, A3 + I3 - axial
    c2, c23, s2, s23 = np.cos(q[1]), np.cos(q[1] + q[2]), np.sin(q[1]), np.sin(q[1] + q[2])
    h2 = -(s2*(A2*c2 + B*c23) + s23*(A3*c23 + B*c2))
    h3 = -s23*(A3*c23 + B*c2)
    b = B*np.sin(q[2])
    return np.array([[h2*qd[1] + h3*qd[2], h2*qd[0], h3*qd[0]],
                     [-h2*qd[0], -b*qd[2], -b*(qd[1] + qd[2])],
                     [-h3*qd[0], b*qd[1], 0]])

def gravity(q):
    c2, c23 = np.cos(q[1]), np.cos(q[1] + q[2])
    t3 = -m3*g*lc3*c23
    return np.array([0, -(m2*lc2 + m3*a2)*g*c2 + t3, t3])

def inverse_dynamics(q, qd, qdd):
    return mass_matrix(q) @ qdd + coriolis_matrix(q, qd) @ qd + gravity(q)

def forward_dynamics(q, qd, tau):
    return np.linalg.solve(mass_matrix(q), tau - coriolis_matrix(q, qd) @ qd - gravity(q))
"""
MISTAKES = {
    "mass_matrix": ("+ 2*B*c2*c23", "+ B*c2*c23", [[1, 1]]),
    "coriolis_matrix": ("-b*qd[2], -b*(qd[1] + qd[2])", "-b*qd[2], -b*(qd[1] - qd[2])", [[2]]),
    "inverse_dynamics": (
        "coriolis_matrix(q, qd) @ qd + gravity",
        "coriolis_matrix(q, qd) @ qdd + gravity",
        [[1], [2], [3]],
    ),
    "forward_dynamics": ("tau - coriolis_matrix", "tau + coriolis_matrix", [[1], [2], [3]]),
}


@pytest.mark.sample(1)
@pytest.mark.parametrize("function", MISTAKES)
def test_dynamics_are_judged(function: str, written: Any) -> None:
    path = written("dynamics.py", DYNAMICS)
    right = verify.formula_verdict(f"{path}:{function}")
    assert right.ok, str(right)
    old, new, entries = MISTAKES[function]
    assert old in DYNAMICS
    wrong = verify.formula_verdict(f"{written('dynamics.py', DYNAMICS.replace(old, new))}:{function}")
    assert [finding.entry for finding in wrong.findings] == entries
    line = DYNAMICS[: DYNAMICS.index(old)].count("\n") + 1
    assert {finding.line for finding in wrong.findings} == {line}, str(wrong)


READ = {
    "mass_matrix": ("+ 2*B*c2*c23", "+ B*c2*c23", "M(1,1) has 1/2 m3 a2 lc3 C3 "),
    "coriolis_matrix": (
        "-b*(qd[1] + qd[2])",
        "-b*(qd[1] - qd[2])",
        "h2 has m3 a2 lc3 S3 qd3^2 where -m3 a2 lc3 S3 qd3^2",
    ),
}


@pytest.mark.sample(1)
@pytest.mark.parametrize("function", READ)
def test_terms_of_the_dynamics_are_read(function: str, written: Any) -> None:
    old, new, words = READ[function]
    verdict = verify.formula_verdict(f"{written('dynamics.py', DYNAMICS.replace(old, new))}:{function}")
    assert words in str(verdict) and "right terms" in str(verdict)


def test_forward_dynamics_are_read_as_the_torque() -> None:
    def formula(extra: float, q: Any, qd: Any, tau: Any) -> Any:
        return ARM.forward_dynamics(q, qd, tau - np.array([0, extra * np.sin(q[2]) * qd[1] ** 2, 0]))

    verdict = verify.forward(partial(formula, 0.3))
    words = "is wrong: solved for the torque, t2 has 3/10 S3 qd2^2 where nothing should be"
    assert len(verdict.findings) == 2 and not verdict.unexplained
    assert all(words in finding.cause for finding in verdict.findings), str(verdict)


def test_a_rate_that_is_lost_is_read(written: Any) -> None:
    text = DYNAMICS.replace("b*qd[1], 0]])", "b, 0]])")
    verdict = verify.formula_verdict(f"{written('dynamics.py', text)}:coriolis_matrix")
    (finding,) = verdict.findings
    assert finding.entry == [3] and "S3 qd2 " in f"{finding.reads} ", str(verdict)


def test_terms_are_read_with_few_evaluations(written: Any, monkeypatch: Any) -> None:
    rows = 0

    def counted(formula: Formula, call: Any, samples: Samples, *rest: Any) -> Any:
        nonlocal rows
        rows += len(samples.arms) * len(samples.states["q"])
        return values(formula, call, samples, *rest)

    values = Formula.values
    monkeypatch.setattr(Formula, "values", counted)
    test_a_rate_that_is_lost_is_read(written)
    assert 10_000 < rows < 80_000


def test_a_coriolis_matrix_is_judged_by_its_product() -> None:
    def another(q: Any, qd: Any) -> Any:
        matrix = ARM.coriolis_matrix(q, qd)
        matrix[0] += [qd[1], -qd[0], 0]  # a row that is normal to qd
        return matrix

    verdict = verify.coriolis(another)
    assert verdict.ok and "dM/dt - 2C is not skew" in verdict.warnings[0]
    assert not verify.coriolis(lambda q, qd: ARM.coriolis_matrix(q, qd)).warnings


FORMS = {
    "three numbers": lambda q1, q2, q3: ARM.jacobian([q1, q2, q3]),
    "reversed": lambda q3, q2, q1: ARM.jacobian([q1, q2, q3]),
    "a vector": lambda q: ARM.jacobian(q),
    "another name": lambda theta: ARM.jacobian(theta),
    "any name": lambda x: ARM.jacobian(x),
    "any numbers": lambda *x: ARM.jacobian(x),
    "nested lists": lambda q: ARM.jacobian(q).tolist(),
    "six rows": lambda q: ARM.geometric_jacobian(q),
    "parameters": lambda q, a2, a3: jacobian_of(q, a2, a3),
}


def jacobian_of(q: Any, a2: float, a3: float) -> Any:
    scenario = arm3r.Scenario()
    scenario["arm.link2.length"], scenario["arm.link3.length"] = a2, a3
    return scenario.arm.jacobian(q)


@pytest.mark.parametrize("form", FORMS)
def test_every_form_of_a_function_is_taken(form: str) -> None:
    verdict = verify.jacobian(FORMS[form])
    assert verdict.ok, str(verdict)


def test_sympy_expressions_are_taken() -> None:
    sympy = pytest.importorskip("sympy")
    q1, q2, q3, a2, a3 = sympy.symbols("q1 q2 q3 a2 a3")
    r = a2 * sympy.cos(q2) + a3 * sympy.cos(q2 + q3)
    tip = sympy.Matrix([r * sympy.cos(q1), r * sympy.sin(q1), -a2 * sympy.sin(q2) - a3 * sympy.sin(q2 + q3)])
    jacobian = tip.jacobian([q1, q2, q3])
    assert verify.jacobian(jacobian).ok
    assert verify.jacobian(sympy.lambdify((q1, q2, q3, a2, a3), jacobian)).ok
    (finding,) = verify.kinematics(tip + sympy.Matrix([0, a3 * sympy.sin(q1), 0])).findings
    assert finding.entry == [2] and "a3 S1" in finding.reads


def test_degrees_are_taken_where_the_names_say_so() -> None:
    verdict = verify.jacobian(lambda q1_deg, q2_deg, q3_deg: ARM.jacobian(np.radians([q1_deg, q2_deg, q3_deg])))
    assert verdict.ok and "angles in degrees" in verdict.found


def test_names_that_say_degrees_are_kept_to() -> None:
    verdict = verify.jacobian(lambda q1_deg, q2_deg, q3_deg: ARM.jacobian([q1_deg, q2_deg, q3_deg]))
    assert not verdict.ok and "taken in radians, while the arguments' names" in verdict.findings[0].cause


LAW = """
import numpy as np

def law(q, qd):
    g = 9.80665
    c2, c23 = np.cos(q[1]), np.cos(q[1] + q[2])
    t3 = -0.785*g*0.5*c23
    return [0, -0.785*g*1.5*c2 + t3, t3]
"""


def test_a_controller_is_judged_by_the_scenarios_law(written: Any) -> None:
    scenario = arm3r.Scenario("{format: 1, controller: {type: gravity_compensation}}")
    assert verify.controller(written("law.py", LAW), scenario).ok
    wrong = verify.controller(written("law.py", LAW.replace("+ t3, t3", "- t3, t3")), scenario)
    assert [(one.entry, one.line) for one in wrong.findings] == [([2], 8)]
    with pytest.raises(arm3r.UsageError, match="by the law of a scenario"):
        verify.controller(written("law.py", LAW))


def test_a_verdict_is_a_table_in_a_notebook(written: Any) -> None:
    verdict = verify.gravity(lambda q: ARM.gravity_torque(q) + np.array([q[0], 0, 0]))
    page = verdict._repr_html_()
    assert page.count("<td") == 3 and page.count("#f8d0d0") == 1 and "<u>q1</u>" in page


def test_functions_of_time_are_the_joints_of_sympy() -> None:
    """As sympy.physics.mechanics makes them, with their derivatives."""
    sympy = pytest.importorskip("sympy")
    from sympy.physics.mechanics import dynamicsymbols

    q1, q2, q3 = dynamicsymbols("q1 q2 q3")
    a2, a3, time = sympy.symbols("a2 a3 t")
    reach = a2 * sympy.cos(q2) + a3 * sympy.cos(q2 + q3)
    tip = sympy.Matrix([sympy.cos(q1) * reach, sympy.sin(q1) * reach, -a2 * sympy.sin(q2) - a3 * sympy.sin(q2 + q3)])
    assert verify.jacobian(tip.jacobian([q1, q2, q3])).ok
    assert verify.kinematics(tip).ok
    weight = sympy.Matrix([0, -1.5 * sympy.cos(q2) - sympy.cos(q2 + q3) / 2, -sympy.cos(q2 + q3) / 2]) * 0.785 * 9.80665
    assert verify.gravity(weight).ok and verify.gravity(weight.subs(q3, 2 * q3)).findings
    wrong = verify.coriolis(sympy.Matrix([0, q1.diff(time), q2.diff(time, 1) * 0]))
    assert not wrong.ok and "qd1" in str(wrong)


DIFFERENCES = """import numpy as np


def mass(q):
    I, X, m = 0.785 * (1 + 1e-4) / 12, 0.785 * 2e-4 / 12, 0.785
    c2, c23, s2, s23 = np.cos(q[1]), np.cos(q[1] + q[2]), np.sin(q[1]), np.sin(q[1] + q[2])
    m11 = m*(c2**2/4 + (c2 + c23/2)**2) + I*(c2**2 + c23**2) + X*(s2**2 + s23**2)
    m23 = m/4 + I + m*np.cos(q[2])/2
    return np.array([[m11, 0, 0], [0, 2*m23 - m/4 - I + m*1.25 - 0*I + I - m/4, m23], [0, m23, m/4 + I]])


def coriolis(q, qd):
    e = STEP
    d = np.stack([(mass(q + e*np.eye(3)[k]) - mass(q))/e for k in range(3)], 2)
    return np.einsum('ijk,j,k->i', d, qd, qd) - FACTOR*np.einsum('jki,j,k->i', d, qd, qd)
"""


@pytest.mark.sample(1)
@pytest.mark.parametrize("step", ["5e-6", "1e-4", "3e-4"])
def test_the_step_of_differences_is_no_mistake(step: str, tmp_path: Any) -> None:
    path = tmp_path / "coriolis.py"
    path.write_text(DIFFERENCES.replace("STEP", step).replace("FACTOR", "0.5"))
    verdict = verify.coriolis(path)
    assert verdict.ok and f"of differences with the step {step} in line 13" in str(verdict), str(verdict)
    path.write_text(DIFFERENCES.replace("STEP", step).replace("FACTOR", "0.5004"))
    assert not verify.coriolis(path).ok


def test_a_number_without_decimals_is_no_step_of_differences(tmp_path: Any) -> None:
    """Nor is it an error: 0x1 stands in what differs by a small term."""
    text = "from math import cos\n\n\ndef gravity(q):\n    t3 = -0x1*0.785*9.80665/2*cos(q[1] + q[2])\n"
    path = tmp_path / "gravity.py"
    path.write_text(f"{text}    return [0, -1.5*0.785*9.80665*cos(q[1]) + t3, t3 + 1e-4*cos(q[0])]\n")
    assert [one.entry for one in verify.gravity(path).findings] == [[3]]


@pytest.mark.parametrize("small", ["+ 0.0005*cos(q[0])", "+ 1e-5*q[1]", "*(1 + 0.0003)", "+ 0.002*tanh(q[0]/0.01)"])
def test_a_small_mistake_is_no_step_of_differences(small: str, tmp_path: Any) -> None:
    """Its term shrinks with its number, too; where the number is tiny it is gone, and no rounding is left."""
    path = tmp_path / "gravity.py"
    text = "from math import cos, tanh\n\n\ndef gravity(q):\n    t3 = -0.785*9.80665/2*cos(q[1] + q[2])\n"
    path.write_text(f"{text}    return [0, -1.5*0.785*9.80665*cos(q[1]) + t3, t3{small}]\n")
    assert not verify.gravity(path).ok


def test_what_depends_on_a_kind_is_told_in_its_class() -> None:
    """No other module asks which kind a formula has, and names are compared with each of them."""
    assert set(kinds._BY_NAME) == set(KINDS) == set(verify.__dir__()) & set(KINDS)
    package = Path(verify.__file__).parent
    found = []
    for path in package.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            sides = [node.left, *node.comparators] if isinstance(node, ast.Compare) else []
            asked = any(re.fullmatch(r"(.*\.)?kind(\.name)?", ast.unparse(side)) for side in sides)
            words = {one.value for side in sides for one in ast.walk(side) if isinstance(one, ast.Constant)}
            if asked and words & set(KINDS):
                found.append(f"{path.relative_to(package)}:{node.lineno}")
    assert not found


RATE = """
from math import cos, sin

a2, a3 = 1.0, 1.0


def jacobian_dot(q, qd):
    s1, c1, s2, c2 = sin(q[0]), cos(q[0]), sin(q[1]), cos(q[1])
    s23, c23 = sin(q[1] + q[2]), cos(q[1] + q[2])
    w1, w2, w23 = qd[0], qd[1], qd[1] + qd[2]
    r, h = a2*c2 + a3*c23, a2*s2 + a3*s23
    rd, hd = -a2*s2*w2 - a3*s23*w23, a2*c2*w2 + a3*c23*w23
    return [
        [-c1*w1*r - s1*rd, s1*w1*h - c1*hd, a3*s23*s1*w1 - a3*c23*c1*w23],
        [-s1*w1*r + c1*rd, -c1*w1*h - s1*hd, -a3*s23*c1*w1 - a3*c23*s1*w23],
        [0, -rd, a3*s23*w23],
    ]
"""

POSITIONS = """import numpy as np


def jacobian(q):
    s1, c1, s2, c2 = np.sin(q[0]), np.cos(q[0]), np.sin(q[1]), np.cos(q[1])
    s23, c23 = np.sin(q[1] + q[2]), np.cos(q[1] + q[2])
    r, h = c2 + c23, s2 + s23
    return np.array([[-s1*r, -c1*h, -c1*s23], [c1*r, -s1*h, -s1*s23], [0, -r, -c23]])
"""


def test_the_rate_of_a_jacobian(written: Any) -> None:
    right = written("rate.py", RATE)
    verdict = verify.jacobian_dot(right)
    assert verdict.ok and verdict.kind == "jacobian_dot" and "rate of the jacobian" in str(verdict)
    for old, new, entry, reads, due in (
        ("-a3*s23*c1*w1 -", "-a3*s23*c1*w2 -", [2, 3], "- a3 C1 S23 qd2", "-a3 C1 S23 qd1"),
        ("[0, -rd, a3*s23*w23]", "[0, -rd, a3*s23*w2]", [3, 3], "a3 S23 qd2", "a3 S23 qd2 + a3 S23 qd3"),
    ):
        (finding,) = verify.jacobian_dot(written("rate.py", RATE.replace(old, new))).findings
        assert finding.entry == entry and finding.line and finding.old and finding.new
        assert reads in str(finding.reads) and due in str(finding.due), finding


@pytest.mark.parametrize("default", ["eps=2e-6", "*, eps=2e-6"])
def test_the_step_of_differences_may_be_a_default(default: str, written: Any) -> None:
    rate = f"def jacobian_dot(q, qd, {default}):\n    return (jacobian(q + eps*qd) - jacobian(q))/eps\n"
    verdict = verify.jacobian_dot(written("rate.py", f"{POSITIONS}\n\n{rate}"))
    assert verdict.ok and "of differences with the step 2e-6 in line 11" in str(verdict), str(verdict)


def test_the_rate_of_a_jacobian_is_the_change_of_the_jacobian() -> None:
    """Of a chain with a sliding joint, of its six rows, and of the lecture's arm: by differences."""
    random, step = np.random.default_rng(4), 1e-6
    joints = [
        Joint(kind, axis / np.linalg.norm(axis), rotation_of(random.uniform(-2, 2, 3)), random.uniform(-1, 1, 3))
        for kind, axis in ((one, random.uniform(-1, 1, 3)) for one in (True, True, False, True))
    ]
    for truth in (Chain(joints, tool=(0.1, 0.2, 0.3)), ThreeR()):
        q, qd = random.uniform(-2, 2, (2, 20, truth.joints))

        def values(kind: str, q: Any, qd: Any, truth: Any = truth) -> Any:
            return truth.values(KINDS[kind], truth.convention, {"q": q, "qd": qd}, {}, rows=tuple(range(6)))

        by_differences = (values("jacobian", q + step * qd, qd) - values("jacobian", q - step * qd, qd)) / (2 * step)
        assert np.allclose(values("jacobian_dot", q, qd), by_differences, rtol=0, atol=1e-8)


STATES = """import numpy as np


def plant(t, x, u):
    return np.concatenate([x[3:], u - x[:3]])
"""


@pytest.mark.parametrize(
    "text",
    [
        "def power(qd, tau):\n    return qd @ tau\n",
        "def friction(q, qd, tau, k):\n    return tau - k*qd\n",
        "def observer(t, y, u):\n    return y[:3]\n",
        "def reward(s, u):\n    return s[0]\n",
        "def jdot_qd(q, qd):\n    return 0*qd\n",
    ],
)
def test_what_only_looks_like_a_kind_is_asked_for(text: str, written: Any) -> None:
    with pytest.raises(arm3r.UsageError, match="is not clear; name it by --kind"):
        verify.formula_verdict(written("some.py", text))


def test_a_right_hand_side_is_found_by_its_arguments_and_a_wrong_one_is_read(written: Any) -> None:
    """Its derivative of the state is solved for the torque as plain accelerations are."""
    verdict = verify.formula_verdict(written("plant.py", STATES))
    assert not verdict.ok and verdict.kind == "forward"


EULER = """import numpy as np


def jacobian(q):
    s1, c1, s2, c2 = np.sin(q[0]), np.cos(q[0]), np.sin(q[1]), np.cos(q[1])
    s23, c23 = np.sin(q[1] + q[2]), np.cos(q[1] + q[2])
    r, h = c2 + c23, s2 + s23
    linear = [[-s1*r, -c1*h, -c1*s23], [c1*r, -s1*h, -s1*s23], [0, -r, -c23]]
    return np.array(linear + [RATES])
"""


@pytest.mark.sample(1)
@pytest.mark.parametrize("rates", ["[1, 0, 0], [0, 1, 1], [0, 0, 0]", "[0, 0, 0], [0, 1, 1], [1, 0, 0]"])
def test_an_analytical_jacobian_is_called_so(rates: str, written: Any) -> None:
    """The angular rows are the rates of yaw, q1, pitch, q2 + q3, and roll, which stays zero; in either order."""
    verdict = verify.jacobian(written("jacobian.py", EULER.replace("[RATES]", f"[{rates}]")))
    words = "he angular rows are the rates of roll, pitch and yaw, an analytical Jacobian"
    assert words in str(verdict) and not verdict.unexplained, str(verdict)


def test_the_rates_of_euler_angles_are_those_of_a_rotation() -> None:
    """By differences of a rotation of given angles, for turns about x, y and z of the moving frame."""
    random, step = np.random.default_rng(3), 1e-6

    def turn(angles: Any) -> Any:
        x, y, z = (rotation_about(axis, np.array([angle]))[0] for axis, angle in zip(np.eye(3), angles, strict=True))
        return x @ y @ z

    for _ in range(20):
        angles, rates = random.uniform(-1.2, 1.2, (2, 3))
        change = (turn(angles + step * rates) - turn(angles - step * rates)) / (2 * step) @ turn(angles).T
        jacobian = np.array([0, 0, 0, change[2, 1], change[0, 2], change[1, 0]])[None, :, None]
        whole = of_other_frames(jacobian, Pose(turn(angles)[None], np.zeros((1, 3)), np.zeros((1, 3, 1))))
        found = [values()[0, 3:, 0] for words, values, weight, _ in whole if "(XYZ)" in words and weight == 1]
        assert any(np.allclose(one, rates, rtol=0, atol=1e-7) for one in found)


@pytest.mark.parametrize("name", ["Jdot", "dJ", "jacobianDot", "jacobianDerivative", "jacobian_rate", "d_jacobian"])
def test_names_of_a_rate(name: str) -> None:
    assert kinds.kind_of_name(name) == "jacobian_dot"


def test_a_rate_beside_its_jacobian_is_judged_by_its_kind(written: Any) -> None:
    whole = RATE + POSITIONS.replace("import numpy as np", "import numpy as np")
    path = written(
        "both.py", whole + "\n\ndef jacobians(q, qd):\n    return jacobian(q), np.array(jacobian_dot(q, qd))\n"
    )
    for kind in ("jacobian", "jacobian_dot"):
        assert verify.formula_verdict(f"{path}:jacobians", kind).ok
