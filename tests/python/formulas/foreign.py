"""Mutants of Python programs by a foreign tool, Cosmic Ray: its operators for arithmetic, signs, numbers and loops."""

from __future__ import annotations

import re
from functools import cache

import pytest

pytest.importorskip("cosmic_ray")

from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator, operator_names

_USED = re.compile(
    r"core/(ReplaceBinaryOperator_(Add|Sub|Mul|Div|Pow)_(Add|Sub|Mul|Div|Pow|Mod|FloorDiv)"
    r"|ReplaceUnaryOperator_(USub_UAdd|Delete_USub)|NumberReplacer|ZeroIterationForLoop)"
)
_MOST = 500  # of one operator in one text


@cache
def foreign_mutants(text: str) -> tuple[str, ...]:
    """Every mutant of a text by one of the operators that make another formula."""
    found: dict[str, None] = {}
    for name in filter(_USED.fullmatch, operator_names()):
        operator = get_operator(name)()
        for occurrence in range(_MOST):
            mutant = mutate_code(text, operator, occurrence)
            if mutant is None:
                break
            if _changes_no_number_of_the_arm(text, mutant):
                found[mutant] = None
    return tuple(found)


def _changes_no_number_of_the_arm(text: str, mutant: str) -> bool:
    """`a2 = 2` in the place of `a2 = 1` is another arm, which has tests of its own."""
    lines = zip(text.split("\n"), mutant.split("\n"), strict=False)
    changed = next((line for line, other in lines if line != other), "")
    return not re.fullmatch(r"\s*[\w, ]+ = [\d., e-]+", changed)
