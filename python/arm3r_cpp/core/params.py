"""Scenarios as flat arrays of numbers: names, indices and defaults of the parameters."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from .. import _native
from .._native import Floats, ffi, lib


def numbers_of(scenario: Any) -> Floats:
    """All numbers of a scenario of the library's: shape (param_count(),), or more with long tables."""
    count = ffi.new("size_t *")
    _native.call(lib.arm3r_scenario_param_count, scenario, count)
    numbers = np.empty(count[0])
    _native.call(lib.arm3r_scenario_params, scenario, _native.writable(numbers), numbers.size)
    return numbers


def param_count() -> int:
    """How many numbers a scenario has."""
    return int(lib.arm3r_param_count())


@cache
def param_index(name: str) -> int:
    """The index of a parameter, such as "wall.contact.stiffness" or "initial.q[0]".

    Raises:
        UsageError: there is no such parameter; the message names the nearest one.
    """
    index = ffi.new("size_t *")
    _native.call(lib.arm3r_param_index, *_native.utf8(name, "name"), index)
    return int(index[0])


def param_name(index: int) -> str:
    """The name of a parameter.

    Raises:
        UsageError: the index is not below `param_count()`.
    """
    if index < 0:
        raise IndexError(f"index: a parameter has an index from 0 to {param_count() - 1}, got {index}")
    return _native.text(lib.arm3r_param_name, index)


class ParamKey(NamedTuple):
    """The key of the scenario file that a parameter belongs to."""

    path: str
    """ "wall.contact.stiffness" """
    kind: str
    """ "number", "angle", "integer", "flag", "choice", "section", "column" or "file" """
    unit: str
    """ "N/m"; "" for none"""


def param_key(index: int) -> ParamKey:
    """The key that a parameter belongs to.

    Raises:
        UsageError: the index is not below `param_count()`.
    """
    if index < 0:
        raise IndexError(f"index: a parameter has an index from 0 to {param_count() - 1}, got {index}")
    out = [ffi.new("const char **") for _ in ParamKey._fields]
    _native.call(lib.arm3r_param_key, index, *out)
    return ParamKey(*(_native.string(pointer[0]) for pointer in out))


@cache
def places() -> dict[str, list[int]]:
    """The indices that every key, "initial.q", and every name of a number, "initial.q[1]", stands for."""
    found: dict[str, list[int]] = {}
    for index in range(param_count()):
        found.setdefault(param_key(index).path, []).append(index)
    return found | {param_name(index): [index] for index in range(param_count())}


def param_defaults() -> Floats:
    """All parameters of the lecture's arm, at rest, without wall and control: shape (param_count(),), SI units."""
    params = np.empty(param_count())
    _native.call(lib.arm3r_param_defaults, _native.writable(params), params.size)
    return params
