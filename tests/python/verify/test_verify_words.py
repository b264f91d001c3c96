"""What is printed of a formula: one sentence about all of it first, and no explanation twice."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from arm3r_cpp import Scenario, verify
from arm3r_cpp.verify.finding import Finding, Judgement
from arm3r_cpp.verify.words import report

GRAVITY = """from math import cos

g, m2, m3, a2, a3 = 9.80665, 0.785, 0.785, 1.0, 1.0


def gravity(q1, q2, q3):
    t3 = {sign}m3*g*a3/2*cos(q2 + q3)
    return 0, {sign}(m2/2 + m3)*g*a2*cos(q2) + t3, t3
"""


SCENARIO = Scenario("format: 1\narm: {convention: simscape, link2: {length: 0.8}}\n")


def test_what_explains_all_of_a_formula_stands_before_its_entries() -> None:
    verdict = verify.gravity(lambda q: -SCENARIO.arm.gravity_torque(np.asarray(q)), SCENARIO)
    _, first, *entries = str(verdict).splitlines()[:4]
    assert first == "  t2, t3: the result has the wrong sign."
    assert [line.split(" reads ")[0] for line in entries] == ["    t2", "    t3"]


def test_of_many_entries_their_number_is_said() -> None:
    without_text = eval(
        "lambda q: roll(jacobian(q), 3, axis=0)", vars(np) | {"jacobian": SCENARIO.arm.geometric_jacobian}
    )
    _, first, second = str(verify.jacobian(without_text, SCENARIO)).splitlines()[:3]
    assert first == "  18 entries: the angular rows stand above the linear ones; the linear rows should be first."
    assert second.startswith("    J(1,1) reads 0, should be ")


@pytest.mark.parametrize("ending", ["py", "m"])
def test_an_edit_is_not_possible_twice(ending: str, tmp_path: Path) -> None:
    """More brackets, two signs that make none, or the sign of the same product elsewhere are the same edit."""
    text = GRAVITY.format(sign="-").replace("+ t3, t3", "+ -t3, t3")
    path = tmp_path / "gravity.py"
    if ending == "m":
        path = tmp_path / "gravity.m"
        text = (
            "function [t1, t2, t3] = gravity(q1, q2, q3)\ng = 9.80665; m2 = 0.785; m3 = 0.785; a2 = 1; a3 = 1;\n"
            "t1 = 0;\nt3 = -m3*g*a3/2*cos(q2 + q3);\nt2 = -(m2/2 + m3)*g*a2*cos(q2) + -t3;\nend\n"
        )
    path.write_text(text)
    verdict = verify.gravity(path)
    assert {(one.old, one.new) for one in verdict.findings} <= {("-", ""), ("+", "-")}, str(verdict)
    assert verdict.alternatives == [], str(verdict)


@pytest.mark.parametrize("row, unit", [(1, " m"), (4, "")])
def test_an_angular_entry_has_no_unit_of_length(row: int, unit: str) -> None:
    error = np.zeros((6, 3))
    error[row, 1] = 0.25
    verdict = verify.jacobian(lambda q: SCENARIO.arm.geometric_jacobian(np.asarray(q)) + error, SCENARIO)
    assert str(verdict).splitlines()[0].endswith(f"1 of 18 entries wrong, by up to 0.25{unit}")


def test_an_entry_that_is_not_read_stands_beside_those_that_are() -> None:
    """One edit mends both: t2, which is not read, is named by its sentence."""
    edit = {"line": 1, "column": 1, "old": "a2", "new": "a3"}
    findings = [
        Finding([2], "t2: in line 1 `a2` should be `a3`; this line spoils 2 entries.", **edit),
        Finding([3], "t3: in line 1 `a2` should be `a3`; this line spoils 2 entries.", "m3 g a2", "m3 g a3", **edit),
    ]
    verdict = Judgement(False, "gravity", "slide", 1.0, findings=findings, shape=[3], text="a2", file="f.m")
    lines = [line.strip() for line in report(verdict).split("\n")]
    assert lines[1] == "t3 reads m3 g a2, should be m3 g a3"
    assert lines[2] == "t2, t3: in line 1 `a2` should be `a3`; this line spoils 2 entries."
