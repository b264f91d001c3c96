"""C functions of a shared library, called by a Python text in the confined process."""

from __future__ import annotations

_TEXT = """
import ctypes
import math

_symbol = getattr(ctypes.CDLL({library!r}), {function!r})
_symbol.restype = None

def {function}(*vectors):
    inputs = [(ctypes.c_double * len(vector))(*vector) for vector in vectors]
    output = (ctypes.c_double * {most})(*[math.nan] * {most})
    _symbol(*inputs, output)
    values = list(output)
    while values and math.isnan(values[-1]):
        values.pop()
    return values
"""
_MOST = 64  # numbers that a function may put out


def text_of(library: str, function: str) -> str:
    """The text of a Python function that calls `void function(const double *q, ..., double *out)`."""
    return _TEXT.format(library=library, function=function, most=_MOST)
