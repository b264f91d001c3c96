"""The small programs of examples/ are built, run, and print what their page says."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

from conftest import script


def test_the_page_shows_the_programs_and_what_they_print(scripts: Path, package: Path, tmp_path: Path) -> None:
    pages = script("tools/example_page.py")
    environment = {**os.environ, "PATH": f"{scripts}{os.pathsep}{os.environ['PATH']}"}

    def run(*command: object) -> str:
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, env=environment, timeout=600)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    run("cmake", "-S", pages.ROOT / "examples", "-B", tmp_path, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={package}")
    run("cmake", "--build", tmp_path)
    printed = {one: run(*pages.command(one, tmp_path)) for one in pages.programs()}
    assert len(printed) == 11
    hint = "`python tools/example_page.py FOLDER` writes the page"
    assert pages.page(printed) == pages.PAGE.read_text(), hint
