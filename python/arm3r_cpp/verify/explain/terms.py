"""Coefficients of a spectrum as rational numbers times monomials of the arm's parameters."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import combinations, product
from typing import Any

import numpy as np

from ..._native import Floats
from .spectrum import Spectrum, Wave

RATIOS = (1, -1, 0.5, -0.5, 2, -2, 1.5, -1.5, 0.25, -0.25, 1 / 3, -1 / 3)  # of a number to a product of named ones
_MANY = 5  # terms that two sums have in common: then only the others are said
_FEW = 30  # monomials of which a sum of two is looked for before one of all
_ORDER = "mgaLlrcIJ"  # of the letters in a term: masses, gravity, lengths


@dataclass(frozen=True)
class Term:
    """number * parameters * waves"""

    number: float
    powers: tuple[tuple[str, int], ...]
    waves: tuple[Wave, ...]
    rates: str = ""
    """The product of rates or accelerations that it stands before."""
    allowed: float = 0.0
    """By how much the number may be another, where it was measured."""

    def __str__(self) -> str:
        """With its sign in front: "+ 1/2 m2 g a2 C2"."""
        words = [name if power == 1 else f"{name}^{power}" for name, power in self.powers if power > 0]
        words += [*(str(wave) for wave in self.waves), *self.rates.split()]
        size = measured_words(abs(self.number), self.allowed) if self.allowed else number_words(abs(self.number))
        text = " ".join(words if size == "1" and words else [size, *words])
        text += "".join(f"/{name}" * -power for name, power in self.powers if power < 0)
        return f"{'-' if self.number < 0 else '+'} {text}"


def number_words(number: float) -> str:
    fraction = Fraction(number).limit_denominator(144)
    if fraction and abs(float(fraction) / number - 1) < 1e-7:
        return str(fraction)
    return f"{number:.9g}"


def measured_words(number: float, allowed: float) -> str:
    """ "(0.4993 +- 0.0021)": the digits that count."""
    digits = max(1 - math.floor(math.log10(allowed)), 0)
    step = 10.0**-digits
    return f"({number:.{digits}f} +- {math.ceil(allowed / step) * step:.{digits}f})"


def is_simple_number(number: float) -> bool:
    """Whether it is a fraction of small numbers."""
    fraction = Fraction(number).limit_denominator(144)
    return bool(fraction) and abs(float(fraction) / number - 1) < 1e-7


def sum_words(terms: Sequence[Term]) -> str:
    """ "-a3 S1 S23 + a2 C2"; "0" for no terms."""
    if not terms:
        return "0"
    text = " ".join(str(term) for term in terms)
    return text[2:] if text.startswith("+") else f"-{text[2:]}"


def difference_words(reads: str, due: str) -> str:
    """ "reads X, should be Y"; of long sums only the terms in which they differ."""
    theirs, right = _summands(reads), _summands(due)
    common = [one for one in theirs if one in right]
    if len(common) <= _MANY:
        return f"reads {reads}, should be {due}"
    has, needs = ([one for one in ones if one not in common] for ones in (theirs, right))
    return f"has {_joined(has)} where {_joined(needs)} should be, beside {len(common)} right terms"


def _joined(summands: list[str]) -> str:
    text = " ".join(summands)
    return f"-{text[2:]}" if text.startswith("- ") else text.removeprefix("+ ") or "nothing"


def _summands(text: str) -> list[str]:
    """The terms of a sum, each with its sign in front."""
    depth, found, start = 0, [], 0
    for place, letter in enumerate(text):
        depth += (letter == "(") - (letter == ")")
        if depth == 0 and text[place : place + 3] in (" + ", " - "):
            found.append(text[start:place])
            start = place + 1
    found.append(text[start:])
    return [one if one[:2] in ("+ ", "- ") else f"- {one[1:]}" if one[:1] == "-" else f"+ {one}" for one in found]


class Parameters:
    """The values that named parameters have in several arms, and fits of coefficients by their monomials."""

    def __init__(self, values: dict[str, Floats], fixed: dict[str, float], arms: int) -> None:
        """values: of lifted parameters in each arm. fixed: numbers of the plant that have a name and do not change."""
        self.names = sorted(values, key=lambda name: (_ORDER.find(name[0]) % 99, name))
        self.values = np.array([values[name] for name in self.names]).reshape(len(self.names), arms)
        self.fixed = {name: value for name, value in fixed.items() if name not in values and value not in (0, 1)}
        logs = np.concatenate([np.log(self.values), np.ones((1, arms))]).T
        self.inverse = np.linalg.pinv(logs)
        self.arms = arms
        self.known_terms: dict[tuple[tuple[Wave, ...], float, tuple[int, ...]], Term] = {}
        """What terms with these numbers are called."""
        self.candidates: list[tuple[int, ...]] = []
        """The powers of the monomials of which a coefficient may be any sum."""
        self.may_stand: Callable[[Iterable[str]], bool] = lambda names: True
        """Whether names may stand together in a term: their product has the units of the entry."""
        self.elsewhere: tuple[Mapping[str, float], Mapping[Any, float]] | None = None
        """The numbers that have a name, and those of the terms, in another arm: a name is in a term that changes so."""
        self.is_determined = arms >= len(self.names) + 2 or not self.names

    def monomial(self, powers: Sequence[int]) -> Floats:
        return np.prod(self.values ** np.array(powers, float)[:, None], axis=0) if self.names else np.ones(self.arms)

    def single(self, coefficient: Floats, limit: float) -> tuple[float, tuple[int, ...]] | None:
        """A number and the powers of one monomial that is the coefficient in every arm."""
        if np.abs(coefficient).min() <= limit or len(set(np.sign(coefficient))) > 1:
            return None
        powers = tuple(int(power) for power in np.round(self.inverse @ np.log(np.abs(coefficient)))[:-1])
        if any(abs(power) > 4 for power in powers):
            return None
        monomial = self.monomial(powers)
        number = float(np.mean(coefficient / monomial))
        return (number, powers) if np.abs(coefficient - number * monomial).max() <= limit else None

    @cached_property  # a cache of the class would keep what judges one formula, with its process, for ever
    def _dictionary(self) -> tuple[list[tuple[int, ...]], Floats]:
        powers = [one for one in product(range(3), repeat=len(self.names)) if sum(one) <= 4]
        return powers, np.array([self.monomial(one) for one in powers])

    def double(self, coefficient: Floats, limit: float) -> list[tuple[float, tuple[int, ...]]] | None:
        """Two monomials with simple numbers."""
        powers, monomials = self._dictionary
        for number in (1, -1, 1 / 2, -1 / 2, 1 / 4, -1 / 4, 1 / 3, -1 / 3, 2, -2, 1 / 8, -1 / 8, 1 / 12, -1 / 12):
            rest = coefficient - number * monomials
            with np.errstate(divide="ignore"):
                fitted = np.log(np.abs(rest) + 1e-300) @ self.inverse.T[:, :-1]
            near = np.abs(fitted - np.round(fitted)).max(axis=1, initial=0) < 1e-4
            for place in np.flatnonzero(near):
                other = self.single(rest[place], limit)
                if other and is_simple_number(other[0]):
                    return [(number, powers[place]), other]
        return None

    def fit(
        self,
        coefficient: Floats,
        due: Sequence[tuple[float, tuple[int, ...]]],
        limit: float,
        every: Sequence[Sequence[tuple[float, tuple[int, ...]]]] = (),
    ) -> list[tuple[float, tuple[int, ...]]] | None:
        """The coefficient as a sum of monomials: some of those that are due, and one or two others."""
        if np.abs(coefficient).max() <= limit:
            return []
        alone = self.single(coefficient, limit)
        if alone and (is_simple_number(alone[0]) or not due):
            return [alone]
        return (
            self._moved(coefficient, [], [due], limit)
            or self._nearest(coefficient, due, limit)
            or self._moved(coefficient, due, every, limit)
            or ([alone] if alone else self._double(coefficient, limit))
            or (self._nearest(coefficient, due, limit, any_number=True) if self.arms > 1 else None)
        )

    def _nearest(
        self,
        coefficient: Floats,
        due: Sequence[tuple[float, tuple[int, ...]]],
        limit: float,
        *,
        any_number: bool = False,
    ) -> list[tuple[float, tuple[int, ...]]] | None:
        """As many as possible of the monomials that are due, and a simple number times another one."""
        kept = [number * self.monomial(powers) for number, powers in due]
        for missing in range(len(due) + 1):
            for places in combinations(range(len(due)), len(due) - missing):
                rest = coefficient - sum((kept[place] for place in places), np.zeros(self.arms))
                chosen = [due[place] for place in places]
                if np.abs(rest).max() <= limit:
                    return chosen
                if len(places) == len(due) - 1 and not self.names:  # numbers alone: that of the last one is another
                    (lost,) = set(range(len(due))) - set(places)
                    number, powers = due[lost]
                    ratio = next((one for one in RATIOS if abs(rest[0] - one * number) <= limit), None)
                    if ratio is not None:
                        return [*chosen, (ratio * number, powers)]
                other = self.single(rest, limit)
                if other and (any_number or is_simple_number(other[0])):
                    return [*chosen, other]
        return None

    def _moved(
        self,
        coefficient: Floats,
        due: Sequence[tuple[float, tuple[int, ...]]],
        every: Sequence[Sequence[tuple[float, tuple[int, ...]]]],
        limit: float,
    ) -> list[tuple[float, tuple[int, ...]]] | None:
        """The monomials that are due here, or none of them, and those of another wave times a simple number."""
        for kept in (list(due), []) if due else ([],):
            rest = coefficient - self._total(kept)
            for other in every:
                if other == due:
                    continue
                total = self._total(other)
                ratio = float(np.sum(rest * total)) / max(float(np.sum(total**2)), 1e-300)
                simple = min(RATIOS, key=lambda one: abs(one - ratio))
                if np.abs(rest - simple * total).max() <= limit:
                    return [*kept, *((simple * number, powers) for number, powers in other)]
        return None

    def _total(self, terms: Sequence[tuple[float, tuple[int, ...]]]) -> Floats:
        return np.sum([np.zeros(self.arms), *(number * self.monomial(powers) for number, powers in terms)], axis=0)

    def _double(self, coefficient: Floats, limit: float) -> list[tuple[float, tuple[int, ...]]] | None:
        is_short = self.is_determined and 0 < len(self.names) <= 8 and len(self.candidates) <= _FEW
        found = self.double(coefficient, limit) if is_short else None
        return found or (self._summed(coefficient, limit) if self.candidates else None)

    def _summed(self, coefficient: Floats, limit: float) -> list[tuple[float, tuple[int, ...]]] | None:
        """Any sum of the candidates, by least squares, without those that are too small to be there."""
        kept = self.candidates
        for _ in range(3):
            matrix = np.stack([self.monomial(one) for one in kept], axis=1)
            numbers = np.linalg.lstsq(matrix, coefficient, rcond=None)[0]
            if np.abs(matrix @ numbers - coefficient).max() > limit:
                return None
            here = np.abs(numbers) > 1e-7 * np.abs(numbers).max()
            if here.all():
                break
            kept = [one for one, is_here in zip(kept, here, strict=True) if is_here]
        return [(float(number), powers) for number, powers in zip(numbers, kept, strict=True)]

    def term(self, number: float, powers: Sequence[int], waves: tuple[Wave, ...]) -> Term:
        if (waves, number, tuple(powers)) in self.known_terms:
            return self.known_terms[waves, number, tuple(powers)]
        named = [(name, power) for name, power in zip(self.names, powers, strict=True) if power]
        if self.fixed and Fraction(number).limit_denominator(4) != number:
            other = self.elsewhere[1].get((waves, tuple(powers)), 0.0) if self.elsewhere else None
            found = self._named_number(number, other)
            if found:
                number, more = found
                named += more
        return Term(number, tuple(sorted(named, key=lambda one: (_ORDER.find(one[0][0]) % 99, one[0]))), waves)

    def _holds_elsewhere(self, ratio: float, names: Sequence[str], other: float | None) -> bool:
        if other is None or not self.elsewhere:
            return True
        due = ratio * float(np.prod([self.elsewhere[0][name] for name in names]))
        return abs(other - due) < 1e-6 * abs(due)

    def _named_number(self, number: float, other: float | None) -> tuple[float, list[tuple[str, int]]] | None:
        """A number of the plant as a simple number times its named quantities, the fewest and the simplest that do.

        Args:
            other: the number in another arm; None: it is not known.
        """
        for size in (1, 2, 3):
            found = []
            for names in combinations(self.fixed, size):
                value = float(np.prod([self.fixed[name] for name in names]))
                ratios = (abs(number / value - ratio) < 1e-9 * abs(ratio) for ratio in RATIOS if value)
                place = next((place for place, is_near in enumerate(ratios) if is_near), None)
                if place is not None and self.may_stand(names) and self._holds_elsewhere(number / value, names, other):
                    found.append((place // 2, number / value, names))
            if found:
                _, ratio, names = min(found, key=lambda one: one[0])
                return ratio, [(name, 1) for name in names]
        return None


def terms_of(
    found: Spectrum,
    parameters: Parameters,
    due: dict[tuple[Wave, ...], list[tuple[float, tuple[int, ...]]]],
    scale: float,
    rates: str = "",
) -> tuple[list[Term], dict[tuple[Wave, ...], list[tuple[float, tuple[int, ...]]]]] | None:
    """The terms of one entry, and the monomials of each wave; None where a coefficient has no name."""
    limit = 2e-9 * scale
    monomials, terms = {}, []
    for place, waves in enumerate(found.waves):
        coefficient = found.coefficients[:, place, 0]
        if np.abs(coefficient).max() <= limit:
            continue
        here = due.get(waves, [])
        fitted = parameters.fit(coefficient, here, limit, list(due.values()))
        if fitted is None:
            return None
        monomials[waves] = fitted
        terms += [replace(parameters.term(number, powers, waves), rates=rates) for number, powers in fitted]
    return _collected(terms), monomials


def _collected(terms: Sequence[Term]) -> list[Term]:
    """Terms of the same kind as one."""
    numbers: dict[Term, list[float]] = {}
    for term in terms:
        numbers.setdefault(replace(term, number=0.0), []).append(term.number)
    return [
        replace(term, number=sum(parts))
        for term, parts in numbers.items()
        if abs(sum(parts)) > 1e-12 * max(map(abs, parts))
    ]
