"""Running a sweep: its shards through any executor into its folder, and from there one table."""

from __future__ import annotations

import os
import threading
import warnings
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import asdict, replace
from operator import index
from typing import TYPE_CHECKING, Any

from .. import _native
from .._files import folder_named, replacing
from ..core.advice import Advice
from ..core.batch import AXIS_ERRORS, axis_of
from ..core.protocols import LawOfFile
from ..core.provided import provided
from ..errors import Arm3rError, ScenarioWarning, UsageError
from ..system.cpus import usable_cpus
from .definition import Sweep
from .folder import SweepFolder, sha256
from .shard import ShardJob, ShardResult, columns_of, run_shard
from .table import SweepTable
from .table_io import merge, pyarrow

if TYPE_CHECKING:
    from ..core.scenario import Scenario

Submit = Callable[[ShardJob], "Future[ShardResult]"]
UnderWay = dict[int, int]
"""How many runs of a shard are done while it is computed, by its first run; only threads say so."""

IN_FLIGHT = 64  # shards, of an executor that does not say how many workers it has

_of_daemons: set[threading.Event] = set()
"""Those that end sweeps of daemon threads: the interpreter does not wait for these, but it would for their pools."""


def _leave_daemons() -> None:
    for left in list(_of_daemons):
        left.set()


if hasattr(threading, "_register_atexit"):  # called before the threads of pools are joined
    threading._register_atexit(_leave_daemons)


def sweep(
    source: Sweep | Mapping[str, Any] | str | os.PathLike[str],
    *,
    out: str | os.PathLike[str],
    executor: Executor | None = None,
    jobs: int | None = None,
    resume: bool = False,
    parquet: bool = False,
    progress: Callable[[int, int], Any] | None = None,
    controller: str | os.PathLike[str] | None = None,
) -> SweepTable:
    """Run a sweep into a folder; a table with one row a run. Same bytes for any executor and any number of jobs.

    Args:
        source: a Sweep, its keys as a map, or its file.
        out: the folder; new or empty, or with `resume` that of the same sweep. The name of a new one has no ending.
        executor: where shards are computed; None: threads of this process.
        jobs: how many shards at a time; None: one for each CPU that this process may use, of an executor 64.
        resume: go on where an interrupted sweep stopped. No finished shard is done again.
        parquet: table.parquet instead of table.csv; needs the extra `parquet`.
        progress: called as progress(runs_done, runs) from the calling thread; a true result ends the sweep, as Ctrl-C
            does, and it can be resumed. Runs of shards on their way count too; on another executor only whole shards.
        controller: a function in a file, as `Scenario.run` takes it, instead of the scenario's controller; workers get
            its text. No axis can be a key of the controller or its reference then.

    Returns:
        The table. A run that failed is a row of it, and raises nothing.

    Raises:
        ScenarioError: the sweep is not valid; all that is wrong is listed.
        UsageError: the folder has the name of a file.
        OutputError: the folder exists, is in use, or cannot be written.
        IncompatibleError: the folder was begun with something else, or a worker has another version.
        Arm3rError: `progress` ended the sweep, or a worker of the executor died; either can be resumed.
    """
    jobs = None if jobs is None else index(jobs)
    folder_path = folder_named(out)
    plan = source if isinstance(source, Sweep) else Sweep(source) if isinstance(source, Mapping) else Sweep.load(source)
    job = _first_job(plan, "parquet" if parquet else "csv", controller)
    with SweepFolder.open(folder_path, _manifest(plan, job), resume=resume) as folder:
        under_way: UnderWay = {}
        with _submitting(executor, jobs, under_way) as (submit, at_a_time):
            _run(plan, job, folder, submit, at_a_time, under_way, progress)
        with replacing(folder.path / f"table.{job.table}") as part, part.open("wb") as file:
            merge(map(folder.read, range(_shards(plan))), columns_of(job), job.table, file)
    return SweepTable(out)


def _first_job(plan: Sweep, table: str, controller: str | os.PathLike[str] | None) -> ShardJob:
    scenario = plan.scenario.copy()
    scenario["checks"] = []
    return ShardJob(
        first=0,
        scenario=scenario.to_yaml(),
        file=plan.file,
        values=plan.values(0, 1),
        metrics=plan.metrics,
        statistics=plan.statistics,
        table=table,
        version=_native.version,
        abi=_native.lib.arm3r_abi_version(),
        controller=None if controller is None else _block(controller, plan),
        arms={words: one.to_yaml() for words, one in plan.arms().items()},
    )


def _block(controller: str | os.PathLike[str], plan: Sweep) -> LawOfFile:
    """
    Raises:
        UsageError: the function cannot be read, or an axis or a statistic needs the scenario's own controller.
        ControllerError: it failed at the start of a run.
    """
    block: LawOfFile = provided("function of a file")(controller)
    short = plan.scenario.for_law(None).quiet()
    short["checks"] = []
    _check_axes(short, plan)
    short["time.stop"] = short["time.start"]
    columns = short.run(controller=block.law(short)).columns
    for statistic in plan.statistics:
        if statistic.column not in columns:
            what = f"{plan.file}: statistics: with a controller of your own there is no column {statistic.column}"
            raise UsageError(what, code="usage")
    return block


def _check_axes(scenario: Scenario, plan: Sweep) -> None:
    """UsageError: a scenario with a law of the user's own has not the key of an axis."""
    for key, values in plan.values(0, 1).items():
        one = scenario.copy()
        try:
            one[key] = axis_of(scenario, key, values).at((0,), (1,))
            one.validate()
        except Arm3rError as error:
            if any(problem["code"] in AXIS_ERRORS for problem in error.problems):
                what = (
                    f"{plan.file}: axes: {key} belongs to the scenario's controller; with one of your own take it out"
                )
                raise UsageError(what, code="usage") from error


def _manifest(plan: Sweep, job: ShardJob) -> dict[str, Any]:
    """Everything that decides the bytes of the table."""
    return {
        "version": job.version,
        "abi": job.abi,
        "table": job.table,
        "pyarrow": pyarrow().__version__ if job.table == "parquet" else None,
        "hashes": {
            "sweep": sha256(plan.text.encode()),
            "scenario": sha256(job.scenario.encode()),
            **({"controller": sha256(job.controller.text.encode())} if job.controller else {}),
            **({"arms": sha256("".join(job.arms.values()).encode())} if job.arms else {}),
        },
        **({"controller": job.controller.function} if job.controller else {}),
        "runs": plan.runs,
        "shard": plan.shard,
        "mode": plan.mode,
        "axes": [{**asdict(axis), "items": list(axis.items)} for axis in plan.axes],
        "columns": {name: plan.units.get(name, "") for name in columns_of(job)},
        "sweep": plan.text,
        "scenario": job.scenario,
    }


def _shards(plan: Sweep) -> int:
    return -(-plan.runs // plan.shard)


def _run(
    plan: Sweep,
    job: ShardJob,
    folder: SweepFolder,
    submit: Submit,
    at_a_time: int,
    under_way: UnderWay,
    progress: Callable[[int, int], Any] | None,
) -> None:
    """Compute and store every shard that the folder does not have; at most `at_a_time` are on their way."""
    missing = (number for number in range(_shards(plan)) if number not in folder.finished)
    pending: dict[Future[ShardResult], tuple[int, int, int]] = {}
    advice, before = None if job.controller else Advice(plan.scenario), folder.runs_done
    try:
        while True:
            while len(pending) < at_a_time and (number := next(missing, None)) is not None:
                first = number * plan.shard
                count = min(plan.shard, plan.runs - first)
                future = submit(replace(job, first=first, values=plan.values(first, count)))
                pending[future] = number, first, count
            if not pending:
                return
            finished, _ = wait(pending, timeout=0.1, return_when=FIRST_COMPLETED)
            for future in finished:
                shard = pending.pop(future)
                folder.store(*shard, *future.result())
                under_way.pop(shard[1], None)
            done = folder.runs_done + sum(list(under_way.values()))
            if advice and (sentence := advice.after(done - before, plan.runs - before)):
                warnings.warn(f"{plan.file}: {sentence}", ScenarioWarning, stacklevel=2)
            if progress and progress(done, plan.runs):
                raise Arm3rError(f"{folder.path}: stopped after {folder.runs_done} of {plan.runs} runs", code="stopped")
    except BrokenExecutor as broken:
        message = f"a worker died; {folder.runs_done} of {plan.runs} runs are finished, and resuming goes on from there"
        raise Arm3rError(f"{folder.path}: {message}", code="crashed") from broken
    finally:
        for future in pending:
            future.cancel()


@contextmanager
def _submitting(executor: Executor | None, jobs: int | None, under_way: UnderWay) -> Iterator[tuple[Submit, int]]:
    """The function that submits a job, and how many jobs are submitted at a time."""
    if executor is not None:
        yield lambda job: executor.submit(run_shard, job), IN_FLIGHT if jobs is None else max(1, jobs)
        return
    threads = _allowed(jobs)
    left = threading.Event()

    def computed(job: ShardJob) -> ShardResult:
        def go_on(runs_done: int, runs: int) -> None:
            under_way[job.first] = runs_done
            if left.is_set():
                raise Arm3rError("the sweep was left", code="stopped")

        return run_shard(job, go_on)

    if threading.current_thread().daemon:
        _of_daemons.add(left)
    with ThreadPoolExecutor(threads) as pool:
        try:
            yield lambda job: pool.submit(computed, job), 2 * threads
        finally:
            left.set()
            _of_daemons.discard(left)


def _allowed(jobs: int | None) -> int:
    cpus = usable_cpus()
    threads = cpus if jobs is None else min(max(jobs, 1), cpus)
    if jobs not in (None, threads):
        warnings.warn(f"{jobs} jobs: this process may use {cpus} CPUs, so it is {threads}", stacklevel=2)
    return threads
