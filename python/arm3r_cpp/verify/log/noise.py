"""Whether what is left between a log and what is due follows the states, or is noise: white, coloured or of steps."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import combinations_with_replacement

import numpy as np

from ..._native import Floats
from ..explain.regression import columns_of, design
from ..kinds import Kind

SUSPECT, CERTAIN, CERTAIN_IF_WHITE = 5.0, 7.0, 20.0  # standard deviations of a coefficient
FEWEST_ROWS = 8
_MOST_FEATURES = 4000
_MOST_CHOSEN = 6
_SPIKE = 12.0  # standard deviations
_ROUNDING = 1e-9
_MOST_DECIMALS = 10
_HALF = 0.5 * (1 + 1e-6)  # of a step: the largest error of rounding
_DIFFERENCES = 6  # the order of those in which a smooth motion vanishes
_SMOOTH = 0.3  # of its own size: what has more is no motion in the order of its rows
_ORDERS = 16  # of the autoregressive model of the noise: a slow one with a white one on it asks for many
_ROWS_AN_ORDER = 20
_SLIPS = (0.01, 0.1, 0.5)  # rad/s, by which friction has come to its sign
_AGAINST = 0.02  # of the work of friction: more is none that drives the joint
_ONE_WAY = 0.02  # of the rows


def features_of(
    kind: Kind,
    groups: Sequence[Sequence[int]],
    revolute: Sequence[bool],
    states: dict[str, Floats],
    varied: Mapping[str, Floats],
) -> Floats:
    """(rows, features): what the terms of such a formula are made of.

    Args:
        varied: the arm's numbers that differ from row to row: what a term has of them is a factor of it.
    """
    first, second = (_waves(order, groups, revolute, states["q"]) for order in (1, 2))
    columns = np.concatenate(kind.features(first, second, states), axis=1)
    known = {tuple(name for name in names if name in varied) for names in kind.monomials}
    products = sorted(known - {()}) or [
        names for count in (1, 2, 3) for names in combinations_with_replacement(varied, count)
    ]
    factors = [np.prod([varied[name] for name in names], axis=0) for names in products]
    factors = factors[: _MOST_FEATURES // columns.shape[1]]
    return np.concatenate([columns, *(columns * one[:, None] for one in factors)], axis=1)


def _waves(order: int, groups: Sequence[Sequence[int]], revolute: Sequence[bool], q: Floats) -> Floats:
    columns = columns_of(groups, revolute, order)
    if len(columns) > _MOST_FEATURES // 16:  # many joints: what no more than two of them make
        columns = [(names, waves) for names, waves in columns if sum(len(one.joints) for one in waves) <= 2]
    return design(columns, q, {})


def friction_in(left: Floats, qd: Floats, step: float) -> Floats | None:
    """The part of what is left of a torque that friction explains, of a joint of these rates; None: none is seen.

    It opposes the rate, and may be another one each way.
    """
    odd = np.stack([qd, qd * np.abs(qd), *(np.tanh(qd / slip) for slip in _SLIPS)], axis=1)
    if not follows(left, odd, step):
        return None
    forward = (qd > 0)[:, None]
    both = np.concatenate([odd * forward, odd * ~forward], axis=1)
    for columns in (both, odd):
        found = columns @ np.linalg.lstsq(columns, left, rcond=None)[0]
        power = found * qd
        if -np.minimum(power, 0.0).sum() <= _AGAINST * np.abs(power).sum():
            return found
    return None


def reverses(qd: Floats) -> bool:
    """Whether a joint turns both ways: else a friction looks like any constant torque."""
    return bool(min(np.mean(qd > 0), np.mean(qd < 0)) > _ONE_WAY)


def noise_of(states: Mapping[str, Floats]) -> dict[str, Floats]:
    """The noise of each number of the states along a smooth motion, from sixth differences; none of random poses."""
    if len(states["q"]) < 4 * _DIFFERENCES:
        return {}
    gain = np.sqrt(float(math.comb(2 * _DIFFERENCES, _DIFFERENCES)))
    sizes = {
        name: np.sqrt(np.mean(np.diff(values, _DIFFERENCES, axis=0) ** 2, axis=0)) / gain
        for name, values in states.items()
    }
    moves = np.std(states["q"], axis=0)
    return sizes if (sizes["q"] <= _SMOOTH * moves).all() else {}


def spikes_of(left: Floats) -> set[int]:
    """The rows that lie farther from the median than any noise does; none of what is exact in most rows."""
    off = np.abs(left - np.median(left))
    typical = 1.4826 * float(np.median(off))  # the standard deviation of normal noise
    return set(np.flatnonzero(off > _SPIKE * typical).tolist()) if typical > _ROUNDING * off.max() else set()


def quantum(values: Floats) -> float:
    """The step between the values of a column: of its decimals, or of the few that it has; 0: none is seen."""
    if not np.ptp(values):
        return 0.0
    for decimals in range(_MOST_DECIMALS):
        if np.array_equal(np.round(values, decimals), values):
            return float(10.0**-decimals)
    steps = np.diff(np.unique(values))
    if len(steps) == 0:
        return 0.0
    step = float(steps.min())
    with np.errstate(all="ignore"):  # a step may be tiny
        count = values / step
        off = np.abs(count - np.round(count)).max()
    return step if off < 0.01 and step > 1e-6 * np.abs(values).max() else 0.0


def follows(left: Floats, features: Floats, step: float = 0.0) -> bool:
    """Whether what is left follows the features: no noise that is as smooth as it explains their coefficients.

    Terms are chosen twice: as if the noise were as smooth as what is left, which a slow motion hides from, and as if
    it were white. The latter overrates them where the noise is smooth, and has to show far more.
    Numbers that are rounded to steps may be off by half a step everywhere.

    Args:
        left: measured less due, in the order in which it was measured.
        step: of the measured numbers.
    """
    if np.abs(left).max() <= _HALF * step or len(left) < FEWEST_ROWS:
        return False
    norms = np.sqrt(np.mean(features**2, axis=0))
    features = features[:, norms > 1e-9 * norms.max(initial=0.0)]
    if not features.size:
        return False
    for filtered, certain in ((_filter_of(left - left.mean()), CERTAIN), (np.ones(1), CERTAIN_IF_WHITE)):
        own = features[:, _chosen(_apply(filtered, left), _apply(filtered, features))]
        if not own.size:
            continue
        part = own @ np.linalg.lstsq(own, left, rcond=None)[0]
        if np.abs(part).max() > _HALF * step and _strength(_filter_of(left - part), left, own) > certain:
            return True
    return False


def _chosen(left: Floats, columns: Floats) -> list[int]:
    """The columns that explain the most, one after the other."""
    found: list[int] = []
    rest, squares = left, np.sum(columns**2, axis=0)
    while len(found) < min(_MOST_CHOSEN, len(left) // 30 + 1):
        scores = _scores(rest, columns, squares)
        best = int(np.argmax(scores))
        if scores[best] < SUSPECT or best in found:
            break
        found.append(best)
        rest = left - columns[:, found] @ np.linalg.lstsq(columns[:, found], left, rcond=None)[0]
    return found


def inflation(noise: Floats) -> float:
    """By how much a coloured noise spoils a smooth fit more than a white one of the same size does."""
    filtered = _filter_of(noise)
    size = float(np.sqrt(np.mean(noise**2)))
    if not size:
        return 1.0
    white = float(np.sqrt(np.mean(_apply(filtered, noise) ** 2)))
    return max(white / max(abs(float(filtered.sum())), 1e-3) / size, 1.0)


def _scores(left: Floats, columns: Floats, squares: Floats) -> Floats:
    """How many standard deviations the coefficient of each column, with its sum of squares, alone is from zero."""
    coefficients = columns.T @ left / np.where(squares > 0, squares, 1.0)
    spread = np.sqrt(np.maximum(np.sum(left**2) - coefficients**2 * squares, 1e-24 * np.sum(left**2)) / len(left))
    return np.abs(coefficients) * np.sqrt(squares) / np.maximum(spread, 1e-300)


def _strength(filtered: Floats, left: Floats, own: Floats) -> float:
    """How many standard deviations the coefficients are from zero together, for each of them."""
    white, columns = _apply(filtered, left), _apply(filtered, own)
    coefficients = np.linalg.lstsq(columns, white, rcond=None)[0]
    rest = white - columns @ coefficients
    inverse = np.linalg.pinv(columns.T @ columns, hermitian=True)
    spread = columns * rest[:, None]
    covariance = inverse @ (spread.T @ spread) @ inverse
    floor = 1e-24 * np.sum(white**2) * inverse
    distance = float(coefficients @ np.linalg.pinv(covariance + floor, hermitian=True) @ coefficients)
    return float(np.sqrt(max(distance, 0.0) / len(coefficients)))


def _filter_of(noise: Floats) -> Floats:
    """The coefficients that make an autoregressive noise white (Yule and Walker)."""
    count = len(noise)
    orders = min(_ORDERS, count // _ROWS_AN_ORDER)
    lags = np.array([noise[: count - lag] @ noise[lag:] for lag in range(orders + 1)])
    if not lags[0] > 0 or not orders:
        return np.ones(1)
    matrix = lags[np.abs(np.subtract.outer(np.arange(orders), np.arange(orders)))]
    return np.concatenate([[1.0], -np.linalg.lstsq(matrix, lags[1:], rcond=1e-12)[0]])


def _apply(filtered: Floats, values: Floats) -> Floats:
    last = len(filtered) - 1
    found = filtered[0] * values[last:]
    part = np.empty_like(found)
    for lag, one in enumerate(filtered[1:], 1):
        found += np.multiply(one, values[last - lag : len(values) - lag], out=part)
    return found
