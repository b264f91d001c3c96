"""Serial chains as the truth: the recursion against Pinocchio and against DH transforms, and formulas judged by it."""

from __future__ import annotations

import os
import random
import re
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest
from arm3r_cpp import UsageError, verify
from arm3r_cpp.verify import Chain
from arm3r_cpp.verify.formula import from_file
from arm3r_cpp.verify.kinds import KINDS
from formulas.draws import draws
from formulas.mutants import mutants
from numpy.typing import NDArray

ROBOTS = Path(__file__).parents[1] / "robots"
TABLES = ("ur5", "puma560", "panda", "rpp")
Floats = NDArray[np.float64]


def chain_of(name: str) -> Chain:
    return Chain.from_urdf(ROBOTS / "elbow.urdf") if name == "elbow" else Chain.from_dh(ROBOTS / f"{name}.csv")


def states(joints: int, count: int = 12) -> tuple[Floats, ...]:
    random = np.random.default_rng(3)
    return tuple(random.uniform(-2.5, 2.5, (count, joints)) for _ in range(4))


def pinocchio_of(chain: Chain) -> tuple[Any, Any]:
    """The same chain, built joint by joint in Pinocchio, with a frame at the tip."""
    model = pin.Model()
    model.gravity.linear = chain.gravity
    parent = 0
    for number, joint in enumerate(chain.parts):
        kind = pin.JointModelRevoluteUnaligned if joint.is_revolute else pin.JointModelPrismaticUnaligned
        parent = model.addJoint(parent, kind(joint.axis), pin.SE3(joint.rotation, joint.origin), f"joint{number}")
        model.appendBodyToJoint(parent, pin.Inertia(joint.mass, joint.centre, joint.inertia), pin.SE3.Identity())
    model.addFrame(pin.Frame("tip", parent, pin.SE3(chain.tool_rotation, chain.tool), pin.FrameType.OP_FRAME))
    return model, model.createData()


def compare(chain: Chain, model: Any, data: Any, tip: int) -> None:
    q, qd, qdd, tau = states(chain.joints)
    given = {"q": q, "qd": qd, "qdd": qdd, "tau": tau}
    rows = {kind: tuple(range(6 if kind == "jacobian" else 3)) for kind in KINDS if kind != "controller"}
    ours = {kind: chain.values(KINDS[kind], "", given, {}, rows=rows[kind]) for kind in rows}
    for row in range(len(q)):
        pin.crba(model, data, q[row])
        mass = np.triu(data.M) + np.triu(data.M, 1).T
        theirs = {
            "jacobian": pin.computeFrameJacobian(model, data, q[row], tip, pin.LOCAL_WORLD_ALIGNED).copy(),
            "mass": mass.copy(),
            "gravity": pin.computeGeneralizedGravity(model, data, q[row]).copy(),
            "inverse": pin.rnea(model, data, q[row], qd[row], qdd[row]).copy(),
            "coriolis": pin.nonLinearEffects(model, data, q[row], qd[row])
            - pin.computeGeneralizedGravity(model, data, q[row]),
            "forward": pin.aba(model, data, q[row], qd[row], tau[row]).copy(),
        }
        pin.framesForwardKinematics(model, data, q[row])
        theirs["kinematics"] = data.oMf[tip].translation.copy()
        for kind, right in theirs.items():
            scale = 1 + np.abs(right).max()
            assert np.abs(ours[kind][row] - right).max() < 1e-9 * scale, kind


@pytest.mark.parametrize("name", [*TABLES, "elbow"])
def test_the_recursion_is_pinocchios(name: str) -> None:
    chain = chain_of(name)
    model, data = pinocchio_of(chain)
    compare(chain, model, data, model.getFrameId("tip"))


def test_a_urdf_is_read_as_pinocchio_reads_it() -> None:
    model = pin.buildModelFromUrdf(str(ROBOTS / "elbow.urdf"))
    chain = chain_of("elbow")
    model.gravity.linear = chain.gravity
    assert chain.revolute == (True, True, False)
    q, qd, qdd, _ = states(3)
    for row in range(len(q)):
        there = np.array(
            [np.cos(q[row, 0]), np.sin(q[row, 0]), q[row, 1], q[row, 2]]
        )  # a continuous joint has two numbers
        data = model.createData()
        tau = pin.rnea(model, data, there, qd[row], qdd[row])
        given = {"q": q[[row]], "qd": qd[[row]], "qdd": qdd[[row]]}
        assert np.allclose(chain.values(KINDS["inverse"], "", given, {}), tau, rtol=0, atol=1e-10)
        pin.framesForwardKinematics(model, data, there)
        tip = data.oMf[model.getFrameId("hand")].translation
        assert np.allclose(chain.values(KINDS["kinematics"], "", given, {}), tip, rtol=0, atol=1e-12)


def transform(word: str, row: list[float], value: float, is_revolute: bool) -> Floats:
    """The textbook's matrix of a row, Spong's for a standard table and Craig's for a modified one."""
    a, alpha, d, theta = row
    theta, d = (theta + value, d) if is_revolute else (theta, d + value)
    c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    if word == "standard":
        return np.array([[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]])
    return np.array([[c, -s, 0, a], [s * ca, c * ca, -sa, -d * sa], [s * sa, c * sa, ca, d * ca], [0, 0, 0, 1]])


@pytest.mark.parametrize("name", TABLES)
def test_a_table_is_read_as_the_textbooks_write_it(name: str) -> None:
    chain = chain_of(name)
    lines = [line for line in (ROBOTS / f"{name}.csv").read_text().splitlines() if not line.startswith("#")]
    cells = [line.split(",") for line in lines[2:]]
    numbers = {"pi/2": np.pi / 2, "-pi/2": -np.pi / 2, "30 deg": np.pi / 6}
    rows = [[numbers[cell] if cell in numbers else float(cell) for cell in line[1:5]] for line in cells]
    q = states(chain.joints)[0]
    for state in q:
        whole = np.eye(4)
        for line, row, value in zip(cells, rows, [*state, 0.0], strict=False):
            whole = whole @ transform(lines[0], row, value, line[0] != "P")
        tip = chain.values(KINDS["kinematics"], "", {"q": state[None], "qd": state[None]}, {})[0]
        assert np.allclose(tip, whole[:3, 3], rtol=0, atol=1e-12)
        assert np.allclose(chain.rotation("", state[None])[0], whole[:3, :3], rtol=0, atol=1e-12)


# ---- formulas -------------------------------------------------------------------------------------------------------

PROGRAM = """
import numpy as np
TABLE = {table}

def frame(a, alpha, d, theta):
    c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array({matrix})

def frames(q):
    T = np.eye(4)
    found = [T]
    for i, (kind, a, alpha, d, theta) in enumerate(TABLE):
        if kind == 'R':
            T = T @ frame(a, alpha, d, theta + q[i])
        else:
            T = T @ frame(a, alpha, d + q[i], theta)
        found.append(T)
    return found

def jacobian(q):
    found = frames(q)
    tip = (found[-1] @ np.array([0, 0, {tool}, 1]))[:3]
    columns = []
    for i, row in enumerate(TABLE):
        T = found[i + {first}]
        z = T[:3, 2]
        if row[0] == 'R':
            columns.append(np.cross(z, tip - T[:3, 3]))
        else:
            columns.append(z)
    return np.array(columns).T

def gravity(q):
    g = 9.80665
    found = frames(q)
    tau = np.zeros(len(TABLE))
    for j, (mass, centre) in enumerate({masses}):
        p = (found[j + 1] @ np.array([*centre, 1]))[:3]
        for i in range(j + 1):
            T = found[i + {first}]
            if TABLE[i][0] == 'R':
                tau[i] += mass*g*np.cross(T[:3, 2], p - T[:3, 3])[2]
            else:
                tau[i] += mass*g*T[2, 2]
    return tau
"""
STANDARD = "[[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]]"
MODIFIED = "[[c, -s, 0, a], [s*ca, c*ca, -sa, -d*sa], [s*sa, c*sa, ca, d*ca], [0, 0, 0, 1]]"


def program_of(name: str) -> str:
    lines = [line for line in (ROBOTS / f"{name}.csv").read_text().splitlines() if not line.startswith("#")]
    rows = [line.split(",") for line in lines[2:]]
    joints = [row for row in rows if row[0] != "tool"]
    words = {"pi/2": "np.pi/2", "-pi/2": "-np.pi/2", "30 deg": "np.pi/6"}
    table = ", ".join(f"('{row[0]}', {', '.join(words.get(cell, cell) for cell in row[1:5])})" for row in joints)
    masses = ", ".join(f"({row[5]}, ({row[6]}, {row[7]}, {row[8]}))" for row in joints)
    tool = rows[-1][3] if rows[-1][0] == "tool" else "0"
    is_modified = lines[0] == "modified"
    return PROGRAM.format(table=f"[{table}]", matrix=MODIFIED if is_modified else STANDARD, tool=tool,
                          first=1 if is_modified else 0, masses=f"[{masses}]")  # fmt: skip


@pytest.mark.parametrize("name", TABLES)
@pytest.mark.parametrize("kind", ["jacobian", "gravity"])
def test_right_formulas_of_other_arms(name: str, kind: str, tmp_path: Path) -> None:
    path = tmp_path / "arm.py"
    path.write_text(program_of(name))
    verdict = verify.formula_verdict(f"{path}:{kind}", kind, chain_of(name))
    assert verdict.ok, str(verdict)


@pytest.mark.parametrize("name", ["rpp", pytest.param("ur5", marks=pytest.mark.gate)])
def test_a_wrong_transform_is_repaired(name: str, tmp_path: Path) -> None:
    path = tmp_path / "arm.py"
    path.write_text(program_of(name).replace("c*ca, -c*sa", "c*ca, c*sa"))
    verdict = verify.formula_verdict(f"{path}:jacobian", "jacobian", chain_of(name))
    (place,) = {(one.line, one.old, one.new) for one in verdict.findings}
    assert "c*sa" in path.read_text().splitlines()[place[0] - 1]


def wrong_entries(text: str, kind: str, chain: Chain) -> set[tuple[int, ...]] | None:
    """The entries, from 1, in which a text differs from the recursion; None where it fails, or divides by rounding.

    With -s / ca for -s * ca and ca = cos(pi / 2), numbers reach 1e31, and an entry that is due to be zero is zero or
    rounding of these: which of the two hangs on the state.
    """
    names: dict[str, Any] = {}
    found: set[tuple[int, ...]] = set()
    try:
        exec(text, names)
        for q in states(chain.joints)[0]:
            due = chain.values(KINDS[kind], "", {"q": q[None], "qd": q[None]}, {})[0]
            got = np.asarray(names[kind](q), float)
            if got.shape != due.shape or not np.isfinite(got).any() or np.abs(got).max() > 1e9 * np.abs(due).max():
                return None
            wrong = np.argwhere(~(np.abs(got - due) <= 1e-8 * np.abs(due).max()))
            found |= {tuple(int(one) + 1 for one in place) for place in wrong}
    except Exception:
        return None
    return found


@pytest.mark.gate
@pytest.mark.parametrize("name", ["rpp", "ur5", "panda"])
@pytest.mark.parametrize("kind", ["jacobian", "gravity"])
def test_mistakes_in_formulas_of_other_arms(name: str, kind: str, tmp_path: Path) -> None:
    outcomes: Counter[str] = Counter()
    chain, path, every = chain_of(name), tmp_path / "arm.py", mutants(program_of(name), "python")
    for choose in draws(int(os.environ.get("ARM3R_SEED", random.randrange(10**6)))):
        if outcomes.total() >= 30:
            break
        text = choose.choice(every)
        wrong = wrong_entries(text, kind, chain)
        if not wrong:
            continue
        path.write_text(text)
        verdict = verify.formula_verdict(from_file(f"{path}:{kind}"), kind, chain)
        assert {tuple(one.entry or ()) for one in verdict.findings} == wrong, text
        is_named = all(one.old is not None or one.reads is not None for one in verdict.findings)
        outcomes["named" if is_named else "unexplained"] += 1
    assert outcomes["named"] >= 27, outcomes


def test_a_division_by_rounding_has_an_edit_and_no_terms(tmp_path: Path) -> None:
    path = tmp_path / "arm.py"
    path.write_text(program_of("ur5").replace("-s*ca", "-s/ca"))
    verdict = verify.formula_verdict(f"{path}:jacobian", "jacobian", chain_of("ur5"))
    assert {(one.old, one.new) for one in verdict.findings} == {("/", "*")}
    assert {one.reads for one in verdict.findings} == {None}
    assert "e+" not in str(verdict).split("\n", 1)[1]


def test_terms_of_a_black_box_carry_the_tables_names() -> None:
    chain = chain_of("ur5")

    def wrong(q: Any) -> Any:
        q = np.asarray(q)
        values = chain.geometric_jacobian(q[None])[0, :3].copy()
        values[2, 1] -= -0.425 * np.cos(q[1])
        return values

    (finding,) = verify.jacobian(wrong, chain).findings
    assert finding.entry == [3, 2] and "a2 C2" in finding.due and "a2 C2" not in finding.reads
    assert "a3 C23" in finding.reads


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("type,a\n", "the first line says which table it is"),
        ("standard\ntype,a,alpha,d\n", ":2: the header is type,a,alpha,d,theta"),
        ("standard\ntype,a,alpha,d,theta\nR,0,ninety,0,0\n", ":3: alpha is a number"),
        ("standard\ntype,a,alpha,d,theta\nQ,0,0,0,0\n", ":3: the type of a joint is R or P"),
        (
            "standard\ntype,a,alpha,d,theta\nR,0,-90,0,0\n",
            ":3: alpha is -90 rad, more than a turn; write -90 deg, or alpha_deg",
        ),
        ("standard\na,alpha [deg],d\n", ":2: the header is type,a,alpha,d,theta"),
        ("standard\ntype,a,alpha,d,theta\n" + "R,0,0,0,0\n" * 8, "1 to 7 joints, got 8"),
    ],
)
def test_what_is_no_table_is_refused(text: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "arm.csv"
    path.write_text(text)
    with pytest.raises(UsageError, match=words):
        Chain.from_dh(path)


@pytest.mark.parametrize("header", ["theta,d,a,alpha_deg", "theta (deg),d,a,alpha[deg]", "theta_rad,d,a,alpha deg"])
def test_a_table_may_have_any_order_and_angles_in_degrees(header: str, tmp_path: Path) -> None:
    rows = ["0,0.089159,0,90", "0,0,-0.425,0", "0,0,-0.39225,0", "0,0.10915,0,90", "0,0.09465,0,-90", "0,0.0823,0,0"]
    path = tmp_path / "ur5.csv"
    path.write_text("\n".join(["standard", header, *rows, ""]))
    q = {"q": np.array([[0.3, -0.5, 0.9, 0.2, 0.1, 0.7]])}
    ours, theirs = (
        one.values(KINDS["jacobian"], "", q, {}) for one in (Chain.from_dh(path), Chain.from_dh(ROBOTS / "ur5.csv"))
    )
    assert np.array_equal(ours, theirs)


def test_what_is_no_urdf_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    for text, words in (("<robot", "this is not XML"), ("<arm/>", "begins with <robot>"),
                        ((ROBOTS / "elbow.urdf").read_text().replace("prismatic", "planar"), "is planar")):  # fmt: skip
        path.write_text(text)
        with pytest.raises(UsageError, match=words):
            Chain.from_urdf(path)


BRANCHED = """<robot name="arm_with_gripper">
<link name="base"/><link name="upper"><inertial><origin xyz="0.25 0.02 0" rpy="0.3 0.1 -0.2"/><mass value="2"/>
  <inertia ixx="0.004" iyy="0.05" izz="0.06" ixy="0.001" ixz="0" iyz="0.002"/></inertial></link>
<link name="fore"><inertial><origin xyz="0.2 0 0.01"/><mass value="1.1"/>
  <inertia ixx="0.003" iyy="0.03" izz="0.03" ixy="0" ixz="0.001" iyz="0"/></inertial></link>
<link name="camera"><inertial><origin xyz="0 0 0.03"/><mass value="0.3"/>
  <inertia ixx="1e-4" iyy="2e-4" izz="2e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="hand"><inertial><mass value="0.4"/>
  <inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="finger"><inertial><origin xyz="0.02 0 0"/><mass value="0.05"/>
  <inertia ixx="1e-5" iyy="1e-5" izz="1e-5" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="tool"/>
<joint name="j1" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.3" rpy="1.2 0 0.4"/>
  <axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="9" velocity="3"/></joint>
<joint name="jc" type="fixed"><parent link="upper"/><child link="camera"/>
  <origin xyz="0.1 0.05 0" rpy="0 0.5 0"/></joint>
<joint name="j2" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="0.5 0 0" rpy="0 0 0.2"/>
  <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="9" velocity="3"/></joint>
<joint name="jh" type="fixed"><parent link="fore"/><child link="hand"/><origin xyz="0.4 0 0" rpy="0.2 0 0"/></joint>
<joint name="jf" type="prismatic"><parent link="hand"/><child link="finger"/><origin xyz="0 0.03 0"/>
  <axis xyz="0 1 0"/><limit lower="0" upper="0.04" effort="9" velocity="3"/></joint>
<joint name="jt" type="fixed"><parent link="hand"/><child link="tool"/><origin xyz="0.1 0 0"/></joint>
</robot>
"""


@pytest.fixture
def branched(tmp_path: Path) -> Path:
    path = tmp_path / "branched.urdf"
    path.write_text(BRANCHED)
    return path


def test_what_hangs_beside_the_chain_is_counted(branched: Path) -> None:
    """A camera, a hand and its finger, which a joint holds at zero; a payload at the tip, and a base that is turned."""
    chain = Chain.from_urdf(branched, tip="tool").placed(payload=0.7, base_rotation=[0.1, -0.4, 0.9])
    assert "mass matrix, jf at zero: right" in str(verify.mass(lambda q: chain.mass_matrix(np.array([q]))[0], chain))
    turn = pin.rpy.rpyToMatrix(0.1, -0.4, 0.9)
    whole = pin.buildModelFromXML(BRANCHED)
    model = pin.buildReducedModel(whole, [whole.getJointId("jf")], np.zeros(3))
    model.gravity.linear = turn.T @ [0, 0, -9.80665]
    frame = model.frames[model.getFrameId("tool")]
    point = pin.Inertia(0.7, frame.placement.translation, np.zeros((3, 3)))
    model.inertias[frame.parentJoint] = model.inertias[frame.parentJoint] + point
    data, (q, qd, qdd, _) = model.createData(), states(2)
    given = {"q": q, "qd": qd, "qdd": qdd}
    torque, mass = (chain.values(KINDS[kind], "", given, {}) for kind in ("inverse", "mass"))
    for row in range(len(q)):
        assert torque[row] == pytest.approx(pin.rnea(model, data, q[row], qd[row], qdd[row]), rel=1e-12, abs=1e-12)
        inertia = pin.crba(model, data, q[row])
        assert mass[row] == pytest.approx(np.triu(inertia) + np.triu(inertia, 1).T, rel=1e-12, abs=1e-12)
        pin.framesForwardKinematics(model, data, q[row])
        place = turn @ data.oMf[model.getFrameId("tool")].translation
        assert chain.values(KINDS["kinematics"], "", given, {})[row] == pytest.approx(place, abs=1e-14)


def test_a_link_of_which_nothing_is_said_is_no_link_without_mass(branched: Path, command: Any) -> None:
    gravity = branched.with_name("gravity.py")
    gravity.write_text("def gravity(q):\n    return [1.0 for _ in q]\n")

    def told(removed: int, mass: str = "") -> tuple[int, str]:
        """With the first inertials replaced: the link's own, or also the one of what is fixed on it."""
        branched.write_text(re.sub(r"(?s)<inertial>.*?</inertial>", mass, BRANCHED, count=removed))
        done = command(gravity, "--urdf", branched, "--tip", "tool")
        return done.returncode, done.stdout + done.stderr

    code, said = told(1, '<inertial><mass value="1"/></inertial>')
    assert code == 11 and "without mass" not in said
    code, said = told(1)  # the camera has one
    assert code == 11 and "upper without mass, as the file gives none" in said
    code, said = told(3)  # with fore's, on which a hand is fixed
    assert code == 12 and "the link upper moves and has no <inertial>; write it into the file, with the mass 0" in said
    code, said = told(3, '<inertial><mass value="0"/></inertial>')
    assert code == 11 and "<inertial>" not in said and "without mass" not in said


def test_a_tree_asks_for_the_tip(branched: Path, command: Any) -> None:
    done = command(branched.with_name("x.py"), "--urdf", branched)
    assert done.returncode == 2 and "ends in camera, finger, tool; name the tip's link: --tip LINK" in done.stderr
    for options, words in {
        ("--tip", "tool"): "--tip: it names a link of --urdf",
        ("--base-rotation", "0,0,1"): "--base-rotation: it turns the base of --urdf or --dh",
        ("--gravity", "90deg,0,0"): "three numbers with commas between them are needed, got '90deg,0,0'",
        ("--urdf", str(branched), "--tip", "tool", "--payload", "nan"): "the payload is nan kg; at most 1e+12 kg",
        ("--urdf", str(branched), "--tip", "tool", "--payload", "inf"): "the payload is inf kg; at most 1e+12 kg",
        ("--gravity", "0,0"): "three numbers with commas between them are needed, got '0,0'",
        ("--urdf", str(branched), "--tip", "tool", "--payload", "-1"): "the payload is -1 kg; none is negative",
    }.items():
        done = command("x.py", *options)
        assert done.returncode == 2 and words in done.stderr, done.stderr


PLANAR = """standard
type,a,alpha,d,theta,mass,cx,cy,cz,Ixx,Iyy,Izz
R,0.9,0,0,0,2,-0.4,0,0,0,0.1,0.1
R,0.6,0,0,0,1.3,-0.25,0,0,0,0.05,0.05
R,0.35,0,0,0,0.7,-0.1,0,0,0,0.02,0.02
"""
IN_THE_PLANE = """function %s = %s(q)
l1 = 0.9; l2 = 0.6; l3 = 0.35; phi = q(1)+q(2)+q(3);
s1 = sin(q(1)); s2 = sin(q(1)+q(2)); s3 = sin(phi); c1 = cos(q(1)); c2 = cos(q(1)+q(2)); c3 = cos(phi);
x = l1*c1 + l2*c2 + l3*c3; y = l1*s1 + l2*s2 + l3*s3;
%s
end
"""
J_OF_PLANE = "J = [-y, -l2*s2-l3*s3, -l3*s3; x, l2*c2+l3*c3, l3*c3"


@pytest.mark.parametrize(
    ("name", "last"),
    [
        ("jacobian", f"{J_OF_PLANE}];"),
        ("jacobian", f"{J_OF_PLANE}; 1 1 1];"),
        ("jacobian", f"{J_OF_PLANE}; 0 0 0];"),
        ("fk", "p = [x; y];"),
        ("fk", "p = [x; y; phi];"),
        ("fk", "p = [x; y; 0];"),
    ],
)
def test_planar_arms_have_rows_of_their_plane(name: str, last: str, written: Any) -> None:
    chain = Chain.from_dh(written("planar.csv", PLANAR))
    text = IN_THE_PLANE % (last[0], name, last)
    verdict = verify.formula_verdict(written(f"{name}.m", text), None, chain)
    assert verdict.ok, str(verdict)
    assert ("third row about z" in str(verdict)) == ("1 1 1" in last or "phi" in last)
    wrong = verify.formula_verdict(written(f"{name}.m", text.replace("l2*c2 + l3", "l2*c2 + l2")), None, chain)
    assert {(one.old, one.new) for one in wrong.findings} == {("l2", "l3")}, str(wrong)


FALLS = """function G = gravity(q%s)
G = %s*[2*cos(q(1)) + 0.4*cos(q(1)+q(2)); 0.4*cos(q(1)+q(2))];
end
"""
UPRIGHT = """<robot name="upright"><link name="base"/>
<link name="l1"><inertial><origin xyz="0.5 0 0"/><mass value="2"/>
  <inertia ixx="0" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="l2"><inertial><origin xyz="0.4 0 0"/><mass value="1"/>
  <inertia ixx="0" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial></link><link name="tip"/>
<joint name="j1" type="revolute"><parent link="base"/><child link="l1"/>
  <origin rpy="1.5707963267948966 0 0" xyz="0 0 0.4"/><axis xyz="0 0 1"/></joint>
<joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/></joint>
<joint name="jt" type="fixed"><parent link="l2"/><child link="tip"/><origin xyz="0.8 0 0"/></joint></robot>
"""


@pytest.mark.sample(2)
@pytest.mark.parametrize("g", ["9.80665", "9.81", "9.8", "10", "g", "9.7"])
def test_what_the_file_does_not_say_of_gravity_is_found(g: str, written: Any, command: Any) -> None:
    """A number that people use is taken and said; another one is wrong, until it is given."""
    urdf, path = written("arm.urdf", UPRIGHT), written("gravity.m", FALLS % (", g" if g == "g" else "", g))
    done = command(path, "--urdf", urdf)
    assert done.returncode == (11 if g == "9.7" else 0), done.stdout
    if g == "g":
        assert "m/s^2" not in done.stdout
    elif g != "9.7":
        assert done.stdout.startswith(f"{path}: gravity torque, g = {g} m/s^2: right")
        stated = command(path, "--urdf", urdf, "--gravity", "0,0,-9.7")
        assert stated.returncode == 11 and "g = 9.7 m/s^2" in stated.stdout
    else:
        assert command(path, "--urdf", urdf, "--gravity", "0,0,-9.7").returncode == 0


def test_the_frame_of_the_first_joint_is_said(written: Any, command: Any) -> None:
    text = """function J = jacobian(q)
J = [-sin(q(1))-0.8*sin(q(1)+q(2)), -0.8*sin(q(1)+q(2)); cos(q(1))+0.8*cos(q(1)+q(2)), 0.8*cos(q(1)+q(2)); 0 0];
end
"""
    done = command(written("jacobian.m", text), "--urdf", written("arm.urdf", UPRIGHT))
    words = "in the frame of joint 1, which is turned by 90 deg about x and is moved by [0, 0, 0.4] m in link base"
    assert done.returncode == 0 and f"{words}, tip tip: right" in done.stdout, done.stdout
    second = "cos(q(1))+0.8*cos(q(1)+q(2)), 0.8*cos(q(1)+q(2))"
    turned = text.replace(f"{second}; 0 0]", f"0 0; {second}]")
    done = command(written("jacobian.m", turned), "--urdf", written("arm.urdf", UPRIGHT))
    assert done.returncode == 0 and "frame of joint 1" not in done.stdout


PAPER = """standard
type,a,alpha,d,theta,mass,cx,cy,cz,Ixx,Iyy,Izz
R,0.7,0,0,0,2.0,-0.35,0,0,0.01,0.1,0.1
R,0.5,0,0,0,1.5,-0.3,0,0,0.008,0.05,0.05
"""
TOGETHER = """function [M, C, G] = dynamics(q, qd)
  m1 = 2.0; m2 = 1.5; l1 = 0.7; lc1 = 0.35; lc2 = 0.2; I1 = 0.1; I2 = 0.05; g = 9.81;
  c2 = cos(q(2)); s2 = sin(q(2));
  h = m2*l1*lc2*s2;
  M = [I1 + I2 + m1*lc1^2 + m2*(l1^2 + lc2^2 + 2*l1*lc2*c2), I2 + m2*(lc2^2 + l1*lc2*c2);
       I2 + m2*(lc2^2 + l1*lc2*c2), I2 + m2*lc2^2];
  C = [-h*qd(2), -h*(qd(1) + qd(2)); h*qd(1), 0];
  G = [(m1*lc1 + m2*l1)*g*cos(q(1)) + m2*lc2*g*cos(q(1)+q(2)); m2*lc2*g*cos(q(1)+q(2))];
end
"""


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("kind", "right", "wrong", "output"),
    [
        ("mass", "2*l1*lc2*c2", "l1*lc2*c2", "M"),
        ("coriolis", "-h*(qd(1) + qd(2))", "-h*qd(2)", "C"),
        ("gravity", "m2*l1)*g", "m2*lc1)*g", "G"),
    ],
)
def test_of_several_matrices_the_one_that_fits_is_judged(
    kind: str, right: str, wrong: str, output: str, written: Any
) -> None:
    chain = Chain.from_dh(written("paper.csv", PAPER))
    verdict = verify.formula_verdict(written("dynamics.m", TOGETHER), kind, chain)
    assert verdict.ok and f"its output {output}" in str(verdict), str(verdict)
    verdict = verify.formula_verdict(written("wrong.m", TOGETHER.replace(right, wrong)), kind, chain)
    lines = {one.line for one in verdict.findings}
    assert lines == {TOGETHER[: TOGETHER.index(right)].count("\n") + 1}, str(verdict)


MISTAKES = {  # of [c, G], whose other output fits, too, and of [tau2, tau1], whose names look like an order
    "[c, G]": ("c", "G"),
    "[F, tau]": ("F", "tau"),
    "[tau2, tau1]": ("tau2", "tau1"),
}


@pytest.mark.parametrize("outputs", MISTAKES)
def test_of_several_vectors_the_one_that_is_named_so_is_judged_with_its_edits(outputs: str, written: Any) -> None:
    chain = Chain.from_dh(written("paper.csv", PAPER)).placed(gravity=(0, -9.81, 0))
    first, second = MISTAKES[outputs]
    G = "[1.75*9.81*cos(q(1)) + 0.3*9.81*cos(q(1)+q(2)); 0.3*9.81*cos(q(1)+q(2))]"
    text = f"function {outputs} = forces(q, qd)\n{first} = [0; 0];\n{second} = {G};\nend\n"
    assert verify.gravity(written("right.m", text), chain).ok
    wrong = text.replace("1.75*9.81*cos", "1.75*9.81*sin").replace("9.81*cos(q(1)+q(2))]", "9.81*cos(q(1))]")
    verdict = verify.gravity(written("wrong.m", wrong), chain)
    assert f"its output {second}" in str(verdict) and "the formula fails" not in str(verdict), str(verdict)
    assert {one.line for one in verdict.findings} == {3}


def test_an_output_that_is_not_asked_for_may_be_missing(written: Any) -> None:
    chain = Chain.from_dh(written("paper.csv", PAPER))
    text = "function [p, J, info] = kin(q)\np = [0.7*cos(q(1)); 0.7*sin(q(1))];\n" + (
        "J = [-0.7*sin(q(1))-0.5*sin(q(1)+q(2)), -0.5*sin(q(1)+q(2)); "
        "0.7*cos(q(1))+0.5*cos(q(1)+q(2)), 0.5*cos(q(1)+q(2))];\nend\n"
    )
    assert verify.jacobian(written("kin.m", text), chain).ok


@pytest.mark.parametrize("g", ["9.81", "9.810"])
@pytest.mark.parametrize("change", [("cos(q[0] + q[1])]", "cos(q[1])]"), ("[G1 + G2, G2]", "[G1 + G2, 0*G2]")])
def test_gravity_acts_on_an_arm_on_paper_whose_formula_has_numbers_alone(g: str, change: Any, written: Any) -> None:
    """A mistake does not make an arm that lies across gravity the likelier one."""
    chain = Chain.from_dh(written("paper.csv", PAPER))
    text = (
        "from math import cos\n\n\ndef gravity(q):\n    G1, [G2] = 1.75*9.81*cos(q[0]), [0.3*9.81*cos(q[0] + q[1])]\n"
    )
    text += "    return [G1 + G2, G2]\n"
    text = text.replace("9.81", g)
    assert verify.gravity(written("right.py", text), chain).ok
    verdict = verify.gravity(written("wrong.py", text.replace(*change)), chain)
    assert not verdict.ok and "g = 9.81 m/s^2 along [0, -1, 0], as the formula has it" in str(verdict), str(verdict)
    assert all(one.due != "0" for one in verdict.findings), str(verdict)


def test_an_arm_that_slides_in_its_plane_lies_on_paper_too(written: Any) -> None:
    table = "standard\ntype,a,alpha,d,theta,mass,cx,cy,cz,Ixx,Iyy,Izz\n" + (
        "R,0,pi/2,0,pi/2,2.0,0,0,0,0.1,0.1,0.1\nP,0,0,0,0,1.0,0,0,0,0.1,0.1,0.1\n"
    )
    chain = Chain.from_dh(written("rp.csv", table))
    verdict = verify.gravity(
        written(
            "g.py", "from math import cos, sin\n\n\ndef gravity(q):\n    return [9.81*q[1]*cos(q[0]), 9.81*sin(q[0])]\n"
        ),
        chain,
    )
    assert verdict.ok, str(verdict)


@pytest.mark.sample(1)
@pytest.mark.parametrize(("wave", "along"), [("cos", "[0, -1, 0]"), ("sin", "[1, 0, 0]"), ("-sin", "[-1, 0, 0]")])
def test_an_arm_that_lies_across_gravity_may_hang_or_stand_on_paper(wave: str, along: str, written: Any) -> None:
    """Its file says nothing of gravity: what the formula means is said first, and so is g."""
    chain = Chain.from_dh(written("paper.csv", PAPER))
    text = TOGETHER.replace("g*cos(", f"g*{wave.strip('-')}(")
    text = text.replace("G = [", "G = -[") if "-" in wave else text
    verdict = verify.formula_verdict(written("gravity.m", text), "gravity", chain)
    assert verdict.ok and f"g = 9.81 m/s^2 along {along}" in str(verdict), str(verdict)
    verdict = verify.formula_verdict(written("gravity.m", text.replace("g = 9.81", "g = 9.7")), "gravity", chain)
    assert "g is 9.7 in line 2; standard gravity is 9.80665 m/s^2, --gravity X,Y,Z gives another" in str(verdict)
    upright = Chain.from_dh(written("paper.csv", PAPER)).placed(gravity=(0, 0, -9.81))
    verdict = verify.formula_verdict(written("gravity.m", text), "gravity", upright)
    assert not verdict.ok and "perpendicular to the arm's plane" in str(verdict), str(verdict)


@pytest.mark.parametrize(("g", "is_near"), [("9.807", True), ("9.82", True), ("9.18", False)])
def test_g_may_be_what_it_is_somewhere_on_earth(g: str, is_near: bool, written: Any) -> None:
    chain = Chain.from_dh(written("paper.csv", PAPER))
    verdict = verify.gravity(written("gravity.m", TOGETHER.replace("g = 9.81", f"g = {g}")), chain)
    assert verdict.ok == is_near and f"g is {g}" in str(verdict), str(verdict)


def test_a_term_of_a_table_has_the_units_of_its_entry(written: Any) -> None:
    """0.3 kg m is no product of two lengths, 3/2 a1 a2, though 0.3 = 3/2 0.4 0.5 by chance."""
    chain = Chain.from_dh(written("paper.csv", PAPER.replace("R,0.7", "R,0.4").replace("-0.35", "-0.2")))
    text = (
        "function G = gravity(q)\nG = [2.0*9.81*cos(q(1)) - 0.3*9.81*cos(q(1)+q(2)); -0.3*9.81*cos(q(1)+q(2))];\nend\n"
    )
    assert "a1 a2" not in str(verify.gravity(written("gravity.m", text), chain))


TWO_ENDS = """<robot name="pendulum"><link name="base"/><link name="plate"/>
<link name="rod"><inertial><origin xyz="0.3 0 0"/><mass value="2"/>
  <inertia ixx="0.001" iyy="0.06" izz="0.06" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="flange"/><link name="tool0"/>
<joint name="jp" type="fixed"><parent link="base"/><child link="plate"/></joint>
<joint name="j1" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/></joint>
<joint name="jf" type="fixed"><parent link="rod"/><child link="flange"/><origin xyz="0.6 0 0"/></joint>
<joint name="jt" type="fixed"><parent link="rod"/><child link="tool0"/><origin xyz="0.7 0 0"/></joint></robot>
"""


def test_what_does_not_depend_on_the_tip_is_judged_without_it(written: Any) -> None:
    """A link that stands on the base is no end; two on the last link are moved by the same joints."""
    path = written("pendulum.urdf", TWO_ENDS)
    chain = Chain.from_urdf(path)
    assert verify.gravity(lambda q: [-2 * 9.80665 * 0.3 * np.cos(q[0])], chain).ok
    assert verify.mass(lambda q: [[0.06 + 2 * 0.3**2]], chain.placed(gravity=[0, 0, -9.81])).ok
    words = "the tree ends in flange, tool0; name the tip's link: --tip LINK"
    with pytest.raises(UsageError, match=words):
        verify.jacobian(lambda q: [-0.7 * np.sin(q[0]), 0, -0.7 * np.cos(q[0])], chain)
    with pytest.raises(UsageError, match=words):
        chain.placed(payload=1.0)
    path = written("one_end.urdf", re.sub('<link name="flange"/>|<joint name="jf".*</joint>\n', "", TWO_ENDS))
    tip = verify.kinematics(lambda q: [0.7 * np.cos(q[0]), 0, -0.7 * np.sin(q[0])], Chain.from_urdf(path))
    assert tip.ok and "tip tool0" in tip.found
