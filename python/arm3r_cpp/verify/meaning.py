"""How a formula is meant: its convention, the unit of angles, which of its numbers are varied, what follows them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

from .._native import Floats
from ..errors import UsageError
from ..user_functions.expressions import Number
from ..user_functions.programs import ProcessEnded, ProgramError
from .comparison import TOLERANCE, Comparison, scales
from .explain.frames import named_frames
from .formula import Formula
from .kinds import ANGULAR, KINDS, SPATIAL, Kind, kinds_of_outputs
from .names import is_right_hand_side, vectors_of
from .samples import Samples
from .truth.three_r import FOLLOWING

_CHANGE = 1e-6  # of the largest: what changes less does not change
_MOST_MEANINGS = 8  # that are tried where some entries are wrong in all of them
_MOST_OUTPUTS = 4
ANGULAR_FIRST = (*ANGULAR, *SPATIAL)
_NEAR = 0.25  # of the distance from what is right in the frame of the base


def as_called(formula: Formula, kind: Kind, truth: Any) -> Formula:
    """The formula in the way in which it returns what its kind does: given plain vectors or else columns (n, 1).

    Of several results that fit by their shapes, and whose names say no other kind, the one is taken that changes with
    the state and whose name says the kind, else the nearest one.
    """
    if formula.output is not None or _has_fitting_shape(formula, kind, truth):
        return formula
    if formula.language == "matlab":
        others = [replace(formula, output=one) for one in range(len(formula.outputs))]
    elif formula.language == "python":
        ways = product((False, True), (None, *range(_MOST_OUTPUTS)))
        others = [replace(formula, output=one, as_columns=columns) for columns, one in ways]
    else:
        others = []
    named = [one for one in others if _kind_of_output(one) == kind.name]
    others = [one for one in others if _kind_of_output(one) in (None, kind.name)]
    fitting = [one for one in others if _has_fitting_shape(one, kind, truth)]

    def likeliness(one: Formula) -> tuple[bool, bool, int, float]:
        is_constant, count, error = _distance(one, kind, truth)
        return is_constant, one not in named, count, error

    return min(fitting, key=likeliness, default=named[0] if named else formula)


def _distance(formula: Formula, kind: Kind, truth: Any) -> tuple[bool, int, float]:
    """How far it is from what is right: whether it is the same at all states, the wrong entries, and by how much."""
    case = meant(formula, kind, truth)[0]
    values = case.values(case.second)
    return bool((values == values[:1]).all()), len(case.wrong(values, case.second)), case.error


def _kind_of_output(formula: Formula) -> str | None:
    """The kind that the name of the chosen output tells."""
    place = formula.output
    return kinds_of_outputs(formula.outputs)[place] if place is not None and place < len(formula.outputs) else None


def _has_fitting_shape(formula: Formula, kind: Kind, truth: Any) -> bool:
    """Whether it returns numbers in a shape of its kind; also where nothing of it will come, as it hangs or crashes."""
    case = Comparison(formula, truth, kind, _parameters(formula, kind, truth))
    try:
        case.values(case.first)
    except ProgramError as error:
        return isinstance(error, ProcessEnded)
    return True


def wrong_count(formula: Formula, kind: Kind, truth: Any) -> int:
    """How many entries are wrong in the likeliest meaning."""
    return _distance(formula, kind, truth)[1]


def assumed(formula: Formula, kind: Kind, truth: Any) -> Any:
    """Of the arms that a file may mean, the one by which fewest entries are wrong.

    Of equals it is one on which the formula's gravity acts, with a size that stands in its text; then the nearest. Of
    equal frames it is the base's, unless the formula is far from what is right there and near in another.
    """
    others = truth.open_to(kind)
    if not others:
        return truth
    numbers = formula.numbers()
    literals = {node.value for top in formula.nodes for node in top.walk() if isinstance(node, Number)}
    feels_gravity = kind.depends_on_gravity and _feels_gravity(formula, kind, truth)

    def has_size(one: Any) -> bool:
        return any(math.isclose(one.gravity_size, number, rel_tol=1e-9) for number in literals)

    is_written = any(map(has_size, [truth, *others]))
    cases = [(one, meant(formula, kind, one)[0]) for one in (truth, *others)]
    in_base = _mean_error(cases[0][1])

    def distance(meaning: tuple[Any, Comparison]) -> tuple[int, bool, int, bool, bool, bool, float]:
        one, case = meaning
        parameters = _parameters(formula, kind, one)
        given = [(numbers[name], one.values_of_quantities[parameters[name]]) for name in parameters if name in numbers]
        values, due = case.values(case.second), case.due(case.second)
        return (
            len(case.wrong(values, case.second, due)),
            feels_gravity and one.is_across_gravity(),
            sum(not np.isclose(*pair, rtol=1e-9) for pair in given),
            is_written and not has_size(one),
            one.takes_gravity,
            not (kind.depends_on_base and _mean_error(case) < _NEAR * in_base),
            _apart_but_for_the_sign(values, due) if kind.depends_on_gravity else 0.0,  # of frames the base's
        )

    return min(cases, key=distance)[0]


def _mean_error(case: Comparison) -> float:
    """The mean difference from what is right, relative to the entries' scales."""
    due = case.due(case.second)
    return float(np.mean(np.abs(case.values(case.second) - due) / scales(due)))


def _apart_but_for_the_sign(values: Floats, due: Floats) -> float:
    """The median difference from what is right, or from its opposite: a lost sign is no other arm."""
    error = min(float(np.median(np.abs(values - sign * due) / scales(due))) for sign in (1, -1))
    return float(f"{error:.6g}") if np.isfinite(error) else float("inf")


def _feels_gravity(formula: Formula, kind: Kind, truth: Any) -> bool:
    """Whether it returns something for an arm at rest, which no torque drives."""
    case = Comparison(formula, truth, kind, _parameters(formula, kind, truth))
    still = {name: np.zeros_like(values) for name, values in case.second.states.items()}
    try:
        values = case.values(Samples({**still, "q": case.second.states["q"]}, case.second.arms))
    except ProgramError:
        return False
    return bool(np.abs(values).max(initial=0.0) > TOLERANCE)


def kind_by_arguments(formula: Formula, truth: Any) -> Kind | None:
    """Forward dynamics, where a function takes a state, and a torque on which its result depends or none."""
    if not is_right_hand_side(formula.arguments):
        return None
    kind = truth.allowing(KINDS["forward"]).taking(vectors_of(formula.arguments))
    try:
        case = Comparison(formula, truth, kind, _parameters(formula, kind, truth))
        states = case.second.states
        other = Samples({**states, "tau": states["tau"] + 1.0}, case.second.arms)
        values, changed = case.values(case.second), case.values(other)
    except (ProgramError, UsageError):
        return None
    return kind if "tau" not in kind.inputs or (changed != values).any() else None


def meant(formula: Formula, kind: Kind, truth: Any) -> list[Comparison]:
    """The comparisons in which fewest entries are wrong; where some are, all that may be meant, the likeliest first."""
    counted: list[tuple[int, Comparison]] = []
    for parameters, is_doubtful in _choices(formula, kind, truth):
        found = list(_counted(formula, kind, truth, parameters))
        if not is_doubtful or min(count for count, _ in found) < min(count for count, _ in counted):
            counted += found
        if any(count == 0 for count, _ in counted):
            break
    best = _fewest(counted)
    return _in_other_rows(best[0]) or best


def _in_other_rows(case: Comparison) -> list[Comparison]:
    """The comparison with the angular rows first, or in a frame that the name says, where few entries are wrong so.

    None where no entry is wrong with the angular rows first: then one sentence says it.
    """
    rows = case.due(case.first).shape[1]
    if not case.kind.is_derivative or rows not in (3, 6):
        return []
    frames = named_frames(case.formula.name, rows) if case.kind.inputs == ("q",) else []
    others = [replace(case, frame=one) for one in frames] + [replace(case, rows=ANGULAR_FIRST)] * (rows == 6)
    values = case.values(case.second)
    whole, *counts = [len(one.wrong(values, case.second, one.due(case.second))) for one in (case, *others)]
    fewest = min(counts, default=whole)
    chosen = others[counts.index(fewest)] if 2 * fewest < whole else None
    return [chosen] if chosen and (fewest or chosen.frame) else []


def doubted(formula: Formula, kind: Kind, truth: Any, case: Comparison) -> list[Comparison]:
    """For a formula that is right as long as numbers of it that it does not use keep their values: with others."""
    parameters, _ = next(_choices(formula, kind, truth))
    if not set(case.parameters) < set(parameters):
        return []
    unused = _idle(Comparison(formula, truth, kind, parameters), set(parameters) - set(case.parameters))
    if set(case.parameters) | unused != set(parameters):
        return []
    counted = [one for one in _counted(formula, kind, truth, parameters) if one[1].follows == FOLLOWING[0]]
    return _fewest(counted)[:1]


def _fewest(counted: list[tuple[int, Comparison]]) -> list[Comparison]:
    """The comparisons with the fewest wrong entries: of what may follow a length, what comes nearest goes first."""
    fewest = min(count for count, _ in counted)
    best = [case for count, case in counted if count == fewest]
    if fewest == 0:
        return best[:1]
    errors: dict[tuple[str, ...], float] = {}
    for case in best:
        errors[case.follows] = min(errors.get(case.follows, float("inf")), case.error)
    meanings: dict[Any, Comparison] = {}
    for case in sorted(
        best, key=lambda case: (errors[case.follows], FOLLOWING.index(case.follows), _still(case), case.error)
    ):
        meanings.setdefault((tuple(case.parameters), case.due(case.second).tobytes()), case)
    return list(meanings.values())[:_MOST_MEANINGS]


def _still(case: Comparison) -> int:
    """How many entries change that should stay the same: of a plane's x, y and angle the last one, read as z."""
    values, due = (np.ptp(one, axis=0) for one in (case.values(case.second), case.due(case.second)))
    return int(np.sum((values > TOLERANCE) & (due <= TOLERANCE)))


def ways(formula: Formula, kind: Kind, truth: Any) -> list[Comparison]:
    """The comparisons in every convention, for a formula that returns nothing that could be compared."""
    base = Comparison(formula, truth, kind, _parameters(formula, kind, truth))
    return [replace(base, convention=convention) for convention in truth.conventions]


def _choices(formula: Formula, kind: Kind, truth: Any) -> Iterator[tuple[dict[str, str], bool]]:
    """The formula's names of quantities that may be varied: all of them, then without those that may mean others.

    The last choice, without those that are not used, is doubtful: it counts where fewer entries are wrong by it.
    """
    own, every = truth.values_of_quantities, _parameters(formula, kind, truth)
    numbers = {name: value for name, value in formula.numbers().items() if name in every}
    every = {name: quantity for name, quantity in every.items() if not _is_opposite(numbers.get(name), own[quantity])}
    yield every, False
    others = {name for name in every if name in numbers and not np.isclose(numbers[name], own[every[name]], rtol=1e-9)}
    if others:
        yield {name: quantity for name, quantity in every.items() if name not in others}, False
    idle = _idle(Comparison(formula, truth, kind, every), set(numbers) & set(every))
    if idle:
        yield {name: quantity for name, quantity in every.items() if name not in idle}, True


def _parameters(formula: Formula, kind: Kind, truth: Any) -> dict[str, str]:
    return {
        name: quantity
        for name, quantity in formula.parameters(kind, truth.joints).items()
        if quantity in truth.values_of_quantities and kind.is_of_arm and not _is_of_other_axis(name, quantity, truth)
    }


def _is_of_other_axis(name: str, quantity: str, truth: Any) -> bool:
    """Whether a link's Iy stands for itself, as its Iz is another number."""
    is_y = quantity.startswith("inertia") and re.fullmatch(r"I_?yy?_?\d", name.rpartition(".")[2], re.I) is not None
    return is_y and not truth.is_axisymmetric(int(quantity[-1]))


def _is_opposite(number: float | None, own: float) -> bool:
    """Whether a number is the arm's own with the other sign, such as g = -9.80665."""
    return number is not None and own != 0 and bool(np.isclose(number, -own, rtol=1e-9))


def _idle(case: Comparison, numbers: set[str]) -> set[str]:
    """The numbers of the text that change nothing in what the formula returns."""
    samples = case.first
    values = case.values(samples)
    found = set()
    for name in numbers:
        quantity = case.parameters[name]
        arms = [{**arm, quantity: 1.37 * arm[quantity]} for arm in samples.arms]
        if np.array_equal(case.values(Samples(samples.states, arms)), values):  # NaN shows nothing
            found.add(name)
    return found


def _counted(formula: Formula, kind: Kind, truth: Any, parameters: dict[str, str]) -> Iterator[tuple[int, Comparison]]:
    """How many entries are wrong, in each convention, unit of angles, and for all that may follow a length."""
    base = Comparison(formula, truth, kind, parameters)
    values = base.values(base.second)
    units = _units_of_angles(formula)
    varied = {quantity.rstrip("23") for quantity in parameters.values()} & {"length", "mass"}
    following = FOLLOWING if varied and kind.needs_masses else FOLLOWING[:1]
    first = truth.convention
    conventions = (first, *(one for one in truth.conventions if one != first))
    refuted: dict[bool, set[tuple[str, ...]]] = {}
    returned = truth.rows_of(kind, values.shape[1])
    for convention, rows, follows, degrees in product(conventions, returned, following, units):
        case = replace(base, convention=convention, follows=follows, rows=rows, degrees=degrees)
        result = case.values(case.second) if degrees else values
        due = case.due(case.second)
        wrong = case.wrong(result, case.second, due)
        if wrong and follows != following[0]:
            if degrees not in refuted:
                refuted[degrees] = _refuted(replace(base, rows=rows, degrees=degrees), conventions, following)
            if follows in refuted[degrees]:
                continue
        error = float(np.median(np.abs(result - due) / scales(due)))
        case.error = float(f"{error:.6g}") if np.isfinite(error) else float("inf")
        yield len(wrong), case


def _refuted(
    case: Comparison, conventions: Sequence[str], following: Sequence[tuple[str, ...]]
) -> set[tuple[str, ...]]:
    """What cannot follow a length: a part of the formula changes as it is due in the likeliest meaning, and not in it.

    A part is what changes of an entry with one length or mass, or only with both a length and a mass.
    """
    samples, changes = _one_by_one(case)
    found = set()
    values = changes(case.values(samples))
    for convention in conventions:
        due = [changes(replace(case, convention=convention, follows=one).due(samples)) for one in following]
        scale = np.abs(due[0]).max(axis=1)
        same = scale > _CHANGE * scale.max(axis=1, keepdims=True)
        same &= np.abs(values - due[0]).max(axis=1) <= TOLERANCE * scale
        for follows, other in zip(following[1:], due[1:], strict=True):
            if (same & (np.abs(other - due[0]).max(axis=1) > _CHANGE * scale)).any():
                found.add(follows)
    return found


def _one_by_one(case: Comparison) -> tuple[Samples, Callable[[Floats], Floats]]:
    """Samples in which single quantities change, and what changes in them: (rows, ...) to (parts, states, entries)."""
    lengths, masses = ([name for name in case.known if name.startswith(stem)] for stem in ("length", "mass"))
    sets = [(), *((name,) for name in (*lengths, *masses)), *product(lengths, masses)]
    arm = case.second.arms[0]
    arms = [{**arm, **{name: 1.37 * arm[name] for name in names}} for names in sets]
    place = {names: number for number, names in enumerate(sets)}

    def changes(values: Floats) -> Floats:
        each = values.reshape(len(sets), -1, int(np.prod(values.shape[1:])))
        single = [each[place[one,]] - each[0] for one in (*lengths, *masses)]
        double = [
            each[place[one, other]] - each[place[one,]] - each[place[other,]] + each[0]
            for one, other in product(lengths, masses)
        ]
        return np.stack([*single, *double])

    return Samples(case.second.states, arms), changes


def _units_of_angles(formula: Formula) -> tuple[bool, ...]:
    """Whether angles may be in degrees, the likelier answer first: names of arguments decide it, comments do not."""
    if any("deg" in name for name in formula.arguments):
        return (True,)
    return (False, True) if "deg" in formula.comments.lower() else (False,)


def is_right_as_it_stands(case: Comparison) -> bool:
    """Whether a formula whose varied numbers all stand in its text is right with these numbers."""
    numbers = case.formula.numbers()
    if not set(case.parameters) <= set(numbers):
        return False
    written = {case.parameters[name]: numbers[name] for name in case.parameters}
    states = case.second.states
    due = case.due(Samples(states, [case.own]))
    try:
        return not case.wrong(case.values(Samples(states, [{**case.own, **written}])), case.second, due)
    except (ProgramError, UsageError):
        return False
