"""C functions of a shared library, called by a Python text in the confined process."""

from __future__ import annotations

_TEXT = """
import ctypes
import math

_symbol = getattr(ctypes.CDLL({library!r}), {function!r})
_symbol.restype = None

def _vector(values):
    return (ctypes.c_double * {most})(*values, *[math.nan] * ({most} - len(values)))

def {function}(*vectors):
    inputs, output = [_vector(one) for one in vectors], _vector([])
    before = bytes(inputs[0]), bytes(output)
    _symbol(*inputs, output)
    if bytes(output) == before[1] and bytes(inputs[0]) != before[0]:  # it writes what comes first
        _symbol(output, *[_vector(one) for one in vectors])
    values = list(output)
    while values and math.isnan(values[-1]):
        values.pop()
    return values
"""
_MOST = 64  # numbers that a function may put out, and more than it takes in a vector


def text_of(library: str, function: str) -> str:
    """The text of a Python function that calls `void function(const double *q, ..., double *out)`; out may be first."""
    return _TEXT.format(library=library, function=function, most=_MOST)
