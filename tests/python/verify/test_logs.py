"""Logs as laboratories and other programs write them: encodings, separators, names, units; one reader for all."""

from __future__ import annotations

import codecs
import math
import random
from collections.abc import Callable, Sequence
from pathlib import Path

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.commands import verify as verify_cli
from arm3r_cpp.logs.names import columns_of
from arm3r_cpp.logs.table import read_table
from arm3r_cpp.verify.functions import formula_verdict
from arm3r_cpp.verify.log.reading import is_known
from numpy.typing import NDArray
from random_scenarios import sample_seed

JOINTS = [f"{quantity}{joint}" for quantity in ("q", "qd", "qdd", "tau") for joint in (1, 2, 3)]


def names_in(text: str) -> list[str]:
    return [column.name for column in columns_of(text.split("|"), is_known)]


@pytest.mark.parametrize(
    ("given", "due"),
    [
        ("t|q1|q2|q3|dq1|ddq1|torque1", "t q1 q2 q3 qd1 qdd1 tau1"),
        ("timestamp|actual_q_0|actual_q_1|actual_q_2|actual_qd_0|target_q_0", "t q1 q2 q3 qd1 target_q_0"),
        ("actual_q_0|actual_TCP_pose_0|actual_TCP_pose_2|actual_TCP_pose_3", "q1 tip_x tip_z actual_TCP_pose_3"),
        ("q1|ee_position_x|tcp_pos[3] [mm]|tool_pose_2", "q1 tip_x tip_z tip_y"),
        ("time|joint_1|joint_2|joint_3", "t q1 q2 q3"),
        ("Time|Joint 1 Position|Joint 2 Position|Joint 1 Velocity", "t q1 q2 qd1"),
        ("/joint_states/position[0]|/joint_states/position[1]|/joint_states/velocity[0]", "q1 q2 qd1"),
        ("/joint_states/panda_joint1/position|/joint_states/panda_joint2/effort", "q1 tau2"),
        ("js.position.0|js.position.1|js.effort.1", "q1 q2 tau2"),
        ("field.position0|field.position1|field.position2", "q1 q2 q3"),
        ("base/position|arm/position|fore/position", "q1 q2 q3"),
        ("ur5_base/position|ur5_arm/position", "q1 q2"),
        ("q(1)|q(2)|q(3)|qdot_1|q2_dot|q3_ddot", "q1 q2 q3 qd1 qd2 qdd3"),
        ("q1|q2|q3|theta1|measured_q_1|joint_1", "q1 q2 q3 theta1 measured_q_1 joint_1"),  # the name itself wins
        ("theta1|joint_1", "theta1 joint_1"),  # which of them is q1 is not known
        ("J11|J_12|J(1,3)|g1|M33|tip_x|a2", "J11 J_12 J(1,3) g1 M33 tip_x a2"),
        ("tip_position|gripper_velocity|force|position", "tip_position gripper_velocity force position"),
    ],
)
def test_names_of_others_are_understood_where_they_say_one_thing(given: str, due: str) -> None:
    assert names_in(given) == due.split()


@pytest.mark.parametrize(
    ("given", "name", "factor"),
    [
        ("q1_deg", "q1", math.pi / 180),
        ("q1 [deg]", "q1", math.pi / 180),
        ("dq2 (deg/s)", "qd2", math.pi / 180),
        ("joint_3 [°]", "q3", math.pi / 180),
        ("q1 [rad]", "q1", 1.0),
        ("tau2 [N m]", "tau2", 1.0),
        ("time [ms]", "t", 1e-3),
        ("p1 [mm]", "p1", 1e-3),
        ("q[0]", "q1", 1.0),
    ],
)
def test_units_are_taken_from_names(given: str, name: str, factor: float) -> None:
    (column,) = columns_of([given], is_known)
    assert column.name == name and column.factor == pytest.approx(factor)


def test_what_a_column_is_can_be_said() -> None:
    columns = columns_of(["a", "b", "q3"], is_known, called={"a": "q1 [deg]", "b": "J12"})
    assert [column.name for column in columns] == ["q1", "J12", "q3"]
    assert columns[0].factor == pytest.approx(math.pi / 180)
    with pytest.raises(arm3r.UsageError, match="no column is called 'c'; there are a, b"):
        columns_of(["a", "b"], is_known, called={"c": "q1"})


# ---- however a file is written ---------------------------------------------------------------------------------------

WRITTEN: dict[str, Callable[[Sequence[str], NDArray[np.float64]], bytes]] = {}


def written(way: Callable[..., bytes]) -> Callable[..., bytes]:
    WRITTEN[way.__name__] = way
    return way


def text_of(names: Sequence[str], rows: NDArray[np.float64], separator: str = ",", end: str = "\n") -> str:
    return end.join([separator.join(names), *(separator.join(f"{one:.15g}" for one in row) for row in rows)]) + end


@written
def plain(names: Sequence[str], rows: NDArray[np.float64]) -> bytes:
    return text_of(names, rows).encode()


@written
def excel(names: Sequence[str], rows: NDArray[np.float64]) -> bytes:
    return codecs.BOM_UTF8 + text_of(names, rows, ";", "\r\n").replace(".", ",").encode()


@written
def unicode_text(names: Sequence[str], rows: NDArray[np.float64]) -> bytes:
    return text_of(names, rows, "\t", "\r\n").encode("utf-16")


@written
def latin(names: Sequence[str], rows: NDArray[np.float64]) -> bytes:
    return text_of([*names, "Größe"], np.column_stack([rows, rows[:, 0]])).encode("latin-1")


@written
def carriage_returns(names: Sequence[str], rows: NDArray[np.float64]) -> bytes:
    return text_of(names, rows, end="\r").encode()


@written
def savetxt(names: Sequence[str], rows: NDArray[np.float64]) -> bytes:
    return ("# of a robot\n# " + text_of(names, rows, " ")).encode()


@written
def trailing(names: Sequence[str], rows: NDArray[np.float64]) -> bytes:
    return text_of(names, rows).replace("\n", ",\n").encode()


@written
def blank_lines(names: Sequence[str], rows: NDArray[np.float64]) -> bytes:
    return ("\n\n" + text_of(names, rows).replace("\n", "\n\n")).encode()


@written
def with_units(names: Sequence[str], rows: NDArray[np.float64]) -> bytes:
    lines = text_of(names, rows).splitlines()
    lines.insert(1, ",".join("deg" if name[0] == "q" else "m" for name in names))
    scaled = rows * [180 / math.pi if name[0] == "q" else 1.0 for name in names]
    return "\n".join([*lines[:2], *text_of(names, scaled).splitlines()[1:]]).encode()


@written
def text_beside(names: Sequence[str], rows: NDArray[np.float64]) -> bytes:
    lines = text_of(["mode", *names], np.column_stack([rows[:, 0], rows])).splitlines()
    return "\n".join([lines[0], *("auto," + line.partition(",")[2] for line in lines[1:])]).encode()


def jacobians(rows: int, rng: np.random.Generator) -> tuple[list[str], NDArray[np.float64]]:
    """A right log of the Jacobian of the lecture's arm."""
    arm = arm3r.Scenario("{format: 1}").arm
    q = rng.uniform(-3, 3, (rows, 3))
    names = ["q1", "q2", "q3", *(f"J{row}{column}" for row in (1, 2, 3) for column in (1, 2, 3))]
    return names, np.array([[*one, *np.asarray(arm.jacobian(one)).ravel()] for one in q])


@pytest.mark.parametrize("way", WRITTEN)
def test_a_right_log_is_right_however_it_is_written(way: str, tmp_path: Path) -> None:
    names, rows = jacobians(60, np.random.default_rng(sample_seed()))
    path = tmp_path / "log.csv"
    path.write_bytes(WRITTEN[way](names, rows))
    verdict = formula_verdict(path)
    assert verdict.ok and verdict.kind == "jacobian", str(verdict)


def test_a_file_of_numbers_alone_is_told_what_its_columns_are(tmp_path: Path) -> None:
    names, rows = jacobians(60, np.random.default_rng(sample_seed()))
    path = tmp_path / "log.txt"
    path.write_bytes(text_of(names, rows, " ").partition("\n")[2].encode())
    with pytest.raises(arm3r.UsageError, match=r"--columns NAME=q1,\.\.\. says which they are: 1, 2, 3"):
        formula_verdict(path)
    said = {str(number): name for number, name in enumerate(names, start=1)}
    assert formula_verdict(path, columns=said).ok
    words = ",".join(f"{number}={name}" for number, name in said.items())
    assert verify_cli.main([str(path), "--columns", words]) == 0
    assert verify_cli.main([str(path), "--columns", "1=q1,99=q2"]) == 2


@pytest.mark.parametrize("wrong", [False, True])
def test_degrees_that_nobody_said_are_found(wrong: bool, tmp_path: Path) -> None:
    names, rows = jacobians(60, np.random.default_rng(sample_seed()))
    rows[:, :3] = np.degrees(rows[:, :3])
    rows[:, 7] *= 1.5 if wrong else 1.0  # J22
    path = tmp_path / "log.csv"
    path.write_bytes(plain(names, rows))
    verdict = formula_verdict(path)
    assert "angles in degrees" in verdict.found
    assert [finding.entry for finding in verdict.findings] == ([[2, 2]] if wrong else [])


def test_turns_beyond_a_circle_are_no_degrees(tmp_path: Path) -> None:
    names, rows = jacobians(60, np.random.default_rng(sample_seed()))
    rows[:, 0] += 4 * math.pi
    rows[:, 7] *= 1.5
    path = tmp_path / "log.csv"
    path.write_bytes(plain(names, rows))
    verdict = formula_verdict(path)
    assert "angles in degrees" not in verdict.found
    assert [finding.entry for finding in verdict.findings] == [[2, 2]]


def test_what_was_read_under_another_name_is_said(tmp_path: Path) -> None:
    names, rows = jacobians(60, np.random.default_rng(sample_seed()))
    path = tmp_path / "log.csv"
    path.write_bytes(plain([name.replace("q", "joint_") for name in names], rows))
    assert "read as q1: joint_1, q2: joint_2, q3: joint_3" in formula_verdict(path).warnings


def test_one_row_is_not_enough(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("q1,q2,q3,g1,g2,g3\n0.1,0.2,0.3,0,-17.1,-3.3\n")
    with pytest.raises(arm3r.UnjudgedError, match="8 rows or more are needed"):
        formula_verdict(path)
    assert verify_cli.main([str(path)]) == 12


def test_a_constant_where_zero_is_due_is_read(tmp_path: Path) -> None:
    rng = np.random.default_rng(sample_seed())
    arm, q = arm3r.Scenario("{format: 1}").arm, rng.uniform(-3, 3, (400, 3))
    torques = np.array([arm.gravity_torque(one) for one in q]) + np.array([0.05, 0, 0])
    path = tmp_path / "log.csv"
    path.write_bytes(plain(["q1", "q2", "q3", "g1", "g2", "g3"], np.column_stack([q, torques])))
    (finding,) = formula_verdict(path).findings
    assert (finding.entry, finding.reads, finding.due) == ([1], "1/20", "0")


# ---- what is refused -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("data", "due"),
    [
        (b"", "no rows"),
        (b"\n\n# only comments\n", "no rows"),
        (b"a,b\n1,2,3\n", ":2: a row has 2 numbers, got 3"),
        (b"a,b\n1,5,2,5\n", "decimal commas need another separator"),
        (b'a,b\n"1,2\n', ":2: this row cannot be read"),
        (b"a,b\n\0,2\n", "it is not text"),
    ],
)
def test_what_is_no_table_is_refused_in_a_line(data: bytes, due: str, tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes(data)
    with pytest.raises(arm3r.UsageError) as refused:
        read_table(path)
    assert due in str(refused.value) and len(str(refused.value).splitlines()) == 1


def test_no_mutation_of_a_log_is_more_than_a_line(tmp_path: Path) -> None:
    seed = sample_seed()
    choose = random.Random(seed)
    names, rows = jacobians(10, np.random.default_rng(seed))
    path = tmp_path / "log.csv"
    for number in range(150):
        data = bytearray(choose.choice(list(WRITTEN.values()))(names, rows))
        for _ in range(choose.randrange(1, 6)):
            data[choose.randrange(len(data))] = choose.randrange(256)
        path.write_bytes(bytes(data[: choose.randrange(len(data))] if choose.random() < 0.2 else data))
        try:
            formula_verdict(path)
        except arm3r.Arm3rError as error:
            assert len(str(error).splitlines()) == 1, (seed, number, str(error))


@pytest.mark.parametrize(
    "vector, matrix", [("g(%d)", "J(%d,%d)"), ("g_%d", "J_%d_%d"), ("g[%d]", "J[%d][%d]"), ("g%d", "J%d%d")]
)
@pytest.mark.parametrize("first", [0, 1])
def test_entries_by_their_indices_are_entries(first: int, vector: str, matrix: str, tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    q, arm = rng.uniform(-2, 2, (40, 3)), arm3r.Scenario().arm
    places = range(first, first + 3)
    for names, values in (
        ([vector % one for one in places], arm.gravity_torque(q)),
        ([matrix % (one, two) for one in places for two in places], arm.jacobian(q).reshape(-1, 9)),
    ):
        path = tmp_path / "log.csv"
        header = ",".join(["q1", "q2", "q3", *(f'"{name}"' for name in names)])
        np.savetxt(path, np.hstack([q, values]), delimiter=",", fmt="%.17g", header=header, comments="")
        assert formula_verdict(path).ok
        np.savetxt(path, np.hstack([q, 1.1 * values]), delimiter=",", fmt="%.17g", header=header, comments="")
        assert not formula_verdict(path).ok
