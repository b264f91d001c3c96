"""Batches, and the tables that they return."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from .arrays import readable, writable
from .calls import call
from .library import Floats, ffi, lib, string
from .progress import BatchProgress, InProgress, called_by_the_library, interpreter, this_thread
from .runs import column_places


@called_by_the_library("arm3r_batch_progress")
def arm3r_python_batch_progress(user: Any, runs_done: int, runs: int) -> int:
    progress = this_thread.call.progress
    return int(progress is not None and bool(progress(runs_done, runs)))


@called_by_the_library("arm3r_law")
def arm3r_python_batch_law(user: Any, state: Any, tau: Any) -> int:
    call = this_thread.call
    call.stop[0] |= interpreter.stop[0]
    return call.law(int(ffi.cast("uintptr_t", user)), state, tau)


def batch(
    params: Floats,
    varied: list[int],
    values: Floats,
    *,
    threads: int | None,
    progress: BatchProgress | None,
    law: Any = None,
    rows: tuple[Sequence[str], Floats] | None = None,
    metrics: Sequence[str] | None = None,
) -> tuple[Floats, BaseException | None]:
    """The table of (varied, runs) values in the places of the varied numbers, (columns, runs); and what a law raised.

    law: None, in machine code (NativeLaw), or called as law(run, state, tau). If it raises, no other run is begun.
    rows: names of columns, and the array (runs, columns, rows) that is to be filled with them.
    metrics: the names of the table's columns; None: all of `summary_columns()`.
    """
    known = list(summary_columns())
    wanted = [known.index(name) for name in (known if metrics is None else metrics)]
    results = np.empty((len(wanted), values.shape[1]))
    given = _variation(params, varied, values)
    running = InProgress(progress, law)
    options = ffi.new("arm3r_batch_options *")
    options.struct_size = ffi.sizeof("arm3r_batch_options")
    options.stop = running.stop if callable(law) else interpreter.stop_flag()
    options.progress = arm3r_python_batch_progress
    options.threads = threads or 0
    memory, _kept = batch_rows(*rows) if rows else (ffi.NULL, None)
    options.rows = memory
    summary = ffi.new("size_t[]", wanted or 1)
    options.summary, options.summary_size = summary, len(wanted)
    with running:
        if law is None:
            call(lib.arm3r_batch_run, *given, options, writable(results))
        else:
            call(lib.arm3r_batch_control, *given, _batch_law(law), options, writable(results))
    return results, running.raised


def batch_row_count(params: Floats, varied: list[int], values: Floats, columns: Sequence[str]) -> int:
    """The most rows that a run of the batch can have. ScenarioError: no run has one of the columns."""
    count = ffi.new("size_t *")
    call(lib.arm3r_batch_row_count, *_variation(params, varied, values), _places(columns), len(columns), count)
    return int(count[0])


def _variation(params: Floats, varied: list[int], values: Floats) -> list[Any]:
    places = ffi.new("size_t[]", varied or 1)
    return [readable(params), params.size, places, len(varied), readable(values), values.shape[1]]


def _places(columns: Sequence[str]) -> Any:
    return ffi.new("size_t[]", [column_places()[name] for name in columns] or 1)


def batch_rows(columns: Sequence[str], block: Floats) -> tuple[Any, Any]:
    """An arm3r_batch_rows, and what must live as long as it does."""
    rows, places = ffi.new("arm3r_batch_rows *"), _places(columns)
    rows.struct_size = ffi.sizeof("arm3r_batch_rows")
    rows.columns, rows.column_count, rows.row_count = places, len(columns), block.shape[2]
    rows.data = writable(block)
    return rows, places


def _batch_law(law: Any) -> Any:
    struct = ffi.new("arm3r_batch_law *")
    struct.struct_size = ffi.sizeof("arm3r_batch_law")
    if callable(law):
        struct.function, struct.user_stride = arm3r_python_batch_law, 1  # `user` is the number of the run
    else:
        struct.function = ffi.cast("arm3r_law", int(law.address))
        struct.user = ffi.cast("void *", int(law.user))
        struct.user_stride, struct.reentrant = int(law.stride), int(law.reentrant)
    return struct


@cache
def summary_columns() -> dict[str, str]:
    """Units of a batch's columns, by name."""
    name, unit, meaning = (ffi.new("const char **") for _ in range(3))
    units = {}
    for index in range(lib.arm3r_summary_count()):
        call(lib.arm3r_summary_column, index, name, unit, meaning)
        units[string(name[0])] = string(unit[0])
    return units
