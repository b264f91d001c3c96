"""Reads wrong entries: what terms they have, and what terms are due."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..._native import Floats
from ..names import SHORT
from ..program.nodes import ProgramError
from ..samples import Samples
from .spectrum import read
from .terms import Parameters, Term, sum_words, terms_of

_VARIED = {
    "jacobian": ("length2", "length3"),
    "gravity": ("length2", "length3", "mass2", "mass3", "gravity"),
    "kinematics": ("length2", "length3", "height"),
}


class Reading(NamedTuple):
    reads: str | None
    due: str | None
    note: str = ""


def read_entries(case: Any, wrong: frozenset[int]) -> dict[int, Reading]:
    """The readings of the wrong entries that can be read."""
    if case.kind.name not in _VARIED:
        return {}
    found = {}
    sampled: dict[bytes, Floats] = {}
    for place in sorted(wrong):
        try:
            found[place] = _entry(case, place, sampled)
        except (ProgramError, np.linalg.LinAlgError, FloatingPointError):
            continue
    return found


def _entry(case: Any, place: int, sampled: dict[bytes, Floats]) -> Reading:
    own = case.truth.values_of_quantities
    varied = [name for name in _VARIED[case.kind.name] if own.get(name) or name in case.known]
    lifted = [name for name in case.known if name in varied or name in ("com2", "com3")]
    names = {quantity: name for name, quantity in case.parameters.items()}
    shown = {
        quantity: names.get(quantity, SHORT.get(quantity, quantity)) for quantity in case.truth.values_of_quantities
    }
    due_terms, monomials = _due(case, place, sorted({*varied, *lifted}), shown)
    arms = _arms(case, case.known, len(case.known) + 5 if case.known else 1)
    fixed = {
        shown[name]: own[name] for name in varied if name not in case.known and own.get(name)
    } | case.truth.named_numbers
    values = {shown[name]: np.array([arm[name] for arm in arms]) for name in case.known}
    parameters = Parameters(values, fixed, len(arms))

    def user(q: Floats) -> Floats:
        key = q.tobytes()
        if key not in sampled:
            sampled[key] = _at(case, q, arms, case.values)
        return sampled[key]

    spectrum = read(user, case.truth.groups, case.truth.revolute, place)
    due_words = sum_words(due_terms) if due_terms is not None else None
    if spectrum is None:
        return Reading(None, due_words)
    scale = float(np.abs(spectrum.coefficients).max()) or 1.0
    hints = _hints(monomials, parameters, fixed) if monomials else {}
    result = terms_of(spectrum, parameters, hints, scale)
    if result is None:
        return Reading(None, due_words)
    note = ""
    equal = [
        pair
        for pair in (("length2", "length3"), ("mass2", "mass3"))
        if set(pair) <= set(varied) and not set(pair) & set(case.known) and own[pair[0]] == own[pair[1]]
    ]
    if equal:
        note = "cannot tell " + ", ".join(f"{shown[a]} from {shown[b]}" for a, b in equal) + " here: they are equal"
    return Reading(sum_words(_like(result[0], due_terms or [])), due_words, note)


def _due(case: Any, place: int, varied: list[str], shown: dict[str, str]) -> tuple[list[Term] | None, Any]:
    """The terms of the truth with all quantities varied, and their monomials."""
    arms = _arms(case, varied, len(varied) + 5)
    values = {shown[name]: np.array([arm[name] for arm in arms]) for name in varied}
    parameters = Parameters(values, dict(case.truth.named_numbers), len(arms))

    def truth(q: Floats) -> Floats:
        return _at(case, q, arms, case.due)

    spectrum = read(truth, case.truth.groups, case.truth.revolute, place)
    if spectrum is None:
        return None, None
    scale = float(np.abs(spectrum.coefficients).max()) or 1.0
    result = terms_of(spectrum, parameters, {}, scale)
    if result is None:
        return None, None
    return result[0], {
        waves: [(number, dict(zip(parameters.names, powers, strict=True))) for number, powers in found]
        for waves, found in result[1].items()
    }


def _hints(monomials: Any, parameters: Parameters, fixed: dict[str, float]) -> Any:
    """The monomials that are due, with the numbers of the quantities that are not varied put in."""
    hints: dict[Any, Any] = {}
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
            if named:
                parameters.known_terms[waves, whole, left] = Term(number, named, waves)
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


def _arms(case: Any, names: list[str], count: int) -> list[dict[str, float]]:
    random = np.random.default_rng(31)
    return [case.truth.random_quantities(set(names), random) for _ in range(count)] if names else [{}]


def _at(case: Any, q: Floats, arms: list[dict[str, float]], function: Any) -> Floats:
    """(arms, S, entries)"""
    zero = np.zeros_like(q)
    values = function(Samples({"q": q, "qd": zero, "qdd": zero, "tau": zero}, arms))
    if not np.isfinite(values).all():
        raise ProgramError("is not finite")
    return values.reshape(len(arms), len(q), -1)
