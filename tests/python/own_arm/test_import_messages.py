"""What a URDF must be to become an elbow arm: each refusal names the file, the joint, the rule and the fix."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from arm3r_cpp import Arm, ScenarioWarning, UsageError
from arm3r_cpp.commands.interchange.import_urdf import main
from arm3r_cpp.core.scenario import Scenario
from arm3r_cpp.robots.choice import Choice
from arm3r_cpp.robots.explicit import explicit_arm, own_arm
from arm3r_cpp.robots.start_scenario import start_pose, start_scenario
from elbow_keys import ElbowKeys


def inertial(mass: float, x: float, principal: str = "0.01 0.02 0.03") -> str:
    xx, yy, zz = principal.split()
    return (
        f'<inertial><origin xyz="{x} 0.01 0.02"/><mass value="{mass}"/>'
        f'<inertia ixx="{xx}" iyy="{yy}" izz="{zz}" ixy="0.001" ixz="0" iyz="-0.002"/></inertial>'
    )


ARM = f"""<robot name="arm">
<link name="base"/><link name="column">{inertial(3, 0)}</link><link name="upper">{inertial(2, 0.2)}</link>
<link name="fore">{inertial(1.5, 0.15)}</link><link name="hand">{inertial(0.4, 0.05)}</link><link name="tool"/>
<joint name="turn" type="continuous"><parent link="base"/><child link="column"/><origin xyz="0 0 0.3"/>
  <axis xyz="0 0 1"/></joint>
<joint name="lift" type="revolute"><parent link="column"/><child link="upper"/><origin xyz="0.05 0.1 0.2"/>
  <axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="90" velocity="2"/>
  <dynamics damping="0.5" friction="0.1"/></joint>
<joint name="reach" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="0.4 -0.05 0"/>
  <axis xyz="0 -1 0"/><limit lower="-2.5" upper="2.5" effort="40" velocity="2"/></joint>
<joint name="wrist" type="revolute"><parent link="fore"/><child link="hand"/><origin xyz="0.3 0 0"/>
  <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="9" velocity="2"/></joint>
<joint name="grip" type="fixed"><parent link="hand"/><child link="tool"/><origin xyz="0.1 0 0"/></joint>
</robot>
"""
LOCKED = {"lock": {"wrist": 0}}
FINGER = """<link name="finger"/><joint name="open" type="prismatic"><parent link="hand"/><child link="finger"/>
<axis xyz="0 1 0"/></joint></robot>"""
ROLL = """<origin xyz="0 0 0"/><axis xyz="1 0 0"/></joint><link name="roller"/>
<joint name="reach" type="revolute"><parent link="roller"/>"""
"""Between upper and fore: a joint along the upper arm."""

Import = Callable[..., str]


@pytest.fixture
def imported(tmp_path: Path) -> Import:
    """imported((old, new), ..., lock=...): the keys of the arm with texts replaced."""

    def call(*changes: tuple[str, str], **request: Any) -> str:
        text = ARM
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        (tmp_path / "arm.urdf").write_text(text)
        return explicit_arm({"urdf": "arm.urdf", "folder": tmp_path, **request})

    return call


def with_roll(text: str = "revolute") -> tuple[str, str]:
    return (
        '<joint name="reach" type="revolute"><parent link="upper"/>',
        f'<joint name="roll" type="{text}"><parent link="upper"/><child link="roller"/>{ROLL}',
    )


def test_the_keys_are_named_by_the_joints_and_links_of_the_file(imported: Import) -> None:
    keys = imported(lock={"wrist": "30 deg"})
    assert "# joints: turn, lift, reach\njoint_zero" in keys and "# fore, hand, tool\nlink3:" in keys
    found = yaml.safe_load(keys)
    assert found["damping"] == [0, 0.5, 0] and found["friction"] == [0, 0.1, 0]
    assert found["torque_limit"] == ["inf", 90, 40]
    assert found["base"] == {"position": [0, 0, 0.5], "rotation": [0, 0, 0]} and found["shoulder_offset"] == 0.05
    assert found["joint_sign"] == [1, -1, 1] and found["joint_zero"][:2] == [0, 0]
    assert found["link2"]["length"] == 0.4 and found["link2"]["offset"] == 0.05
    assert max(map(len, keys.splitlines())) <= 110


@pytest.mark.parametrize(
    ("changes", "request_", "words"),
    [
        ([], {}, "on the way to tool wrist moves, too, and an elbow arm has three joints (turn, lift, reach); lock "
                 "what shall not move, such as lock: {wrist: 0}"),
        ([with_roll()], {"joints": ["turn", "lift", "reach"]},
         "roll and wrist move, too, and an elbow arm has three joints (turn, lift, reach); lock what shall not move, "
         "such as lock: {roll: 0, wrist: 0}"),
        ([], {"lock": {"writs": 0}}, "there is no joint 'writs'; did you mean wrist?"),
        ([], {"lock": {"grip": 0}}, "lock: grip is fixed; what can be locked is revolute, continuous or prismatic"),
        ([], {"lock": {"wrist": "half"}}, "lock: wrist: an angle is needed, in rad or such as -90 deg, got 'half'"),
        ([], {"lock": {"wrist": float("nan")}}, "lock: wrist: an angle is needed, in rad or such as -90 deg, got nan"),
        ([], {"lock": ["wrist"]}, "lock: a map of names and angles is needed, such as {wrist: -90 deg}, got ['wrist']"),
        ([], LOCKED | {"axis_tolerance": 1}, "axis_tolerance: an angle from 0 to 45 deg is needed, got 1 rad"),
        ([], LOCKED | {"joints": ["turn", "lift"]}, "joints: the names of three joints are needed, from base to tip"),
        ([], LOCKED | {"joints": ["turn", "lift", "raech"]}, "there is no joint 'raech'; did you mean reach?"),
        ([], LOCKED | {"joints": ["turn", "lift", "wrist"]}, "wrist is among joints and is locked; it is one of them"),
        ([], LOCKED | {"joints": ["turn", "lift", "grip"]}, "grip does not move; turn, lift and reach can"),
        ([], LOCKED | {"joints": ["lift", "turn", "reach"]}, "joints are named from base to tip: turn, lift, reach"),
        ([("</robot>", FINGER)], {"tip": "tool", "joints": ["turn", "lift", "open"]},
         "open is not on the way to tool: turn, lift, reach, wrist, grip"),
        ([], {"lock": {"wrist": 0, "lift": 0}}, "only turn and reach can move; an elbow arm has three joints"),
        ([('"turn" type="continuous"', '"turn" type="prismatic"')], LOCKED,
         "turn is prismatic; the three joints of an elbow arm are revolute or continuous: lock it, such as "
         "lock: {turn: 0}"),
        ([('"turn" type="continuous"', '"turn" type="floating"')], LOCKED, "turn is floating; the three joints"),
        ([('<axis xyz="0 -1 0"/>', '<axis xyz="0 -1 0"/><mimic joint="lift" multiplier="-1"/>')], LOCKED,
         "reach mimics lift, and joints of an elbow arm move each on its own; lock one of them"),
        ([("</robot>", FINGER)], LOCKED, "the tree ends in tool, finger; name the tip's link: --tip LINK, in a "
                                         "scenario arm.tip, in Python tip="),
        ([], LOCKED | {"tip": "nail"}, "there is no link 'nail'; it has base, column, upper, fore, hand, tool"),
        ([(inertial(2, 0.2), "")], LOCKED, "upper has no <inertial>: give arm.link2.mass, com, inertia beside"),
        ([('<mass value="2"/>', "")], LOCKED, "upper has no mass: give arm.link2.mass, com, inertia beside arm.urdf"),
        ([('<child link="tool"/>', '<child link="hand"/>')], LOCKED,
         "the joints 'wrist' and 'grip' have one child, 'hand'; a URDF is a tree"),
        ([('xyz="0.4 -0.05 0"', 'xyz="0 0.3 0"')], LOCKED, "lift and reach have one axis; an elbow arm has a link"),
        ([], {"lock": {"wrist": 0}, "tip": "fore"}, "fore lies on the axis of reach, which cannot move it; name"),
        ([('<axis xyz="0 1 0"/>', '<axis xyz="0 1 1"/>')], LOCKED,
         "the axes of turn and lift are 45 deg apart; an elbow arm needs them at 90 deg within axis_tolerance, 1e-06 "
         "rad"),
        ([with_roll()], {"lock": {"wrist": 0, "roll": 0.3}},
         "the axes of lift and reach are 17.19 deg apart; an elbow arm needs them parallel within axis_tolerance, "
         "1e-06 rad; lock roll at 0 or 180 deg instead of 0.3 rad"),
        ([('<axis xyz="0 -1 0"/>', '<axis xyz="0 -1 0.0066"/>')], LOCKED,
         "the axes of lift and reach are 0.3781 deg apart; an elbow arm needs them parallel within axis_tolerance, "
         "1e-06 rad; axis_tolerance: 0.0066 takes them so; the tip is then up to"),
    ],
)  # fmt: skip
def test_what_is_no_elbow_arm_is_refused(
    imported: Import, tmp_path: Path, changes: list[tuple[str, str]], request_: dict[str, Any], words: str
) -> None:
    with pytest.raises(UsageError) as error:
        imported(*changes, **request_)
    assert str(error.value).startswith(f"{tmp_path / 'arm.urdf'}: ") and words in str(error.value)


def test_a_xacro_file_is_not_taken_for_a_urdf(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf.xacro"
    words = re.escape(f"{path}: this is a xacro file; `xacro {path} > robot.urdf` expands it to a URDF")
    for head in ('<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">', '<robot name="arm">'):
        path.write_text(ARM.replace('<robot name="arm">', f'{head}<xacro:include filename="a.xacro"/>'))
        with pytest.raises(UsageError, match=words):
            explicit_arm({"urdf": path, **LOCKED})
    path.write_text(ARM.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" '))  # it was expanded
    assert "model: elbow" in explicit_arm({"urdf": path, **LOCKED})


def test_masses_beside_the_file_take_the_place_of_those_it_lacks(imported: Import) -> None:
    bare = (inertial(2, 0.2), "")
    with pytest.raises(UsageError, match=r"give arm\.link2\.com, inertia beside"):
        imported(bare, **LOCKED, given=["link2.mass"])
    keys = yaml.safe_load(imported(bare, **LOCKED, given=["link2.mass", "link2.com", "link2.inertia"]))
    assert keys["link2"] == {"length": 0.4, "offset": 0.05}
    assert "link1" not in yaml.safe_load(imported((inertial(3, 0), ""), **LOCKED))


# ---- what is taken, and said ----------------------------------------------------------------------------------------


def test_no_effort_is_no_limit(imported: Import) -> None:
    with pytest.warns(ScenarioWarning, match=r"arm\.urdf: effort of reach is 0: taken as no limit of torque"):
        assert yaml.safe_load(imported(('effort="40"', 'effort="0"'), **LOCKED))["torque_limit"] == ["inf", 90, "inf"]


def test_joints_beside_the_way_are_held_and_named(imported: Import) -> None:
    with pytest.warns(ScenarioWarning, match="held at zero beside the way to tool: open; lock sets other positions"):
        imported(("</robot>", FINGER), tip="tool", **LOCKED)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        imported(("</robot>", FINGER), tip="tool", lock={"wrist": 0, "open": 0.02})


def test_placeholders_are_named(imported: Import) -> None:
    alike = [(inertial(*old), inertial(2, old[1])) for old in ((3, 0), (1.5, 0.15), (0.4, 0.05))]
    with pytest.warns(ScenarioWarning, match="column, upper, fore, hand all have the mass 2 kg and one inertia"):
        imported(*alike, **LOCKED)


def test_a_link_1_without_mass_keeps_its_inertia(imported: Import) -> None:
    """Of a PUMA 560's link 1 only the inertia about axis 1 is published."""
    keys = ElbowKeys(
        imported((inertial(3, 0), inertial(0, 0, "0 0 0.35").replace("0.001", "0").replace("-0.002", "0")), **LOCKED)
    )
    other = ElbowKeys(imported((inertial(3, 0), ""), **LOCKED))
    q = np.array([0.3, -0.7, 1.1])
    assert keys.mass_matrix(q) - other.mass_matrix(q) == pytest.approx(np.diag([0.35, 0, 0]), abs=1e-13)


def test_a_joint_that_mimics_a_locked_one_is_locked(imported: Import) -> None:
    mimic = ('<axis xyz="0 0 1"/><limit', '<axis xyz="0 0 1"/><mimic joint="roll" multiplier="-2" offset="0.1"/><limit')
    assert imported(with_roll(), mimic, lock={"roll": np.pi}) == imported(
        with_roll(), lock={"roll": "180deg", "wrist": 0.1 - 2 * np.pi}
    )


def test_right_angles_of_nine_decimals_are_right(imported: Import) -> None:
    def turned(angle: str) -> list[tuple[str, str]]:
        return [('xyz="0.05 0.1 0.2"', f'xyz="0.05 0.1 0.2" rpy="{angle} 0 0"'),
                ('<axis xyz="0 1 0"/>', '<axis xyz="0 0 -1"/>')]  # fmt: skip

    exact = imported(*turned("1.5707963267948966"), ('<axis xyz="0 -1 0"/>', '<axis xyz="0 0 1"/>'), **LOCKED)
    assert imported(*turned("1.570796327"), ('<axis xyz="0 -1 0"/>', '<axis xyz="0 0 1"/>'), **LOCKED) == exact


def test_axes_within_the_tolerance_are_taken_as_those_of_an_elbow_arm(imported: Import, tmp_path: Path) -> None:
    """The tip is off by what the message says, and nowhere by more."""
    tilts = [
        ('<axis xyz="0 -1 0"/>', '<axis xyz="0.004 -1 0.005"/>'),
        ('<axis xyz="0 1 0"/>', '<axis xyz="0 1 0.002"/>'),
    ]
    with pytest.raises(UsageError) as error:
        imported(*tilts, **LOCKED)
    tolerance, millimetres = re.findall(r"axis_tolerance: (\S+) takes them so.* up to (\S+) mm off", str(error.value))[
        0
    ]
    assert 1 < float(millimetres) < 6
    with pytest.warns(
        ScenarioWarning, match=rf"taken as those of an elbow arm.*; the tip is up to {millimetres} mm off"
    ):
        imported(*tilts, **LOCKED, axis_tolerance=float(tolerance))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        arm = own_arm(Choice.of({"urdf": tmp_path / "arm.urdf", **LOCKED, "axis_tolerance": tolerance}))
    q = np.random.default_rng(9).uniform(-np.pi, np.pi, (3000, 3))
    keys = ElbowKeys(arm.text)
    ours = np.array([keys.tip_position(one) for one in q])
    assert ours == pytest.approx(arm.elbow.tip_position(q), abs=1e-14)
    off = np.linalg.norm(ours - arm.chain.tip_position(q), axis=1)
    assert 0.5 < 1e3 * off.max() / float(millimetres) < 1.1


# ---- a whole scenario -----------------------------------------------------------------------------------------------


def test_the_start_is_clear_of_singular_poses_and_within_the_limits(imported: Import, tmp_path: Path) -> None:
    for limits in ('lower="-2.5" upper="2.5"', 'lower="0.3" upper="0.4"', 'lower="-0.1" upper="1"'):
        imported(('lower="-2.5" upper="2.5"', limits), **LOCKED)
        choice = Choice.of({"urdf": tmp_path / "arm.urdf", **LOCKED})
        arm = own_arm(choice)
        pose = start_pose(arm.elbow, arm.chain)
        least, greatest = (float(word.strip('"')) for word in re.findall(r'"[^"]+"', limits))
        assert least <= pose[2] <= greatest
        assert abs(np.linalg.det(ElbowKeys(arm.text).jacobian(pose))) > 0.005
        scenario = yaml.safe_load(start_scenario(choice))
        [tip] = arm.elbow.tip_position(pose[None])
        assert np.linalg.norm(tip - scenario["wall"]["point"]) == pytest.approx(0.05, abs=1e-5)
        assert np.dot(scenario["wall"]["normal"], tip - scenario["wall"]["point"]) == pytest.approx(0.05, abs=1e-5)


def test_the_command_prints_a_scenario(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(ARM)
    assert main([str(path)]) == 2
    assert capsys.readouterr().err.startswith(f"arm3r-import: {path}: on the way to tool wrist moves, too")
    assert main([str(path), "--joints", "turn,lift,reach", "--lock", "wrist=-90deg", "--tip", "tool"]) == 0
    text = capsys.readouterr().out
    scenario = yaml.safe_load(text)
    assert scenario["format"] == 1 and scenario["name"] == "arm"
    assert "Locked, in rad or m: wrist at -1.5708" in text
    assert scenario["arm"] == yaml.safe_load(explicit_arm({"urdf": path, "lock": {"wrist": -np.pi / 2}}))
    with pytest.raises(SystemExit):
        main([str(path), "--lock", "wrist"])
    assert "NAME=ANGLE is needed, got 'wrist'" in capsys.readouterr().err


def test_the_scenario_runs_as_it_is(tmp_path: Path) -> None:
    (tmp_path / "arm.urdf").write_text(ARM)
    run = Scenario(start_scenario(Choice.of({"urdf": tmp_path / "arm.urdf", **LOCKED}))).run()
    assert run.passed and [event.type for event in run.events] == ["make"]
    assert np.ptp(run["q"], axis=0).max() < 1e-6


def test_an_arm_comes_from_a_urdf(tmp_path: Path) -> None:
    (tmp_path / "arm.urdf").write_text(ARM)
    arm = Arm.from_urdf(tmp_path / "arm.urdf", lock={"wrist": "30 deg"})
    keys = ElbowKeys(explicit_arm({"urdf": tmp_path / "arm.urdf", "lock": {"wrist": "30 deg"}}))
    for q in np.random.default_rng(2).uniform(-3, 3, (5, 3)):
        assert arm.tip_position(q) == pytest.approx(keys.tip_position(q), abs=1e-13)
        assert arm.mass_matrix(q) == pytest.approx(keys.mass_matrix(q), rel=1e-12, abs=1e-12)
