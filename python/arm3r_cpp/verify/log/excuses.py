"""Why what is left of an entry is no mistake: it is noise, friction, or what the noise of the states makes of it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..._native import Floats
from .case import Candidate, Case, Place, entry_words, rms
from .noise import follows, friction_in, reverses, spikes_of

_OF_STATES = 2.0  # times what the noise of the states makes of an entry: nothing smaller is told from it
_FEW_ROWS = 20  # fewer do not tell what follows a term
_NO_NOISE = 0.1  # of the largest entry: no measurement is meant to be as bad
_APART = 6.0  # times the noise of the other entries, of their size and of their scale: no sensor is as much worse


@dataclass
class Excuse:
    """Why what is left of an entry is no mistake, or may be none."""

    words: str = ""
    doubt: str = ""
    """Why it cannot be told."""
    rest: Floats = field(default_factory=lambda: np.zeros(1))
    """What is left without friction."""
    is_noise: bool = True


def excuse_of(
    case: Case, place: Place, left: Floats, right: Floats, by_states: float, *, is_exact: bool
) -> Excuse | None:
    """Why what is left of an entry is no mistake; None: it is one.

    Args:
        right: what is due.
        by_states: how far the noise of the states spreads the entry.
        is_exact: whether other entries have no noise.
    """
    found = Excuse(rest=left)
    features = np.column_stack([case.features, right])
    if is_exact:
        found.doubt = (
            f"is off by up to {np.abs(left).max():.2g} {case.kind.unit}, as noise may be, beside entries without any: "
            f"that follows no term of {case.kind.a_words}"
        )
        return None if len(left) < _FEW_ROWS or follows(left, features, case.step) else found
    if len(left) < _FEW_ROWS:
        found.doubt = (
            f"is off by up to {np.abs(left).max():.2g} {case.kind.unit}, and {len(left)} rows do not tell a mistake "
            f"from noise; {_FEW_ROWS} or more do"
        )
        return found
    rates = case.log.vector("qd", case.truth.joints) if case.kind.has_friction else None
    friction = friction_in(left, rates[:, place[0]], case.step) if rates is not None else None
    if rates is not None and friction is not None:
        joint, found.rest = place[0] + 1, left - friction
        found.words = (
            f"t{joint} leaves up to {np.abs(friction).max():.2g} N m that follow the rate of joint {joint}, as "
            "friction does: a mistake that looks like friction cannot be judged"
        )
        if not reverses(rates[:, place[0]]):
            found.doubt = (
                f"is off by up to {np.abs(left).max():.2g} N m, and joint {joint} turns one way only: friction and "
                "other torques look alike; log rows in which it turns both ways"
            )
    if not follows(found.rest, features, case.step):
        return found
    if rms(left) > _OF_STATES * by_states:
        return None
    off = f"{np.abs(left).max():.2g} {case.kind.unit}"
    words = (
        f"{entry_words(case.kind, place)} is off by up to {off}, as the noise of the states explains: "
        "no smaller mistake can be judged"
    )
    return Excuse(words, is_noise=False)


def not_noise(case: Case, found: Candidate, quiet: dict[Place, Floats], flat: dict[Place, float]) -> list[Place]:
    """The entries that are wrong though they seem to have noise: far more than others have. Some are left undecided."""
    wrong = []
    sizes = {place: rms(one) for place, one in quiet.items() if np.ptp(case.entries[place])}
    for place, size in sizes.items():
        others = [(one, one / flat[other] * flat[place]) for other, one in sizes.items() if other != place]
        usual = max(np.median(others, axis=0)) if others else np.inf
        is_apart, is_large = size > _APART * usual, size > _NO_NOISE * max(flat.values())
        found.spikes |= spikes_of(quiet[place]) if is_apart or is_large else set()
        if is_apart and size > _NO_NOISE * flat[place]:
            wrong.append(place)
        elif is_apart:
            found.undecided[entry_words(case.kind, place)] = (
                f"leaves {size:.2g} {case.kind.unit} (rms), far more than other entries do, and these rows do not tell "
                "whether that is noise; log random poses, or a motion that excites more"
            )
        elif is_large:
            found.is_unrelated = True
            found.undecided[entry_words(case.kind, place)] = (
                f"is off by up to {np.abs(quiet[place]).max():.2g} and follows no term of {case.kind.a_words}; is this "
                "the arm, and are q1, q2, ... its angles?"
            )
    return wrong
