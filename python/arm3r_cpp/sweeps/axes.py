"""The values of the axes of a sweep in each run: a pure function of the sweep and of the number of the run."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._native import Floats

Runs = NDArray[np.uint64]

SPACES = ("linspace", "geomspace")
DISTRIBUTIONS = ("uniform", "log_uniform", "normal")
DIGITS = 14  # significant, of values that are computed: what the last two hold is rounding


@dataclass(frozen=True)
class SweepAxis:
    """One key and the rule for its values."""

    key: str
    rule: str
    """ "values", one of SPACES, or one of DISTRIBUTIONS"""
    items: tuple[Any, ...]
    """The values; [first, last, count] of a space; [a, b] of a distribution"""
    unit: str = ""

    @property
    def count(self) -> int | None:
        """How many values there are; None where they are drawn."""
        if self.rule in DISTRIBUTIONS:
            return None
        return len(self.items) if self.rule == "values" else int(self.items[2])

    @property
    def is_geometric(self) -> bool:
        return self.rule in ("geomspace", "log_uniform")

    def take(self, places: Runs) -> NDArray[Any]:
        """The values with these numbers."""
        if self.rule == "values":
            return np.array(self.items)[places.astype(np.intp)]
        first, last, count = self.items
        fraction = places.astype(np.float64) / max(count - 1, 1)
        between = _rounded(_between(first, last, fraction, geometric=self.is_geometric))
        return np.where(fraction == 0, first, np.where(fraction == 1, last, between))

    def draw(self, fraction: Floats) -> NDArray[Any]:
        """The values at these fractions, in (0, 1), of their distribution; of a list or space each is as likely."""
        if self.count is not None:
            return self.take(np.minimum(fraction * self.count, self.count - 1).astype(np.uint64))
        a, b = self.items
        if self.rule == "normal":
            normal = NormalDist(a, b)
            return _rounded(np.array([normal.inv_cdf(p) for p in fraction.tolist()]))
        return _rounded(_between(a, b, fraction, geometric=self.is_geometric))


def values_of(axes: tuple[SweepAxis, ...], mode: str, seed: int, total: int, first: int, count: int) -> dict[str, Any]:
    """The values of every key in runs `first` to `first + count` of `total`."""
    runs = np.arange(first, first + count, dtype=np.uint64)
    if mode == "list":
        return {axis.key: axis.take(runs) for axis in axes}
    if mode == "grid":
        return _grid(axes, runs)
    return {axis.key: axis.draw(_fraction(axis.key, mode, seed, total, runs)) for axis in axes}


def _grid(axes: tuple[SweepAxis, ...], runs: Runs) -> dict[str, Any]:
    """The values on a grid, on which the last axis varies fastest."""
    values, left = {}, runs
    for axis in reversed(axes):
        left, place = np.divmod(left, np.uint64(axis.count or 1))
        values[axis.key] = axis.take(place)
    return {axis.key: values[axis.key] for axis in axes}


# ---- between two numbers, by + - * / and sqrt alone: the same bits everywhere ----------------------------------------


def _between(first: float, last: float, fraction: Floats, *, geometric: bool) -> Floats:
    if not geometric:
        return first + (last - first) * fraction
    return first * _power(last / first, fraction)


def _power(base: float, exponent: Floats) -> Floats:
    """base**exponent for exponents in [0, 1): a root for each binary digit."""
    power = np.ones_like(exponent)
    for _ in range(53):
        base = math.sqrt(base)
        exponent = exponent * 2
        power = np.where(exponent >= 1, power * base, power)
        exponent = exponent - (exponent >= 1)
    return power


def _rounded(values: Floats) -> Floats:
    return np.array([float(f"{value:.{DIGITS - 1}e}") for value in values.tolist()])


# ---- chance, from the run's number alone -----------------------------------------------------------------------------


def _fraction(key: str, mode: str, seed: int, total: int, runs: Runs) -> Floats:
    """A number in (0, 1) for each run; in a Latin hypercube each of `total` equal slices has exactly one."""
    chance = ((_mix(runs + _stream(seed, key)) >> np.uint64(12)).astype(np.float64) + 0.5) * 2.0**-52
    if mode == "random":
        return chance
    inside = (_shuffled(runs, total, _stream(seed, f"{key} order")).astype(np.float64) + chance) / total
    return np.minimum(inside, 1 - 2.0**-53)


def _stream(seed: int, name: str) -> np.uint64:
    return np.uint64(int.from_bytes(hashlib.sha256(f"{seed} {name}".encode()).digest()[:8], "little"))


def _mix(number: Runs) -> Runs:
    """splitmix64: neighbouring numbers in, unrelated ones out."""
    number = number * np.uint64(0x9E3779B97F4A7C15)
    number = (number ^ (number >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    number = (number ^ (number >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return number ^ (number >> np.uint64(31))


def _shuffled(places: Runs, total: int, stream: np.uint64) -> Runs:
    """Where a permutation of range(total) takes these places: Feistel rounds, walked until they end inside."""
    half = np.uint64(max(1, (max(total - 1, 1).bit_length() + 1) // 2))
    mask = (np.uint64(1) << half) - np.uint64(1)
    places = places.copy()
    outside = np.ones(places.shape, np.bool_)
    while outside.any():
        left, right = places[outside] >> half, places[outside] & mask
        for turn in range(6):
            left, right = right, left ^ (_mix(right + stream + np.uint64(turn << 40)) & mask)
        places[outside] = left << half | right
        outside = places >= total
    return places
