"""Formulas that are judged: the lecture's listings, mistakes planted in them, and the command."""

from __future__ import annotations

import itertools
import json
import os
import random
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.commands.verify import main as verify_main
from arm3r_cpp.verify.formula import from_file
from arm3r_cpp.verify.functions import formula_verdict
from formulas import reading, runner
from formulas.draws import draws
from formulas.foreign import foreign_mutants
from formulas.mutants import mutants, two_mistakes
from formulas.programs import MATLAB_GRAVITY, MATLAB_JACOBIAN, PROGRAMS, Program
from formulas.rewriting import rewritten
from scipy.stats import binom

SEED = int(os.environ.get("ARM3R_SEED", random.randrange(10**6)))
LECTURE_JACOBIAN = MATLAB_JACOBIAN.replace("SIGN(j32)", "-j32").replace("SIGN(j33)", "-j33")
LECTURE_GRAVITY = MATLAB_GRAVITY.replace("SIGN(", "-(")


# ---- the lecture ----------------------------------------------------------------------------------------------------


def test_the_lectures_listings_are_right(written: Any) -> None:
    assert arm3r.verify.jacobian(written("j.m", LECTURE_JACOBIAN)).ok
    verdict = arm3r.verify.gravity(written("g.m", LECTURE_GRAVITY))
    assert verdict.ok and verdict.convention == "simscape"
    assert "outputs in the order t3, t2, t1" in verdict.found


def test_the_first_listing_drives_joint_1(written: Any) -> None:
    verdict = arm3r.verify.gravity(written("g.m", LECTURE_GRAVITY.replace("t1 = q1*0", "t1 = q1")))
    (finding,) = verdict.findings
    assert not verdict.ok and finding.entry == [1]
    assert (finding.reads, finding.due) == ("q1", "0")
    assert (finding.line, finding.column, finding.old, finding.new) == (7, 6, "q1", "0")


def test_a_lost_angle_is_named_in_its_line(written: Any, command: Any) -> None:
    path = written("my_jacobian.m", LECTURE_JACOBIAN.replace("j23 = -a3*sin(q2+q3)", "j23 = -a3*sin(q2)"))
    done = command(path)
    assert done.returncode == 11
    lines = done.stdout.splitlines()
    assert "jacobian, arguments in the order q3, q2, q1, convention simscape, 1 of 9 entries wrong" in lines[0]
    assert lines[1] == "  J(2,3) reads -a3 S1 S2, should be -a3 S1 S23"
    assert lines[2].strip() == "line 11:  j23 = -a3*sin(q2)*sin(q1);"
    assert lines[3].index("^^") == lines[2].index("q2)") and lines[3].endswith("should be q2+q3")
    assert lines[-1] == "1 mistake in 1 file"


@pytest.mark.parametrize("head", ["(q):\n    q2 = q[1]", "(q):\n    q1, q2, q3 = q", "(q1, q2, q3):\n    pass"])
def test_an_angle_that_is_lost_everywhere_is_due(written: Any, head: str) -> None:
    """q3 stands nowhere in the formula, yet in the edit."""
    text = f"from math import cos\na2 = a3 = 1.0\nm2 = m3 = 0.785\ng = 9.80665\n\n\ndef gravity{head}\n"
    text += "    t3 = -m3*g*a3/2*cos(q2)\n    return 0, t3 - (m2/2 + m3)*g*a2*cos(q2), t3\n"
    if "q[1]" in head:
        text = text.replace("q2 = q[1]", "pass").replace("(q2)", "(q[1])")
    verdict = arm3r.verify.gravity(written("gravity.py", text))
    due = "q[1]+q[2]" if "q[1]" in head else "q2+q3"
    assert {one.new for one in verdict.findings} == {due}, str(verdict)


def test_equal_lengths_hide_nothing(written: Any) -> None:
    """a1/2 and a2/2 in the place of a3/2, as the lecture's slides print it."""
    path = written("g.m", LECTURE_GRAVITY.replace("t3 = -(m3*g*(a3/2)", "t3 = -(m3*g*(a2/2)"))
    (finding,) = arm3r.verify.gravity(path).findings
    assert (finding.entry, finding.reads, finding.due) == ([3], "-1/2 m3 g a2 C23", "-1/2 m3 g a3 C23")
    assert (finding.old, finding.new) == ("a2", "a3")


RECURSION = """import numpy as np
a2, a3 = (1.0, 1.0)
m2, m3, g = (0.785, 0.785, 9.80665)


def gravity_torque(q):
    f3 = m3 * g
    n3 = f3 * LINK3 * np.cos(q[1] + q[2])
    n2 = n3 + f3 * a2 * np.cos(q[1]) + m2 * g * LINK2 * np.cos(q[1])
    return [0, n2, n3]
"""


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("link2", "link3"), [("a2 / 2", "1 / 3"), ("1 / 3", "a3 / 2"), ("a2 / 2", "1 / 4 * a2"), ("a2 / 2", "g / 2")]
)
def test_a_length_that_is_lost_in_one_link_makes_no_right_term_wrong(written: Any, link2: str, link3: str) -> None:
    """With two mistakes at one link: the other link's term shows that its centre of mass follows the length."""
    verdict = arm3r.verify.gravity(written("g.py", RECURSION.replace("LINK2", link2).replace("LINK3", link3)))
    due = {"t2": "m3 g a2 C2 + 1/2 m2 g a2 C2 + 1/2 m3 g a3 C23", "t3": "1/2 m3 g a3 C23"}
    assert verdict.convention == "slide" and verdict.findings
    for one in verdict.findings:
        assert one.entry and one.due == due[f"t{one.entry[0]}"], str(verdict)
    assert not any(one.old and ("m2" in one.old or "a2 / 2" in one.old) for one in verdict.findings), str(verdict)


def test_a_centre_that_is_a_number_stays_one_beside_a_mistake(written: Any) -> None:
    """Both centres of mass stand as numbers: only the mistake is said."""
    text = RECURSION.replace("LINK2", "0.5").replace("LINK3", "0.5").replace("a2 * np.cos", "a2 * np.sin")
    verdict = arm3r.verify.gravity(written("g.py", text))
    assert {(one.old, one.new) for one in verdict.findings} == {("np.sin", "np.cos")}, str(verdict)


def test_two_exchanged_names_hide_behind_no_equal_numbers(written: Any) -> None:
    """m3 for m2 and a3 for a2 in one entry: no single edit mends it, and the lecture's numbers are equal."""
    text = LECTURE_GRAVITY.replace("t2 = -(m2*g*(a2/2)*cos(q2) + m3*g*(a2*", "t2 = -(m3*g*(a2/2)*cos(q2) + m3*g*(a3*")
    verdict = arm3r.verify.gravity(written("g.m", text))
    (finding,) = verdict.findings
    assert finding.entry == [2] and finding.reads.startswith("-1/2 m3 g a2 C2 - m3 g a3 C2"), str(verdict)
    assert "right for the numbers in the text" in verdict.warnings[0]


def test_a_lost_length_hides_behind_no_number_that_is_1(written: Any) -> None:
    text = LECTURE_GRAVITY.replace("(a3/2)", "1/2")
    assert arm3r.verify.gravity(written("g.m", text)).ok  # a3 plays no part: it is written as 1
    text = "a2, a3, m2, m3, g = 1.0, 1.0, 0.785, 0.785, 9.80665\nfrom math import cos\n\n\ndef gravity(q1, q2, q3):\n"
    text += "    t3 = -m3*g/2*cos(q2+q3)\n    return 0, -(m2*g*a2/2 + m3*g*a2)*cos(q2) + t3, t3\n"
    verdict = arm3r.verify.gravity(written("g.py", text))
    assert {(one.old, one.new) for one in verdict.findings} == {("g", "a3*g")}, str(verdict)


def test_numbers_that_are_not_the_arms(written: Any) -> None:
    path = written("g.m", LECTURE_GRAVITY.replace("g=9.80665", "g=9.81"))
    verdict = arm3r.verify.gravity(path)
    assert [finding.entry for finding in verdict.findings] == [[2], [3]]
    assert {(one.line, one.old, one.new) for one in verdict.findings} == {(4, "9.81", "9.80665")}
    assert "g is 9.81 in line 4; the lecture's arm has 9.80665" in verdict.findings[0].cause


# ---- mistakes of the formula as a whole -----------------------------------------------------------------------------

ARM = arm3r.Scenario()


def lecture_jacobian(q: Any) -> Any:
    return ARM.arm.jacobian(q)


WHOLE = {
    "in degrees": lambda q: lecture_jacobian(np.deg2rad(q)),
    "the joints are taken in the order q3, q2, q1": lambda q: lecture_jacobian(np.asarray(q)[::-1]),
    "the matrix is transposed": lambda q: lecture_jacobian(q).T,
    "row 2 has the wrong sign": lambda q: lecture_jacobian(q) * np.array([[1], [-1], [1]]),
    "column 2 has the wrong sign": lambda q: lecture_jacobian(q) * np.array([1, -1, 1]),
    "the rows stand in the order 2, 1, 3": lambda q: lecture_jacobian(q)[[1, 0, 2]],
    "millimetres": lambda q: 1000 * lecture_jacobian(q),
    "the angular rows stand above the linear ones": lambda q: np.roll(ARM.arm.geometric_jacobian(q), 3, axis=0),
    "q3 is taken as the absolute angle": lambda q: lecture_jacobian([q[0], q[1], q[2] - q[1]]),
    "twice what it should be": lambda q: 2 * lecture_jacobian(q),
}


@pytest.mark.parametrize("words", WHOLE)
def test_mistakes_of_the_whole_are_named(words: str) -> None:
    verdict = arm3r.verify.jacobian(WHOLE[words])
    assert not verdict.ok
    assert any(words in cause.lower() for cause in (verdict.findings[0].cause, *verdict.alternatives))


def test_a_black_box_is_read_in_the_arms_names() -> None:
    arm = arm3r.Scenario("{format: 1, arm: {link2: {length: 0.8}, link3: {length: 0.55}}}")
    shift = np.array([0.0, 0.3, 0.0])
    verdict = arm3r.verify.gravity(lambda q: arm.arm.gravity_torque(q) + shift * np.cos(q[1]), arm)
    (finding,) = verdict.findings
    assert finding.due == "-m3 g a2 C2 - 1/2 m2 g a2 C2 - 1/2 m3 g a3 C23"
    assert finding.reads == "-m3 g a2 C2 + 3/10 C2 - 1/2 m2 g a2 C2 - 1/2 m3 g a3 C23"


def test_the_convention_that_the_scenario_states_wins(written: Any) -> None:
    """A formula of the other one is wrong there, by one sentence; it is right where none is stated."""
    text = """from math import cos


def gravity(q1, q2, q3):
    t3 = 3.849110125*cos(q2 + q3)
    return [0, 11.547330375*cos(q2) + t3, t3]
"""
    path = written("gravity.py", text)
    assert arm3r.verify.gravity(path).convention == "slide" and arm3r.verify.gravity(path).ok
    stated = arm3r.Scenario("format: 1\narm: {convention: simscape}\n")
    verdict = arm3r.verify.gravity(path, stated)
    assert not verdict.ok and verdict.convention == "simscape"
    assert {one.cause for one in verdict.findings} == {"The result has the wrong sign."}
    assert [one.reads for one in verdict.findings] == [
        "m3 g a2 C2 + 1/2 m2 g a2 C2 + 1/2 m3 g a3 C23",
        "1/2 m3 g a3 C23",
    ]
    assert "it is right in the convention slide; the scenario states simscape" in verdict.alternatives
    stated["arm.convention"] = "slide"
    assert arm3r.verify.gravity(path, stated).ok and "states" not in str(arm3r.verify.gravity(path, stated))


def test_a_lost_sign_is_put_before_the_whole_term(written: Any) -> None:
    """Not before a length or a mass in it, with which the values would be the same."""
    text = """from math import cos


def gravity(q1, q2, q3):
    m2, m3, a2, a3, g = 0.785, 0.785, 1.0, 1.0, 9.80665
    half = a3/2
    t3 = m3*g*half*cos(q2 + q3)
    return [0.0, -g*(m2*a2/2 + m3*a2)*cos(q2) + t3, t3]
"""
    verdict = arm3r.verify.gravity(
        written("gravity.py", text), arm3r.Scenario("format: 1\narm: {convention: simscape}\n")
    )
    assert {(one.line, one.new) for one in verdict.findings} == {(7, "-m3*g*half*cos(q2 + q3)")}


def test_the_convention_is_found() -> None:
    scenario = arm3r.Scenario()
    scenario["arm.convention"] = "slide"
    verdict = arm3r.verify.jacobian(lambda q: scenario.arm.jacobian(q))
    assert verdict.ok and verdict.convention == "slide"


# ---- mutants --------------------------------------------------------------------------------------------------------


def judged(program: Program, text: str, folder: Path) -> str:
    """ "right", "fails", "missed", "false", "named" or "unexplained"."""
    wrong = {convention: runner.wrong_entries(program, text, convention) for convention in ("simscape", "slide")}
    path = folder / ("program.py" if program.language == "python" else "program.m")
    path.write_text(text)
    if None in wrong.values():
        return "fails"
    verdict = formula_verdict(from_file(path), program.kind)
    if not all(wrong.values()):
        return "right" if verdict.ok else "alarm"
    if verdict.findings and verdict.findings[0].entry is None:
        if verdict.findings[0].old is None:
            return "fails" if runner.returns_nothing(program, text) else "missed"
        return (
            "false"
            if runner.wrong_entries(program, reading.with_edits(text, verdict.findings), verdict.convention)
            else "named"
        )
    located = {tuple(finding.entry) for finding in verdict.findings}
    if located != wrong[verdict.convention]:
        return "missed"
    if any(is_false(program, text, verdict, finding) for finding in verdict.findings):
        return "false"
    named = [one.reads is not None or one.old is not None for one in verdict.findings]
    return "named" if all(named) or " explain it" not in verdict.findings[named.index(False)].cause else "unexplained"


def is_false(program: Program, text: str, verdict: Any, finding: Any) -> bool:
    """Whether what a finding says does not hold for the program as it is."""
    entry = tuple(place - 1 for place in finding.entry)
    numbers = dict(zip(runner.NAMES, runner.ARMS[0], strict=True))
    arm = runner.arm_of(verdict.convention, numbers, with_inertia=program.kind == "mass")
    for q in runner.STATES[:3]:
        got = runner.values(program, text, numbers, q)
        right = runner.due(program.kind, arm, q)
        for sentence, value in ((finding.reads, got), (finding.due, right)):
            if sentence is not None and value is not None:
                said = reading.value(sentence, q, numbers | runner.INERTIA)
                if not abs(said - value[entry]) <= 1e-6 * (1 + abs(value[entry])):
                    return True
    if finding.old is None:
        return False
    left = runner.wrong_entries(program, reading.with_edits(text, verdict.findings), verdict.convention)
    return left is None or tuple(finding.entry) in left


def test_an_edit_follows_a_length_that_is_not_used(written: Any) -> None:
    """`a2` where `a3` is meant, which stands nowhere else: `1`, its number in the text, is not what is due."""
    program = next(one for one in PROGRAMS if one.name == "MATLAB jacobian by transforms, simscape")
    text = program.text.replace("turn(q(3), 0, a3)", "turn(q(3), 0, a2)")
    verdict = arm3r.verify.jacobian(written("jacobian.m", text))
    assert {(one.old, one.new) for one in verdict.findings} == {("a2", "a3")}, str(verdict)
    assert not any("as `1`" in words for words in verdict.alternatives)


def test_what_is_nan_tells_nothing_about_a_length(tmp_path: Path) -> None:
    program = next(one for one in PROGRAMS if one.name == "jacobian by cross products, slide")
    assert program.text.count("*u + a3*") == 1
    assert judged(program, program.text.replace("*u + a3*", "*u ** a3*"), tmp_path) == "named"


def test_what_is_due_is_left_open_where_the_text_does_not_tell_what_follows_a_length(tmp_path: Path) -> None:
    """Two mistakes leave no term that tells `a2/2` from a centre of mass that keeps its number."""
    program = next(one for one in PROGRAMS if one.name == "gravity by centres, slide")
    path = tmp_path / "program.py"
    path.write_text(program.text.replace("m2*h2 + m3*h3", "m2*h2*(m3 + h3)"))
    assert path.read_text() != program.text
    verdict = formula_verdict(from_file(path), program.kind)
    second = next(one for one in verdict.findings if one.entry == [2])
    assert second.reads is not None and second.due is None and "should be" not in second.cause
    notes = [words for words in verdict.warnings if "does not tell what follows a length" in words]
    assert len(notes) == 2 and "m2 g l2 C2" in notes[0] and "1/2 m2 g a2 C2" in notes[1]
    assert judged(program, path.read_text(), tmp_path) == "named"


def test_two_edits_are_shown_only_if_they_hold_together(tmp_path: Path) -> None:
    program = next(one for one in PROGRAMS if one.name == "jacobian by transforms, slide")
    text = program.text.replace("s*sa, a*c]", "s*sa, -a*c]").replace("J[:, 0] =", "J[:, -1] =")
    assert text.count("-1] =") == 1 and judged(program, text, tmp_path) in ("named", "unexplained")


@pytest.mark.parametrize("program", PROGRAMS, ids=lambda program: program.name)
def test_right_programs_are_right(program: Program, tmp_path: Path) -> None:
    assert runner.wrong_entries(program, program.text) == set()
    path = tmp_path / ("program.py" if program.language == "python" else "program.m")
    path.write_text(program.text)
    verdict = formula_verdict(from_file(path), program.kind)
    assert verdict.ok and verdict.convention in (program.convention, "simscape"), str(verdict)


COUNTED = ("missed", "false", "named", "unexplained", "alarm")


def counted(count: int, seed: int, folder: Path, *, two: bool = False, foreign: bool = False) -> Counter[str]:
    """The outcomes for random mutants that differ from what is right and run."""
    outcomes: Counter[str] = Counter()
    for choose in draws(seed):
        if sum(outcomes[one] for one in COUNTED) >= count:
            break
        program = choose.choice([one for one in PROGRAMS if not foreign or one.language == "python"])
        if foreign:
            text: str | None = choose.choice(foreign_mutants(program.text))
        elif two:
            text = next(two_mistakes(program.text, program.language, choose.randrange(10**9), 1), None)
        else:
            text = choose.choice(mutants(program.text, program.language))
        if text is not None:
            outcome = judged(program, text, folder)
            outcomes[outcome] += 1
            if outcome in ("missed", "false", "alarm", "unexplained"):
                print(outcome, program.name, text, sep="\n")
    print(dict(outcomes))
    return outcomes


def test_single_mistakes_are_found_and_named(tmp_path: Path) -> None:
    outcomes = counted(4, SEED, tmp_path)
    assert not outcomes["missed"] and not outcomes["false"] and not outcomes["alarm"]


def test_mistakes_by_a_foreign_tool_are_found(tmp_path: Path) -> None:
    outcomes = counted(3, SEED, tmp_path, foreign=True)
    assert not outcomes["missed"] and not outcomes["false"] and not outcomes["alarm"]


@pytest.mark.gate
@pytest.mark.random
@pytest.mark.parametrize("part", range(6))
def test_many_mistakes_by_a_foreign_tool(part: int, tmp_path: Path) -> None:
    outcomes = counted(60, SEED + part, tmp_path, foreign=True)
    assert not outcomes["missed"] and not outcomes["false"] and not outcomes["alarm"]
    assert outcomes["named"] >= 59


@pytest.mark.gate
@pytest.mark.random
@pytest.mark.parametrize("part", range(4))
def test_many_single_mistakes(part: int, tmp_path: Path) -> None:
    outcomes = counted(100, SEED + part, tmp_path)
    assert not outcomes["missed"] and not outcomes["false"] and not outcomes["alarm"]
    assert outcomes["named"] >= 99


@pytest.mark.gate
@pytest.mark.random
@pytest.mark.long
def test_many_pairs_of_mistakes(tmp_path: Path) -> None:
    """At least nine of ten: 180 of them, as of 60 one sample in twenty would have fewer than 54 by chance."""
    outcomes = counted(180, SEED, tmp_path, two=True)
    assert not outcomes["missed"] and not outcomes["false"] and not outcomes["alarm"]
    assert outcomes["named"] >= binom.ppf(0.001, 180, 0.9)  # which such a share has in 999 of 1000 samples


def no_alarms(count: int, seed: int, folder: Path) -> None:
    programs = [program for program in PROGRAMS if program.language == "python"]
    for choose in itertools.islice(draws(seed), count):
        program = choose.choice(programs)
        text = rewritten(program.text, choose.randrange(10**9))
        path = folder / "program.py"
        path.write_text(text)
        verdict = formula_verdict(from_file(path), program.kind)
        assert verdict.ok, f"{text}\n{verdict}"


def test_equivalent_programs_raise_no_alarm(tmp_path: Path) -> None:
    no_alarms(25, SEED, tmp_path)


@pytest.mark.gate
@pytest.mark.random
@pytest.mark.parametrize("part", range(2))
def test_no_alarm_on_two_thousand_right_programs(part: int, tmp_path: Path) -> None:
    no_alarms(1000, SEED + part, tmp_path)


# ---- coverage -------------------------------------------------------------------------------------------------------


def test_the_lectures_own_tests_see_few_mistakes(written: Any) -> None:
    """The table of docs/lecture.md."""
    jacobian = arm3r.verify.jacobian(written("j.m", LECTURE_JACOBIAN)).coverage["the lecture's free fall"]
    assert (jacobian["planted"], jacobian["seen"], jacobian["joints"]) == (73, 26, [2, 3])
    gravity = arm3r.verify.gravity(written("g.m", LECTURE_GRAVITY)).coverage["the lecture's two holds"]
    assert (gravity["planted"], gravity["seen"], gravity["entries"]) == (22, 13, [[2], [3]])


def test_other_tests_see_what_the_lectures_do_not(written: Any, root: Path) -> None:
    path = written(
        "g.m",
        LECTURE_GRAVITY.replace("t1 = q1*0", "t1 = q1").replace(
            "t3 = -(m3*g*(a3/2)*cos(q2+q3)", "t3 = -(m3*g*(a3/2)*cos(q2)"
        ),
    )
    scenario = root / "scenarios" / "lecture" / "13_unequal_hold.yaml"
    verdict = arm3r.verify.gravity(path, seen_by=[scenario])
    for finding in verdict.findings:
        assert finding.seen_by == {"the lecture's two holds": False, "13_unequal_hold": True}
    reasons = [finding.unseen_because["the lecture's two holds"] for finding in verdict.findings]
    assert reasons == ["there q1 = 0", "there q3 = -2 q2"]
    assert verdict.coverage["13_unequal_hold"]["seen"] == 22


# ---- the command ----------------------------------------------------------------------------------------------------


def test_the_command_prints_json(written: Any, command: Any) -> None:
    right = written("my_jacobian.m", LECTURE_JACOBIAN)
    wrong = written("gravity.py", "def gravity(q):\n    return [q[0], 0, 0]\n")
    done = command(right, wrong, "--json")
    first, second = json.loads(done.stdout)
    assert done.returncode == 11 and first["ok"] and not second["ok"]
    assert set(first) >= {"ok", "kind", "convention", "residual", "findings", "alternatives", "unexplained", "coverage"}
    assert set(second["findings"][0]) >= {"entry", "reads", "due", "cause", "line", "column", "old", "new", "seen_by"}
    assert command(right).returncode == 0


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("missing.m", None, "cannot be read"),
        ("x.m", "function J = jac(q)\nsyms a2\n", "x.m:2:1: `syms` is not read"),
        ("x.m", "function J = jac(q)\nwhile q\n", "x.m:2:1: `while` is not closed by `end`: line 3 has 'the end of"),
        ("x.py", "def jacobian(q:\n", "x.py:1: this is not Python"),
        ("x.py", "def f(q):\n    return q\n", "--kind"),
        ("x.py", "def jacobian(q, friction, y, z):\n    return q\n", "the argument friction is not understood"),
    ],
)
def test_what_cannot_be_read_is_refused(written: Any, command: Any, name: str, text: str | None, words: str) -> None:
    path = written(name, text) if text is not None else name
    done = command(path)
    assert (
        done.returncode == (12 if any(one in words for one in ("not read", "not closed", "not understood")) else 2)
        and words in done.stderr
        and "Traceback" not in done.stderr
    )


HOSTILE = {
    "raise ValueError('no')": "raises ValueError: no",
    "import os; os._exit(0)": "ends its process",
    "return None": "returns None instead of numbers",
    "return 'J'": "returns str",
    "return [[1, 2], [3]]": "returns",
    "import sys; sys.exit()": "raises SystemExit",
    "import numpy; return numpy.zeros((3, 0))": "returns 3x0 numbers",
    "return []": "returns 0 numbers",
    "import random; return [[random.random()] * 3] * 3": "gives different numbers",
}


UNJUDGED = {
    "while True: pass": "takes too long",
    "return [1] * 10**12": "needs too much memory",
    "import threading; threading.Event().wait()": "it waits",
}


@pytest.mark.sample(1)
@pytest.mark.parametrize("body", UNJUDGED)
def test_what_runs_out_is_no_verdict(written: Any, capsys: Any, body: str, monkeypatch: Any) -> None:
    monkeypatch.setattr("arm3r_cpp.user_functions.python_process.ANSWER_TIME", 1.0)
    monkeypatch.setattr("arm3r_cpp.system.patience.WAITING_TIME", 2.0)
    path = written("jacobian.py", f"def jacobian(q):\n    {body}\n")
    wrong = written("gravity.py", "def gravity(q):\n    return [1, 2, 3]\n")
    assert verify_main([str(path)]) == 12
    error = capsys.readouterr().err
    assert UNJUDGED[body] in error and len(error.splitlines()) == 1
    assert verify_main([str(path), str(wrong)]) == 11


def test_a_line_that_fails_is_mended_first(written: Any) -> None:
    """A power of a negative angle is complex; there are thousands of edits in the other lines."""
    lines = [f"    x{n} = -sin(q1)*(a3*cos(q2+q3)+a2*cos(q2))*{n}" for n in range(40)]
    text = (
        "from math import cos, sin\n\n\ndef gravity(q1, q2, q3):\n    a2, a3, m2, m3, g = 1, 1, 0.785, 0.785, 9.80665\n"
    )
    text += "\n".join(lines) + "\n    t3 = -m3*g*a3/2*cos(q2**q3)\n    return [0, t3 - (m2/2 + m3)*g*a2*cos(q2), t3]\n"
    (finding,) = arm3r.verify.gravity(written("gravity.py", text)).findings
    assert (finding.line, finding.old, finding.new) == (46, "q2**q3", "q2+q3"), finding


def test_the_search_for_an_edit_ends(written: Any, monkeypatch: Any) -> None:
    monkeypatch.setattr("arm3r_cpp.verify.judge.REPAIR_EDITS", 0)
    text = "from math import cos\n\n\ndef gravity(q1, q2, q3):\n    return [0, cos(q2)/(2 + cos(q3)), 1]\n"
    verdict = arm3r.verify.gravity(written("gravity.py", text))
    assert not verdict.ok and verdict.unexplained == [[2]]
    assert any("the search for an edit that mends it was ended" in one for one in verdict.warnings)


GROWING = {
    "jacobian.m": ("function J = f(q1, q2, q3)\n  x = [q1 q2];\n" + "  x = [x x];\n" * 60 + "  J = [x; x; x];\nend\n",
                   "a matrix of 1 x 128 is too large"),
    "loops.m": (
        "function J = jacobian(q)\nfor a = 1:9000\nfor b = 1:9000\nx = 1;\nend\nend\nJ = q*q';\nend\n",
        "takes more than 20000 steps",
    ),
    "range.m": ("function J = jacobian(q)\nfor i = 1:1e300\nJ = eye(3);\nend\nend\n", "a range has at most 20000"),
    "infinity.m": ("function J = jacobian(q)\nk = 1/0;\nx = q(k);\nJ = x;\nend\n", "infinity to integer"),
    "cell.m": ("function J = jacobian(q)\nT = cell(1, 1e9);\nJ = eye(3);\nend\n", "of 1 x 1000000000 is too large"),
    "handle.m": (
        "function J = jacobian(q)\nf = @(f, x) f(f, x);\nJ = f(f, q);\nend\n",
        "calls functions more than 30 deep",
    ),
    "jacobian.py": ("a = 1 << 99999999999\n\n\ndef jacobian(q):\n    return [[a] * 3] * 3\n", "needs too much memory"),
}  # fmt: skip


@pytest.mark.parametrize("name", GROWING)
def test_a_text_that_is_read_takes_no_memory_of_this_process(written: Any, name: str) -> None:
    text, cause = GROWING[name]
    path = written(name, text)
    if name == "infinity.m":  # which no language takes
        (finding,) = arm3r.verify.jacobian(path).findings
        assert cause in finding.cause and finding.line
        return
    with pytest.raises(arm3r.UnjudgedError, match=re.escape(cause)) as caught:
        arm3r.verify.jacobian(path)
    assert len(str(caught.value).splitlines()) == 1


READ = {  # of one Jacobian, right in the convention simscape
    "a mask": "J(abs(J) < 1e-12) = 0;",
    "a mask in brackets": "J((J > -1) & ~(J < 1e9)) = 0; J = J0;",
    "pages": "P = zeros(3, 3, 2); P(:,:,1) = J; P(:,:,2) = 2*J; J = P(:,:,2)/size(P, 3);",
    "pages that grow": "P(:,:,2) = J; P(1,2,1) = 5; J = P(1:3,:,2) + 0*P(1,2,1);",
    "an element of a page": "P = zeros(3, 3, 2); P(3,2,2) = -r; J(3,2) = P(3,2,2);",
    "a power of a matrix": "J = J*eye(3)^2;",
    "a matrix that gets pages": "T = J; T(:,:,2) = 2*J; J = T(:,:,1);",
    "a mask that chooses": "v = [1 2 3]; w = v(v > 1); J = J*w(1)/2;",
    "a mask that chooses at some states": "J = J + 0*sum(q(q > 0));",
}
BODY = """function J = jacobian(q)
r = cos(q(2)) + cos(q(2)+q(3)); h = sin(q(2)) + sin(q(2)+q(3));
c1 = cos(q(1)); s1 = sin(q(1)); s23 = sin(q(2)+q(3)); c23 = cos(q(2)+q(3));
J = [-s1*r, -h*c1, -s23*c1; c1*r, -h*s1, -s23*s1; 0, -r, -c23]; J0 = J;
%s
end
"""


@pytest.mark.parametrize("name", READ)
def test_matlab_as_it_is_written(written: Any, name: str) -> None:
    verdict = arm3r.verify.jacobian(written("jacobian.m", BODY % READ[name]))
    assert verdict.ok and verdict.convention == "simscape", str(verdict)


def test_a_misspelt_name_is_a_mistake(written: Any) -> None:
    """It is one where another name of the text makes the formula right."""
    verdict = arm3r.verify.jacobian(written("jacobian.m", (BODY % "").replace("-s23*c1", "-s32*c1")))
    assert {(one.old, one.new) for one in verdict.findings} == {("s32", "s23")}, str(verdict)


UNREAD = {
    "x = erf(q(1));": "'erf' is not known",
    "J = J*l9;": "'l9' has no value in this file: write l9 = NUMBER; above, make it an argument, or say it by",
    "[a, b] = max(q);": "several outputs come from functions of this file and its folder",
    "J(J > 0) = [1; 2];": "more is not read",
    "P = zeros(3, 3, 2); J = P(:, :);": "is read by three indices",
    "J = J(:, :, 1);": "an index of three dimensions",
    "P = zeros(3, 3, 2); P(:,:,1) = J; P = 2*P; J = P(:,:,1)/2;": "one page at a time is read",
    "P = zeros(3, 3, 2); P(:,:,2) = J; J = sum(P, 3);": "sum of an array of three dimensions is not read",
    "P = zeros(3, 3, 2); P(:,:,1) = P; J = P(:,:,1);": "a matrix is put into an array of three dimensions",
    "P = zeros(3, 3, 2); P(1, 2) = 5;": "is set by three indices",
    "J = J*eye(3)^0.5;": "a power of a matrix is read to a whole number",
    "J = J*2^eye(3);": "a matrix as an exponent is not read",
}


@pytest.mark.sample(5)
@pytest.mark.parametrize("line", UNREAD)
def test_what_is_not_read_is_no_mistake(written: Any, command: Any, line: str) -> None:
    """Its language may take it: the line that is not read is named, and nothing is called wrong."""
    done = command(written("jacobian.m", BODY % line))
    assert done.returncode == 12 and not done.stdout, done.stdout
    assert "jacobian.m:5: cannot be judged: " in done.stderr and UNREAD[line] in done.stderr


@pytest.mark.parametrize("body", HOSTILE)
def test_a_hostile_file_is_one_clear_line(written: Any, body: str, monkeypatch: Any) -> None:
    monkeypatch.setattr("arm3r_cpp.user_functions.python_process.ANSWER_TIME", 1.0)
    verdict = arm3r.verify.jacobian(written("jacobian.py", f"def jacobian(q):\n    {body}\n"))
    (finding,) = verdict.findings
    assert not verdict.ok and finding.entry is None and HOSTILE[body] in finding.cause
    assert len(str(verdict).splitlines()) <= 4


SEVERAL = """import numpy as np
from numpy import cos, sin


def jacobian(q):
    q1, q2, q3 = q
    r, h = cos(q2) + cos(q2 + q3), sin(q2) + sin(q2 + q3)
    Jv = np.array([[-sin(q1)*r, -h*cos(q1), -sin(q2 + q3)*cos(q1)],
                   [cos(q1)*r, -h*sin(q1), -sin(q2 + q3)*sin(q1)], [0, -r, -cos(q2 + q3)]])
    Jw = np.array([[0, -sin(q1), -sin(q1)], [0, cos(q1), cos(q1)], [1, 0, 0]])
    return %s
"""


@pytest.mark.parametrize(
    ("returned", "output"),
    [("Jv, Jw", 1), ("Jw, Jv", 2), ("[Jw, Jv, np.linalg.det(Jv)]", 2), ("np.eye(4), Jv", 2), ("3.0, 'J', Jv", 3)],
)
def test_one_of_several_results_is_judged(returned: str, output: int, written: Any) -> None:
    path = written("jacobian.py", SEVERAL % returned)
    verdict = arm3r.verify.jacobian(path)
    assert verdict.ok and f"its output {output}" in str(verdict), str(verdict)
    path = written("jacobian.py", (SEVERAL % returned).replace("-h*sin(q1)", "h*sin(q1)"))
    wrong = arm3r.verify.jacobian(path)
    assert {(one.line, one.new) for one in wrong.findings} == {(9, "-h*sin(q1)")}, str(wrong)


def test_a_number_that_is_not_used_is_missed_beside_another_mistake(written: Any) -> None:
    """The text has a3, and 1 in its place; the other mistake stands in another entry."""
    text = """from math import cos

a2, a3, m2, m3, g = 1.0, 1.0, 0.785, 0.785, 9.80665


def gravity(q1, q2, q3):
    n3 = m3*g*1/2*cos(q2 + q3)
    n2 = n3 + (m3*g + a2)*cos(q2) + m2*g*a2/2*cos(q2)
    return [0, -n2, -n3]
"""
    verdict = arm3r.verify.gravity(written("gravity.py", text))
    assert [one.entry for one in verdict.findings] in ([[2], [3]], [[3], [2]])
    assert any("a3" in str(one.new) for one in verdict.findings), str(verdict)


def test_the_rows_of_a_matrix_are_no_results(written: Any) -> None:
    path = written("gravity.py", "def gravity(q):\n    return [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]\n")
    verdict = arm3r.verify.gravity(path)
    assert "returns 2x3 numbers, where a gravity torque has 3" in verdict.findings[0].cause


def test_numbers_of_one_value_are_said_to_be_so(written: Any) -> None:
    """The text has numbers alone: their letters are those that are due, and the note says which could be others."""
    text = """from math import cos


def gravity(q1, q2, q3):
    t3 = -3.849110125*cos(q2 + q3)
    return [0, -7.69822025*cos(q2) - 3.849110125*cos(q2) - t3, t3]
"""
    verdict = arm3r.verify.gravity(written("gravity.py", text))
    assert verdict.findings[0].reads == "-m3 g a2 C2 - 1/2 m2 g a2 C2 + 1/2 m3 g a3 C23"
    assert "cannot tell a2 from a3, m2 from m3 here: they are equal" in verdict.warnings


def test_edits_do_not_hang_on_the_order_of_sets(written: Any) -> None:
    path = written("jacobian.m", LECTURE_JACOBIAN)
    program = (
        "from arm3r_cpp.verify.formula import from_file\nfrom arm3r_cpp.verify.explain.edits import Editor\n"
        f"one = from_file({str(path)!r})\n"
        "print(Editor(one.text, one.nodes, one.language, ['q1', 'q2', 'q3'], ['a2'], one.outputs).all(one.nodes))\n"
    )
    seeds = [{**os.environ, "PYTHONHASHSEED": str(seed)} for seed in range(3)]
    assert len({subprocess.check_output([sys.executable, "-c", program], env=one) for one in seeds}) == 1
