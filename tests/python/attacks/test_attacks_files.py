"""Attacks on what is read and written by the commands in Python: full disks, FIFOs, hostile JSON, missing parts."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest

SWEEP = """\
format: 1
scenario:
  time: {stop: 0.02}
  controller: {type: gravity_compensation}
axes: [{key: "initial.q[1]", values: [0.1, 0.2]}]
"""


@pytest.fixture
def sweep_file(tmp_path: Path) -> Path:
    path = tmp_path / "sweep.yaml"
    path.write_text(SWEEP)
    return path


@pytest.fixture
def run_file(tmp_path: Path) -> Path:
    path = tmp_path / "run.csv"
    arm3r.Scenario("format: 1\ntime: {stop: 0.02}\nwall: {point: [1.74, 0, 0]}\n").run().to_csv(path)
    return path


def command(scripts: Path, *words: object, **options: Any) -> subprocess.CompletedProcess[str]:
    options = {"capture_output": True, "text": True, "timeout": 600, **options}
    return subprocess.run(list(map(str, (scripts / words[0], *words[1:]))), **options)


def test_a_disk_that_is_full_from_the_start_is_exit_6(scripts: Path, sweep_file: Path, tmp_path: Path) -> None:
    call = f"ulimit -f 0; exec {scripts}/arm3r-sweep {sweep_file} -o {tmp_path}/out"
    done = subprocess.run(["bash", "-c", call], capture_output=True, text=True, timeout=600)
    assert done.returncode == 6 and "cannot be written" in done.stderr and "Traceback" not in done.stderr, done
    assert command(scripts, "arm3r-sweep", sweep_file, "-o", tmp_path / "out", "--resume").returncode == 0


def test_another_format_of_a_sweep_is_exit_9(scripts: Path, sweep_file: Path, tmp_path: Path) -> None:
    sweep_file.write_text(SWEEP.replace("format: 1", "format: 2"))
    done = command(scripts, "arm3r-sweep", sweep_file, "-o", tmp_path / "out")
    assert done.returncode == 9 and f"{sweep_file}:1:9: error[sweep.format]: format" in done.stderr
    assert "written for format 2" in done.stderr and not (tmp_path / "out").exists()
    with pytest.raises(arm3r.IncompatibleError):
        arm3r.Sweep.load(sweep_file)


# ---- FIFOs ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["ledger.jsonl", "sweep.json", "lock"])
def test_a_fifo_in_a_sweeps_folder_is_refused(scripts: Path, sweep_file: Path, tmp_path: Path, name: str) -> None:
    folder = tmp_path / "out"
    assert command(scripts, "arm3r-sweep", sweep_file, "-o", folder).returncode == 0
    (folder / name).unlink()
    os.mkfifo(folder / name)
    done = command(scripts, "arm3r-sweep", sweep_file, "-o", folder, "--resume", timeout=600)
    assert done.returncode in (2, 6) and "Traceback" not in done.stderr, done
    if name == "ledger.jsonl":
        with pytest.raises(arm3r.UsageError):
            arm3r.SweepTable(folder).outcomes  # noqa: B018


@pytest.mark.parametrize("suffix", [".csv", ".json", ".npz"])
def test_a_run_that_is_a_fifo_is_refused(run_file: Path, suffix: str) -> None:
    path = run_file.with_suffix(suffix)
    path.unlink(missing_ok=True)
    os.mkfifo(path)
    with pytest.raises(arm3r.UsageError, match="not a regular file"):
        arm3r.Run.load(run_file if suffix == ".json" else path)


# ---- hostile JSON ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", ["[" * 100_000, '{"columns":' * 100_000, "[]", "1", "null", '"a"', "{}"])
def test_json_that_is_no_summary_is_refused(run_file: Path, text: str) -> None:
    run_file.with_suffix(".json").write_text(text)
    with pytest.raises(arm3r.UsageError, match=r"not the summary of a run|not JSON"):
        arm3r.Run.load(run_file)


@pytest.mark.parametrize(
    "part", ["name", "outcome", "message", "events", "checks", "warnings", "columns", "scenario", "rows", "hash"]
)
@pytest.mark.parametrize("value", [None, 1, "text", [1], [[]], {"a": 1}, [{"type": "make"}], True])
def test_a_summary_with_a_part_of_another_type_is_refused(run_file: Path, part: str, value: Any) -> None:
    path = run_file.with_suffix(".json")
    summary = json.loads(path.read_text())
    if (isinstance(value, str) and isinstance(summary[part], str) and part != "hash") or (value, part) == (
        None,
        "scenario",
    ):
        return
    path.write_text(json.dumps({**summary, part: value}))
    with pytest.raises(arm3r.UsageError):
        arm3r.Run.load(run_file)


def test_a_ledger_and_a_manifest_of_brackets_are_damaged(scripts: Path, sweep_file: Path, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    assert command(scripts, "arm3r-sweep", sweep_file, "-o", folder).returncode == 0
    (folder / "ledger.jsonl").write_text("[" * 100_000 + "\n")
    with pytest.raises(arm3r.UsageError, match="damaged"):
        arm3r.SweepTable(folder).outcomes  # noqa: B018
    assert command(scripts, "arm3r-sweep", sweep_file, "-o", folder, "--resume").returncode == 0
    (folder / "sweep.json").write_text("[" * 100_000)
    assert command(scripts, "arm3r-sweep", sweep_file, "-o", folder, "--resume").returncode == 2


# ---- what is missing ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("words", [["plot", "RUN"], ["plot", "sweep", "DIR"], ["animate", "RUN", "-o", "a.gif"]])
def test_without_matplotlib_figures_say_what_to_install(run_file: Path, sweep_file: Path, words: list[str]) -> None:
    folder = run_file.parent / "out"
    arm3r.sweep(sweep_file, out=folder)
    given = [{"RUN": str(run_file), "DIR": str(folder)}.get(word, word) for word in words[1:]]
    code = (
        "import sys\nsys.modules['matplotlib'] = None\n"
        f"from arm3r_cpp.commands.{words[0]} import main\nsys.exit(main({given!r}))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=run_file.parent)
    assert done.returncode == 2 and "pip install matplotlib" in done.stderr and "Traceback" not in done.stderr, done


def test_a_file_needs_a_folder_that_exists(scripts: Path, run_file: Path, tmp_path: Path) -> None:
    for call in (["arm3r-plot", run_file, "-o", "none/a.png"], ["arm3r-animate", run_file, "-o", "none/a.gif"]):
        done = command(scripts, *call, cwd=tmp_path)
        assert done.returncode == 6 and "none" in done.stderr and not (tmp_path / "none").exists(), done
    assert command(scripts, "arm3r-plot", run_file, "-o", "new/folder", cwd=tmp_path).returncode == 0
    assert (tmp_path / "new/folder/run.png").is_file()


# ---- --resume names what differs ------------------------------------------------------------------------------------


def test_resume_with_other_inputs_names_the_first_line_that_differs(sweep_file: Path, tmp_path: Path) -> None:
    arm3r.sweep(sweep_file, out=tmp_path / "out")
    with pytest.raises(arm3r.IncompatibleError) as raised:
        arm3r.sweep(arm3r.Sweep.load(sweep_file, overrides=["time.stop=0.03"]), out=tmp_path / "out", resume=True)
    lines = str(raised.value).splitlines()
    assert any("scenario: line" in line and "stop: 0.02" in line and "stop: 0.03" in line for line in lines[1:]), lines
    assert lines[1].startswith("  scenario: ")  # checksums come last
    sweep_file.write_text(SWEEP.replace("0.2]", "0.3]"))
    with pytest.raises(arm3r.IncompatibleError) as raised:
        arm3r.sweep(sweep_file, out=tmp_path / "out", resume=True)
    assert "sweep: line 5" in str(raised.value) and "0.3" in str(raised.value)


# ---- arguments from Python ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("field", [0, 1])
@pytest.mark.parametrize(("address", "kind"), [
    (1.5, TypeError), (True, TypeError), ("1", TypeError), (None, TypeError), (2**70, ValueError), (-1, ValueError),
])  # fmt: skip
def test_a_native_law_is_an_address(field: int, address: Any, kind: type[Exception]) -> None:
    law = arm3r.NativeLaw(*([address] if field == 0 else [4096, address]))
    with pytest.raises(kind, match=r"NativeLaw\.(address|user)"):
        arm3r.Scenario("format: 1\ntime: {stop: 0.01}\n").run(controller=law)


def test_a_time_limit_is_a_number() -> None:
    with pytest.raises(TypeError, match="time_limit"):
        arm3r.Scenario("format: 1\n").run(time_limit=True)


@pytest.mark.parametrize("choice", [100000.0, -2.0, -1e300, 0.5, float("nan")])
def test_a_batch_refuses_a_choice_that_is_no_word(choice: float) -> None:
    from arm3r_cpp import _native

    params = arm3r.param_defaults()
    params[arm3r.param_index("controller.type")] = choice
    for varied in ([], [arm3r.param_index("initial.q[1]")]):
        values = np.full((len(varied), 2), 0.1)
        with pytest.raises(arm3r.ScenarioError, match=r"controller\.type"):
            _native.batch(params, varied, values, threads=1, progress=None)


@pytest.mark.parametrize("convention", ["simscape", "slide"])
def test_a_refused_torque_is_shown_as_the_law_gave_it(convention: str, tmp_path: Path) -> None:
    import ctypes

    source = "int law(void *u, const void *s, double *tau) { tau[0] = 1; tau[1] = 2e12; tau[2] = 3; return 0; }\n"
    (tmp_path / "law.c").write_text(source)
    subprocess.run(["gcc", "-shared", "-fPIC", "law.c", "-o", "law.so"], check=True, cwd=tmp_path)
    address = ctypes.cast(ctypes.CDLL(str(tmp_path / "law.so")).law, ctypes.c_void_p).value
    with pytest.raises(arm3r.ControllerError, match=r"the torque \[1, 2e\+12, 3\] N m"):
        arm3r.Scenario(f"format: 1\narm: {{convention: {convention}}}\n").run(controller=arm3r.NativeLaw(address))
