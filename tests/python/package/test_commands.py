"""The commands as a newcomer meets them: help, examples, options that several commands share, progress."""

from __future__ import annotations

import os
import pty
import re
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import pytest
from arm3r_cpp import _progress_bar, examples
from arm3r_cpp.sweeps.runner import sweep
from conftest import ROOT, script

SCENARIO = "format: 1\nwall: {point: [1.8, 0, 0]}\ntime: {stop: 2}\n"
FAILING = SCENARIO + "checks: [{summary: peak_force, equals: -1, name: never}]\n"


@pytest.fixture
def command(scripts: Path, tmp_path: Path) -> Any:
    """command("plot", ...): run `arm3r plot ...` in an empty folder."""
    path = f"{scripts}{os.pathsep}{os.environ['PATH']}"

    def call(*words: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            ["arm3r", *map(str, words)], cwd=tmp_path, capture_output=True, text=True, env={**os.environ, "PATH": path}
        )

    return call


# ---- what a run prints ----------------------------------------------------------------------------------------------


def test_a_tip_that_ends_beside_the_plate_is_reported(command: Any, tmp_path: Path) -> None:
    """depth grows there, and nothing pushes: the report says why."""
    text = """format: 1
initial: {q: [0.1, 0.2, -0.3]}
controller: {type: gravity_compensation}
wall:
  {point: [2.2, 0.9, 0.3], size: [0.4, 0.6], motion: {type: constant, velocity: [-0.2, 0, 0]}}
time: {stop: 2}
"""
    (tmp_path / "beside.yaml").write_text(text)
    tip = arm3r.Scenario.load(tmp_path / "beside.yaml").run()["tip"][-1]
    depth, beside = tip[0] - (2.2 - 0.2 * 2), max(abs(tip[1] - 0.9) - 0.2, abs(tip[2] - 0.3) - 0.3)
    printed = command("run", "beside.yaml").stdout
    assert f"at the end the tip is {depth:.4g} m behind the face and {beside:.4g} m beside the plate" in printed
    (tmp_path / "beside.yaml").write_text(text.replace("[0.4, 0.6]", "[4, 4]"))
    assert "beside the plate" not in command("run", "beside.yaml").stdout


# ---- help -----------------------------------------------------------------------------------------------------------


def test_arm3r_alone_prints_the_help(command: Any) -> None:
    done = command()
    assert (done.returncode, done.stderr) == (0, "") and done.stdout == command("--help").stdout


def test_the_help_lists_every_command(command: Any) -> None:
    text = command().stdout
    scripts = re.findall(r"^arm3r-(\w+) = ", (ROOT / "pyproject.toml").read_text(), re.M)
    assert {"plot", "animate", "sweep", "examples"} <= set(scripts)
    listed = re.findall(r"^  (\w+) ", text, re.M)
    scripts.remove("run")  # which the executable calls where it needs Python
    assert set(scripts) | {"run", "check", "schema", "columns", "template"} <= set(listed)
    for name in listed:
        if name != "NAME":
            assert command(name, "--help").stdout.startswith(f"usage: arm3r-{name}" if name in scripts else "usage: ")


def test_a_mistyped_command_names_the_right_one(command: Any) -> None:
    for typed, meant in {"plto": "plot", "exmaples": "examples", "rnu": "run"}.items():
        done = command(typed)
        assert done.returncode == 2 and f"did you mean {meant}?" in done.stderr


# ---- options --------------------------------------------------------------------------------------------------------


def test_no_checks_leaves_the_checks_out(command: Any, tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text(FAILING)
    assert command("run", "s.yaml").returncode == 10
    done = command("run", "s.yaml", "--no-checks")
    assert done.returncode == 0 and "never" not in done.stdout
    assert "no option --no-checks" in command("check", "s.yaml", "--no-checks").stderr


def test_plot_and_animate_take_set(command: Any, tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text(SCENARIO)
    short = ["--set", "time.stop=0.1", "--set", "wall.point=[1.74, 0, 0]"]
    done = command("animate", "s.yaml", *short, "-o", "film")
    assert done.returncode == 0, done.stderr
    assert len(list((tmp_path / "film").glob("*.png"))) == 4  # of 0.1 s at 25 a second
    done = command("plot", "s.yaml", "--set", "time.stopp=1")
    assert done.returncode == 3 and "time.stopp" in done.stderr and "--set" in done.stderr
    assert command("animate", "s.yaml", "--set", "time.stop").returncode == 2
    command("run", "s.yaml", "-o", "s.csv")
    done = command("plot", "s.csv", "--set", "time.stop=1")
    assert done.returncode == 2 and "s.csv is a finished run" in done.stderr


def test_cmake_dir_is_where_cmake_finds_the_package(command: Any, scripts: Path, tmp_path: Path) -> None:
    folder = Path(command("--cmake-dir").stdout.strip())
    assert (folder / "arm3rConfig.cmake").is_file()
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.22)\nproject(consumer NONE)\nfind_package(arm3r 0.1 REQUIRED)\n"
        'get_target_property(_include arm3r::arm3r INTERFACE_INCLUDE_DIRECTORIES)\nmessage("include: ${_include}")\n'
    )
    cmake = scripts / "cmake" if (scripts / "cmake").exists() else "cmake"
    configure = [cmake, "-S", tmp_path, "-B", tmp_path / "build", f"-Darm3r_DIR={folder}"]
    done = subprocess.run(configure, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    include = re.search(r"include: (\S+)", done.stderr)[1]
    assert (Path(include) / "arm3r/arm3r.h").is_file()
    assert "takes" in command("run", "--cmake-dir").stderr or command("run", "--cmake-dir").returncode == 2


# ---- examples -------------------------------------------------------------------------------------------------------


def test_the_examples_are_the_scenarios_of_the_repository(command: Any) -> None:
    shipped = {path.relative_to(ROOT / "scenarios").with_suffix("").as_posix(): path
               for path in (ROOT / "scenarios").rglob("*.yaml")}  # fmt: skip
    assert set(examples.names()) == set(shipped)
    lines = command("examples").stdout.splitlines()
    assert [line.split()[0] for line in lines] == examples.names()
    for line in lines:
        name, text = line.split(maxsplit=1)
        assert len(text) > 15 and text[-1] in ".?!:", line
        assert examples.path_of(name).read_bytes() == shipped[name].read_bytes()


def test_an_example_runs_wherever_it_is_copied(command: Any, tmp_path: Path) -> None:
    for words in (["moving_wall"], ["lecture/05_free_fall"], ["05_free_fall.yaml"]):
        done = command("examples", *words)
        assert done.returncode == 0 and arm3r.Scenario(done.stdout).validate() is None
        assert Path(re.match(r".*\$schema=(.*)\n", done.stdout)[1]).is_file()
    done = command("examples", "--copy", "mine")
    assert len(done.stdout.splitlines()) == len(examples.names())
    assert command("run", "mine/moving_wall.yaml").returncode == 0
    again = command("examples", "moving_wall", "--copy", "mine")
    assert again.returncode == 6 and "exists already" in again.stderr


def test_a_sweep_is_copied_with_its_scenario(command: Any, tmp_path: Path) -> None:
    done = command("examples", "poses", "--copy", "mine")
    assert done.stdout.splitlines() == ["mine/moving_wall.yaml", "mine/sweeps/poses.yaml"]
    assert arm3r.Sweep.load(tmp_path / "mine/sweeps/poses.yaml").runs == 1000


def test_an_example_by_name() -> None:
    assert arm3r.Scenario.example("moving_wall").to_yaml() == arm3r.Scenario.load(
        ROOT / "scenarios/moving_wall.yaml").to_yaml()  # fmt: skip
    with pytest.raises(arm3r.UsageError, match="did you mean moving_wall"):
        arm3r.Scenario.example("moving_wal")
    with pytest.raises(arm3r.UsageError, match="is a sweep"):
        arm3r.Scenario.example("poses")


# ---- progress -------------------------------------------------------------------------------------------------------


def test_the_progress_of_a_sweep_moves_by_runs(tmp_path: Path) -> None:
    """Also in the middle of a shard, never backwards, and with statistics, for which each run is done once more.

    All runs would take many of the tenths of a second after which it is told; the first one ends the sweep.
    """
    statistics = [{"column": "depth", "of": "max"}]
    for out, count, more in (("plain", 100_000, {}), ("statistics", 10_000, {"statistics": statistics})):
        plan = {
            "format": 1,
            "scenario": {"wall": {"acts_on_arm": True}, "controller": {"type": "gravity_compensation"}},
            "axes": [{"key": "wall.contact.stiffness", "geomspace": [1e3, 1e6, count]}],
            "shard": count,
            "set": {"solver.rtol": 1e-11},
            **more,
        }
        seen: list[tuple[int, int]] = []

        def stop(done: int, runs: int, seen: list[tuple[int, int]] = seen) -> bool:
            seen.append((done, runs))
            return 0 < done < runs

        with pytest.raises(arm3r.Arm3rError, match="stopped after"):
            sweep(plan, out=tmp_path / out, jobs=1, progress=stop)
        counts = [done for done, _ in seen]
        assert counts == sorted(counts) and 0 < counts[-1] < count
        assert {runs for _, runs in seen} == {count}


def _in_a_terminal(code: str) -> str:
    """What code prints on a terminal."""
    main, terminal = pty.openpty()
    shown: list[bytes] = []

    def read() -> None:
        while True:
            try:
                shown.append(os.read(main, 4096))
            except OSError:
                return

    reader = threading.Thread(target=read)
    reader.start()
    subprocess.run([sys.executable, "-c", code], stderr=terminal, check=True)
    os.close(terminal)
    reader.join()
    os.close(main)
    return b"".join(shown).decode()


BATCH = """
import arm3r_cpp as arm3r
from arm3r_cpp import _progress_bar
_progress_bar.DELAY = 0.0
scenario = arm3r.Scenario.example("moving_wall")
scenario["solver"] = {"method": "rk4", "step": 5e-5}  # long enough for a first message, which comes after 20 ms
scenario.batch({"wall.contact.stiffness": [1e3, 2e3, 3e3, 4e3] * 15}, threads=1)
"""


def test_a_batch_shows_a_bar_on_a_terminal_only(
    capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = _in_a_terminal(BATCH)
    assert re.search(r"batch \[[#.]+\] \d+ %  \d+ of 60 ", shown) and shown.endswith("\r\x1b[K")
    monkeypatch.setattr(_progress_bar, "DELAY", 0.0)
    for terminal, progress in ((False, None), (True, False)):
        monkeypatch.setattr("sys.stderr.isatty", lambda terminal=terminal: terminal)
        arm3r.Scenario().batch({"time.stop": [1.0, 2.0]}, progress=progress)
        assert capfd.readouterr().err == ""


def test_a_bar_waits_a_second(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    bar = _progress_bar.Bar("work", "runs")
    bar.draw(1, 10)
    assert capsys.readouterr().err == ""
    bar.start -= 2
    bar.draw(5, 10)
    assert "50 %  5 of 10" in capsys.readouterr().err


def test_the_build_says_how_far_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    module = script("tools/install_package.py")
    monkeypatch.setenv("CMAKE_BUILD_PARALLEL_LEVEL", "2")
    printed = [
        "Processing .\n",
        "  [1/136] Building CXX object a.dir/b.cpp.o\n",
        "noise\n",
        "  [2/136] Linking CXX x\n",
    ]
    output: list[str] = []
    lines = list(module.reported(printed, output))
    minutes = -(-module.CPU_MINUTES // 2)
    assert lines[0].startswith(f"Compiling arm3r: about {minutes} min the first time, 2 jobs at once")
    assert lines[1:] == ["[1/136] a.dir/b.cpp.o", "[2/136] Linking CXX x"] and output == printed
    assert "tools/install_package.py" in (ROOT / "Makefile").read_text()


def test_the_package_is_installed_by_any_pip_of_python_3_10(monkeypatch: pytest.MonkeyPatch) -> None:
    """pip 22.0, of Ubuntu 22.04, knows neither -C nor --config-settings."""
    module = script("tools/install_package.py")
    called: dict[str, Any] = {}

    def popen(command: list[str], **options: Any) -> Any:
        called.update(command=command, **options)
        return real([sys.executable, "-c", ""], stdout=subprocess.PIPE, text=True)

    real = subprocess.Popen
    monkeypatch.setattr(module.subprocess, "Popen", popen)
    assert module.main("folder") == 0
    options = [word for word in called["command"][3:] if word.startswith("-")]
    assert options == ["--disable-pip-version-check", "--no-compile", "--no-build-isolation", "-v"]
    assert called["env"]["SKBUILD_CMAKE_DEFINE"] == "ARM3R_LANES=native"
