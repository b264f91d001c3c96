"""Arrays in and out."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from .calls import error
from .library import Floats, ffi


def reals(value: Any, name: str) -> Floats:
    """`value` as float64, C-contiguous and aligned, itself where it is. TypeError: not real numbers."""
    if np.ma.isMaskedArray(value):
        raise TypeError(f"{name}: a masked array has holes; fill them first")
    array = np.asarray(value)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name}: real numbers are needed, got an array of {array.dtype}")
    return np.require(array, np.float64, ["C", "A"])


def check_finite(array: Floats, name: str) -> None:
    """ValueError: not finite."""
    good = np.isfinite(array)
    if not good.all():
        index = tuple(int(i) for i in np.argwhere(~good)[0])
        raise ValueError(f"{name}{_brackets(index)}: a finite number is needed, got {array[index]}")


def _brackets(index: Iterable[int]) -> str:
    return "".join(f"[{i}]" for i in index)


class States:
    """Arrays (..., 3), broadcast over their leading axes, as the library takes them: n states in a row."""

    def __init__(self, **values: Any) -> None:
        """TypeError, ValueError: not real numbers, or of shapes that do not fit. f_on_tip may be None."""
        given = {name: value for name, value in values.items() if name != "f_on_tip" or value is not None}
        self._arrays = arrays = {name: reals(value, name) for name, value in given.items()}
        for name, array in arrays.items():
            if array.ndim == 0 or array.shape[-1] != 3:
                raise ValueError(f"{name}: the shape (..., 3) is needed, got {array.shape}")
        self._shapes = {name: array.shape[:-1] for name, array in arrays.items()}
        try:
            self.leading = np.broadcast_shapes(*self._shapes.values())
        except ValueError:
            shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
            raise ValueError(f"the leading axes do not broadcast: {shapes}") from None
        full = {name: np.ascontiguousarray(np.broadcast_to(a, (*self.leading, 3))) for name, a in arrays.items()}
        self._pointers = [readable(full[name]) if name in full else ffi.NULL for name in values]

    def call(self, function: Callable[..., int], handle: Any, *arguments: Any) -> None:
        """Call a function that takes a handle, n, the states, and more. ValueError: not finite."""
        n = math.prod(self.leading)
        status = function(handle, n, *self._pointers, *arguments)
        if status or n == 0:  # the library looks at every number, but cannot tell it as the caller gave it
            for name, array in self._arrays.items():
                check_finite(array, name)
        if status:
            raise error(status, self)

    def find(self, path: str) -> tuple[str, tuple[int, ...]] | None:
        """The library's "q[7][1]", of state 7 of n, as the caller counts, "q[3][1][1]"; and that state's index."""
        found = re.fullmatch(r"(\w+)(.*?)\[(\d+)\](.*)", path)
        if not found:
            return None
        name, note, state, component = found.groups()
        name = name if name in self._shapes else next(iter(self._shapes))  # tip, of inverse_kinematics(p)
        index = tuple(int(i) for i in np.unravel_index(int(state), self.leading)) if self.leading else ()
        own = self._shapes[name]
        place = (0 if size == 1 else i for i, size in zip(index[len(index) - len(own) :], own, strict=True))
        return f"{name}{_brackets(place)}{component}{note}", index


def readable(array: Floats) -> Any:
    """A pointer to an array's numbers; it keeps the array alive."""
    if array.dtype != np.float64 or not array.flags.c_contiguous or not array.flags.aligned:
        raise TypeError(f"a contiguous float64 array is needed, got {array.dtype} with strides {array.strides}")
    return ffi.from_buffer("double[]", array)


def writable(array: Floats) -> Any:
    """The same, to be written through."""
    if not array.flags.writeable:
        raise TypeError("a writable array is needed")
    return readable(array)
