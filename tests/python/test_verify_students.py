"""Formulas in the styles of students: no alarm where they are right, nothing false where one thing in them is wrong."""

from __future__ import annotations

import math
import os
import random
from collections import Counter
from functools import cache
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp import verify
from arm3r_cpp.user_functions.programs import ProgramError
from arm3r_cpp.verify.formula import from_text
from arm3r_cpp.verify.kinds import KINDS
from arm3r_cpp.verify.samples import Samples
from formulas import reading
from formulas.draws import draws
from formulas.mistakes import Mistakes, pairs, singles, wrong_text
from formulas.mutants import mutants
from numpy.typing import NDArray

SEED = int(os.environ.get("ARM3R_SEED", random.randrange(10**6)))
Floats = NDArray[np.float64]
FOLDER = Path(__file__).parent / "formulas" / "students"
FILES = sorted(path for arm in ("unequal", "lecture") for path in (FOLDER / arm).iterdir() if path.is_file())
NUMBERS = {
    "unequal": {
        "a2": 0.8,
        "a3": 0.55,
        "m2": 1.3,
        "m3": 2.1,
        "g": 9.80665,
        "l2": 0.37,
        "l3": 0.21,
        "d1": 0.25,
        "I2": 0.071,
        "I3": 0.043,
    },
    "lecture": {
        "a2": 1.0,
        "a3": 1.0,
        "m2": 0.785,
        "m3": 0.785,
        "g": 9.80665,
        "l2": 0.5,
        "l3": 0.5,
        "d1": 0.0,
        "I2": 0.06542320833333333,
        "I3": 0.06542320833333333,
    },
}
_random = np.random.default_rng(7)
STATES = {name: _random.uniform(-2.6, 2.6, (6, 3)) for name in ("q", "qd", "qdd", "tau")}


@cache
def arm_of(name: str, convention: str | None = None) -> arm3r.Scenario:
    """The arm, which states its convention where one is given."""
    scenario = arm3r.Scenario.load(FOLDER / "unequal.yaml") if name == "unequal" else arm3r.Scenario()
    if convention is not None:
        scenario["arm.convention"] = convention
    return scenario


@cache
def due(arm: str, kind: str, convention: str, rows: int) -> Floats:
    """What is right at the states."""
    its, (q, qd, qdd, tau) = arm_of(arm, convention).arm, STATES.values()
    functions: dict[str, Any] = {
        "jacobian": lambda: its.geometric_jacobian(q) if rows == 6 else its.jacobian(q),
        "gravity": lambda: its.gravity_torque(q),
        "kinematics": lambda: its.tip_position(q),
        "mass": lambda: its.mass_matrix(q),
        "coriolis": lambda: its.velocity_product(q, qd),
        "inverse": lambda: its.inverse_dynamics(q, qd, qdd),
        "forward": lambda: its.forward_dynamics(q, qd, tau),
    }
    return functions[kind]()


def values(text: str, path: Path, kind: str) -> Floats | None:
    """What a text returns at the states with the numbers that stand in it; None where it fails."""
    try:
        formula = from_text(text, str(path), None)
        samples = Samples(STATES, [{}])
        call = formula.bind(KINDS[kind], 3, {}, [])
        table = samples.table([])
        if "degrees" in path.name and path.suffix == ".py":
            table[:, :3] = np.rad2deg(table[:, :3])
        raw = formula.program.evaluate(call, table)
        raw = raw[:, formula.order] if formula.order and raw.ndim == 2 else raw
        return KINDS[kind].standard_form(raw, 3, STATES["qd"])
    except (ProgramError, arm3r.UsageError):
        return None


def wrong_entries(found: Floats, right: Floats) -> set[tuple[int, ...]] | None:
    if found.shape != right.shape:
        return None
    scale = np.abs(right).max()
    places = np.argwhere(~(np.abs(found - right) <= 1e-8 * scale).all(axis=0))
    return {tuple(int(one) + 1 for one in place) for place in places}


def kind_of(path: Path) -> str:
    return path.name.split("_")[0]


@pytest.mark.sample(25)
@pytest.mark.parametrize("path", FILES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_right_formulas_raise_no_alarm(path: Path) -> None:
    text = path.read_text()
    verdict = verify.formula_verdict(path, kind_of(path), arm_of(path.parent.name))
    assert verdict.ok, str(verdict)
    found = values(text, path, kind_of(path))
    assert found is not None
    assert not wrong_entries(found, due(path.parent.name, kind_of(path), verdict.convention, found.shape[1]))


def wrong_by_convention(path: Path, found: Floats) -> dict[str, set[tuple[int, ...]] | None]:
    arm, kind, rows = path.parent.name, kind_of(path), found.shape[1]
    return {one: wrong_entries(found, due(arm, kind, one, rows)) for one in ("simscape", "slide")}


def outcome(path: Path, text: str, folder: Path) -> tuple[str, str]:
    """ "right", "fails", "missed", "alarm", "false", "named" or "unexplained"; and the verdict."""
    arm, kind = path.parent.name, kind_of(path)
    found = values(text, path, kind)
    if found is None or not np.isfinite(found).any():
        return "fails", ""
    wrong = wrong_by_convention(path, found)
    if None in wrong.values():
        return "fails", ""
    file = folder / path.name
    file.write_text(text)
    verdict = verify.formula_verdict(file, kind, arm_of(arm))
    located = {tuple(finding.entry) for finding in verdict.findings if finding.entry}
    expected = wrong[verdict.convention]
    assert expected is not None
    if not all(wrong.values()) and arm == "unequal":
        return ("right" if verdict.ok else "alarm"), str(verdict)
    if (located != expected) if arm == "unequal" else not (located >= expected):
        return "missed", f"{expected - located} missed, {located - expected} too many\n{verdict}"
    if not verdict.findings:
        return "right", ""
    false = false_sentence(path, text, verdict, found, expected)
    if false:
        return "false", f"{false}\n{verdict}"
    named = [one.reads is not None or one.old is not None for one in verdict.findings]
    causes = " explain it" in verdict.findings[named.index(False)].cause if not all(named) else False
    return ("unexplained" if causes else "named"), str(verdict)


def false_sentence(path: Path, text: str, verdict: Any, found: Floats, wrong: set[tuple[int, ...]]) -> str:
    """What of a verdict does not hold for the text as it is; "" where all does."""
    arm, kind = path.parent.name, kind_of(path)
    right = due(arm, kind, verdict.convention, found.shape[1])
    formula = from_text(text, str(path), None)
    theirs = formula.parameters(KINDS[kind], 3)
    named = {**NUMBERS[arm], **{name: number_of(arm, quantity) for name, quantity in theirs.items()}}
    # a symbol of a sentence has the size that the text gives it, and the sign of the arm's own number
    sizes = {name: abs(value) for name, value in formula.numbers().items() if name in theirs}
    written = {**named, **{name: math.copysign(size, named[name]) for name, size in sizes.items()}}
    for one in verdict.findings:
        place = tuple(number - 1 for number in one.entry)
        for sentence, due_values, numbers in ((one.reads, found, written), (one.due, right, named)):
            for row, q in enumerate(STATES["q"]):
                if sentence is None:
                    continue
                rates = {f"{name}{n + 1}": STATES[name][row, n] for name in ("qd", "qdd") for n in range(3)}
                said, is_so = reading.value(sentence, q, numbers | rates), due_values[(row, *place)]
                if not abs(said - is_so) <= 1e-6 * (1 + abs(is_so)):
                    return f"{one.entry}: {sentence} is {said} at {q}, not {is_so}"
    edited = reading.with_edits(text, verdict.findings)
    mended = values(edited, path, kind)
    if mended is None:
        return "the edits fail"
    left = wrong_entries(mended, right)
    stays = {tuple(one.entry) for one in verdict.findings if one.old is not None} & (left or set())
    return f"{stays} stay wrong after the edits" if left is None or stays else ""


def number_of(arm: str, quantity: str) -> float:
    names = {"length2": "a2", "length3": "a3", "mass2": "m2", "mass3": "m3", "gravity": "g", "com2": "l2", "com3": "l3",
             "height": "d1", "inertia2": "I2", "inertia3": "I3"}  # fmt: skip
    return NUMBERS[arm].get(names.get(quantity, ""), float("nan"))


def counted(count: int, seed: int, folder: Path, files: list[Path] = FILES) -> Counter[str]:
    """The outcomes for random mutants that differ from what is right and run."""
    outcomes: Counter[str] = Counter()
    for choose in draws(seed):
        if sum(outcomes[one] for one in ("missed", "false", "named", "unexplained", "alarm")) >= count:
            break
        path = choose.choice(files)
        every = mutants(path.read_text(), "matlab" if path.suffix == ".m" else "python")
        if not every:
            continue
        text = choose.choice(every)
        result, words = outcome(path, text, folder)
        outcomes[result] += 1
        if result in ("missed", "false", "alarm", "unexplained"):
            print(result, path.name, text, words, sep="\n")
    print(dict(outcomes))
    return outcomes


def test_single_mistakes_of_students(tmp_path: Path) -> None:
    outcomes = counted(4, SEED, tmp_path)
    assert not outcomes["missed"] and not outcomes["false"] and not outcomes["alarm"]


@pytest.mark.parametrize(
    ("file", "right", "wrong", "words"),
    [
        # what is rounding beside what is due is zero
        ("jacobian_modified_dh.py", "st*ca, ct*ca", "st*ca, ct*sa", "J(1,2) reads 0, should be -a2 C1 S2 - a3 C1 S23"),
        # one mistake in a convention is likelier than two in the other
        ("jacobian_lists.py", "q[1] + q[2]]", "q[2]]", "should be q[1]+q[2]"),
        # what explains everything goes before edits that mend single entries
        ("gravity_levers.py", "tau[j + 1] -=", "tau[j] -=", "t1, t2, t3: the entries stand in the order 2, 3, 1"),
        # a name that is assigned and stands nowhere else
        ("gravity_levers.m", "m*x", "m*lc", "should be x"),
        ("jacobian_lists.py", "cos(th[k]) if k >= j", "cos(th[k]) if k > j", "should be >="),
        ("jacobian_while.py", "q[1:i+1]", "q[1:i]", "should be i+1"),
        ("jacobian_handles.m", "0.55*du(q2 + q3)]", "0.55*u(q2 + q3)]", "should be du"),
        ("gravity_links_from_1.py", "m2*l1", "m1*l1", "should be m2 g0 l1 C2 + m1 g0 lc1 C2 + m2 g0 lc2 C23"),
        ("jacobian_quaternion.py", "w1*w2 - v1", "w1*1 - v1", "should be w2"),
        ("kinematics_rotations.py", "trans(z=0.25)", "trans(z=0.5)", "should be 0.25"),
    ],
)  # fmt: skip
def test_a_mistake_is_said_in_these_words(file: str, right: str, wrong: str, words: str, tmp_path: Path) -> None:
    path = FOLDER / "unequal" / file
    assert right in path.read_text()
    result, verdict = outcome(path, path.read_text().replace(right, wrong), tmp_path)
    assert result == "named" and words in verdict, verdict


@pytest.mark.parametrize(
    ("wrong", "new"),
    [
        ("(m2*lc2 + m3*a2 + g)*cos(q[1])", "(m2*lc2 + m3*a2) * g"),
        ("m2*lc2*(m3*a2)*g*cos(q[1])", "(m2*lc2 + m3*a2)"),
        ("(m2*lc2 + m3*a2)*g/cos(q[1])", "*"),
    ],
)
def test_an_exchanged_operator_is_put_back_with_its_brackets(wrong: str, new: str, tmp_path: Path) -> None:
    path = FOLDER / "unequal" / "gravity_negative_g.py"
    text = path.read_text().replace("(m2*lc2 + m3*a2)*g*cos(q[1])", wrong)
    result, words = outcome(path, text, tmp_path)
    assert result == "named" and f"should be {new}" in words, words


@pytest.mark.gate
@pytest.mark.random
@pytest.mark.parametrize("part", range(4))
def test_many_mistakes_of_students(part: int, tmp_path: Path) -> None:
    outcomes = counted(100, SEED + part, tmp_path)
    assert not outcomes["missed"] and not outcomes["false"] and not outcomes["alarm"]
    assert outcomes["named"] >= 90


# ---- mistakes by hand -----------------------------------------------------------------------------------------------


def changes_nothing(one: Mistakes) -> bool:
    """Whether the values stay right: the mistake makes the other convention, or what stands there plays no part."""
    path = FOLDER / one.file
    found = values(wrong_text(path.read_text(), one), path, kind_of(path))
    return found is not None and set() in wrong_by_convention(path, found).values()


def of_hand(mistakes: list[Mistakes], folder: Path) -> Counter[str]:
    outcomes: Counter[str] = Counter()
    for one in mistakes:
        path = FOLDER / one.file
        result, words = outcome(path, wrong_text(path.read_text(), one), folder)
        outcomes[result] += 1
        if result not in ("named", "right"):
            print(result, one, words, sep="\n")
    print(dict(outcomes))
    return outcomes


def test_some_mistakes_by_hand(tmp_path: Path) -> None:
    print(f"ARM3R_SEED={SEED}")
    plain = [one for one in singles() if "sympy" not in one.file and "lambdify" not in one.file]
    outcomes = of_hand(random.Random(SEED).sample(plain, 4), tmp_path)
    assert set(outcomes) <= {"named", "right", "unexplained"}


@pytest.mark.gate
def test_mistakes_by_hand(tmp_path: Path) -> None:
    outcomes = of_hand(singles(), tmp_path)
    assert set(outcomes) <= {"named", "right", "unexplained"}
    assert outcomes["right"] <= sum(map(changes_nothing, singles()))
    assert outcomes["unexplained"] <= 0.01 * len(singles())


@pytest.mark.gate
def test_pairs_of_mistakes_by_hand(tmp_path: Path) -> None:
    outcomes = of_hand(pairs(), tmp_path)
    assert set(outcomes) <= {"named", "unexplained"} and outcomes["named"] >= 0.9 * len(pairs())


def test_a_value_that_grows_far_away_hides_no_terms(tmp_path: Path) -> None:
    """A hyperbolic cosine is 1e70 where an angle in degrees would be looked for: the other terms are not nothing."""
    path = FOLDER / "unequal" / "jacobian_expm.py"
    text = path.read_text()
    slip = text.replace("[x[2], 0, -x[0]]", "[x[2], 0, -x[1]]")
    assert slip != text
    result, words = outcome(path, slip, tmp_path)
    assert result == "named" and "reads 0" not in words, words
