"""Runs: by the library alone, with a law, and their columns."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from .calls import call, create
from .library import Floats, ffi, lib, string
from .progress import InProgress, Progress, called_by_the_library, interpreter, this_thread


@called_by_the_library("arm3r_progress")
def arm3r_python_progress(user: Any, t: float, stop: float, steps: int) -> int:
    # Entering a Python function is what lets signal handlers run: this is how Ctrl-C ends a run.
    progress = this_thread.call.progress
    return int(progress is not None and bool(progress(t, stop, steps)))


def start(
    function: Callable[..., int],
    *arguments: Any,
    progress: Progress | None,
    time_limit: float | None,
    trust: bool = False,
) -> Any:
    """A run by a function whose last arguments are options and the new run. What `progress` raises comes out again."""
    options = run_options(time_limit)
    options.trust = trust
    with InProgress(progress):
        return create("run", function, *arguments, options)


def run_options(time_limit: float | None) -> Any:
    options = ffi.new("arm3r_run_options *")
    options.struct_size = ffi.sizeof("arm3r_run_options")
    options.stop = interpreter.stop_flag()
    options.progress = arm3r_python_progress
    options.time_limit = 0.0 if time_limit is None else time_limit
    return options


@cache
def column_places() -> dict[str, int]:
    """Every column that some run can have, and its place in arm3r_columns_text."""
    lines = string(lib.arm3r_columns_text()).splitlines()
    return {line.split()[0]: place for place, line in enumerate(lines)}


def outcome(run: Any) -> str:
    out = ffi.new("int32_t *")
    call(lib.arm3r_run_outcome, run, out)
    return outcome_name(out[0])


def outcome_name(number: int) -> str:
    """ "ok", "stopped", ...; "" of an unknown one."""
    return string(lib.arm3r_outcome_name(number))


class _Block:
    """Memory of a run, as numpy takes it: read-only, kept alive by any view of it. A column of the run is a row."""

    def __init__(self, run: Any, data: Any, shape: tuple[int, int], stride: int) -> None:
        self._run = run
        address = int(ffi.cast("uintptr_t", data))
        self.__array_interface__ = {
            "version": 3,
            "typestr": "=f8",
            "shape": shape,
            "strides": (8 * stride, 8),
            "data": (address, True),
        }


def _column_unit(run: Any, index: int) -> str:
    name, unit, data = ffi.new("const char **"), ffi.new("const char **"), ffi.new("const double **")
    call(lib.arm3r_run_column, run, index, name, unit, data)
    return string(unit[0])


_layouts: dict[bytes, tuple[list[str], dict[str, str]]] = {}  # by "t,q1,q2": the names, and the unit of each


def _layout(run: Any, names: bytes) -> tuple[list[str], dict[str, str]]:
    if names not in _layouts:
        columns = names.decode().split(",")
        _layouts[names] = columns, {name: _column_unit(run, index) for index, name in enumerate(columns)}
    return _layouts[names]


def columns(run: Any) -> tuple[dict[str, Floats], dict[str, str]]:
    """Values and units of a run's columns, by name; the values are views of the run's own memory."""
    sizes = ffi.new("size_t[3]")  # rows, columns, stride
    data, text = ffi.new("const double **"), ffi.new("const char **")
    call(lib.arm3r_run_shape, run, sizes, sizes + 1)
    call(lib.arm3r_run_block, run, data, sizes + 2, text)
    rows, count, stride = sizes
    names, units = _layout(run, ffi.string(text[0]))
    block = np.asarray(_Block(run, data[0], (count, rows), stride))
    return dict(zip(names, block, strict=True)), dict(units)
