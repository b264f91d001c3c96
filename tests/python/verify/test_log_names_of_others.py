"""Logs of other programs: joints by their names and numbers, units in all spellings; a right log is right."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arm3r_cpp import UsageError
from arm3r_cpp.commands import verify as verify_cli
from arm3r_cpp.logs.names import columns_of
from arm3r_cpp.logs.table import read_table
from arm3r_cpp.logs.units import unit_of
from arm3r_cpp.verify import Chain
from arm3r_cpp.verify.functions import formula_verdict
from arm3r_cpp.verify.log.reading import is_known, read_log
from numpy.typing import NDArray
from random_scenarios import sample_seed

Floats = NDArray[np.float64]
TABLE = Path(__file__).parents[1] / "robots" / "puma560.csv"
QUANTITIES = ("q", "qd", "qdd", "tau")
WORDS = {"q": "position", "qd": "velocity", "qdd": "acceleration", "tau": "effort"}
UR = ["shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint"]
DEGREE, RPM = math.pi / 180, 2 * math.pi / 60


def names_in(text: str, joints: Sequence[str] = ()) -> dict[str, str]:
    """The known columns: what they are called, by the run's names."""
    columns = columns_of(text.split("|"), is_known, joints=joints)
    return {column.name: column.given for column in columns if is_known(column.name)}


# ---- the joints of a URDF --------------------------------------------------------------------------------------------

ARM = """<robot name="arm"><link name="base"/><link name="tool"/>{links}{joints}
<joint name="flange" type="fixed"><parent link="fore"/><child link="tool"/><origin xyz="0.35 0 0"/></joint></robot>"""
LINK = """<link name="{0}"><inertial><origin xyz="{1}"/><mass value="{2}"/>
<inertia ixx="0.02" iyy="0.12" izz="0.13" ixy="0.005" ixz="0" iyz="0.001"/></inertial></link>"""
JOINT = """<joint name="{0}" type="revolute"><parent link="{1}"/><child link="{2}"/><origin xyz="{3}"/>
<axis xyz="{4}"/><limit lower="-3" upper="3" effort="120" velocity="2"/></joint>"""
LINKS = [("column", "0 -0.02 -0.03", 4), ("upper", "0.2 0.05 0", 6), ("fore", "0.15 0 0", 3)]
PLACES = [("base", "0 0 0.3", "0 0 1"), ("column", "0.05 0.1 0.1", "0 1 0"), ("upper", "0.4 -0.02 0", "0 1 0")]


def urdf(folder: Path, names: Sequence[str]) -> Path:
    """An arm of three unequal links, whose joints have these names from the base to the tip."""
    joints = "".join(
        JOINT.format(name, parent, link, origin, axis)
        for name, (parent, origin, axis), (link, _, _) in zip(names, PLACES, LINKS, strict=True)
    )
    path = folder / "arm.urdf"
    path.write_text(ARM.format(links="".join(LINK.format(*link) for link in LINKS), joints=joints))
    return path


def motion(chain: Chain, rows: int = 120) -> dict[str, Floats]:
    """Columns of a right log: q1, ..., tau3."""
    rng = np.random.default_rng(sample_seed())
    q, qd, qdd = rng.uniform(-2, 2, (3, rows, 3))
    values = {"q": q, "qd": qd, "qdd": qdd, "tau": chain.inverse_dynamics(q, qd, qdd)}
    return {f"{name}{joint + 1}": one[:, joint] for name, one in values.items() for joint in range(3)}


def written(path: Path, columns: Mapping[str, Floats]) -> Path:
    header = ",".join(f'"{name}"' for name in columns)
    np.savetxt(path, np.stack(list(columns.values()), axis=1), "%.15g", ",", header=header, comments="")
    return path


def in_some_order(columns: Mapping[str, Any]) -> dict[str, Any]:
    names = list(columns)
    np.random.default_rng(sample_seed() + 1).shuffle(names)
    return {name: columns[name] for name in names}


ORDERS: dict[str, Callable[[Mapping[str, Any]], dict[str, Any]]] = {
    "as built": dict,
    "sorted": lambda columns: dict(sorted(columns.items())),
    "backwards": lambda columns: dict(reversed(columns.items())),
    "shuffled": in_some_order,
}
NAMED_JOINTS = {
    "UR": UR,
    "against the alphabet": ["Waist", "Shoulder", "ELBOW"],
    "counted otherwise": ["axis_3", "axis_1", "axis_2"],
    "end of each other": ["shoulder_lift_joint", "lift_joint", "elbow_lift_joint"],
}
WRITTEN_AS = {
    "path": "/joint_states/{joint}/{word}",
    "word first": "/joint_states/{word}/{joint}",
    "fields": "js.{joint}.{word}",
    "behind": "{joint}_{word}",
    "before": "actual_{word}_{joint}",
    "spaces": "{joint} {word}",
    "robot before": "/ur5/joint_states/ur5_{joint}/{word}",
}


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("way", WRITTEN_AS)
@pytest.mark.parametrize("named", NAMED_JOINTS)
def test_joints_are_those_of_the_urdf_in_its_order(named: str, way: str, order: str, tmp_path: Path) -> None:
    names = NAMED_JOINTS[named]
    path = urdf(tmp_path, names)
    chain = Chain.from_urdf(path)
    assert list(chain.joint_names) == names
    numbers = motion(chain)
    columns = {
        WRITTEN_AS[way].format(joint=joint, word=word): numbers[f"{quantity}{place}"]
        for quantity, word in WORDS.items()
        for place, joint in enumerate(names, start=1)
    }
    others = {
        WRITTEN_AS[way].format(joint=joint, word=word): numbers["q1"] + 7.0
        for joint in ("finger_joint", "rail_9")
        for word in WORDS.values()
    }
    log = written(tmp_path / "log.csv", ORDERS[order](columns | others))
    verdict = formula_verdict(log, "inverse", chain)
    assert verdict.ok, str(verdict)
    columns[WRITTEN_AS[way].format(joint=names[1], word="effort")] = 1.2 * numbers["tau2"]
    log = written(tmp_path / "log.csv", ORDERS[order](columns | others))
    assert [one.entry for one in formula_verdict(log, "inverse", chain).findings] == [[2]]


def test_the_command_knows_the_joints_of_its_urdf(tmp_path: Path) -> None:
    path = urdf(tmp_path, UR)
    numbers = motion(Chain.from_urdf(path))
    columns = {f"{UR[int(name[-1]) - 1]}/{WORDS[name[:-1]]}": one for name, one in numbers.items()}
    log = written(tmp_path / "log.csv", dict(sorted(columns.items())))
    assert verify_cli.main([str(log), "--urdf", str(path), "--kind", "inverse"]) == 0


@pytest.mark.parametrize(
    ("given", "due"),
    [
        ("elbow_joint|shoulder_pan_joint", "q3=elbow_joint q1=shoulder_pan_joint"),
        ("elbow_joint|temperature/elbow_joint|elbow_joint_temperature", "q3=elbow_joint"),
        ("Elbow_Joint/position|target/elbow_joint/position", "q3=Elbow_Joint/position"),
        ("elbow_joint_position|elbow_joint_position_error|elbow_joint_filtered_position", "q3=elbow_joint_position"),
        ("elbow_joint_actual_position|elbow_joint_target_position", "q3=elbow_joint_actual_position"),
        ("a/elbow_joint/position|b/elbow_joint/position", ""),  # which of them is not known
        ("q_elbow_joint|dq_elbow_joint|tau_elbow_joint", "q3=q_elbow_joint qd3=dq_elbow_joint tau3=tau_elbow_joint"),
        ("elbow_joint/position|joint_9/position|position[4]", "q3=elbow_joint/position"),
        ("elbow_joint/position|finger/effort|tau_0|tau_1", "q3=elbow_joint/position tau1=tau_0 tau2=tau_1"),
        ("q3|elbow_joint/position", "q3=q3"),
        ("elbow_joint/position|elbow_joint/finger/effort", "q3=elbow_joint/position"),
        ("fore/position|base/position", "q1=fore/position q2=base/position"),  # no joint of the arm: as they stand
        (
            "elbow_joint_position_deg|elbow_joint velocity [rpm]",
            "q3=elbow_joint_position_deg qd3=elbow_joint velocity [rpm]",
        ),
    ],
)
def test_what_names_of_joints_say(given: str, due: str) -> None:
    expected = dict(re.findall(r"(\w+)=(.+?)(?= \w+=|$)", due))
    assert names_in(given, UR) == expected


def test_the_name_of_a_joint_may_end_like_a_unit() -> None:
    assert names_in("arm_turn|arm|arm_turn_deg", ["arm", "arm_turn"]) == {"q2": "arm_turn", "q1": "arm"}


# ---- several labels of one number ------------------------------------------------------------------------------------


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("first", [0, 1])
@pytest.mark.parametrize(
    ("plain", "others"),
    [
        ("joint_%d_{}", ["joint_%d_target_{}", "joint_%d_filtered_{}"]),
        ("joint%d_{}", ["joint%d_desired_{}", "gripper_joint%d_{}"]),
        ("joint_%d_actual_{}", ["joint_%d_commanded_{}"]),
        ("joint_%d_{}", ["joint_%d_actual_{}", "motor_joint_%d_{}"]),
        ("panda_joint%d/{}", ["panda_finger_joint%d/{}"]),
        ("/joint_states/j_%d/{}", ["/controller/desired/j_%d/{}"]),
        ("/state/{}[%d]", ["/reference/{}[%d]"]),
        ("axis %d {}", ["axis %d error {}"]),
    ],
)
def test_the_plain_name_of_each_number_is_the_joint(
    plain: str, others: Sequence[str], first: int, order: str, tmp_path: Path
) -> None:
    chain = Chain.from_dh(TABLE)
    numbers = motion_of_six(chain)
    columns: dict[str, Floats] = {}
    for name, one in numbers.items():
        quantity, place = name[:-1], int(name[-1])
        for way in (plain, *others):
            columns[way.format(WORDS[quantity]) % (place - 1 + first)] = one if way == plain else 0.1 * one + 1
    log = written(tmp_path / "log.csv", ORDERS[order](columns))
    found = read_log(log).columns
    assert set(found) == set(numbers)
    for name, one in numbers.items():
        assert np.allclose(found[name], one, rtol=1e-12), name


def motion_of_six(chain: Chain) -> dict[str, Floats]:
    rng = np.random.default_rng(sample_seed())
    return {f"{name}{joint + 1}": rng.uniform(-2, 2, 20) for name in QUANTITIES for joint in range(chain.joints)}


@pytest.mark.parametrize(
    ("given", "due"),
    [
        ("left_joint_1_position|right_joint_1_position", "q1 q2"),  # neither is plainer: in their order, as ever
        ("elbow/position|elbow_target/position|wrist/position", "q1 q2"),
        ("joint_1_position|joint_2_position|joint_2_target_velocity", "q1 q2 qd2"),  # alone it is what there is
        ("ur5_base/position|ur5_base_lift/position|ur5_arm/position", "q1 q2 q3"),
        ("robot/length|robot/width", ""),
        ("theta1|joint_1", ""),
    ],
)
def test_what_is_not_said_is_as_ever(given: str, due: str) -> None:
    assert list(names_in(given)) == due.split()


# ---- units -----------------------------------------------------------------------------------------------------------

SPELLINGS = {
    DEGREE: "deg|Deg|DEG|degrees|°|º|deg/s|deg/sec|deg/s^2|deg/s²|deg/s2|deg/s**2|deg/s/s|deg/(s^2)|deg_s|deg_s2|"
    "deg per s|deg_per_s2|deg.s-1|deg·s⁻¹|deg s^-2|deg s^{-2}|°/s|°/s²|dps",
    1.0: "rad|radians|rad/s|rad/s^2|rad_s2|Nm|NM|nm|N m|N*m|N.m|N-m|N·m|N⋅m|newton-meter|kg m^2|kg*m²|Nm/rad|-|",
    1e-3: "mrad|mrad/s|mNm|mN m|mN.m|Nmm|mm|mm/s|mrad_s2|1e-3 rad|0.001 Nm",
    1e-2: "Ncm|N cm|cm|cm/s",
    1e3: "kNm|kN m|kN",
    RPM: "rpm|RPM|rev/min|r/min|U/min|1/min|min^-1|min⁻¹",
    2 * math.pi: "rev|turn|turns|revolutions|rev/s|turns/s|rev_s",
}


@pytest.mark.parametrize("factor", SPELLINGS)
def test_units_are_known_in_their_spellings(factor: float) -> None:
    for text in SPELLINGS[factor].split("|"):
        unit = unit_of(text)
        assert unit is not None and math.isclose(unit.factor, factor, rel_tol=1e-15), text


@pytest.mark.parametrize("text", ["lbf in", "A", "%", "degC", "°C", "MNm", "1/s", "rads", "q", "7", "1", "N/A", "grad"])
def test_what_is_no_unit_or_may_be_two_is_not_known(text: str) -> None:
    assert unit_of(text) is None


STYLES = ["{} [{}]", "{}[{}]", "{} ({})", "{}({})", "{} {}", "{} in {}", "{} / {}", "{}, {}"]
UNDERSCORED = {"deg/s": "deg_s", "deg/s^2": "deg_s2", "rev/s": "rev_s", "rad/s^2": "rad_s2"}
MIXES = [
    {"q": ("deg", DEGREE), "qd": ("rpm", RPM), "qdd": ("rad/s^2", 1.0), "tau": ("mNm", 1e-3)},
    {"q": ("mrad", 1e-3), "qd": ("deg/s", DEGREE), "qdd": ("deg/s^2", DEGREE), "tau": ("kNm", 1e3)},
    {"q": ("turns", 2 * math.pi), "qd": ("rev/s", 2 * math.pi), "qdd": ("", 1.0), "tau": ("Ncm", 1e-2)},
    {"q": ("", 1.0), "qd": ("", 1.0), "qdd": ("", 1.0), "tau": ("N-m", 1.0)},
]
CALLED = {
    "ours": "{quantity}{joint}",
    "words": "joint_{joint}_{word}",
    "letters": "{letter}{joint}",
    "from 0": "/joint_states/{word}[{before}]",
}
LETTERS = {"q": "theta", "qd": "omega", "qdd": "alpha", "tau": "torque"}


@pytest.mark.parametrize("style", [*STYLES, "{}_{}"])
@pytest.mark.parametrize("called", CALLED)
@pytest.mark.parametrize("mix", range(len(MIXES)))
def test_mixed_units_come_to_si(mix: int, called: str, style: str, tmp_path: Path) -> None:
    path = urdf(tmp_path, UR)
    chain = Chain.from_urdf(path)
    numbers = motion(chain)
    columns = {}
    for name, one in numbers.items():
        quantity, joint = name[:-1], int(name[-1])
        unit, factor = MIXES[mix][quantity]
        word = CALLED[called].format(
            quantity=quantity, joint=joint, word=WORDS[quantity], letter=LETTERS[quantity], before=joint - 1
        )
        written_unit = UNDERSCORED.get(unit, unit.replace("-", "")) if style == "{}_{}" else unit
        columns[style.format(word, written_unit) if unit else word] = one / factor
    verdict = formula_verdict(written(tmp_path / "log.csv", in_some_order(columns)), "inverse", chain)
    assert verdict.ok, str(verdict)


def test_a_unit_is_that_of_its_column_alone(tmp_path: Path) -> None:
    chain = Chain.from_urdf(urdf(tmp_path, UR))
    numbers = motion(chain)
    renamed = {"q2": ("q2_deg", DEGREE), "qd3": ("qd3 [rpm]", RPM), "tau1": ("tau1 (mNm)", 1e-3)}
    columns = {renamed.get(name, (name,))[0]: one / renamed.get(name, ("", 1.0))[1] for name, one in numbers.items()}
    assert formula_verdict(written(tmp_path / "log.csv", columns), "inverse", chain).ok


def test_degrees_that_nobody_said_leave_what_is_said_alone(tmp_path: Path) -> None:
    chain = Chain.from_urdf(urdf(tmp_path, UR))
    columns = {}
    for name, one in motion(chain).items():
        said = {"qd": (" [rpm]", RPM), "tau": ("", 1.0)}
        unit, factor = said.get(name[:-1], ("", DEGREE))
        columns[name + unit] = one / factor
    verdict = formula_verdict(written(tmp_path / "log.csv", columns), "inverse", chain)
    assert verdict.ok and "angles in degrees" in verdict.found, str(verdict)


def test_a_row_of_units_may_hold_one_that_is_not_known(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t,q1,qd1,tau1\n[s],(deg),rpm,lbf in\n" + "".join(f"{n},{n},{n},{n}\n" for n in range(9)))
    log = read_log(path)
    assert np.allclose(log.columns["q1"], DEGREE * np.arange(9)) and np.allclose(log.columns["qd1"], RPM * np.arange(9))
    assert "tau1" not in log.columns and "tau1 [lbf in]: its unit is not known" in log.hint()


@pytest.mark.parametrize(
    ("second", "rows"),
    [("[1],rad,-", 9), (",,", 9), ("m,,s", 9), ("-,1,2", 10), ("auto,,", 10), ("auto,manual,off", 10), ("7,,", 10)],
)
def test_a_row_of_units_has_a_unit_and_no_number(second: str, rows: int, tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(f"J11,q1,t\n{second}\n" + "1,2,3\n" * 9)
    table = read_table(path)
    assert len(table.rows) == rows
    assert second != "[1],rad,-" or read_log(path).columns.keys() == {"J11", "q1"}


@pytest.mark.parametrize(
    ("given", "due"),
    [
        ("q_deg_0|q_deg_1|qdd_rad_s2_0", {"q1": DEGREE, "q2": DEGREE, "qdd1": 1.0}),
        ("position [deg][0]|q(deg)_2", {"q1": DEGREE, "q3": DEGREE}),
        ("effort_1 [Nm]|tau1 [lbf in]", {"tau1": 1.0}),  # the known unit wins
        ("effort_1 [lbf in]|torque_1 [mNm]", {"tau1": 1e-3}),
        ("omega1|w2", {"qd1": 1.0}),
        ("q_deg1|qd_deg_s2|tau_mNm3", {"q1": DEGREE, "qd2": DEGREE, "tau3": 1e-3}),  # of arrays
        ("q1|q1_deg|tau1_mNm|tau1", {"q1": 1.0, "tau1": 1.0}),  # the name itself wins
        ("q1 [deg]|q1 [rad]", {"q1": DEGREE}),  # the same number twice
        ("joint_1_position_rad|joint_1_position_deg", {"q1": 1.0}),
        ("tip_x_m|p2_m|p3_mm|tcp_pose_2_mm", {"tip_x": 1.0, "p2": 1.0, "p3": 1e-3, "tip_y": 1e-3}),
        ("tau1_m|q1_m|q2_min|q3_s|tau2_N", {}),  # words of the name
        ("omega1|alpha1", {"qd1": 1.0, "qdd1": 1.0}),
        ("alpha1|alpha2 [deg]|w1|w2 [deg]", {}),  # angles of a table, or what else
        ("alpha1 [deg/s^2]|w2 [rpm]", {"qdd1": DEGREE, "qd2": RPM}),
        ("θ1 [°]|ω1 [°/s]|α1 [°/s²]|τ1 [N·m]", {"q1": DEGREE, "qd1": DEGREE, "qdd1": DEGREE, "tau1": 1.0}),
        ("M11 [kg m^2]|J12 [m]|g1 [Nm]|h1 (mNm)", {"M11": 1.0, "J12": 1.0, "g1": 1.0, "h1": 1e-3}),
        ("joint_velocities[0] [rpm]|speed_2 rpm", {"qd1": RPM, "qd3": RPM}),
    ],
)
def test_what_names_with_units_say(given: str, due: dict[str, float]) -> None:
    found = [(one.name, one.factor) for one in columns_of(given.split("|"), is_known) if is_known(one.name)]
    assert sorted(found) == sorted((name, pytest.approx(factor)) for name, factor in due.items())


# ---- units that are not known ----------------------------------------------------------------------------------------


def log_in_pounds(folder: Path, pound: str = "lbf in") -> tuple[Path, list[str]]:
    path = urdf(folder, UR)
    size = {"tau": 0.1129848}
    columns = {
        f"{name} [{pound}]" if name[:-1] == "tau" else name: one / size.get(name[:-1], 1.0)
        for name, one in motion(Chain.from_urdf(path)).items()
    }
    return written(folder / "log.csv", columns), ["--urdf", str(path), "--kind", "inverse"]


def test_a_unit_that_is_not_known_is_named_and_can_be_said(tmp_path: Path, capsys: Any) -> None:
    log, arm = log_in_pounds(tmp_path)
    assert verify_cli.main([str(log), *arm]) == 2
    error = capsys.readouterr().err
    assert "tau1 [lbf in]: its unit is not known, nor is that of tau2 [lbf in], tau3 [lbf in]" in error
    (said,) = re.findall(r'--columns "(.*?)"', error)
    assert said.split(",")[1] == "tau2 [lbf in]=tau2 [1 N m]"
    assert verify_cli.main([str(log), *arm, "--columns", said]) == 11  # as typed: read, and 8.85 times too large
    assert verify_cli.main([str(log), *arm, "--columns", said.replace("[1 N m]", "[0.1129848 N m]")]) == 0


def test_every_error_about_missing_columns_names_the_unit(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    for header, kind in [
        ("q1 [grad],q2,q3,g1,g2,g3", "gravity"),
        ("q1,q2,q3,g1 [lbf in],g2,g3", "mass"),
        ("q1,q2,q3,effort_1 [lbf in],effort_2 [lbf in]", None),
    ]:
        path.write_text(header + "\n" + (",".join("0.1" for _ in header.split(",")) + "\n") * 9)
        with pytest.raises(UsageError, match=r"\w+ \[(grad|lbf in)\]: its unit is not known.*--columns \"") as refused:
            formula_verdict(path, kind)
        assert len(str(refused.value).splitlines()) == 1


def test_a_unit_that_is_said_must_be_known(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("a,q2\n" + "1,2\n" * 9)
    with pytest.raises(UsageError, match=r"q1\[furlong\]: its unit is not known; rad, deg, m"):
        read_log(path, {"a": "q1[furlong]"})
    assert read_log(path, {"a": "q1[0.01 deg]"}).columns["q1"][0] == pytest.approx(0.01 * DEGREE)
    with pytest.raises(UsageError, match="two columns are named 'q2'"):
        read_log(path, {"a": "q2 [deg]"})


@pytest.mark.parametrize("given", ["tau1 [lbf in]|tau1", "q1 [7]", "temperature [°C]", "time [ticks]", "joint_1 ()"])
def test_no_unit_is_asked_for_where_none_is_missed(given: str, tmp_path: Path) -> None:
    names = given.split("|")
    path = tmp_path / "log.csv"
    path.write_text(",".join([*names, "g1"]) + "\n" + (",".join("1" * (len(names) + 1)) + "\n") * 9)
    assert "unit is not known" not in read_log(path).hint()


def test_a_name_that_cannot_be_typed_is_in_no_command(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text('"tau1 [in,lbf]",q1\n' + "1,2\n" * 9)
    hint = read_log(path).hint()
    assert 'tau1 [in,lbf]: its unit is not known; --columns "NAME=tau1 [1 N m],..."' in hint
