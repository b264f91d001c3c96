"""Files of others, however broken, end in a few lines and an exit code of the contract, never in a traceback."""

from __future__ import annotations

import os
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.commands import verify
from mutations import NUMBERS, mutated

SEED = int(os.environ.get("ARM3R_SEED", random.randrange(10**6)))
EXITS = {0, 2, 3, 11, 12}

CHAIN = "standard\ntype,a,alpha,d,theta,mass,cx\nR,0,pi/2,0.4,0,1,0\nR,0.5,0,0,0,1,-0.2\nR,0.3,0,0,90 deg,1,0\n"
URDF = """<robot name="c"><link name="a"/>
<link name="b"><inertial><origin xyz="0.5 0 0"/><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
<link name="c"/><joint name="j1" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
<joint name="j2" type="fixed"><origin rpy="0 1 0"/><parent link="b"/><child link="c"/></joint></robot>"""
GRAVITY = """function t = gravity(q)
  a2 = 1; m = [0.785, 0.785]; g = 9.80665;
  for i = 1:2
    if i > 1
      t3 = -m(i)*g*a2/2*cos(q(2) + q(3));
    end
  end
  t = reshape([0; t3 - (m(1)/2 + m(2))*g*a2*cos(q(2)); t3], 3, 1);
end
"""
PYTHON = (
    "from math import cos\n\ndef gravity(q):\n"
    "    t3 = -3.85 * cos(q[1] + q[2])\n    return [0, t3 - 11.5 * cos(q[1]), t3]\n"
)

MATLAB = [
    GRAVITY,
    *(f"function t = gravity(q)\nt={body}" for body in (
        "[" * 5000, "(" * 5000, "[0;0;0" + "+1" * 20_000 + "];", "-" * 5000 + "1", "{" * 300 + "}" * 300,
        "reshape(zeros(1,3),[],1e9);", "reshape(zeros(1,3),[],0);", "reshape(zeros(1,3),0,[]);", "zeros(1e300,1);",
        "eye(-1);", "1:0:3;", "q(0);", "q(1e300);", "q(:,:,:);", "q{1};", "x.y.z;", "@(x) x;", "inv(zeros(3));", "''''",
        "[1 2;3];", "cell(1e9);", "mod(1,0);", "0^-1*ones(3,1);", "diag([]);", "norm({});", "gravity(q);", "q(end+1);",
    )),
    "function t = gravity(q)\n" + "if q(1)>0\n" * 400, "function", "function [", "function t = gravity(", "\0", "",
]  # fmt: skip
TABLES = [
    CHAIN, *(f"standard\ntype,a,alpha,d,theta\nR,{cell},0,0\n" for cell in ("0,pi/0", "..,0", "1,1.2.3", "1e999,0")),
    "standard\ntype,a,alpha,d,theta\ntool,0,0,0,0\nR,1,0,0,0\n", "modified\ntype,a,alpha,d,theta\n", "standard\n", "",
    "standard\ntype,a,alpha,d,theta,mass,mass\nR,1,0,0,0,1,2\n", 'standard\ntype,a,alpha,d,theta\n"R,1,0,0,0\n',
]  # fmt: skip
ROBOTS = [
    URDF, URDF.replace('<link name="b">', '<link name="x">'), URDF.replace('value="1"', 'value="-1"'),
    URDF.replace('link="a"', 'link="c"'), URDF.replace('xyz="0 0 1"', 'xyz="0 0 0"'), URDF.replace('"1"', '"1e200"'),
    "<robot/>", "<robot>" * 3000, "<!DOCTYPE x><robot/>", "<robot><joint/></robot>",
    "<?xml version='1.0' encoding='x'?><robot/>",
]  # fmt: skip


def log() -> str:
    q = np.random.default_rng(1).uniform(-2, 2, (12, 3))
    torque = arm3r.Scenario().arm.gravity_torque(q)
    rows = [",".join(f"{number:.17g}" for number in (*one, *other)) for one, other in zip(q, torque, strict=True)]
    return "\n".join(["q1,q2,q3,g1,g2,g3", *rows, ""])


def logs() -> list[str]:
    whole = log()
    head, first, *rest = whole.split("\n")
    cells = first.split(",")
    with_number = [
        "\n".join([head, ",".join([*cells[:k], number, *cells[k + 1 :]]), *rest]) for number in NUMBERS for k in (0, 5)
    ]
    return [
        whole,
        *with_number,
        head,
        f"{head}\n{first}\n",
        f"{head},g3\n{first},1\n",
        whole.replace("g2", "g7"),
        "\0",
        "",
    ]


def formula_call(folder: Path, ending: str, data: bytes) -> list[str]:
    """The words behind `arm3r verify` with which a file is read."""
    file = folder / f"gravity{ending}"
    file.write_bytes(data)
    option = {".dh": "--dh", ".urdf": "--urdf"}.get(ending)
    formula = folder / "kinematics.m"
    formula.write_text("function p = kinematics(q)\np = [cos(q(1)); sin(q(1)); q(2)];\nend\n")
    return [str(formula), option, str(file)] if option else [str(file), "--kind", "gravity"]


@pytest.fixture
def ends_well(tmp_path: Path, capfd: Any) -> Callable[[str, bytes], int]:
    def check(ending: str, data: bytes) -> int:
        capfd.readouterr()
        code = verify.main(formula_call(tmp_path, ending, data))
        out, error = capfd.readouterr()
        assert code in EXITS and "Traceback" not in out + error, (code, error[-2000:], data[:500])
        assert len(error.splitlines()) <= (code not in (0, 11)), (error, data[:500])
        assert (code in (0, 11)) == bool(out), (code, out, error)
        return code

    return check


FILES = [
    (ending, text)
    for ending, texts in ((".m", MATLAB), (".dh", TABLES), (".urdf", ROBOTS), (".csv", logs()))
    for text in texts
]


@pytest.mark.sample(2)
@pytest.mark.parametrize("ending", [".m", ".dh", ".urdf", ".csv"])
def test_a_broken_file_is_one_line(ending: str, ends_well: Callable[[str, bytes], int]) -> None:
    for one, text in FILES:
        if one == ending:
            ends_well(ending, text.encode())


@pytest.mark.parametrize("count", [40, pytest.param(300, marks=[pytest.mark.gate, pytest.mark.random])])
def test_random_changes_of_files_are_one_line_each(
    count: int, capfd: Any, ends_well: Callable[[str, bytes], int]
) -> None:
    with capfd.disabled():
        print(f"ARM3R_SEED={SEED}", end=" ")
    chance = random.Random(SEED)
    for _ in range(count):
        ending, text = chance.choice([*FILES, *[(".py", PYTHON)] * 3])
        ends_well(ending, mutated(text.encode(), chance))


def test_rows_of_a_log_without_numbers_are_left_out_and_named(
    tmp_path: Path, capfd: Any, ends_well: Callable[[str, bytes], int]
) -> None:
    head, *rows = log().splitlines()
    rows[2] = rows[2].replace(rows[2].split(",")[0], "nan", 1)
    rows[5] = ",".join([*rows[5].split(",")[:-1], "-inf"])
    (tmp_path / "log.csv").write_text("\n".join([head, *rows]))
    verdict = arm3r.verify.gravity(tmp_path / "log.csv")
    assert verdict.ok and "2 rows with NaN or infinity left out: line 4, 7" in verdict.warnings
