"""What Windows does differently, tried by wine on the executable of the wheel."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
from conftest import ROOT, Cli
from wheel_files import PLATFORMS, QUIET, RUNNERS, run, unpacked, wheels

pytestmark = [pytest.mark.gate, pytest.mark.needs("wheels", "wine")]

WINDOWS = "windows-x86_64"
ENDED_BY_CTRL_C = 0xC000013A  # the exit code, of which a Unix process keeps 8 bits
SCENARIO = (ROOT / "scenarios/moving_wall.yaml").read_bytes()
LONG = "format: 1\nsolver: {method: rk4, step: 1e-6, max_steps: 1000000000}\ntime: {stop: 1000, log_every: 1}\n"


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return unpacked(WINDOWS, tmp_path_factory.mktemp("windows")) / "bin" / "arm3r.exe"


def compiled(source: str, output: Path) -> Path:
    """A small program for Windows."""
    code = output.with_suffix(".c")
    code.write_text(source)
    command = [wheels.ZIG, "cc", "-target", PLATFORMS[WINDOWS].target, "-municode", code, "-o", output]
    subprocess.run(list(map(str, command)), check=True, capture_output=True)
    return output


def test_names_of_files_are_utf8_and_lines_end_as_on_linux(program: Path, cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "Wand_\u00e4\u6c34.yaml").write_bytes(SCENARIO)
    done = run(WINDOWS, program, "run", "Wand_\u00e4\u6c34.yaml", "-o", "\u00fc\u6c34.csv", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert cli("run", ROOT / "scenarios/moving_wall.yaml", "-o", tmp_path / "native.csv").returncode == 0
    written = (tmp_path / "\u00fc\u6c34.csv").read_bytes()
    assert b"\r" not in written and written == (tmp_path / "native.csv").read_bytes()
    assert b"\r" not in (tmp_path / "\u00fc\u6c34.json").read_bytes() and "\r" not in done.stdout


def test_an_error_names_the_file(program: Path, tmp_path: Path) -> None:
    done = run(WINDOWS, program, "run", "keine_\u00e4.yaml", cwd=tmp_path)
    assert done.returncode == 2 and done.stderr.startswith("keine_\u00e4.yaml: error[file.open]")
    (tmp_path / "folder.yaml").mkdir()
    done = run(WINDOWS, program, "run", "folder.yaml", cwd=tmp_path)
    assert done.returncode == 2 and done.stderr.startswith("folder.yaml: error[file.")


def test_a_file_that_is_there_is_replaced_in_one_step(program: Path, tmp_path: Path) -> None:
    """A reader that has the old file open keeps it, the new one is complete, and nothing else is left."""
    (tmp_path / "s.yaml").write_bytes(SCENARIO)
    (tmp_path / "out.csv").write_text("old")
    with (tmp_path / "out.csv").open() as reader:
        assert run(WINDOWS, program, "run", "s.yaml", "-o", "out.csv", cwd=tmp_path).returncode == 0
        assert reader.read() == "old"
    assert (tmp_path / "out.csv").read_text().startswith("t,")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out.csv", "out.json", "s.yaml"]


SAY = r"""
#include <stdio.h>
#include <wchar.h>
int wmain(int count, wchar_t **words) {
    printf("%s", "NAME");
    for (int i = 1; i < count; ++i) {
        printf(" [");
        for (const wchar_t *c = words[i]; *c; ++c) printf("%04x", *c);
        printf("]");
    }
    printf("\n");
    return 7;
}
"""


def test_other_programs_are_found_beside_it_and_on_the_path(program: Path, tmp_path: Path) -> None:
    """PATH is divided at semicolons, a name has .exe, and the words and the exit code arrive as they are."""
    one, two = tmp_path / "one", tmp_path / "two dir"
    one.mkdir(), two.mkdir()
    compiled(SAY.replace("NAME", "found"), two / "arm3r-hello.exe")
    path = ";".join("Z:" + str(folder).replace("/", "\\") for folder in (one, two))
    words = ["a b", 'quo"te', "back\\", "\u00e4"]
    done = run(WINDOWS, program, "hello", *words, env={"WINEPATH": path})
    expected = " ".join("[" + "".join(f"{ord(c):04x}" for c in word) + "]" for word in words)
    assert (done.returncode, done.stdout.split()) == (7, f"found {expected}".split()), done.stderr
    compiled(SAY.replace("NAME", "beside"), program.with_name("arm3r-hello.exe"))
    assert run(WINDOWS, program, "hello", env={"WINEPATH": path}).stdout.split() == ["beside"]
    program.with_name("arm3r-hello.exe").unlink()
    done = run(WINDOWS, program, "hello")
    assert done.returncode == 2 and "arm3r: error[usage]: " in done.stderr


def test_the_command_starts_the_executable_and_ends_with_its_code(program: Path, tmp_path: Path) -> None:
    """The launcher that pip puts into Scripts, with the package where pip puts it."""
    launcher = next(program.parents[2].glob("*.data/scripts/arm3r.exe"))
    (tmp_path / "Scripts").mkdir()
    (tmp_path / "Lib").mkdir()
    (tmp_path / "Scripts/arm3r.exe").write_bytes(launcher.read_bytes())
    (tmp_path / "Lib/site-packages").symlink_to(program.parents[2])
    done = run(WINDOWS, tmp_path / "Scripts/arm3r.exe", "--version")
    assert done.returncode == 0 and done.stdout == run(WINDOWS, program, "--version").stdout
    assert run(WINDOWS, tmp_path / "Scripts/arm3r.exe", "run", "none.yaml").returncode == 2
    (tmp_path / "Lib/site-packages").unlink()
    done = run(WINDOWS, tmp_path / "Scripts/arm3r.exe", "--version")
    assert done.returncode == 2 and "no package arm3r_cpp is installed" in done.stderr


def test_ctrl_c_ends_a_run_and_leaves_no_file(program: Path, tmp_path: Path) -> None:
    (tmp_path / "long.yaml").write_text(LONG)
    command = [*RUNNERS[WINDOWS], str(program), "run", "long.yaml", "-o", "out.csv"]
    run(WINDOWS, program, "--version")  # wine has started
    process = subprocess.Popen(command, cwd=tmp_path, env={**os.environ, **QUIET}, start_new_session=True)
    time.sleep(5)
    assert process.poll() is None
    process.send_signal(signal.SIGINT)  # which wine hands on as Ctrl-C
    assert process.wait(timeout=600) == ENDED_BY_CTRL_C & 0xFF
    assert [path.name for path in tmp_path.iterdir()] == ["long.yaml"]
