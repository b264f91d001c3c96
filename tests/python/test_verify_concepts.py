"""Mistakes of understanding in the programs of students: found, in the arm's own convention, and said in true words.

Each gate prints what it counts, and how much of it.
"""

from __future__ import annotations

import os
import random
from collections import Counter, defaultdict
from pathlib import Path
from typing import NamedTuple

import pytest
from formulas.concepts import Mutant, mutants, style
from formulas.mistakes import pairs, wrong_text
from formulas.outcomes import FOLDER, outcome, own_convention

SEED = int(os.environ.get("ARM3R_SEED", random.randrange(10**6)))
WRONG = ("named", "unexplained", "false", "missed")


class Count(NamedTuple):
    mutants: list[Mutant]
    """Those that are wrong."""
    outcomes: Counter[str]

    def __str__(self) -> str:
        paths = {one.path for one in self.mutants}
        programs, styles, concepts = len(paths), len(set(map(style, paths))), len({one.concept for one in self.mutants})
        of = f"{len(self.mutants)} mutants by {concepts} concepts of {programs} programs in {styles} styles"
        rates = f"located {100 * self.located:.1f} %, named {100 * self.named:.1f} %"
        return (
            f"{of}: {rates}, false sentences {self.outcomes['false']}, right ones called wrong {self.outcomes['alarm']}"
        )

    @property
    def located(self) -> float:
        return 1 - self.outcomes["missed"] / len(self.mutants)

    @property
    def named(self) -> float:
        return self.outcomes["named"] / len(self.mutants)


def counted(count: int, folder: Path) -> Count:
    """The outcomes of random mutants, as many of each concept as there are, until so many are wrong."""
    print(f"ARM3R_SEED={SEED}")
    choose, every = random.Random(SEED), defaultdict(list)
    for one in mutants():
        every[one.concept].append(one)
    for ones in every.values():
        choose.shuffle(ones)
    found = Count([], Counter())
    while len(found.mutants) < count:
        for concept in [one for one in every if every[one]]:
            one = every[concept].pop()
            word, words = outcome(one.path, one.text, folder, convention=own_convention(one.path))
            found.outcomes[word] += 1
            if word in WRONG:
                found.mutants.append(one)
            if word not in ("named", "right", "fails"):
                print(word, concept, one.path.name, one.text, words, sep="\n")
            if len(found.mutants) == count:
                break
    print(found)
    return found


def test_some_mistakes_of_understanding(tmp_path: Path) -> None:
    found = counted(4, tmp_path)
    assert not found.outcomes["missed"] and not found.outcomes["false"] and not found.outcomes["alarm"]


@pytest.mark.gate
@pytest.mark.random
def test_four_hundred_mistakes_of_understanding(tmp_path: Path) -> None:
    found = counted(400, tmp_path)
    paths = {one.path for one in found.mutants}
    assert len(paths) >= 40 and len(set(map(style, paths))) >= 15
    assert found.located >= 0.99 and found.named >= 0.97
    assert not found.outcomes["false"] and not found.outcomes["alarm"]


@pytest.mark.gate
def test_pairs_of_mistakes_by_hand(tmp_path: Path) -> None:
    outcomes: Counter[str] = Counter()
    for one in pairs():
        path = FOLDER / one.file
        word, words = outcome(path, wrong_text(path.read_text(), one), tmp_path)
        outcomes[word] += 1
        if word != "named":
            print(word, one, words, sep="\n")
    print(dict(outcomes))
    assert set(outcomes) <= {"named", "unexplained"} and outcomes["named"] >= 0.9 * len(pairs())
