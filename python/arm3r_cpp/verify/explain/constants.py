"""The numbers that a text gives to the arm's quantities, against the arm's own."""

from __future__ import annotations

import re

import numpy as np

from ...user_functions.expressions import Number
from ...user_functions.programs import Constant, line_and_column
from ..comparison import Comparison
from ..finding import Finding
from ..formula import Formula
from ..verdict import Verdict

_NEAR = 0.01  # of g: what it may be somewhere on Earth, or is rounded to


def judge_constants(verdict: Verdict, case: Comparison) -> None:
    """The numbers that the text gives to the arm's quantities, against the arm's own."""
    for constant in stated_numbers(case.formula):
        name = constant.name
        quantity = case.parameters.get(name)
        own = case.truth.values_of_quantities.get(quantity) if quantity else None
        if own is None or abs(constant.value - own) <= 1e-9 * max(abs(own), 1e-3):
            continue
        if quantity == "gravity" and not case.truth.states_gravity and abs(constant.value / own - 1) < _NEAR:
            verdict.warnings.append(f"{name} is {constant.value:.10g}; standard gravity is {own:.10g} m/s^2")
            continue
        places = _depending(case, str(quantity), constant.value)
        text = case.formula.text or ""
        line, column = line_and_column(text, constant.start)
        is_shared = sum(one.start == constant.start for one in case.formula.constants.values()) > 1  # a2 = a3 = 1
        old = None if is_shared else text[constant.start : constant.end]
        words = "millimetres? " if own and abs(constant.value / own - 1000) < 1e-6 else ""
        arm = "the lecture's arm" if case.truth.is_default else "the arm"
        due = f"{arm} has {own:.10g}{_meaning(case, str(quantity), constant.value)}"
        if quantity == "gravity" and not case.truth.states_gravity:
            due = f"standard gravity is {own:.10g} m/s^2, --gravity X,Y,Z gives another"
        for place in places:
            verdict.findings.append(
                Finding(
                    case.entry(place),
                    f"{name} is {constant.value:.10g} in line {line}; {words}{due}.",
                    None,
                    None,
                    line,
                    column,
                    old,
                    None if is_shared else f"{own:.12g}",
                )
            )


def _meaning(case: Comparison, quantity: str, value: float) -> str:
    """What a number is of the arm that stands in the place of another."""
    own, what, link = case.truth.values_of_quantities, quantity[:-1], quantity[-1]
    other = {"2": "3", "3": "2"}.get(link, "")
    meanings = {f"that of link {other}": own.get(what + other)}
    if what == "com":
        meanings |= {"the link's end": own[f"length{link}"], "the link's middle": own[f"length{link}"] / 2}
    if what == "inertia":
        meanings["its inertia about the joint, with m l^2"] = (
            own[quantity] + own[f"mass{link}"] * own[f"com{link}"] ** 2
        )
    for words, number in meanings.items():
        if number is not None and np.isclose(value, number, rtol=1e-6, atol=0):
            return f"; {value:.10g} is {words}"
    return ""


def stated_numbers(formula: Formula) -> list[Constant]:
    """The numbers that a text gives to names, and those of arguments by default, `def gravity(q, g=9.80665)`."""
    text = formula.text or ""
    by_default = [
        Constant(name, value, node.start, node.end)
        for name, value in formula.defaults.items()
        if name not in formula.given
        for node in formula.default_nodes
        if isinstance(node, Number) and node.value == value
        if re.search(rf"\b{name}\b[^=,()]*=\s*$", text[: node.start])
    ]
    return [*formula.constants.values(), *by_default]


def _depending(case: Comparison, quantity: str, value: float) -> list[int]:
    """The entries that another value of a quantity changes."""
    samples = type(case.second)(case.second.states, [case.own])
    right = case.due(samples)
    changed = case.due(samples, {quantity: np.full(len(right), value)})
    flat, other = (one.reshape(len(one), -1) for one in (right, changed))
    return [int(place) for place in np.flatnonzero(np.abs(flat - other).max(axis=0) > 1e-12 * np.abs(flat).max())]
