"""The only room that knows the library: loading, errors, text, arrays, handles, and runs in progress.

In: functions of the C interface, numbers, arrays, texts and laws of the caller's own.
Out: the same calls, which raise where the library refuses, and runs, batches and simulations as Python has them.

What a callback raises comes out of the call that led to it (`progress`); memory that both sides see is in `laws`.
"""

from .arm_files import read_arms_with
from .arrays import States, check_finite, readable, reals, writable
from .batches import batch, batch_row_count, batch_rows, summary_columns
from .calls import call, create, error, file_path, nearest_word, sweep, text, utf8
from .laws import LawMemory, NoTorque, SimulationView, StateMemory, control, put_torque, state_index
from .library import Floats, ffi, lib, string, version
from .progress import BatchProgress, Progress
from .runs import column_places, columns, outcome, outcome_name, start

__all__ = [
    "BatchProgress",
    "Floats",
    "LawMemory",
    "NoTorque",
    "Progress",
    "SimulationView",
    "StateMemory",
    "States",
    "batch",
    "batch_row_count",
    "batch_rows",
    "call",
    "check_finite",
    "column_places",
    "columns",
    "control",
    "create",
    "error",
    "ffi",
    "file_path",
    "lib",
    "nearest_word",
    "outcome",
    "outcome_name",
    "put_torque",
    "read_arms_with",
    "readable",
    "reals",
    "start",
    "state_index",
    "string",
    "summary_columns",
    "sweep",
    "text",
    "utf8",
    "version",
    "writable",
]
