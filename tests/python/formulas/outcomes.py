"""What verify makes of a wrong program of a student, against what is known about it without verify."""

from __future__ import annotations

import math
import re
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import arm3r_cpp as arm3r
import numpy as np
from arm3r_cpp import verify
from arm3r_cpp.user_functions.programs import ProgramError
from arm3r_cpp.verify.formula import from_text
from arm3r_cpp.verify.kinds import KINDS
from arm3r_cpp.verify.samples import Samples
from numpy.typing import NDArray

from . import causes, reading

Floats = NDArray[np.float64]
Entries = set[tuple[int, ...]]
FOLDER = Path(__file__).parent / "students"
FILES = sorted(path for arm in ("unequal", "lecture") for path in (FOLDER / arm).iterdir() if path.is_file())
CONVENTIONS = ("simscape", "slide")
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
        "axial2": 0.002,
        "axial3": 0.003,
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
        "axial2": 1.3083333333333334e-05,
        "axial3": 1.3083333333333334e-05,
    },
}
_random = np.random.default_rng(7)
STATES = {name: _random.uniform(-2.6, 2.6, (6, 3)) for name in ("q", "qd", "qdd", "tau")}


class Outcome(NamedTuple):
    word: str
    """ "right", "fails", "alarm", "missed", "false", "named" or "unexplained"."""
    words: str = ""
    """What is wrong with the verdict, and the verdict."""


def kind_of(path: Path) -> str:
    """The kind of formula that a file's name tells."""
    return "jacobian_dot" if path.name.startswith("jacobian_dot") else path.name.partition("_")[0]


@cache
def arm_of(name: str, convention: str | None = None) -> arm3r.Scenario:
    """The arm, which states its convention and gravity where a convention is given."""
    scenario = arm3r.Scenario.load(FOLDER / "unequal.yaml") if name == "unequal" else arm3r.Scenario()
    if convention is not None:
        scenario["arm.convention"] = convention
        scenario["arm.gravity"] = [0, 0, -9.80665]
    return scenario


def due_at(arm: Any, kind: str, rows: int, states: dict[str, Floats]) -> Floats:
    """What is right at states."""
    q, qd, qdd, tau = states.values()
    functions: dict[str, Any] = {
        "jacobian": lambda: arm.geometric_jacobian(q) if rows == 6 else arm.jacobian(q),
        "jacobian_dot": lambda: arm.jacobian_dot(q, qd),
        "gravity": lambda: arm.gravity_torque(q),
        "kinematics": lambda: arm.tip_position(q),
        "mass": lambda: arm.mass_matrix(q),
        "coriolis": lambda: arm.velocity_product(q, qd),
        "inverse": lambda: arm.inverse_dynamics(q, qd, qdd),
        "forward": lambda: arm.forward_dynamics(q, qd, tau),
    }
    return functions[kind]()


@cache
def due(arm: str, kind: str, convention: str, rows: int) -> Floats:
    return due_at(arm_of(arm, convention).arm, kind, rows, STATES)


@cache
def own_convention(path: Path) -> str:
    """That in which a right program is right; the arm's where both are."""
    found = values(path.read_text(), path)
    assert found is not None, path
    return next(one for one in CONVENTIONS if wrong_entries(path, found, one) == set())


def values(text: str, path: Path) -> Floats | None:
    """What a text returns at the states with the numbers that stand in it; None where it fails."""
    kind = KINDS[kind_of(path)]
    try:
        formula = from_text(text, str(path), None)
        call = formula.bind(kind, 3, {}, [])
        table = Samples(STATES, [{}]).table([])
        if takes_degrees(path):
            table[:, :3] = np.rad2deg(table[:, :3])
        raw = formula.program.evaluate(call, table)
        raw = raw[:, formula.order] if formula.order and raw.ndim == 2 else raw
        return kind.standard_form(raw, 3, STATES["qd"])
    except (ProgramError, arm3r.UsageError):
        return None


def takes_degrees(path: Path) -> bool:
    return "degrees" in path.name and path.suffix == ".py"


def wrong_entries(path: Path, found: Floats, convention: str) -> Entries | None:
    """The entries, from 1, that differ from what is right; None where the shape does."""
    right = due(path.parent.name, kind_of(path), convention, found.shape[1])
    if found.shape != right.shape:
        return None
    scale = np.abs(right).max()
    places = np.argwhere(~(np.abs(found - right) <= 1e-8 * scale).all(axis=0))
    return {tuple(int(one) + 1 for one in place) for place in places}


def wrong_by_convention(path: Path, found: Floats) -> dict[str, Entries | None]:
    return {one: wrong_entries(path, found, one) for one in CONVENTIONS}


def outcome(path: Path, text: str, folder: Path, *, convention: str | None = None) -> Outcome:
    """What the verdict on a text says, which is a right program's or a mutant's.

    Args:
        convention: that the arm states; by default none, and a formula that is right in either is right.
    """
    arm, kind = path.parent.name, kind_of(path)
    found = values(text, path)
    if found is None or not np.isfinite(found).any():
        return Outcome("fails")
    wrong = {one: wrong_entries(path, found, one) for one in ([convention] if convention else CONVENTIONS)}
    if None in wrong.values():
        return Outcome("fails")
    file = folder / path.name
    file.write_text(text)
    verdict = verify.formula_verdict(file, kind, arm_of(arm, convention))
    located = {tuple(finding.entry) for finding in verdict.findings if finding.entry}
    if not all(wrong.values()) and arm == "unequal":
        return Outcome("right" if verdict.ok else "alarm", str(verdict))
    expected = wrong.get(verdict.convention)
    if expected is None:
        return Outcome("missed", f"in the convention {verdict.convention}\n{verdict}")
    if (located != expected) if arm == "unequal" else not (located >= expected):
        return Outcome("missed", f"{expected - located} missed, {located - expected} too many\n{verdict}")
    if not verdict.findings:
        return Outcome("right")
    if false := false_sentence(path, text, verdict, found, expected):
        return Outcome("false", f"{false}\n{verdict}")
    return Outcome("named" if all(map(_is_named, verdict.findings)) else "unexplained", str(verdict))


def _is_named(finding: Any) -> bool:
    """Whether there is an edit, or what the entry reads, or one sentence for the whole."""
    unnamed = " is wrong, and neither its terms nor a single edit explain it."
    return finding.old is not None or finding.reads is not None or not finding.cause.endswith(unnamed)


def false_sentence(path: Path, text: str, verdict: Any, found: Floats, wrong: Entries) -> str:
    """What of a verdict does not hold for the text as it is; "" where all does."""
    right = due(path.parent.name, kind_of(path), verdict.convention, found.shape[1])
    return (
        _false_reading(path, text, verdict, found, right)
        or _false_edit(path, text, verdict)
        or _false_cause(path, verdict, found)
        or _false_alternative(path, text, verdict, wrong)
    )


def _false_reading(path: Path, text: str, verdict: Any, found: Floats, right: Floats) -> str:
    arm = path.parent.name
    formula = from_text(text, str(path), None)
    theirs = formula.parameters(KINDS[kind_of(path)], 3)
    named = {**NUMBERS[arm], **{name: _number_of(arm, quantity) for name, quantity in theirs.items()}}
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
    return ""


def _number_of(arm: str, quantity: str) -> float:
    names = {"length2": "a2", "length3": "a3", "mass2": "m2", "mass3": "m3", "gravity": "g", "com2": "l2", "com3": "l3",
             "height": "d1", "inertia2": "I2", "inertia3": "I3"}  # fmt: skip
    return NUMBERS[arm].get(names.get(quantity, ""), float("nan"))


def _false_edit(path: Path, text: str, verdict: Any) -> str:
    mended = values(reading.with_edits(text, verdict.findings), path)
    left = None if mended is None else wrong_entries(path, mended, verdict.convention)
    if left is None:
        return "the edits fail"
    stays = {tuple(one.entry) for one in verdict.findings if one.old is not None} & left
    return f"{stays} stay wrong after the edits" if stays else ""


def _false_cause(path: Path, verdict: Any, found: Floats) -> str:
    """A sentence about the formula as a whole that does not hold."""
    arm, kind, rows = path.parent.name, kind_of(path), found.shape[1]

    def due_of(states: dict[str, Floats], changes: dict[str, Any]) -> Floats:
        scenario = arm_of(arm, verdict.convention).copy()
        scenario.update(changes)
        return due_at(scenario.arm, kind, rows, states)

    known = causes.Known(due_of, STATES, NUMBERS[arm], takes_degrees(path))
    for sentence in {one.cause for one in verdict.findings if one.old is None} | set(verdict.alternatives):
        said = causes.said(sentence, known)
        if said is not None and not np.abs(said - found).max() <= 1e-6 * (1 + np.abs(found).max()):
            return f"not so: {sentence}"
    return ""


_ALSO = re.compile(r"in line (\d+) `(.*)` as `(.*)` would be right, too", re.S)


def _false_alternative(path: Path, text: str, verdict: Any, wrong: Entries) -> str:
    """Another edit that mends nothing, or spoils what is right, wherever in its line it is made.

    A formula that is right for the numbers in its text, and only for these, has no wrong entry here: it is to stay so.
    """
    for sentence in verdict.alternatives:
        if (said := _ALSO.fullmatch(sentence)) and not any(
            left is not None and (left < wrong or not (left or wrong))
            for left in _left_after(path, text, int(said[1]), said[2], said[3], verdict.convention)
        ):
            return f"not so: {sentence}"
    return ""


def _left_after(path: Path, text: str, line: int, old: str, new: str, convention: str) -> Any:
    """What stays wrong after an edit at each of the places that it may mean."""
    start = sum(len(one) + 1 for one in text.split("\n")[: line - 1])
    end = start + len(text.split("\n")[line - 1])
    for place in range(start, end + 1):
        if text.startswith(old, place):
            mended = values(text[:place] + new + text[place + len(old) :], path)
            if mended is not None:
                yield wrong_entries(path, mended, convention)
