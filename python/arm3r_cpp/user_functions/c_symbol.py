"""C functions of a shared library, called by a Python text in the confined process."""

from __future__ import annotations

_TEXT = '''
import ctypes
import math
import sys

from _arm3r_user.user_functions.programs import Unread  # as the process calls it

_symbol = getattr(ctypes.CDLL({library!r}), {function!r})
_symbol.restype = None
_UNTOUCHED = {most} * b"output\\xf8\\x7f"  # a NaN that no formula computes

def _vector(values):
    return (ctypes.c_double * {most})(*values, *[math.nan] * ({most} - len(values)))

def _put_out(vectors, more):
    """What the function puts out; `more` is the number that it finds where it looks for more than there are."""
    scalars = [ctypes.c_double(one) for vector in vectors for one in vector]
    scalars += [ctypes.c_double(more)] * (8 - len(scalars))  # but on Windows, doubles have registers of their own
    for is_first in (False, True):
        inputs = [_vector(one) for one in vectors]
        output, *spare = [(ctypes.c_double * {most}).from_buffer_copy(_UNTOUCHED) for _ in range(3)]
        before, pointers = bytes(inputs[0]), [output, *inputs] if is_first else [*inputs, output]
        _symbol(*pointers, *spare, *(scalars if sys.platform != "win32" else []))
        if any(bytes(one) != _UNTOUCHED for one in spare):
            given = "{{}} and its result".format(len(vectors))
            raise Unread("takes more vectors than " + given + ": name a function of these alone")
        if bytes(output) != _UNTOUCHED or bytes(inputs[0]) == before:
            break
    written = bytes(output)
    count = next((one for one in range({most}, 0, -1) if written[8 * one - 8 : 8 * one] != _UNTOUCHED[:8]), 0)
    return output[:count]

def {function}(*vectors):
    found = _put_out(vectors, math.nan)
    if any(map(math.isnan, found)) and not any(map(math.isnan, _put_out(vectors, 0.0))):
        raise Unread("takes more numbers than those of its joints: name a function of these alone")
    return found
'''
_MOST = 64  # numbers that a function may put out, and more than it takes in a vector


def text_of(library: str, function: str) -> str:
    """The text of a Python function that calls `void function(const double *q, ..., double *out)`.

    out may be first, and there may be doubles, `double q1, double q2, ...`, in the place of vectors.
    """
    return _TEXT.format(library=library, function=function, most=_MOST)
