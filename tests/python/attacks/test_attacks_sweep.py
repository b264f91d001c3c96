"""Attacks on sweeps: workers that die or have no memory, large tables, file systems that lose what was written."""

from __future__ import annotations

import errno
import fcntl
import io
import os
import resource
import signal
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.sweeps import shard as sweep_shard
from arm3r_cpp.sweeps import table_io as sweep_encode

PLAN = {
    "format": 1,
    "scenario": {"time": {"stop": 0}},
    "axes": [{"key": "initial.q[1]", "linspace": [0.1, 0.7, 9]}],
    "metrics": ["q2", "steps.accepted"],
    "shard": 2,
}


@pytest.fixture
def expected(tmp_path: Path) -> bytes:
    return arm3r.sweep(PLAN, out=tmp_path / "expected").path.read_bytes()


# ---- workers --------------------------------------------------------------------------------------------------------


def test_the_job_of_a_worker_that_is_killed_is_done_by_another(expected: bytes, tmp_path: Path) -> None:
    """Where the executor begins such a job anew, as Dask does; a pool of processes ends the sweep, to be resumed."""
    distributed = pytest.importorskip("distributed")
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None, local_directory=str(tmp_path)
    )
    killed: list[int] = []

    def kill_one(done: int, runs: int) -> None:
        if not killed:
            killed.extend(client.run(os.getpid).values())
            os.kill(killed[0], signal.SIGKILL)

    with cluster, distributed.Client(cluster) as client:
        table = arm3r.sweep(PLAN, out=tmp_path / "out", executor=client.get_executor(), jobs=2, progress=kill_one)
    assert killed and table.path.read_bytes() == expected


def test_a_shard_that_is_too_large_for_the_memory_is_refused_by_its_runs(scripts: Path, tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text(
        "format: 1\nscenario: {time: {stop: 0}}\nshard: 1000000\n"
        "axes: [{key: time.log_every, linspace: [1, 2, 1000000]}]\n"
    )
    call = [scripts / "arm3r-sweep", tmp_path / "s.yaml", "-o", tmp_path / "out"]
    limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (400 << 20, 400 << 20))  # noqa: E731
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}  # each would take memory for itself
    done = subprocess.run(call, capture_output=True, text=True, preexec_fn=limit, env=environment, timeout=600)
    assert done.returncode == 5, done.stderr
    assert done.stderr.endswith("runs 0 to 999999 take more memory than there is; give a smaller `shard`\n")
    assert not (tmp_path / "out" / "table.csv").exists()


def test_memory_that_ends_while_rows_are_written_is_reported_in_the_same_way(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def too_large(*_: Any) -> bytes:
        raise MemoryError

    monkeypatch.setattr(sweep_shard, "encode", too_large)
    with pytest.raises(arm3r.BudgetError, match="runs 0 to 1 take more memory than there is; give a smaller `shard`"):
        arm3r.sweep(PLAN, out=tmp_path / "out", executor=ThreadPoolExecutor(1), jobs=1)


# ---- large tables ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["csv", "parquet"])
@pytest.mark.parametrize("width", [1000, pytest.param(10_000, marks=pytest.mark.gate)])
def test_a_table_of_very_many_columns_is_a_table(kind: str, width: int, tmp_path: Path) -> None:
    if kind == "parquet":
        pytest.importorskip("pyarrow")
    columns = {f"c{i}": np.array([i, np.nan, -i / 3]) for i in range(width)}
    piece = sweep_encode.encode(columns, kind, lambda: None)
    with (tmp_path / "table").open("wb") as file:
        sweep_encode.merge([piece, piece], list(columns), kind, file)
    again = sweep_encode.decode(tmp_path / "table", kind)
    assert list(again) == list(columns)
    for name, column in columns.items():
        assert np.array_equal(again[name], np.tile(column, 2), equal_nan=True)


def _resident() -> int:
    """Bytes of this process in memory."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


class _Nowhere(io.RawIOBase):
    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> int:
        return len(data)


@pytest.mark.gate
def test_memory_does_not_grow_with_the_number_of_shards() -> None:
    pytest.importorskip("pyarrow")
    columns = {f"c{i}": np.arange(200.0) + i for i in range(50)}
    piece = sweep_encode.encode(columns, "parquet", lambda: None)

    def merged(count: int) -> int:
        sweep_encode.merge((piece for _ in range(count)), list(columns), "parquet", _Nowhere())
        return _resident()

    few = merged(1000)
    assert merged(20_000) - few < 200e6


def test_groups_of_rows_are_neither_many_nor_without_bound(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    monkeypatch.setattr(sweep_encode, "ROWS_OF_A_GROUP", 5)
    table = arm3r.sweep(PLAN, out=tmp_path / "out", parquet=True)
    groups = parquet.ParquetFile(table.path).metadata
    assert [groups.row_group(i).num_rows for i in range(groups.num_row_groups)] == [6, 3]
    assert table["run"].tolist() == list(range(9))


# ---- file systems ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("parquet", [False, True])
def test_what_a_file_system_loses_after_the_write_reaches_no_table(parquet: bool, tmp_path: Path) -> None:
    if parquet:
        pytest.importorskip("pyarrow")
    table = arm3r.sweep(PLAN, out=tmp_path / "expected", parquet=parquet)
    out = tmp_path / "out"

    def lose(done: int, runs: int) -> None:
        first = out / "shards" / f"000000{table.path.suffix}"
        if done == runs:
            first.write_bytes(first.read_bytes()[:-8] + b"        ")

    with pytest.raises(arm3r.OutputError, match=r"000000.*checksum.*resuming does its runs again"):
        arm3r.sweep(PLAN, out=out, jobs=1, parquet=parquet, progress=lose)
    assert not list(out.glob("table.*"))
    with pytest.warns(UserWarning, match="runs 0 to 1 are done again"):
        again = arm3r.sweep(PLAN, out=out, parquet=parquet, resume=True)
    assert again.path.read_bytes() == table.path.read_bytes()


def test_a_file_system_without_locks_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def none(*_: Any) -> None:
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))

    monkeypatch.setattr(fcntl, "flock", none)
    with pytest.raises(arm3r.OutputError, match="No locks available"):
        arm3r.sweep(PLAN, out=tmp_path / "out")


LATE = """
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <unistd.h>
/* As NFS does over its quota: writes are taken, and close() says that they are lost. */
int close(int file) {
    const int flags = fcntl(file, F_GETFL);
    int (*next)(int) = (int (*)(int))dlsym(RTLD_NEXT, "close");
    const int result = next(file);
    if (flags < 0 || (flags & O_ACCMODE) != O_WRONLY) return result;
    errno = EDQUOT;
    return -1;
}
"""


@pytest.mark.skipif(os.uname().sysname != "Linux", reason="a library is put before another by Linux's loader")
def test_an_error_that_comes_with_close_leaves_no_file(cli: Any, tmp_path: Path) -> None:
    library = tmp_path / "late.so"
    compiler = [os.environ.get("CC", "cc"), "-shared", "-fPIC", "-xc", "-", "-o", library, "-ldl"]
    subprocess.run(compiler, input=LATE, text=True, check=True)
    (tmp_path / "s.yaml").write_text("format: 1\ntime: {stop: 0.1}\n")
    environment = {**os.environ, "LD_PRELOAD": str(library)}
    before = set(tmp_path.iterdir())
    done = cli("run", tmp_path / "s.yaml", "-o", tmp_path / "x.csv", env=environment)
    assert done.returncode == 6 and os.strerror(errno.EDQUOT) in done.stderr
    assert set(tmp_path.iterdir()) == before
