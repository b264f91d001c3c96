"""A shard of a sweep: some of its runs, computed wherever an executor puts them, as a piece of the table."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _native
from .._native import Floats
from ..answers.refusals import Refusal, merged
from ..core.batch import Batch, run_batch
from ..core.params import param_key, places
from ..core.protocols import LawOfFile
from ..core.run import Run
from ..core.scenario import Scenario
from ..errors import Arm3rError, BudgetError, IncompatibleError
from .table_io import encode

STATISTICS: dict[str, Callable[[Floats], float]] = {
    "max": np.max,
    "min": np.min,
    "mean": lambda column: math.fsum(column) / len(column),
    "final": lambda column: column[-1],
    "range": np.ptp,
    "max_abs": lambda column: np.max(np.abs(column)),
}


class Statistic(NamedTuple):
    """A number made of a column of a run."""

    column: str
    of: str

    @property
    def name(self) -> str:
        return f"{self.column}.{self.of}"

    def __call__(self, run: Run | None) -> float:
        return math.nan if run is None else float(STATISTICS[self.of](run[self.column])) + 0.0


@dataclass(frozen=True)
class ShardJob:
    """What a worker receives: text and numbers only; `controller`: a function in a file, which is a text, too.

    arms: of a sweep over files of arms, the scenario with each of them, by the values of these axes.
    """

    first: int
    scenario: str
    file: str
    values: dict[str, NDArray[Any]]
    metrics: Sequence[str]
    statistics: Sequence[Statistic]
    table: str
    version: str
    abi: int
    controller: LawOfFile | None = None
    arms: Mapping[tuple[str, ...], str] = field(default_factory=dict)


class ShardResult(NamedTuple):
    """What a worker returns."""

    data: bytes
    outcomes: dict[str, int]
    refusals: list[Refusal]
    """Why runs of it are invalid."""


def run_shard(job: ShardJob, progress: Callable[[int, int], Any] | None = None) -> ShardResult:
    """The rows of a job's runs, as bytes.

    Raises:
        IncompatibleError: this is another version than the one that plans the sweep.
        BudgetError: the runs take more memory than there is.
    """
    _preflight(job)
    try:
        return _computed(job, progress)
    except (MemoryError, BudgetError) as error:
        if isinstance(error, BudgetError) and not error.code.endswith("memory"):
            raise
        last = job.first + max(len(values) for values in job.values.values()) - 1
        message = f"runs {job.first} to {last} take more memory than there is; give a smaller `shard`"
        raise BudgetError(message, code="budget.memory") from error


def _computed(job: ShardJob, progress: Callable[[int, int], Any] | None) -> ShardResult:
    """The parts of a shard, a part for each arm, put together."""
    runs = len(next(iter(job.values.values())))
    places_of: list[NDArray[Any]] = []
    parts, refusals, done = [], [], 0
    for rows, scenario, values in _parts(job, np.arange(runs)):
        part_progress = progress and partial(_later, progress, done, runs)
        batch = _batch(job, Scenario(scenario, file=job.file).quiet(), len(rows), values, part_progress)
        part = {"outcome": batch.outcomes, **{name: batch[name] for name in job.metrics}}
        parts.append(part | _statistics(job.statistics, batch, part_progress))
        places_of.append(rows)
        done += len(rows)
        refusals.append(batch.refusals())
    order = np.argsort(np.concatenate(places_of))
    columns = {"run": np.arange(job.first, job.first + runs), **_axes(job)}
    columns |= {name: np.concatenate([part[name] for part in parts])[order] for name in parts[0]}
    data = encode(columns, job.table, lambda: progress and progress(runs, runs))
    return ShardResult(data, dict(sorted(Counter(columns["outcome"].tolist()).items())), merged(refusals))


def _later(progress: Callable[[int, int], Any], before: int, runs: int, runs_done: int, _: int) -> Any:
    return progress(before + runs_done, runs)


def _parts(job: ShardJob, rows: NDArray[Any]) -> Iterator[tuple[NDArray[Any], str, dict[str, NDArray[Any]]]]:
    """The rows with one arm, the scenario with it, and what else varies."""
    keys = [key for key in job.values if is_of_arm(key)]
    if not keys:
        yield rows, job.scenario, job.values
        return
    words = list(zip(*(job.values[key].tolist() for key in keys), strict=True))
    for chosen, text in job.arms.items():
        here = rows[[one == chosen for one in words]]
        if len(here):
            yield here, text, {key: values[here] for key, values in job.values.items() if key not in keys}


def is_of_arm(key: str) -> bool:
    """Whether it is a word of the file of an arm: its numbers stand in the scenario, and are other ones with it."""
    return param_key(places()[key][0]).kind == "arm_file"


def _batch(
    job: ShardJob,
    scenario: Scenario,
    runs: int,
    values: dict[str, NDArray[Any]],
    progress: Callable[[int, int], Any] | None,
) -> Batch[Any]:
    counts_later = progress and (lambda runs_done, runs: progress(0, runs))  # statistics run each of them once more
    values = values or {"time.stop": np.full(runs, scenario["time.stop"])}  # nothing but the arm varies
    report = counts_later if job.statistics else progress
    return run_batch(scenario, values, threads=1, progress=report, controller=job.controller, metrics=job.metrics)


def columns_of(job: ShardJob) -> list[str]:
    """The names of a table's columns, in order."""
    return ["run", *_axes(job), "outcome", *job.metrics, *(statistic.name for statistic in job.statistics)]


def _preflight(job: ShardJob) -> None:
    here, there = (_native.version, _native.lib.arm3r_abi_version()), (job.version, job.abi)
    if here != there:
        raise IncompatibleError(
            f"a worker has arm3r {here[0]} with version {here[1]} of the C interface, the sweep was planned by arm3r "
            f"{there[0]} with {there[1]}; install the same on all",
            code="sweep.version",
        )


def _axes(job: ShardJob) -> dict[str, NDArray[Any]]:
    """The values that vary, a column a number."""
    columns: dict[str, NDArray[Any]] = {}
    for key, given in job.values.items():
        values = np.where(given, "true", "false") if given.dtype.kind == "b" else given
        wide = values.ndim > 1
        columns |= {f"{key}[{i}]": values[:, i] for i in range(values.shape[1])} if wide else {key: values}
    return columns


def _statistics(
    wanted: Sequence[Statistic], batch: Batch[Any], progress: Callable[[int, int], Any] | None
) -> dict[str, Any]:
    """The statistics of every run, which is run once more with its rows."""
    rows = []
    for i, outcome in enumerate(batch.outcomes if wanted else ()):
        if progress:
            progress(i, len(batch))
        run = None if outcome == "invalid" else _run(batch, i, progress)
        rows.append([statistic(run) for statistic in wanted])
    return {statistic.name: np.array([row[j] for row in rows]) for j, statistic in enumerate(wanted)}


def _run(batch: Batch[Any], index: int, progress: Callable[[int, int], Any] | None) -> Run | None:
    """The run, or as much of it as there is."""
    try:
        return batch.run(index, progress=lambda t, stop, steps: progress and progress(index, len(batch)))
    except Arm3rError as error:
        return error.run
