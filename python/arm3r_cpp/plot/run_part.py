"""A part of a run: the rows from one time to another, with what the summary says of that time."""

from __future__ import annotations

from typing import Any

from ..core.run import Run
from ..errors import UsageError

OF_FIRST_CONTACT = ("settling_time",)
PEAKS = ("peak_force", "first_contact_peak")


def part_of(run: Run, start: float | None, end: float | None) -> Run:
    """The rows with start <= t <= end, s; None: the run's own start or end.

    A number of the summary that belongs to another time is taken away; the others are those of the whole run.

    Raises:
        UsageError: fewer than two rows are left.
    """
    if start is None and end is None:
        return run
    t = run.t
    first, last = float(t[0]) if start is None else start, float(t[-1]) if end is None else end
    kept = (t >= first - 1e-9) & (t <= last + 1e-9)
    if kept.sum() < 2:
        message = f"from {first:g} s to {last:g} s: there are {kept.sum()} rows, and 2 are needed"
        raise UsageError(f"{message}; the run has {len(t)} rows from {t[0]:g} s to {t[-1]:g} s", code="usage")
    columns = {name: run[name][kept] for name in run.columns}
    return Run(columns, run.units, _summary(run, first, last), None)


def _summary(run: Run, first: float, last: float) -> dict[str, Any]:
    metrics = run.summary.get("metrics") or {}
    begins = next((event.t for event in run.events if event.type == "make"), None)
    gone: set[str] = set()
    if begins is None or not first <= begins <= last:
        gone.update(OF_FIRST_CONTACT)
    for peak in PEAKS:
        instant = metrics.get(f"{peak}_time")
        if instant is None or not first <= instant <= last:
            gone.update((peak, f"{peak}_time"))
    return {
        **{key: value for key, value in run.summary.items() if key not in gone},
        "metrics": {key: value for key, value in metrics.items() if key not in gone},
        "events": [event for event in run.summary["events"] if first <= event["t"] <= last],
    }
