"""Random draws that can be had again: each has a generator of its own."""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator


def draws(seed: int) -> Iterator[random.Random]:
    """A generator for each draw, without end; prints the seed, which a failing test then shows."""
    print(f"ARM3R_SEED={seed}")
    return (random.Random(f"{seed} {number}") for number in itertools.count())
