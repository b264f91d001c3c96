"""What the columns of a log may be: numbers of the arm or not, degrees, and rows late."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

from ...errors import Arm3rError
from ..kinds import Kind
from .candidate import judged
from .case import Candidate, due_of, left_of, quantities_in, rms
from .noise import noise_of
from .reading import Log

_EQUAL, _FAR_NEARER = 1.05, 0.5  # of what entries are off by otherwise


def best_meaning(log: Log, kind: Kind, truth: Any, noise: float | None) -> Candidate:
    """The verdict in that reading of the columns in which fewest entries are wrong; a draw goes to the first.

    Raises:
        UsageError: no reading of it is possible.
    """
    best: Candidate | None = None
    refusal: Arm3rError | None = None
    for words, one in _readings(log, kind, truth):
        if best and len(one.lines) < len(log.lines) and not _is_nearer(one, best):
            continue
        try:
            found = judged(one, kind, truth, noise)
        except Arm3rError as error:
            refusal = refusal or error
            continue
        if best is None or found.rank < best.rank:
            best = found
            best.verdict.found += words
        if not any(best.rank):
            break
    if best is None:
        assert refusal is not None
        raise refusal
    return best


def _is_nearer(log: Log, best: Candidate) -> bool:
    """Whether an entry of a log with columns that are moved is far nearer to what is due, and none is farther."""
    case, convention = best.case, best.verdict.convention
    moved = replace(
        case,
        log=log,
        entries=log.judged(case.kind),
        states=log.states(case.truth.joints),
        given={quantity: log.columns[name] for quantity, name in quantities_in(log, case.truth).items()},
    )
    off, other = (
        np.array([rms(one) for one in left_of(one, due_of(one, convention, one.states)).values()])
        for one in (case, moved)
    )
    return bool((other <= _EQUAL * off).all() and (other < _FAR_NEARER * off).any())


def _readings(log: Log, kind: Kind, truth: Any) -> Iterator[tuple[list[str], Log]]:
    """What the columns of a log may be, in words and as a log, the likeliest first."""
    found: list[tuple[list[str], Log]] = [([], log)]
    if names := list(quantities_in(log, truth).values()):
        found.append(([f"without its column{'s' * (len(names) > 1)} {', '.join(names)}"], log.but_for(names)))
    yield from found
    if log.may_be_degrees:
        yield from (([*words, "angles in degrees"], one.in_radians(truth.revolute)) for words, one in found)
    judged = [name for name in log.columns if re.fullmatch(kind.columns, name)]
    for rows, (words, one) in product((1, -1, 2, -2) if noise_of(log.states(truth.joints)) else (), found):
        late = ", ".join(judged) if rows > 0 else "all but what is judged"
        yield [*words, f"{late} {abs(rows)} row{'s' * (abs(rows) > 1)} late"], one.later(rows, judged)
