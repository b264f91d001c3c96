"""What a user says of a formula's arguments and names, where the names do not say it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..errors import UsageError
from .formula import Formula

_NAME = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*")


def told(formula: Formula, arguments: Sequence[str], values: Mapping[str, Any]) -> Formula:
    """The formula with its arguments called by other names, and with the values of names that have none.

    Args:
        arguments: what each argument is, in their order: a state such as q or q1, a parameter such as a2, or a name
            with a value.
        values: by names; p.l1 is the field l1 of the structure p.

    Raises:
        UsageError: the numbers of arguments differ, a name has a value already, or a value is no number.
    """
    if arguments:
        formula = _renamed(formula, list(arguments))
    given: dict[str, Any] = {}
    for name, value in values.items():
        _put(given, name, _number(name, value))
    for name in given:
        if name not in formula.arguments and not re.search(rf"\b{name}\b", formula.text or ""):
            raise UsageError(f"{formula.file}: --set {name}: no argument and no name of the text is called so")
        if name in formula.constants:
            line = (formula.text or "").count("\n", 0, formula.constants[name].start) + 1
            raise UsageError(
                f"{formula.file}:{line}: {name} has a value here: change it there, and leave it out of --set"
            )
    return replace(formula, given=given) if given else formula


def _renamed(formula: Formula, arguments: list[str]) -> Formula:
    if formula.language == "c":
        raise UsageError(f"{formula.file}: --args: a C function takes the vectors of its kind, and then the result")
    needed = [name for name in formula.arguments if name not in formula.optional]
    if formula.arguments != ["*"] and not len(needed) <= len(arguments) <= len(formula.arguments):
        raise UsageError(
            f"{formula.file}: --args names {len(arguments)} arguments; {formula.name} takes {len(formula.arguments)}: "
            f"{', '.join(formula.arguments)}"
        )
    return replace(formula, arguments=arguments, optional=[])


def _put(given: dict[str, Any], name: str, value: Any) -> None:
    """A value under its name, in the structure that the name is a field of."""
    if not _NAME.fullmatch(name):
        raise UsageError(f"--set: {name!r} is not a name")
    *structures, field = name.split(".")
    for structure in structures:
        given = given.setdefault(structure, {})
        if not isinstance(given, dict):
            raise UsageError(f"--set: {structure} is a number and a structure")
    if isinstance(given.get(field), dict):
        raise UsageError(f"--set: {field} is a number and a structure")
    given[field] = value


def _number(name: str, value: Any) -> Any:
    """A number, or a list of numbers as nested lists."""
    try:
        array = np.asarray(value)
    except ValueError:  # rows of different lengths
        array = np.array("")
    if array.dtype.kind not in "fiu" or not np.isfinite(array).all() or array.ndim > 2 or not array.size:
        raise UsageError(f"--set {name}: a number or a list of numbers is needed, got {value!r}")
    return array.astype(np.float64).tolist()
