"""What a user says of arguments and names: `--args` and `--set`; without it, what is not understood is asked for."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import pytest

PLAIN = """from math import cos


def gravity(%s):
    t3 = -%s*g*%s/2*cos(q[1] + q[2])
    return [0, -(%s/2 + %s)*g*%s*cos(q[1]) + t3, t3]
"""
MATLAB = """function G = gravity(%s)
t3 = -%s*g*%s/2*cos(q(2) + q(3));
G = [0; -(%s/2 + %s)*g*%s*cos(q(2)) + t3; t3];
end
"""
VECTORS = ("q, m, l", "m[1]", "l[1]", "m[0]", "m[1]", "l[0]")
OF_MATLAB = tuple(one.replace("[1]", "(2)").replace("[0]", "(1)") for one in VECTORS)
FIELDS = ("q, p", "p.m3", "p.l3", "p.m2", "p.m3", "p.l2")
RIGHT = {
    "vectors": ("x.py", PLAIN % VECTORS, ["g=9.80665", "m=[0.785,0.785]", "l=[1,1]"]),
    "vectors of MATLAB": ("x.m", MATLAB % OF_MATLAB, ["g=9.80665", "m=[0.785,0.785]", "l=[1,1]"]),
    "a structure": ("x.py", PLAIN % FIELDS, ["g=9.80665", "p.m2=0.785", "p.m3=0.785", "p.l2=1", "p.l3=1"]),
    "a structure of MATLAB": ("x.m", MATLAB % FIELDS, ["g=9.80665", "p.m2=0.785", "p.m3=0.785", "p.l2=1", "p.l3=1"]),
    "a dictionary": (
        "x.py",
        PLAIN % tuple(one.replace("p.", "p['") + "']" if "p." in one else one for one in FIELDS),
        ["g=9.80665", "p.m2=0.785", "p.m3=0.785", "p.l2=1", "p.l3=1"],
    ),
    "globals": (
        "x.m",
        (MATLAB % ("q", "m", "l", "m", "m", "l")).replace("t3 =", "global m l\nt3 =", 1),
        ["g=9.80665", "m=0.785", "l=1"],
    ),
    "numbers of the arm by name": ("x.py", PLAIN % ("q, m2, m3, a2, a3", "m3", "a3", "m2", "m3", "a2"), ["g=9.80665"]),
}


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", RIGHT)
def test_values_that_are_said_are_used(name: str, tmp_path: Path, command: Any) -> None:
    file, text, values = RIGHT[name]
    path = tmp_path / file
    path.write_text(text)
    options = [word for value in values for word in ("--set", value)]
    done = command(path, *options)
    assert done.returncode == 0 and "as given" in done.stdout, done.stdout + done.stderr
    wrong = command(path, *(one.replace("g=9.80665", "g=4") for one in options))
    assert wrong.returncode == 11


def test_arguments_are_what_is_said(tmp_path: Path, command: Any) -> None:
    path = tmp_path / "gravity.py"
    path.write_text((PLAIN % ("param, z", "param", "1", "param", "param", "1")).replace("q[", "z["))
    assert command(path).returncode == 12
    assert command(path, "--args", "m,q", "--set", "m=0.785", "--set", "g=9.80665").returncode == 0
    verdict = arm3r.verify.gravity(path, args=["m", "q"], given={"m": 0.785, "g": 9.80665})
    assert verdict.ok


def test_an_edit_is_found_in_a_text_with_values_that_are_said(tmp_path: Path) -> None:
    path = tmp_path / "gravity.m"
    path.write_text((MATLAB % FIELDS).replace("q(2) + q(3)", "q(2) - q(3)"))
    given = {"g": 9.80665, "p.m2": 0.785, "p.m3": 0.785, "p.l2": 1.0, "p.l3": 1.0}
    verdict = arm3r.verify.gravity(path, given=given)
    assert {(one.line, one.old, one.new) for one in verdict.findings} == {(2, "-", "+")}, str(verdict)


@pytest.mark.parametrize("arguments", ["q, m, l", "t, z, u, v", "m, l, q"])
def test_what_is_not_understood_is_asked_for(arguments: str, tmp_path: Path, command: Any) -> None:
    """A mass and a length are not taken for angles."""
    path = tmp_path / "gravity.py"
    path.write_text(f"def gravity({arguments}):\n    return [0, 0, 0]\n")
    done = command(path)
    assert done.returncode == 12 and "--args q,... says what the arguments are" in done.stderr, done.stderr


def test_globals_are_asked_for_by_every_reader(tmp_path: Path, command: Any) -> None:
    """For Octave a `global` without a value is empty, and no error."""
    path = tmp_path / "gravity.m"
    path.write_text("function t = gravity(q)\n  global m2 g\n  t = [0; -m2*g*cos(q(2)); 0];\nend\n")
    for values, asked in (((), "m2"), (("--set", "m2=1"), "g")):
        done = command(path, *values)
        assert done.returncode == 12 and f"say it by --set {asked}=NUMBER" in done.stderr, done.stdout + done.stderr


@pytest.mark.parametrize("read", ["p.m3 * p.a", "p['m3'] * p[\"a\"]"])
def test_what_a_structure_needs_is_named_by_its_fields(read: str, tmp_path: Path, command: Any) -> None:
    path = tmp_path / "gravity.py"
    path.write_text(f"def gravity(q, p):\n    return [0, 0, {read} * p.copy()]\n")
    done = command(path)
    assert done.returncode == 12 and "--set p.m3=VALUE --set p.a=VALUE gives it a value" in done.stderr, done.stderr


REFUSED = {
    ("--set", "gg=1"): "--set gg: no argument and no name of the text is called so",
    ("--set", "g"): "NAME=NUMBER or NAME=[NUMBER, ...] is needed, got 'g'",
    ("--set", "g=much"): "is needed, got 'g=much'",
    ("--set", "g=true"): "a number or a list of numbers is needed",
    ("--set", "g=[[1,2],[3]]"): "a number or a list of numbers is needed",
    ("--set", "p.a=1", "--set", "p=2"): "p is a number and a structure",
    ("--set", 'g="1"'): "a number or a list of numbers is needed",
    ("--set", "g=NaN"): "a number or a list of numbers is needed",
    ("--set", "2x=1"): "'2x' is not a name",
    ("--set", "a2=1"): "x.py:1: a2 has a value here: change it there",
    ("--args", "q,qd"): "--args names 2 arguments; gravity takes 1: q",
    ("--args", "q d"): "names with commas between them are needed",
}


def test_what_is_said_of_a_log_or_of_no_text_is_refused(tmp_path: Path, command: Any) -> None:
    log = tmp_path / "log.csv"
    log.write_text("q1,q2,q3,g1,g2,g3\n" + "1,2,3,4,5,6\n" * 9)
    done = command(log, "--set", "g=9.81")
    assert done.returncode == 2 and "--columns is for a log" in done.stderr
    with pytest.raises(arm3r.UsageError, match="no argument and no name of the text"):
        arm3r.verify.gravity(max, args=["q"], given={"g": 9.81})


@pytest.mark.sample(5)
@pytest.mark.parametrize("options", REFUSED, ids=" ".join)
def test_what_cannot_be_meant_is_one_line(options: tuple[str, ...], tmp_path: Path, command: Any) -> None:
    path = tmp_path / "x.py"
    path.write_text("a2 = 1.0\n\n\ndef gravity(q):\n    return [0, 0, g]\n")
    done = command(path, *options)
    assert done.returncode == 2 and REFUSED[options] in done.stderr, done.stderr
