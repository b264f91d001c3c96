"""Rows of the benchmark table, as every program here writes them."""

from __future__ import annotations

import csv
import statistics
import sys
from collections.abc import Sequence
from pathlib import Path

HEADER = ["job", "who", "unit", "median", "min", "times_ours", "cpu", "build"]


def cpu() -> str:
    """The processor's own name."""
    names = (line.partition(":")[2] for line in Path("/proc/cpuinfo").read_text().splitlines() if "model name" in line)
    return next(names, "unknown").strip()


class Table:
    """CSV on standard output. The first row of a job is ours; the others are told as multiples of it."""

    def __init__(self) -> None:
        self._writer = csv.writer(sys.stdout, lineterminator="\n")
        self._writer.writerow(HEADER)
        self._ours: dict[str, float] = {}

    def row(self, job: str, who: str, build: str, unit: str, samples: Sequence[float]) -> None:
        """A row from measurements in `unit`; no samples: the peer is missing, and `build` says why."""
        if not samples:
            self._writer.writerow([job, who, unit, "", "", "", cpu(), build])
            return
        median = statistics.median(samples)
        ours = self._ours.setdefault(job, median)
        figures = [f"{figure:.4g}" for figure in (median, min(samples), median / ours if ours else float("nan"))]
        self._writer.writerow([job, who, unit, *figures, cpu(), build])
        sys.stdout.flush()
