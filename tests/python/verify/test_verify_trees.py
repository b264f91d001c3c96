"""The trees of real robots: their chains against Pinocchio's, and what a file leaves open is refused with the remedy.

robots/trees.csv has the published numbers of their URDFs, a row a joint: Universal Robots (ur_description), Franka
Emika (franka_description), KUKA and ABB (support packages of ROS-Industrial, descriptions of MathWorks and Drake),
Kinova (kinova-ros, ros_kortex), Rethink's Sawyer, PUMA 560 (Robotics Toolbox), Unitree's Z1, Gluon of Innfos (by the
exporter of SolidWorks), Blueprint Lab's Bravo 7 with a camera beside its hand; right angles have all digits, but those
of the Bravo, which has four or five.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest
from arm3r_cpp import UnjudgedError, UsageError, verify
from arm3r_cpp.verify import Chain
from arm3r_cpp.verify.functions import formula_verdict
from arm3r_cpp.verify.kinds import KINDS
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Row = dict[str, str]
with (Path(__file__).parents[1] / "robots" / "trees.csv").open() as file:
    ROWS = list(csv.DictReader(file))
TREES = {name: [row for row in ROWS if row["robot"] == name] for name in dict.fromkeys(row["robot"] for row in ROWS)}
TIPS = {
    "ur3": "tool0",
    "ur5": "ee_link",
    "ur10": "tool0",
    "ur5e": "tool0",
    "panda": "panda_hand",
    "panda_fingers": "panda_rightfinger",
    "panda_bodies": "end_effector_frame",
    "fr3": "fr3_link8",
    "iiwa7": "iiwa_link_ee",
    "iiwa14": "iiwa_link_ee",
    "kr16": "tool0",
    "kr210": "tool0",
    "irb120": "tool0",
    "irb2400": "tool0",
    "irb6640": "tool0",
    "kinova_j2n6s300": "j2n6s300_end_effector",
    "kinova_gen3": None,
    "sawyer": "right_hand",
    "puma560": None,
    "ur3e": "tool0",
    "ur10e": "tool0",
    "ur16e": "tool0",
    "kr5": "tool0",
    "z1": None,
    "gluon": None,
    "bravo7": "bravo_finger_jaws_base_link",
}
TOO_LONG = {"panda_fingers": "a chain has 1 to 7 joints, got 8"}  # a finger's joint is one
WITHOUT_BODIES = ("panda", "fr3", "irb2400", "irb6640", "puma560", "bravo7")


def urdf_of(rows: Iterable[Row]) -> str:
    links: dict[str, Row | None] = {}
    joints = []
    for row in rows:
        links.setdefault(row["parent"], None)
        links[row["child"]] = row
        limit = (
            '<limit lower="-3" upper="3" effort="9" velocity="3"/>' if row["type"] in ("revolute", "prismatic") else ""
        )
        joints.append(
            f'<joint name="{row["joint"]}" type="{row["type"]}"><parent link="{row["parent"]}"/>'
            f'<child link="{row["child"]}"/><origin xyz="{row["xyz"]}" rpy="{row["rpy"]}"/>'
            f'<axis xyz="{row["axis"]}"/>{limit}</joint>'
        )
    bodies = [f'<link name="{name}">{inertial_of(row) if row else ""}</link>' for name, row in links.items()]
    return f'<robot name="tree">{"".join(bodies)}{"".join(joints)}</robot>'


def inertial_of(row: Row) -> str:
    if not row["mass"]:
        return ""
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    inertia = " ".join(f'{name}="{value}"' for name, value in zip(names, row["inertia"].split(), strict=True))
    return (
        f'<inertial><origin xyz="{row["centre"]}" rpy="{row["turn"]}"/><mass value="{row["mass"]}"/>'
        f"<inertia {inertia}/></inertial>"
    )


@pytest.fixture
def chain_of(tmp_path: Path) -> Any:
    def make(name: str) -> tuple[Chain, str]:
        path = tmp_path / f"{name}.urdf"
        path.write_text(urdf_of(TREES[name]))
        return Chain.from_urdf(path, tip=TIPS[name]), path.read_text()

    return make


def moving(name: str, tip: str) -> list[str]:
    """The joints from the base to the tip."""
    by_child = {row["child"]: row for row in TREES[name]}
    found: list[str] = []
    while tip in by_child:
        row = by_child[tip]
        found += [row["joint"]] if row["type"] != "fixed" else []
        tip = row["parent"]
    return found[::-1]


@pytest.mark.parametrize("name", sorted(TREES.keys() - TOO_LONG.keys()))
def test_a_tree_is_pinocchios(name: str, chain_of: Any) -> None:
    chain, text = chain_of(name)
    whole = pin.buildModelFromXML(text)
    on_way = moving(name, chain.tip)
    still = [joint for joint in range(1, whole.njoints) if whole.names[joint] not in on_way]
    model = pin.buildReducedModel(whole, still, pin.neutral(whole)) if still else whole
    assert [joint for joint in model.names if joint != "universe"] == on_way
    model.gravity.linear = chain.gravity
    data, frame = model.createData(), model.getFrameId(chain.tip, pin.FrameType.BODY)
    rng = np.random.default_rng(7)
    states = {word: rng.uniform(-2.5, 2.5, (8, chain.joints)) for word in ("q", "qd", "qdd", "tau")}
    ours = {word: chain.values(KINDS[word], "", states, {}) for word in ("kinematics",)}
    ours["jacobian"] = chain.values(KINDS["jacobian"], "", states, {}, rows=tuple(range(6)))
    if name not in WITHOUT_BODIES:
        ours |= {word: chain.values(KINDS[word], "", states, {}) for word in ("mass", "gravity", "inverse")}
    for row in range(8):
        q = pin.integrate(model, pin.neutral(model), states["q"][row])  # of a continuous joint a sine and a cosine
        inertia = pin.crba(model, data, q).copy()
        theirs = {
            "jacobian": pin.computeFrameJacobian(model, data, q, frame, pin.LOCAL_WORLD_ALIGNED).copy(),
            "mass": np.triu(inertia) + np.triu(inertia, 1).T,
            "gravity": pin.computeGeneralizedGravity(model, data, q).copy(),
            "inverse": pin.rnea(model, data, q, states["qd"][row], states["qdd"][row]).copy(),
        }
        pin.framesForwardKinematics(model, data, q)
        theirs["kinematics"] = data.oMf[frame].translation.copy()
        for word, values in ours.items():
            scale = 1 + np.abs(theirs[word]).max()
            assert np.abs(values[row] - theirs[word]).max() < 1e-12 * scale, word


@pytest.mark.parametrize("name", TOO_LONG)
def test_a_chain_of_more_joints_is_refused(name: str, chain_of: Any) -> None:
    with pytest.raises(UsageError, match=TOO_LONG[name]):
        chain_of(name)


@pytest.mark.parametrize("name", WITHOUT_BODIES)
def test_of_a_file_without_bodies_what_needs_none_is_judged(name: str, chain_of: Any) -> None:
    chain, _ = chain_of(name)
    right = chain.values

    def tip(q: Any) -> Any:
        return right(KINDS["kinematics"], "", {"q": np.atleast_2d(q)}, {})[0]

    assert verify.kinematics(tip, chain).ok
    with pytest.raises(
        UnjudgedError, match=r"no <inertial>; write it into the file, with the mass 0 where there is none"
    ):
        verify.gravity(lambda q: 0 * np.asarray(q), chain)


def test_an_inertia_that_no_body_has_is_still_compared(tmp_path: Path) -> None:
    """A published PUMA 560 has one: the recursion takes it as it is, and so does Pinocchio's model of its numbers."""
    row = next(one for one in TREES["ur5"] if one["joint"] == "elbow_joint")
    odd = [one | {"inertia": "0.01 0 0 -0.002 0 0.3"} if one is row else one for one in TREES["ur5"]]
    path = tmp_path / "odd.urdf"
    path.write_text(urdf_of(odd))
    chain = Chain.from_urdf(path, tip="ee_link")
    q = np.array([[0.2, -0.7, 1.1, 0.4, -0.3, 0.6]])
    plain = Chain.from_urdf(_plain(tmp_path), tip="ee_link")
    change = chain.values(KINDS["mass"], "", {"q": q}, {})[0] - plain.values(KINDS["mass"], "", {"q": q}, {})[0]
    assert np.abs(change[3:, 3:]).max() < 1e-14 < np.abs(change[:3, :3]).max()


def _plain(folder: Path) -> Path:
    path = folder / "plain.urdf"
    path.write_text(urdf_of(TREES["ur5"]))
    return path


DH_OF_UR = {  # d1, a2, a3, d4, d5, d6 as the manufacturer gives them, of frame 0 and of joints with these twists
    "ur3": (0.1519, -0.24365, -0.21325, 0.11235, 0.08535, 0.0819),
    "ur5": (0.089159, -0.425, -0.39225, 0.10915, 0.09465, 0.0823),
    "ur10": (0.1273, -0.612, -0.5723, 0.163941, 0.1157, 0.0922),
    "ur3e": (0.15185, -0.24355, -0.2132, 0.13105, 0.08535, 0.0921),
    "ur5e": (0.1625, -0.425, -0.3922, 0.1333, 0.0997, 0.0996),
    "ur10e": (0.1807, -0.6127, -0.57155, 0.17415, 0.11985, 0.11655),
    "ur16e": (0.1807, -0.4784, -0.36, 0.17415, 0.11985, 0.11655),
}
UR = """import numpy as np

d = [D1, 0, 0, D4, D5, D6]
a = [0, A2, A3, 0, 0, 0]
alpha = [np.pi/2, 0, 0, np.pi/2, -np.pi/2, 0]


def frames(q):
    found = [np.eye(4)]
    for i in range(6):
        c, s, ca, sa = np.cos(q[i]), np.sin(q[i]), np.cos(alpha[i]), np.sin(alpha[i])
        step = [[c, -s*ca, s*sa, a[i]*c], [s, c*ca, -c*sa, a[i]*s], [0, sa, ca, d[i]], [0, 0, 0, 1]]
        found.append(found[-1] @ np.array(step))
    return found


def forward_kinematics(q):
    return frames(q)[-1]


def jacobian(q):
    *before, last = frames(q)
    return np.array([[*np.cross(one[:3, 2], last[:3, 3] - one[:3, 3]), *one[:3, 2]] for one in before]).T
"""


def ur_program(name: str) -> str:
    text = UR
    for letter, value in zip(("D1", "A2", "A3", "D4", "D5", "D6"), DH_OF_UR[name], strict=True):
        text = text.replace(letter, str(value))
    return text


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", DH_OF_UR)
def test_formulas_in_the_frame_of_another_fixed_link_are_right(name: str, chain_of: Any, tmp_path: Path) -> None:
    """The controller of a UR has its frame turned by 180 degrees from that of ROS: its file has both."""
    chain, _ = chain_of(name)
    text = ur_program(name)
    path = tmp_path / "ur.py"
    path.write_text(text)
    for function in ("forward_kinematics", "jacobian"):
        verdict = formula_verdict(f"{path}:{function}", arm=chain)
        assert verdict.ok, str(verdict)
        assert any(re.match(r"in the frame of link base\w*, which is turned by 180 deg about -?z", one)
                   for one in verdict.found), verdict.found  # fmt: skip
    path.write_text(text.replace("-np.pi/2", "np.pi/2"))
    assert not formula_verdict(f"{path}:jacobian", arm=chain).ok


def test_a_point_of_another_link_on_the_last_one_is_named(tmp_path: Path) -> None:
    path, formula = tmp_path / "ur5.urdf", tmp_path / "ur.py"
    path.write_text(urdf_of(TREES["ur5"]))
    formula.write_text(ur_program("ur5"))
    wrist = Chain.from_urdf(path, tip="wrist_3_link")
    verdict = formula_verdict(f"{formula}:forward_kinematics", arm=wrist)
    assert {one.cause for one in verdict.findings} == {"The point is that of link ee_link: name it by --tip ee_link."}
    assert "in the frame of link base, which is turned by 180 deg about z in link world" in verdict.found
    turned = wrist.placed(base_rotation=(0, 0, np.pi / 2))
    verdict = formula_verdict(f"{formula}:forward_kinematics", arm=turned)
    words = "in the frame of link base, which is turned by 90 deg about -z in that in which the base stands"
    assert words in verdict.found, verdict.found


TWISTS = """

def body_jacobian(q):
    J, R = jacobian(q), frames(q)[-1][:3, :3]
    return np.vstack([R.T @ J[3:], R.T @ J[:3]])


def JacobianSpace(q):
    J, p = jacobian(q), frames(q)[-1][:3, 3]
    return np.vstack([J[3:], J[:3] - np.cross(J[3:].T, p).T])
"""


def twists(tip: str, folder: Path) -> tuple[Chain, Path]:
    """A UR5 up to a tip, and Jacobians of it as twists."""
    path, formula = folder / "ur5.urdf", folder / "ur.py"
    path.write_text(urdf_of(TREES["ur5"]))
    formula.write_text(ur_program("ur5") + TWISTS)
    return Chain.from_urdf(path, tip=tip), formula


@pytest.mark.parametrize("tip", ["tool0", "ee_link"])
def test_body_and_space_jacobians_are_right_as_what_they_are_called(tip: str, tmp_path: Path) -> None:
    """Angular rows first, in any fixed frame of the file and any frame on the tip."""
    chain, formula = twists(tip, tmp_path)
    moving = "the tip's frame" if tip == "tool0" else "a frame that moves with the tip"
    words = {
        "body_jacobian": f"a body Jacobian, in {moving}, angular rows first",
        "JacobianSpace": "a space Jacobian, of the point at the base's origin, angular rows first",
    }
    for name, said in words.items():
        verdict = formula_verdict(f"{formula}:{name}", arm=chain)
        assert verdict.ok and verdict.residual < 1e-12 and verdict.found[0].startswith(said), str(verdict)


@pytest.mark.gate
def test_wrong_body_and_space_jacobians_and_those_of_other_names_are_wrong(tmp_path: Path) -> None:
    chain, formula = twists("tool0", tmp_path)
    text = formula.read_text()
    formula.write_text(text.replace("R.T @ J[:3]", "R @ J[:3]").replace("- np.cross", "+ np.cross"))
    assert not any(formula_verdict(f"{formula}:{name}", arm=chain).ok for name in ("body_jacobian", "JacobianSpace"))
    for name in ("jacobian_of_tip", "task_space_jacobian"):
        formula.write_text(text.replace("body_jacobian", name).replace("JacobianSpace", name))
        assert not formula_verdict(f"{formula}:{name}", arm=chain).ok
    formula.write_text(text.replace("body_jacobian", "jacobian_of_tip"))
    verdict = formula_verdict(f"{formula}:jacobian_of_tip", arm=chain)
    assert not verdict.ok and "in the tip's frame" in verdict.findings[0].cause


def test_the_rate_of_a_jacobian_in_other_axes_is_no_rate_of_a_body_jacobian(tmp_path: Path) -> None:
    """That has the rate of the axes, too."""
    path = tmp_path / "rate.py"
    path.write_text("""import numpy as np


def turned(q):
    c1, s1, c, s = np.cos(q[0]), np.sin(q[0]), np.cos(q[1] + q[2]), np.sin(q[1] + q[2])
    return np.array([[c1*c, s1*c, -s], [-s1, c1, 0], [c1*s, s1*s, c]])


def jacobian(q):
    c1, s1 = np.cos(q[0]), np.sin(q[0])
    a, b, c, d = np.cos(q[1]), np.sin(q[1]), np.cos(q[1] + q[2]), np.sin(q[1] + q[2])
    r, h = a + c, b + d
    return np.array([[-s1*r, -c1*h, -c1*d], [c1*r, -s1*h, -s1*d], [0, -r, -c]])


def body_jacobian(q):
    return turned(q) @ jacobian(q)


def body_jacobian_dot(q, qd):
    small = 1e-30
    return turned(q) @ np.imag(jacobian(np.array(q) + 1j*small*np.array(qd)).astype(complex))/small
""")
    verdict = formula_verdict(f"{path}:body_jacobian")
    assert verdict.ok and verdict.found[0] == "a body Jacobian, in the tip's frame", str(verdict)
    verdict = formula_verdict(f"{path}:body_jacobian_dot")
    assert not verdict.ok and "in the tip's frame" in verdict.findings[0].cause, str(verdict)
