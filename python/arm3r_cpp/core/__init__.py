"""Scenarios, their runs and batches: what everything above is about.

In: text or files of scenarios, numbers and arrays for their keys, laws of the caller's own.
Out: `Scenario`, `Run`, `Batch`, `Simulation` and `Arm`, which hold what the library computed.

A run is written and read here (`run_file`). What shows, draws or sweeps them stands above this room.
"""
