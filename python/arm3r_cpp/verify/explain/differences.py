"""Differences that are no mistake: rounding, and the step of finite differences."""

from __future__ import annotations

import numpy as np

from ..._native import Floats
from ...user_functions.expressions import Node, Number
from ...user_functions.programs import Edit, ProgramError, line_and_column
from ..comparison import Comparison, scales
from ..verdict import Verdict

_LARGEST_OF_A_STEP, _LARGEST_STEP = 1e-3, 0.1  # of the scale; rad: what is taken for the step of differences
_FINER, _FINEST, _ROUNDING = 1000.0, 1e-13, 1e-5  # a step that is smaller, and one that leaves rounding of the scale
_NUMERICAL = 1e-6  # of the scale: a difference below it that has no structure comes from rounding


def only_structured(
    verdict: Verdict, case: Comparison, values: Floats, due: Floats, wrong: frozenset[int]
) -> frozenset[int]:
    """Without the entries that are right but for rounding, or for the step of differences: these get a warning."""
    flat, right = values.reshape(len(values), -1), due.reshape(len(due), -1)
    relative = np.abs(flat - right).max(axis=0) / scales(right)
    numerical = {place for place in wrong if relative[place] < _NUMERICAL}
    step = ""
    if wrong and numerical != wrong and relative.max() < _LARGEST_OF_A_STEP:
        step = _step_of_differences(case, flat, right)
        numerical = set(wrong) if step else numerical
    if wrong and numerical == wrong:
        verdict.warnings.append(
            f"differences of up to {relative.max():.1e} of the entries' scale: these are numerical{step}"
        )
        return frozenset()
    return wrong


def _step_of_differences(case: Comparison, values: Floats, due: Floats) -> str:
    """The small number of the text that is the step of finite differences, in words; "" where none is.

    The errors shrink with it, and where it is tiny rounding is all that is left: a small term would just be gone.
    """
    text, scale = case.formula.text or "", scales(due)
    every = [*case.formula.nodes, *case.formula.default_nodes]

    def off(node: Node, step: float) -> Floats:
        other = case.values(case.second, Edit(node.start, node.end, repr(step)))
        return np.asarray(np.abs(other.reshape(len(other), -1) - due).max(axis=0))

    for node in (inner for top in every for inner in top.walk() if isinstance(inner, Number)):
        number = node.value
        if not 0 < number < _LARGEST_STEP:
            continue
        try:
            left, rounded = off(node, number / _FINER), off(node, _FINEST)
        except (ProgramError, ValueError):
            continue
        error = np.abs(values - due).max(axis=0)
        shrinks = (left <= error / (0.7 * _FINER) + _NUMERICAL * scale).all() and (left < _NUMERICAL * scale).any()
        if shrinks and (rounded > _ROUNDING * scale).any():
            line, _ = line_and_column(text, node.start)
            return f", of differences with the step {node.word} in line {line}"
    return ""
