"""Entries of a formula from noisy numbers: a least-squares fit of sines, cosines and monomials."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from ..._native import Floats
from .spectrum import Wave, axis
from .terms import Term, sum_words

SIGNIFICANT = 6.0  # standard deviations: with a thousand coefficients, chance exceeds it once in a million times
_FLOOR = 1e-12  # of the scale: numbers of a log are not more exact
_EXACT = 1e-6  # of a coefficient: without noise, a fraction as near as this is no chance


@dataclass
class Fit:
    """Coefficients with their standard deviations; `noise` is that of a single number, and `left` what is left."""

    columns: list[tuple[tuple[str, ...], tuple[Wave, ...]]]
    matrix: Floats
    inverse: Floats
    values: Floats
    deviations: Floats
    noise: float
    left: Floats

    def differs(self, due: Floats) -> Floats:
        """By how many standard deviations each coefficient differs from what is due."""
        return np.abs(self.values - due) / self.deviations

    def read(self, due: Floats) -> Floats:
        """Each coefficient as what is due, or as zero, where the noise allows it; else as measured."""
        allowed = SIGNIFICANT * self.deviations
        found = np.where(np.abs(self.values) <= allowed, 0.0, self.values)
        return np.where(np.abs(self.values - due) <= allowed, due, found)

    def words(self, coefficients: Floats, due: Floats, shown: Mapping[str, str]) -> str:
        """The coefficients as a sum of terms; those that are not due with what the noise allows."""
        terms = []
        for place, number in enumerate(coefficients):
            if number:
                names, waves = self.columns[place]
                exact, allowed = float(number), SIGNIFICANT * float(self.deviations[place])
                is_measured = number != due[place]
                if is_measured and allowed < _EXACT * abs(number):
                    exact, is_measured = _simple(exact, allowed), False
                powers = tuple((shown[name], 1) for name in names)
                terms.append(Term(exact, powers, waves, allowed=allowed if is_measured else 0.0))
        return sum_words(terms)


def _simple(number: float, allowed: float) -> float:
    """A fraction of small numbers where one is as near as is allowed."""
    near = (round(number * denominator) / denominator for denominator in range(1, 13))
    return next((one for one in near if abs(one - number) <= allowed), number)


def columns_of(
    groups: Sequence[Sequence[int]],
    revolute: Sequence[bool],
    order: int,
    among: Sequence[tuple[str, ...]] = (),
    varied: Sequence[str] = (),
) -> list[tuple[tuple[str, ...], tuple[Wave, ...]]]:
    """The monomials `among` some that quantities which a log varies make, times the waves up to an order."""
    n = len(revolute)
    axes = []
    for group in groups:
        joints = tuple(group)
        what = "angle" if revolute[joints[0]] else "power"
        axes.append(axis(joints, what, (order,) * len(joints), n))
    waves = [tuple(one for one in waves if one.joints) for waves in product(*(one.waves for one in axes))]
    monomials = [names for names in among if set(names) <= set(varied)] or [()]
    return list(product(monomials, waves))


def design(
    columns: Sequence[tuple[tuple[str, ...], tuple[Wave, ...]]], q: Floats, quantities: Mapping[str, Floats]
) -> Floats:
    """(rows, columns)"""
    found = []
    for names, waves in columns:
        column = np.ones(len(q))
        for name in names:
            column = column * quantities[name]
        for wave in waves:
            column = column * wave.at(q)
        found.append(column)
    return np.stack(found, axis=1)


def fits(
    columns: list[tuple[tuple[str, ...], tuple[Wave, ...]]], matrix: Floats, entries: Mapping[tuple[int, ...], Floats]
) -> dict[tuple[int, ...], Fit]:
    """The fit of each entry; none where the rows are too few, or do not tell the columns apart."""
    rows, count = matrix.shape
    if rows < 1.5 * count:
        return {}
    product_inverse = np.linalg.pinv(matrix.T @ matrix, rcond=1e-13, hermitian=True)
    inverse = product_inverse @ matrix.T
    if np.abs(inverse @ matrix - np.eye(count)).max() > 1e-6:
        return {}
    spread = np.sqrt(np.diag(product_inverse))
    found = {}
    for place, values in entries.items():
        coefficients = inverse @ values
        coefficients += inverse @ (values - matrix @ coefficients)
        scale = float(np.abs(values).max()) or 1.0
        left = values - matrix @ coefficients
        noise = float(np.sqrt(np.sum(left**2) / (rows - count)))
        found[place] = Fit(columns, matrix, inverse, coefficients, max(noise, _FLOOR * scale) * spread, noise, left)
    return found
