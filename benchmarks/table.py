"""Rows of the benchmark table, as every program here writes them, and races that fill them."""

from __future__ import annotations

import csv
import statistics
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Protocol

import numpy as np

HEADER = ["job", "who", "setting", "unit", "median", "min", "times_ours", "error", "cpu", "build"]
MOST_ROUNDS = 400


def cpu() -> str:
    """The processor's own name."""
    names = (line.partition(":")[2] for line in Path("/proc/cpuinfo").read_text().splitlines() if "model name" in line)
    return next(names, "unknown").strip()


class Table:
    """CSV on standard output. The first row of a job and setting is ours; the others are told as multiples of it."""

    def __init__(self) -> None:
        self._writer = csv.writer(sys.stdout, lineterminator="\n")
        self._writer.writerow(HEADER)
        self._ours: dict[tuple[str, str], float] = {}

    def row(
        self,
        job: str,
        who: str,
        build: str,
        unit: str,
        samples: Sequence[float],
        *,
        setting: str = "",
        error: float | None = None,
    ) -> None:
        """A row from measurements in `unit`; no samples: the peer is missing, and `build` says why."""
        figures = ["", "", ""]
        if samples:
            median = statistics.median(samples)
            if who.startswith("arm3r"):
                self._ours.setdefault((job, setting), median)
            ours = self._ours.get((job, setting))
            figures = [f"{median:.4g}", f"{min(samples):.4g}", f"{median / ours:.4g}" if ours else ""]
        self._writer.writerow(
            [job, who, setting, unit, *figures, "" if error is None else f"{error:.2g}", cpu(), build]
        )
        sys.stdout.flush()


class Runner(Protocol):
    """Does a job once. `run` may return the nanoseconds that count, else all do; `q` are final angles, a row a run."""

    def run(self) -> float | None: ...

    @property
    def q(self) -> np.ndarray: ...


@dataclass
class Racer:
    """Who does a job how, `units` at a time. No runner: the peer is missing, and `build` says why.

    exact: true final angles, of the first runs.
    """

    who: str
    build: str
    runner: Runner | None
    units: float = 1
    setting: str = ""
    exact: np.ndarray | None = None

    @property
    def error(self) -> float | None:
        """The largest of the final angles, rad."""
        if self.runner is None or self.exact is None:
            return None
        count = min(len(self.exact), len(self.runner.q))
        return float(np.abs(self.runner.q[:count] - self.exact[:count]).max())

    def nanoseconds(self) -> float:
        """A unit's time."""
        begun = time.perf_counter_ns()
        counted = self.runner.run()
        return (time.perf_counter_ns() - begun if counted is None else counted) / self.units


def race(table: Table, job: str, unit: str, racers: Sequence[Racer], *, seconds: float) -> None:
    """Let them take turns for about so long, after a warm-up, and write their rows. `unit`: ns, us, ms or s.

    Where one turn takes that long already, it is the measurement.
    """
    scale = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}[unit]
    begun = time.perf_counter()
    samples: list[list[float]] = [[] for _ in racers]
    for _ in range(1 + MOST_ROUNDS):
        for racer, times in zip(racers, samples, strict=True):
            if racer.runner:
                times.append(racer.nanoseconds() / scale)
        if time.perf_counter() - begun > seconds:
            break
    for racer, times in zip(racers, samples, strict=True):
        table.row(job, racer.who, racer.build, unit, times[1:] or times, setting=racer.setting, error=racer.error)


def installed(package: str) -> bool:
    """Whether a peer is there; a racer without runner names it where it is not."""
    return find_spec(package) is not None
