"""Scenarios as flat arrays of numbers: names, indices and defaults of the parameters."""

from __future__ import annotations

import numpy as np

from . import _native
from ._native import Floats, ffi, lib


def param_count() -> int:
    """How many numbers a scenario has."""
    return int(lib.arm3r_param_count())


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


def param_defaults() -> Floats:
    """All parameters of the lecture's arm, at rest, without wall and control: shape (param_count(),), SI units."""
    params = np.empty(param_count())
    _native.call(lib.arm3r_param_defaults, _native.writable(params), params.size)
    return params
