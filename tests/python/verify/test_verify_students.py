"""Formulas in the styles of students: no alarm where they are right, nothing false where one thing in them is wrong."""

from __future__ import annotations

import os
import random
from collections import Counter
from pathlib import Path

import pytest
from arm3r_cpp import verify
from formulas.draws import draws
from formulas.mutants import mutants
from formulas.outcomes import FILES, FOLDER, arm_of, kind_of, outcome, values, wrong_entries

SEED = int(os.environ.get("ARM3R_SEED", random.randrange(10**6)))


@pytest.mark.sample(25)
@pytest.mark.parametrize("path", FILES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_right_formulas_raise_no_alarm(path: Path) -> None:
    verdict = verify.formula_verdict(path, kind_of(path), arm_of(path.parent.name))
    assert verdict.ok, str(verdict)
    found = values(path.read_text(), path)
    assert found is not None and wrong_entries(path, found, verdict.convention) == set()


def test_right_programs_by_hand_are_over_two_hundred() -> None:
    """Each of them is judged right by a test of its own: the test above, and those of the idioms."""
    folders = [FOLDER / "unequal", FOLDER / "lecture", FOLDER.parent / "idioms", FOLDER.parent / "python_idioms"]
    counts = {folder.name: sum(one.suffix in (".m", ".py") for one in folder.iterdir()) for folder in folders}
    assert sum(counts.values()) >= 200, counts


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
    outcomes = counted(3, SEED, tmp_path)
    assert not outcomes["missed"] and not outcomes["false"] and not outcomes["alarm"]


@pytest.mark.sample(4)
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
        ("gravity_shorthand.m", "c23 = cos(", "c23 = cosd(", "should be cos"),
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
def test_many_mistakes_of_students(tmp_path: Path) -> None:
    outcomes = counted(100, SEED, tmp_path)
    assert not outcomes["missed"] and not outcomes["false"] and not outcomes["alarm"]
    assert outcomes["named"] >= 90


def test_a_value_that_grows_far_away_hides_no_terms(tmp_path: Path) -> None:
    """A hyperbolic cosine is 1e70 where an angle in degrees would be looked for: the other terms are not nothing."""
    path = FOLDER / "unequal" / "jacobian_expm.py"
    text = path.read_text()
    slip = text.replace("[x[2], 0, -x[0]]", "[x[2], 0, -x[1]]")
    assert slip != text
    result, words = outcome(path, slip, tmp_path)
    assert result == "named" and "reads 0" not in words, words
