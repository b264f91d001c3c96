"""The table is the same for every executor: threads, processes, Dask, MPI."""

from __future__ import annotations

import multiprocessing
import os
import subprocess
import sys
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import pytest
from arm3r_cpp.sweeps import runner as sweep_run
from arm3r_cpp.sweeps import shard as sweep_shard

SWEEP = """\
format: 1
scenario: {wall: {point: [1.78, 0, 0], acts_on_arm: true}, controller: {type: gravity_compensation}, time: {stop: 1}}
mode: latin_hypercube
runs: 60
axes:
  - {key: wall.contact.stiffness, log_uniform: [1e2, 1e6]}
  - {key: solver.method, values: [dopri5, rk4]}
metrics: [peak_force, first_contact]
statistics: [{column: depth, of: max}]
shard: 7
"""


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    return arm3r.sweep(arm3r.Sweep(SWEEP), out=tmp_path_factory.mktemp("here") / "out", jobs=1).path.read_bytes()


def run_on(executor: Executor, folder: Path, **options: Any) -> bytes:
    return arm3r.sweep(arm3r.Sweep(SWEEP), out=folder, executor=executor, **options).path.read_bytes()


def test_threads(expected: bytes, tmp_path: Path) -> None:
    with ThreadPoolExecutor(3) as executor:
        assert run_on(executor, tmp_path / "out") == expected


@pytest.mark.parametrize("start", ["spawn", "fork"])
def test_processes(expected: bytes, tmp_path: Path, start: str) -> None:
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context(start)) as executor:
        assert run_on(executor, tmp_path / "out", jobs=3) == expected


def test_dask(expected: bytes, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None, local_directory=str(tmp_path)
    )
    with cluster, distributed.Client(cluster) as client:
        assert run_on(client.get_executor(), tmp_path / "out") == expected


MPI = """
import sys
import arm3r_cpp as arm3r
from mpi4py.futures import MPIPoolExecutor

if __name__ == "__main__":
    with MPIPoolExecutor() as executor:
        assert executor.num_workers == 2
        arm3r.sweep(sys.argv[1], out=sys.argv[2], executor=executor)
"""


def test_mpi(expected: bytes, tmp_path: Path, scripts: Path) -> None:
    pytest.importorskip("mpi4py")
    mpiexec = scripts / "mpiexec"
    if not mpiexec.exists():
        pytest.skip("mpich is not installed")
    (tmp_path / "script.py").write_text(MPI)
    (tmp_path / "sweep.yaml").write_text(SWEEP)
    call = [mpiexec, "-n", "3", sys.executable, "-m", "mpi4py.futures", "script.py", "sweep.yaml", "out"]
    done = subprocess.run(call, cwd=tmp_path, capture_output=True, text=True, timeout=600, env={**os.environ})
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out/table.csv").read_bytes() == expected


# ---- workers of another kind ----------------------------------------------------------------------------------------


class Twice(Executor):
    """Computes every job twice, as a scheduler does that lost touch with a worker."""

    def __init__(self) -> None:
        self.done: list[Any] = []

    def submit(self, function: Any, /, *arguments: Any, **named: Any) -> Future[Any]:
        future: Future[Any] = Future()
        first = function(*arguments, **named)
        self.done.append((arguments, first))
        assert function(*arguments, **named) == first
        future.set_result(first)
        return future


def test_a_job_done_twice_gives_the_same_bytes(expected: bytes, tmp_path: Path) -> None:
    executor = Twice()
    assert run_on(executor, tmp_path / "out") == expected
    assert len(executor.done) == 9


def test_a_shard_stored_twice_stays(expected: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store = sweep_run.SweepFolder.store

    def twice(folder: Any, *shard: Any) -> None:
        store(folder, *shard)
        store(folder, *shard[:3], b"late", {})

    monkeypatch.setattr(sweep_run.SweepFolder, "store", twice)
    table = arm3r.sweep(arm3r.Sweep(SWEEP), out=tmp_path / "out")
    assert table.path.read_bytes() == expected
    assert len((tmp_path / "out/ledger.jsonl").read_text().splitlines()) == 9


def _of_another_version(job: sweep_shard.ShardJob) -> sweep_shard.ShardResult:
    return sweep_shard.run_shard(replace(job, version="9.9.9"))


def test_workers_of_another_version_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sweep_run, "run_shard", _of_another_version)
    with ThreadPoolExecutor(1) as executor, pytest.raises(arm3r.IncompatibleError, match=r"9\.9\.9.*install the same"):
        run_on(executor, tmp_path / "out")
    assert not (tmp_path / "out/table.csv").exists()


def test_a_worker_that_fails_is_heard(expected: bytes, tmp_path: Path) -> None:
    with ThreadPoolExecutor(1) as executor:
        executor.shutdown()
        with pytest.raises(RuntimeError, match="shutdown"):
            run_on(executor, tmp_path / "out")
    assert arm3r.sweep(arm3r.Sweep(SWEEP), out=tmp_path / "out", resume=True).path.read_bytes() == expected


class Deadly(ProcessPoolExecutor):
    """Whose workers die of their fifth job."""

    jobs = 0

    def submit(self, function: Any, /, *arguments: Any, **options: Any) -> Future[Any]:
        self.jobs += 1
        if self.jobs == 5:
            return super().submit(os._exit, 1)
        return super().submit(function, *arguments, **options)


def test_a_dead_worker_is_named_and_the_sweep_goes_on(expected: bytes, tmp_path: Path) -> None:
    context = multiprocessing.get_context("spawn")
    with Deadly(1, mp_context=context) as executor, pytest.raises(arm3r.Arm3rError) as caught:
        run_on(executor, tmp_path / "out", jobs=1)
    assert caught.value.code == "crashed"
    assert str(caught.value).endswith("a worker died; 28 of 60 runs are finished, and resuming goes on from there")
    with ThreadPoolExecutor(2) as executor:
        assert run_on(executor, tmp_path / "out", resume=True) == expected
