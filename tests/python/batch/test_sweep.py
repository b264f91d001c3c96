"""Sweeps from end to end: the same bytes always, nothing lost, nothing believed."""

from __future__ import annotations

import itertools
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from conftest import Cli
from timing import once_within

SWEEP = """\
format: 1
scenario: {wall: {point: [1.78, 0, 0], acts_on_arm: true}, controller: {type: gravity_compensation}, time: {stop: 1.2}}
mode: random
runs: 95
axes:
  - {key: wall.contact.stiffness, log_uniform: [1e2, 1e6]}
  - {key: initial.qd, values: [[0, 0, 0], [0, 0.1, 0]]}
  - {key: solver.method, values: [dopri5, rk4]}
  - {key: solver.max_steps, values: [20, 1000000]}
  - {key: "wall.point[0]", uniform: [1.5, 1.9]}
metrics: [peak_force, first_contact, steps.accepted]
statistics: [{column: depth, of: max}, {column: q2, of: mean}, {column: f_on_wall_x, of: max_abs}]
shard: 10
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "sweep.yaml"
    path.write_text(SWEEP)
    return path


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return arm3r.sweep(arm3r.Sweep(SWEEP), out=tmp_path_factory.mktemp("reference") / "out").folder


@pytest.fixture
def started(reference: Path, tmp_path: Path) -> Path:
    """A finished sweep without its table, to be resumed."""
    shutil.copytree(reference, tmp_path / "out")
    (tmp_path / "out/table.csv").unlink()
    return tmp_path / "out"


@pytest.fixture
def command(scripts: Path) -> Cli:
    def call(*arguments: object) -> subprocess.CompletedProcess[str]:
        call = [scripts / "arm3r-sweep", *map(str, arguments)]
        return subprocess.run(call, capture_output=True, text=True, timeout=600)

    return call


def bytes_of(folder: Path) -> bytes:
    return (folder / "table.csv").read_bytes()


# ---- the table ------------------------------------------------------------------------------------------------------


def test_one_row_a_run_with_the_runs_own_numbers(reference: Path) -> None:
    table, plan = arm3r.SweepTable(reference), arm3r.Sweep(SWEEP)
    assert len(table) == 95 and table["run"].tolist() == list(range(95))
    values = plan.values()
    batch = plan.scenario.batch(values)
    assert table["outcome"].tolist() == batch.outcomes.tolist()
    assert {"ok", "invalid", "budget"} == set(table.outcomes)
    assert table["solver.method"].tolist() == values["solver.method"].tolist()
    assert np.array_equal(table["initial.qd[1]"], values["initial.qd"][:, 1])
    for name in plan.metrics:
        assert np.array_equal(table[name], batch[name], equal_nan=True), name
    index = int(np.flatnonzero(table.ok & (table["peak_force"] > 0))[0])
    run = batch.run(index)
    assert table["depth.max"][index] == run["depth"].max()
    assert table["q2.mean"][index] == pytest.approx(run["q2"].mean(), rel=1e-15)
    assert table["f_on_wall_x.max_abs"][index] == abs(run["f_on_wall_x"]).max() > 0


def test_the_file_is_plain(reference: Path) -> None:
    header, *rows = bytes_of(reference).decode().split("\n")
    assert header.startswith("run,wall.contact.stiffness,initial.qd[0],initial.qd[1],initial.qd[2],solver.method,")
    assert rows[-1] == "" and "nan" not in "".join(rows) and "inf" not in "".join(rows)
    invalid = next(row for row in rows if ",invalid," in row)
    assert invalid.endswith(",invalid,,,,,,")


def test_outcomes_are_counted(reference: Path) -> None:
    table = arm3r.SweepTable(reference)
    names, counts = np.unique(table["outcome"], return_counts=True)
    assert table.outcomes == dict(zip(names.tolist(), counts.tolist(), strict=True))


def test_flags_are_words(tmp_path: Path) -> None:
    axes = [{"key": "wall.acts_on_arm", "values": [True, False]}]
    plan = {"format": 1, "scenario": {"time": {"stop": 0}}, "axes": axes, "metrics": ["t_end"]}
    table = arm3r.sweep(plan, out=tmp_path / "out")
    assert table["wall.acts_on_arm"].tolist() == ["true", "false"]
    pytest.importorskip("pyarrow")
    assert arm3r.sweep(plan, out=tmp_path / "p", parquet=True)["wall.acts_on_arm"].tolist() == ["true", "false"]


def test_columns_have_units_and_mistaken_names_a_hint(reference: Path) -> None:
    table = arm3r.SweepTable(reference)
    assert (table.units["peak_force"], table.units["depth.max"], table.units["initial.qd[2]"]) == ("N", "m", "rad/s")
    assert table.units["steps.accepted"] == "" and list(table) == table.names
    with pytest.raises(KeyError, match="peak_force"):
        table["peak_forc"]


@pytest.mark.parametrize("shard", [1, 7, 1000])
def test_shards_do_not_show_in_the_table(reference: Path, tmp_path: Path, shard: int) -> None:
    plan = arm3r.Sweep(SWEEP.replace("shard: 10", f"shard: {shard}"))
    assert bytes_of(arm3r.sweep(plan, out=tmp_path / "out", jobs=1).folder) == bytes_of(reference)


def test_parquet_holds_the_same(reference: Path, tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    first = arm3r.sweep(arm3r.Sweep(SWEEP), out=tmp_path / "a", parquet=True, jobs=1)
    second = arm3r.sweep(arm3r.Sweep(SWEEP), out=tmp_path / "b", parquet=True)
    assert first.path.name == "table.parquet" and first.path.read_bytes() == second.path.read_bytes()
    plain = arm3r.SweepTable(reference)
    for name in plain:
        same = plain[name] == first[name] if plain[name].dtype.kind == "U" else None
        assert same.all() if same is not None else np.array_equal(plain[name], first[name], equal_nan=True), name


def test_without_pyarrow_parquet_names_the_extra(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(arm3r.UsageError, match=r"arm3r_cpp\[parquet\]"):
        arm3r.sweep(arm3r.Sweep(SWEEP), out=tmp_path / "out", parquet=True)


# ---- resuming -------------------------------------------------------------------------------------------------------


def resumed(folder: Path) -> tuple[bytes, list[str]]:
    with pytest.warns() as told:
        import warnings

        warnings.warn("so that there is one", stacklevel=1)
        arm3r.sweep(arm3r.Sweep(SWEEP), out=folder, resume=True)
    return bytes_of(folder), [str(warning.message) for warning in told][1:]


def times(folder: Path) -> dict[str, int]:
    return {path.name: path.stat().st_mtime_ns for path in (folder / "shards").iterdir()}


def test_resume_does_nothing_again(reference: Path, started: Path) -> None:
    before = times(started)
    assert resumed(started) == (bytes_of(reference), [])
    assert times(started) == before


def damage_flip(folder: Path) -> None:
    data = bytearray((folder / "shards/000003.csv").read_bytes())
    data[40] ^= 1
    (folder / "shards/000003.csv").write_bytes(data)


def damage_cut(folder: Path) -> None:
    os.truncate(folder / "shards/000003.csv", 100)


def damage_empty(folder: Path) -> None:
    os.truncate(folder / "shards/000003.csv", 0)


def damage_lose(folder: Path) -> None:
    (folder / "shards/000003.csv").unlink()


def damage_swap(folder: Path) -> None:
    shutil.copy(folder / "shards/000004.csv", folder / "shards/000003.csv")


def damage_ledger_line(folder: Path) -> None:
    text = (folder / "ledger.jsonl").read_text()
    (folder / "ledger.jsonl").write_text(text.replace('"first": 30', '"first": 31'))


def damage_ledger_end(folder: Path) -> None:
    os.truncate(folder / "ledger.jsonl", (folder / "ledger.jsonl").stat().st_size - 9)


def test_a_line_without_its_end_is_whole(reference: Path, started: Path) -> None:
    damage_lose(started)
    os.truncate(started / "ledger.jsonl", (started / "ledger.jsonl").stat().st_size - 1)
    assert resumed(started)[0] == bytes_of(reference)
    assert resumed(started) == (bytes_of(reference), [])


DAMAGES = [damage_flip, damage_cut, damage_empty, damage_lose, damage_swap, damage_ledger_line, damage_ledger_end]


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda damage: damage.__name__)
def test_damage_is_said_and_mended(reference: Path, started: Path, damage: Any) -> None:
    damage(started)
    before = times(started)
    table, told = resumed(started)
    assert table == bytes_of(reference)
    assert len(told) == 1 and "again" in told[0]
    if "ledger" not in damage.__name__:
        assert "000003" in told[0] and "runs 30 to 39" in told[0]
    changed = {name for name, stamp in times(started).items() if before.get(name) != stamp}
    assert len(changed) == 1


def test_a_shard_without_its_line_is_not_accepted(reference: Path, started: Path) -> None:
    lines = (started / "ledger.jsonl").read_text().splitlines(keepends=True)
    (started / "ledger.jsonl").write_text("".join(lines[1:]))
    first = json.loads(lines[0])
    (started / first["file"]).write_text("rubbish\n")
    (started / "shards" / "000001.csv.99.part").write_text("half")
    assert resumed(started) == (bytes_of(reference), [])
    assert not list(started.rglob("*.part"))


def test_other_inputs_are_refused_and_listed(started: Path) -> None:
    plan = arm3r.Sweep(SWEEP.replace("runs: 95", "runs: 96"), overrides=["time.stop=1.3"])
    with pytest.raises(arm3r.IncompatibleError) as raised:
        arm3r.sweep(plan, out=started, resume=True)
    assert all(word in str(raised.value) for word in ("runs: 95 then, 96 now", "scenario:", "sweep:", "hashes:"))


@pytest.mark.parametrize("text", [b"", b"{", b"[]", b"{}", b"\xff"])
def test_a_damaged_plan_is_named(started: Path, text: bytes) -> None:
    (started / "sweep.json").write_bytes(text)
    with pytest.raises(arm3r.UsageError, match=r"sweep\.json is damaged"):
        arm3r.sweep(arm3r.Sweep(SWEEP), out=started, resume=True)
    with pytest.raises(arm3r.UsageError, match=r"sweep\.json is damaged"):
        arm3r.SweepTable(started)


TABLES = [b"", b"x", b"run,t\n1", b"\xff", b"HEADER", b"HEADER1,2\n", b"ROWS,5,6\n"]


@pytest.mark.parametrize("text", TABLES)
def test_a_damaged_table_is_named_and_made_again(reference: Path, started: Path, text: bytes) -> None:
    header = bytes_of(reference).split(b"\n")[0] + b"\n"
    text = text.replace(b"HEADER", header).replace(b"ROWS", bytes_of(reference))
    (started / "table.csv").write_bytes(text)
    with pytest.raises(arm3r.UsageError, match="is not the table of 95 runs"):
        arm3r.SweepTable(started)["run"]
    assert resumed(started) == (bytes_of(reference), [])


def test_shards_and_ledger_of_another_sweep_are_not_accepted(reference: Path, started: Path, tmp_path: Path) -> None:
    other = arm3r.sweep(arm3r.Sweep(SWEEP.replace("stop: 1.2", "stop: 1.3")), out=tmp_path / "other").folder
    shutil.copytree(other / "shards", started / "shards", dirs_exist_ok=True)
    shutil.copy(other / "ledger.jsonl", started)
    table, told = resumed(started)
    assert table == bytes_of(reference) != bytes_of(other)
    assert told and all("another sweep" in line for line in told)


def test_a_line_that_stands_twice_counts_once(reference: Path, started: Path) -> None:
    ledger = started / "ledger.jsonl"
    ledger.write_bytes(ledger.read_bytes() * 2)
    assert resumed(started) == (bytes_of(reference), [])
    assert sum(arm3r.SweepTable(started).outcomes.values()) == 95
    ledger.write_bytes(b"{")
    with pytest.raises(arm3r.UsageError, match=r"ledger\.jsonl is damaged"):
        _ = arm3r.SweepTable(started).outcomes


def test_another_version_is_refused(started: Path) -> None:
    manifest = json.loads((started / "sweep.json").read_text())
    (started / "sweep.json").write_text(json.dumps({**manifest, "version": "0.0.1"}))
    with pytest.raises(arm3r.IncompatibleError, match=r'version: "0\.0\.1" then'):
        arm3r.sweep(arm3r.Sweep(SWEEP), out=started, resume=True)


def test_a_stopped_sweep_goes_on(reference: Path, tmp_path: Path) -> None:
    def stop(done: int, runs: int) -> bool:
        assert runs == 95
        return done >= 20

    with pytest.raises(arm3r.Arm3rError, match="stopped after"):
        arm3r.sweep(arm3r.Sweep(SWEEP), out=tmp_path / "out", jobs=1, progress=stop)
    kept = times(tmp_path / "out")
    assert 2 <= len(kept) < 10 and not (tmp_path / "out/table.csv").exists()
    with pytest.raises(arm3r.UsageError, match="not finished"):
        arm3r.SweepTable(tmp_path / "out")
    assert resumed(tmp_path / "out") == (bytes_of(reference), [])
    assert kept.items() <= times(tmp_path / "out").items()


# ---- the command ----------------------------------------------------------------------------------------------------


def test_failed_runs_are_exit_7_with_their_count(command: Cli, file: Path, reference: Path, tmp_path: Path) -> None:
    done = command(file, "-o", tmp_path / "out")
    assert done.returncode == 7 and done.stderr == ""
    failed = (~arm3r.SweepTable(reference).ok).sum()
    assert f"95 runs, {failed} not ok: " in done.stdout and "invalid" in done.stdout
    assert bytes_of(tmp_path / "out") == bytes_of(reference)


def test_all_ok_is_exit_0(command: Cli, file: Path, tmp_path: Path) -> None:
    file.write_text("{format: 1, scenario: {}, axes: [{key: time.stop, values: [0, 0.1]}], metrics: [t_end]}")
    done = command(file, "-o", tmp_path / "out", "--set", "time.log_every=0.1")
    assert (done.returncode, done.stdout) == (0, f"{tmp_path / 'out/table.csv'}: 2 runs, all ok\n")
    assert bytes_of(tmp_path / "out") == b"run,time.stop,outcome,t_end\n0,0,ok,0\n1,0.1,ok,0.1\n"


def test_a_full_disk_is_exit_6_and_resumes(command: Cli, scripts: Path, file: Path) -> None:
    folder = file.parent / "out"
    call = f"ulimit -f 8; exec {scripts}/arm3r-sweep {file} -o {folder}"
    file.write_text(SWEEP.replace("shard: 10", "shard: 95").replace("runs: 95", "runs: 400"))
    done = subprocess.run(["bash", "-c", call], capture_output=True, text=True)
    assert done.returncode == 6 and ".csv: cannot be written: File too large" in done.stderr
    assert not list(folder.rglob("*.part")) and not list((folder / "shards").iterdir())
    assert command(file, "-o", folder, "--resume").returncode == 7


def test_a_full_stdout_is_exit_6(scripts: Path, file: Path, tmp_path: Path) -> None:
    with open("/dev/full", "w") as full:
        call = [scripts / "arm3r-sweep", file, "-o", tmp_path / "out"]
        done = subprocess.run(call, stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 6
    assert done.stderr == "arm3r-sweep: standard output cannot be written: No space left on device\n"


def test_a_closed_pipe_ends_it_quietly(scripts: Path, file: Path, tmp_path: Path) -> None:
    call = [scripts / "arm3r-sweep", file, "-o", tmp_path / "out"]
    process = subprocess.Popen(call, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    process.stdout.close()
    assert process.stderr.read() == b"" and process.wait(600) == -signal.SIGPIPE
    assert (tmp_path / "out/table.csv").exists()


@pytest.mark.parametrize("jobs", [1.5, "2"])
def test_jobs_are_a_whole_number(tmp_path: Path, jobs: Any) -> None:
    with pytest.raises(TypeError, match="integer"):
        arm3r.sweep(arm3r.Sweep(SWEEP), out=tmp_path / "out", jobs=jobs)


def test_what_progress_raises_comes_out(tmp_path: Path) -> None:
    def fail(done: int, runs: int) -> None:
        raise mine

    for i, mine in enumerate((LookupError("mine"), StopIteration("mine"), SystemExit(3))):
        with pytest.raises(type(mine)) as raised:
            arm3r.sweep(arm3r.Sweep(SWEEP), out=tmp_path / str(i), progress=fail)
        assert raised.value is mine


def test_an_existing_folder_is_exit_6(command: Cli, file: Path, started: Path) -> None:
    done = command(file, "-o", started)
    assert done.returncode == 6 and "--resume" in done.stderr
    assert command(file, "-o", started, "--resume").returncode == 7
    (started.parent / "mine").mkdir()
    (started.parent / "mine/letter.txt").write_text("dear")
    done = command(file, "-o", started.parent / "mine", "--resume")
    assert done.returncode == 6 and "not the folder of a sweep" in done.stderr
    assert command(file, "-o", file / "below").returncode == 6


@pytest.mark.parametrize("resume", [[], ["--resume"]])
def test_a_folder_of_another_kind_is_left_alone(command: Cli, file: Path, tmp_path: Path, resume: list[str]) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/lock").write_text("precious")
    (tmp_path / "mine/letter.txt").write_text("dear")
    assert command(file, "-o", tmp_path / "mine", *resume).returncode == 6
    assert {path.name: path.read_text() for path in (tmp_path / "mine").iterdir()} == {
        "lock": "precious", "letter.txt": "dear"
    }  # fmt: skip


def test_exit_codes_of_mistakes(command: Cli, file: Path, started: Path, tmp_path: Path) -> None:
    assert command("nowhere.yaml", "-o", tmp_path / "x").returncode == 2
    assert command(file).returncode == 2
    file.write_text(SWEEP.replace("runs: 95", "runs: 96"))
    done = command(file, "-o", started, "--resume")
    assert done.returncode == 9 and "runs: 95 then, 96 now" in done.stderr
    file.write_text(SWEEP.replace("runs: 95", "run: 96"))
    done = command(file, "-o", tmp_path / "x")
    assert done.returncode == 3 and "did you mean runs?" in done.stderr and not (tmp_path / "x").exists()


@pytest.mark.parametrize("jobs", ["0", "-1", "10000"])
def test_jobs_are_clamped_and_said_once(command: Cli, file: Path, reference: Path, tmp_path: Path, jobs: str) -> None:
    done = command(file, "-o", tmp_path / "out", f"--jobs={jobs}")
    assert done.returncode == 7 and bytes_of(tmp_path / "out") == bytes_of(reference)
    assert done.stderr.count("\n") == 1 and f"{jobs} jobs" in done.stderr and "CPUs" in done.stderr


LONG = """\
format: 1
scenario: {wall: {acts_on_arm: true}, controller: {type: gravity_compensation}, time: {stop: 8}}
axes: [{key: wall.contact.stiffness, geomspace: [1e2, 1e6, 600]}]
metrics: [peak_force, impulse]
statistics: [{column: depth, of: max}]
shard: 10
"""


@pytest.fixture
def long(tmp_path: Path, scripts: Path) -> Any:
    (tmp_path / "long.yaml").write_text(LONG)

    def start(*more: str) -> subprocess.Popen[str]:
        return subprocess.Popen([scripts / "arm3r-sweep", tmp_path / "long.yaml", "-o", tmp_path / "long", *more],
                                stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)  # fmt: skip

    return start


def acknowledged(folder: Path) -> dict[str, int]:
    """When the shards were written that the ledger tells of; a signal may come between a shard and its line."""
    lines = (folder / "ledger.jsonl").read_text().splitlines(keepends=True)
    names = {Path(json.loads(line)["file"]).name for line in lines if line.endswith("\n")}
    return {name: stamp for name, stamp in times(folder).items() if name in names}


def wait_for(path: Path) -> None:
    end = time.monotonic() + 30
    while not (path.exists() and path.stat().st_size):
        assert time.monotonic() < end
        time.sleep(0.005)


def test_a_second_driver_learns_the_process_of_the_first(long: Any, command: Cli, tmp_path: Path) -> None:
    first = long()
    wait_for(tmp_path / "long/ledger.jsonl")
    first.send_signal(signal.SIGSTOP)
    done = command(tmp_path / "long.yaml", "-o", tmp_path / "long", "--resume")
    first.kill()
    first.communicate()
    assert done.returncode == 6 and f"in use by pid {first.pid}" in done.stderr


def test_interrupt_keeps_what_is_finished(long: Any, tmp_path: Path) -> None:
    process = long()
    wait_for(tmp_path / "long/ledger.jsonl")
    process.send_signal(signal.SIGINT)
    _, error = process.communicate(timeout=600)
    assert process.returncode == -signal.SIGINT and "--resume" in error and "Traceback" not in error
    kept = acknowledged(tmp_path / "long")
    again = long("--resume")
    assert again.wait(600) == 0
    assert kept and kept.items() <= times(tmp_path / "long").items()


def test_a_terminated_sweep_goes_on(long: Any, tmp_path: Path) -> None:
    process = long()
    wait_for(tmp_path / "long/ledger.jsonl")
    process.terminate()
    assert process.wait(600) == -signal.SIGTERM
    kept = acknowledged(tmp_path / "long")
    assert kept and long("--resume").wait(600) == 0
    assert kept.items() <= times(tmp_path / "long").items()


BIG = (
    "format: 1\nscenario: {time: {stop: 0}}\naxes: [{key: time.log_every, linspace: [1, 2, 1000000]}]\nshard: 1000000\n"
)
SLOW = LONG.replace("600", "60000").replace("shard: 10\n", "shard: 2000\n")


@pytest.mark.sample(1)
@pytest.mark.timed
@pytest.mark.parametrize(("text", "seconds"), [(BIG, 2.5), (SLOW, 0.9)], ids=["while rows are written", "statistics"])
def test_a_big_shard_does_not_hold_an_interrupt(long: Any, tmp_path: Path, text: str, seconds: float) -> None:
    (tmp_path / "long.yaml").write_text(text)

    def delay() -> float:
        process = long()
        wait_for(tmp_path / "long/sweep.json")
        time.sleep(seconds)
        sent = time.monotonic()
        process.send_signal(signal.SIGINT)
        process.wait(600)
        took = time.monotonic() - sent
        assert process.returncode == -signal.SIGINT and not (tmp_path / "long/table.csv").exists()
        shutil.rmtree(tmp_path / "long")
        return took

    assert once_within(0.25, delay)


def _rounds(long: Any, tmp_path: Path, rounds: int) -> None:
    expected = bytes_of(arm3r.sweep(arm3r.Sweep(LONG), out=tmp_path / "whole").folder)
    chance, killed, folder = random.Random(1), 0, tmp_path / "long"
    while killed < rounds:
        shutil.rmtree(folder, ignore_errors=True)
        for attempt in itertools.count():
            process = long("--resume")
            while process.poll() is None and not _works_in(folder, process.pid):
                time.sleep(0.002)
            time.sleep(chance.uniform(0, 0.3 + 0.1 * attempt))  # a busy machine comes to the end too
            process.kill()
            _, error = process.communicate()
            if process.returncode == 0:
                break
            killed += 1
            ledger = folder / "ledger.jsonl"
            acknowledged = ledger.read_text().splitlines() if ledger.exists() else []
            assert all((folder / json.loads(line)["file"]).exists() for line in acknowledged)
            assert "again" not in error
        assert bytes_of(folder) == expected
        assert len(list((folder / "shards").iterdir())) == 60


def _works_in(folder: Path, pid: int) -> bool:
    return (folder / "lock").exists() and (folder / "lock").read_text().strip() == str(pid)


def test_kill_loses_no_finished_shard(long: Any, tmp_path: Path) -> None:
    _rounds(long, tmp_path, 1)


@pytest.mark.gate
def test_twenty_rounds_of_kills_lose_no_finished_shard(long: Any, tmp_path: Path) -> None:
    _rounds(long, tmp_path, 20)


def test_the_bar_shows_rate_and_time_left(long: Any, tmp_path: Path, scripts: Path) -> None:
    (tmp_path / "long.yaml").write_text(LONG.replace("600", "60000"))
    parent, child = os.openpty()
    process = subprocess.Popen([scripts / "arm3r-sweep", tmp_path / "long.yaml", "-o", tmp_path / "long"], stderr=child)
    os.close(child)
    shown = b""
    while b" left" not in shown and process.poll() is None:
        shown += os.read(parent, 1024)
    process.kill()
    process.wait()
    assert b"runs/s" in shown and b" of 60000" in shown and b"[" in shown
