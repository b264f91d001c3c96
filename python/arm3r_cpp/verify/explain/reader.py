"""Reads wrong entries: what terms they have, and what terms are due."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import replace
from functools import cached_property, partial
from itertools import combinations_with_replacement
from typing import Any, NamedTuple

import numpy as np

from ..._native import Floats
from ...user_functions.programs import ProgramError
from ..names import SHORT
from ..samples import Samples
from .budget import Budget
from .parts import Part, parts_of
from .spectrum import Spectrum, read
from .terms import RATIOS, Parameters, Term, is_simple_number, sum_words, terms_of

_DYNAMIC = ("length2", "com2", "com3", "mass2", "mass3", "inertia2", "inertia3", "gravity")
_FEW_ARMS = 3
"""At these it shows in what kinds of terms each joint stands; all arms confirm it."""
_ROUNDING = 1e9
"""Times what is due: what a division by rounding leaves, by cos(pi/2), has terms that mean nothing."""

_UNITS = {"length": (1, 0, 0), "com": (1, 0, 0), "height": (1, 0, 0), "mass": (0, 1, 0), "inertia": (2, 1, 0)}
"""Powers of a length, a mass and g."""


class Reading(NamedTuple):
    reads: str | None
    due: str | None
    note: str = ""
    has_due_units: bool = False
    """Whether all terms have simple numbers and the units of what is due: no quantity is a bare number in them."""


class TooSlow(Exception):
    """The terms of a formula take too long to be read."""


def read_entries(case: Any, wrong: frozenset[int], budget: Budget) -> tuple[dict[int, Reading], bool]:
    """The readings of the wrong entries that can be read, and whether the time for it has ended before the last one."""
    if not case.kind.is_read:
        return {}, False
    reader = _Reader(case, budget)
    found: dict[int, Reading] = {}
    for place in sorted(wrong):
        try:
            found[place] = reader.entry(place)
        except (ProgramError, np.linalg.LinAlgError, FloatingPointError):
            continue
        except TooSlow:
            return found, True
    return found, False


class _Reader:
    """Reads entries of one formula, and the same entries of the truth."""

    def __init__(self, case: Any, budget: Budget) -> None:
        self.case, self.kind, self.budget = case, case.kind, budget
        self.parts = parts_of(self.kind, case.truth.joints)
        self.own = case.truth.values_of_quantities
        names = {quantity: name for name, quantity in case.parameters.items()}
        self.shown = {quantity: names.get(quantity, SHORT.get(quantity, quantity)) for quantity in self.own}
        self.varied, self.lifted = self._quantities()
        self.arms = self._arms(case.known)
        self.due_arms = self._arms(sorted({*self.varied, *self.lifted}))
        self.named = self._named()
        self._sampled: dict[tuple[bool, int, bytes], Floats] = {}

    def _named(self) -> dict[str, float]:
        """The chain's numbers that have a name, but for those that the text gives to other numbers."""
        own, text = self.case.formula.numbers(), self.case.formula.text or ""
        return {
            name: value
            for name, value in self.case.truth.named_numbers.items()
            if own.get(name, np.nan) == value or not re.search(rf"(?<![\w.]){name}\b", text)
        }

    @cached_property
    def _elsewhere(self) -> _Reader:
        """What is due of a chain with other lengths: it shows which of them are in a number."""
        random = np.random.default_rng(37)
        numbers = {name: value * random.uniform(1.1, 1.9) for name, value in self.named.items()}
        return _Reader(replace(self.case, truth=self.case.truth.with_lengths(numbers)), self.budget)

    def due_numbers(self, index: int, part: Part) -> dict[Any, float]:
        """The number of each term that is due, by its waves and the powers of what is varied."""
        found = self._terms_due(index, part, {})
        return {
            (waves, powers): number for waves, ones in (found[1] if found else {}).items() for number, powers in ones
        }

    def _quantities(self) -> tuple[list[str], list[str]]:
        """The quantities in which what is due is written, and those of them that the formula's text varies."""
        known = self.case.known
        if self.kind.quantities:
            varied = [name for name in self.kind.quantities if self.own.get(name) or name in known]
            keeps_centres = "com" not in self.case.follows or (not known and self.case.truth.states_centres)
            if self.kind.needs_masses and keeps_centres:  # a centre that keeps its number has a name
                varied += [name for name in ("com2", "com3") if self.own.get(name)]
            return varied, [name for name in known if name in varied or name in ("com2", "com3")]
        varied = list(known) or [name for name in _DYNAMIC if self.own.get(name)]
        return [name for name in varied if name != "gravity" or self.kind.depends_on_gravity], list(known)

    def _arms(self, names: list[str]) -> list[dict[str, float]]:
        random = np.random.default_rng(31)
        count = 4 + max(len(names), *(len(self._monomials(part, names)) for part in self.parts))
        return [self.case.truth.random_quantities(set(names), random) for _ in range(count)] if names else [{}]

    def _monomials(self, part: Part, names: list[str]) -> list[tuple[str, ...]]:
        is_torque = not part.words and self.kind.depends_on_gravity
        return monomials(names, is_torque=is_torque) if is_torque or self.kind.has_products else []

    def _at(self, q: Floats, of_truth: bool, most_arms: int | None = None) -> Floats:
        """The parts at joint angles: (arms, S, entries times parts)."""
        arms = (self.due_arms if of_truth else self.arms)[:most_arms]
        key = of_truth, len(arms), q.tobytes()
        if key not in self._sampled:
            found: dict[bytes, Floats] = {}
            self._sampled[key] = np.stack([self._part(q, part, arms, of_truth, found) for part in self.parts], axis=3)
            self._sampled[key] = self._sampled[key].reshape(len(arms), len(q), -1)
        return self._sampled[key]

    def _part(
        self, q: Floats, part: Part, arms: list[dict[str, float]], of_truth: bool, found: dict[bytes, Floats]
    ) -> Floats:
        total: Any = 0.0
        for weight, vectors in part.weights:
            states = {name: np.zeros_like(q) + vectors.get(name, 0.0) for name in ("qd", "qdd", "tau")}
            key = b"".join(one[:1].tobytes() for one in states.values())
            if key not in found:
                found[key] = self._values(Samples({"q": q, **states}, arms), of_truth)
            total = total + weight * found[key]
        return np.asarray(total)

    def _values(self, samples: Samples, of_truth: bool) -> Floats:
        if self.budget.is_over():
            raise TooSlow
        values = (self.case.due if of_truth else self.case.values)(samples)
        if not np.isfinite(values).all():
            raise ProgramError("is not finite")
        return np.asarray(values.reshape(len(samples.arms), len(samples.states["q"]), -1))

    def entry(self, place: int) -> Reading:
        """What an entry reads, and what is due."""
        due_terms: list[Term] | None = []
        terms: list[Term] | None = []
        for number, part in enumerate(self.parts):
            index = place * len(self.parts) + number
            due, monomials_due = self._due(index, part)
            due_terms = None if due is None or due_terms is None else due_terms + due
            names = None if due is None else {name for term in due for name, _ in term.powers}
            read_ones = self._read(index, part, monomials_due, names)
            terms = None if read_ones is None or terms is None else terms + _like(read_ones, due or [])
        due_words = sum_words(due_terms) if due_terms is not None else None
        words = sum_words(terms) if terms is not None and self._is_whole(place) else None
        if terms is None or words is None or words == due_words:  # the difference is below what words say
            return Reading(None, due_words)
        units = {self._units(term.powers) for term in (*terms, *(due_terms or []))}
        is_simple = all(is_simple_number(term.number) for term in (*terms, *(due_terms or [])))
        return Reading(words, due_words, self._note(), is_simple and len(units) == 1)

    def _units(self, powers: Iterable[tuple[str, int]]) -> tuple[int, ...]:
        """Of names with their powers: kilograms, m/s^2 and metres."""
        quantities = {shown: quantity for quantity, shown in self.shown.items()}
        total = np.zeros(3, int)
        for name, power in powers:
            total += power * np.array(_UNITS.get(quantities.get(name, "").rstrip("0123456789"), (0, 0, 1)))
        return tuple(map(int, total))

    def _is_whole(self, place: int) -> bool:
        """Whether the parts give the entry at random states."""
        if len(self.parts) == 1:
            return True
        random = np.random.default_rng(41)
        n = self.case.truth.joints
        states = {name: random.uniform(-2, 2, (6, n)) for name in ("q", "qd", "qdd", "tau")}
        values = self._values(Samples(states, self.arms), False)[..., place]
        parts = self._at(states["q"], False).reshape(*values.shape, -1, len(self.parts))[:, :, place]
        factors = np.stack([part.factor(states) for part in self.parts], axis=1)
        return bool(np.abs((parts * factors).sum(axis=2) - values).max() < 1e-8 * (1e-6 + np.abs(values).max()))

    def _due(self, index: int, part: Part) -> tuple[list[Term] | None, Any]:
        """The terms of the truth with all quantities varied, and their monomials."""
        result = self._terms_due(index, part, self.named)
        if not result:
            return None, {}
        shown = self._parameters_due(part, {}).names
        return result[0], {
            waves: [(number, dict(zip(shown, powers, strict=True))) for number, powers in found]
            for waves, found in result[1].items()
        }

    def _terms_due(self, index: int, part: Part, named: dict[str, float]) -> Any:
        parameters = self._parameters_due(part, named)
        if named:
            parameters.elsewhere = self._elsewhere.case.truth.named_numbers, self._elsewhere.due_numbers(index, part)
        spectrum = self._spectrum(index, True)
        return spectrum and terms_of(spectrum, parameters, {}, self._scale(index, True), part.words)

    def _parameters_due(self, part: Part, named: dict[str, float]) -> Parameters:
        names = sorted({*self.varied, *self.lifted})
        values = {self.shown[name]: np.array([arm[name] for arm in self.due_arms]) for name in names}
        parameters = Parameters(values, dict(named), len(self.due_arms))
        parameters.may_stand = partial(self._has_few_lengths, part)
        parameters.candidates = self._candidates(part, names, parameters)
        return parameters

    def _read(self, index: int, part: Part, monomials_due: Any, due: set[str] | None) -> list[Term] | None:
        """The terms of the formula; its numbers are called as the table's only where these are due in this entry."""
        known = self.case.known
        fixed = {self.shown[name]: self.own[name] for name in self.varied if name not in known and self.own.get(name)}
        fixed |= {name: value for name, value in self.named.items() if due is not None and name in due}
        values = {self.shown[name]: np.array([arm[name] for arm in self.arms]) for name in known}
        parameters = Parameters(values, fixed, len(self.arms))
        parameters.candidates = self._candidates(part, known, parameters)
        units = self._units_in(monomials_due) or self._units_of(part)
        if self.case.truth.named_numbers:  # lengths of a table; what stands beside them has no name
            parameters.may_stand = partial(self._has_few_lengths, part)
        else:
            parameters.may_stand = lambda names: self._units((name, 1) for name in names) in units
        spectrum = self._spectrum(index, False)
        if spectrum is None or self._scale(index, False) > _ROUNDING * self._scale(index, True):
            return None
        result = terms_of(
            spectrum, parameters, _hints(monomials_due, parameters, fixed), self._scale(index, False), part.words
        )
        return result[0] if result else None

    def _units_in(self, monomials_due: Any) -> set[tuple[int, ...]]:
        return {self._units(powers.items()) for found in monomials_due.values() for _, powers in found}

    def _units_of(self, part: Part) -> set[tuple[int, ...]]:
        """The units of what is due before this part's waves in any entry; where nothing is, numbers stand alone."""
        number = self.parts.index(part)
        places = range(int(np.prod(self.case.due(self.case.first).shape[1:])))
        found = (self._due(place * len(self.parts) + number, part)[1] for place in places)
        return set().union(*map(self._units_in, found))

    def _has_few_lengths(self, part: Part, names: Iterable[str]) -> bool:
        """Whether so many lengths may stand in one term: two where a mass stands before them, which moves."""
        is_of_motion = self.kind.has_products and (bool(part.words) or not self.kind.polynomial_in)
        return len(list(names)) <= 1 + is_of_motion

    def _spectrum(self, index: int, of_truth: bool) -> Spectrum | None:
        truth = self.case.truth
        self._at(np.random.default_rng(43).uniform(-3, 3, (8, truth.joints)), of_truth)
        scale = self._scale(index, of_truth) if len(self.parts) > 1 else 0.0
        return read(
            lambda q: self._at(q, of_truth),
            truth.groups,
            truth.revolute,
            index,
            few_arms=lambda q: self._at(q, of_truth, _FEW_ARMS),
            scale=scale,
        )

    def _scale(self, index: int, of_truth: bool) -> float:
        """The largest value of all parts of an entry; what a formula returns may be rounding beside what is due.

        Of turns up to one: where it is looked for degrees, a hyperbolic sine would hide all else.
        """
        first, largest = index - index % len(self.parts), 0.0
        for (truth, _, angles), values in self._sampled.items():
            if truth or not of_truth:
                near = np.abs(np.frombuffer(angles).reshape(-1, self.case.truth.joints)).max(axis=1) <= 2 * np.pi
                here = values[:, near, first : first + len(self.parts)]
                largest = max(largest, float(np.abs(here).max(initial=0.0)))
        return largest or 1.0

    def _candidates(self, part: Part, names: list[str], parameters: Parameters) -> list[tuple[int, ...]]:
        """The powers of the monomials that a part may hold."""
        shown = [[self.shown[name] for name in one] for one in self._monomials(part, names)]
        return [tuple(one.count(name) for name in parameters.names) for one in shown]

    def _note(self) -> str:
        shown, known = self.shown, set(self.case.known)
        equal = [
            f"{shown[a]} from {shown[b]}"
            for a, b in (("length2", "length3"), ("mass2", "mass3"))
            if {a, b} <= set(self.varied) and not {a, b} & known and math.isclose(self.own[a], self.own[b])
        ]
        return f"cannot tell {', '.join(equal)} here: they are equal" if equal else ""


def monomials(names: list[str], *, is_torque: bool) -> list[tuple[str, ...]]:
    """What stands before waves in a mass matrix (a mass times two lengths, an inertia), or in a gravity torque."""
    lengths = [name for name in names if name.startswith(("length", "com"))]
    masses = [(name,) for name in names if name.startswith("mass")]
    inertias = [(name,) for name in names if name.startswith("inertia")]
    singles = [(), *((name,) for name in lengths)]
    if is_torque:
        forces: list[tuple[str, ...]] = [(), ("gravity",)] if "gravity" in names else [()]
        return [(*mass, *one, *force) for mass in [(), *masses] for one in singles for force in forces]
    pairs = list(combinations_with_replacement(lengths, 2))
    return [*((*mass, *one) for mass in [(), *masses] for one in (*singles, *pairs)), *inertias]


def _hints(monomials: Any, parameters: Parameters, fixed: dict[str, float]) -> Any:
    """The monomials that are due, with the numbers of the quantities that are not varied put in."""
    hints: dict[Any, Any] = {}
    terms: list[tuple[float, tuple[int, ...], Term]] = []
    for waves, found in monomials.items():
        hints[waves] = []
        for number, powers in found:
            whole = number
            for name, power in powers.items():
                if name not in parameters.names:
                    whole *= fixed.get(name, 1.0) ** power
            left = tuple(powers.get(name, 0) for name in parameters.names)
            hints[waves].append((whole, left))
            named = tuple((name, power) for name, power in powers.items() if power)
            terms += [(whole, left, Term(number, named, waves))] if named else []
    for ratio in reversed(RATIOS):  # what is due itself goes before what is a multiple of it
        for whole, left, term in terms:
            parameters.known_terms[term.waves, ratio * whole, left] = replace(term, number=ratio * term.number)
    return hints


def _like(terms: list[Term], due: list[Term]) -> list[Term]:
    """The terms in the order in which those that are due stand, the others behind."""
    order = [(term.waves, term.powers) for term in due]
    waves = [term.waves for term in due]

    def place(term: Term) -> tuple[int, int]:
        key = (term.waves, term.powers)
        if key in order:
            return order.index(key), 0
        return (waves.index(term.waves), 1) if term.waves in waves else (len(order), 0)

    return sorted(terms, key=place)
