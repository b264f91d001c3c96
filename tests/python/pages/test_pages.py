"""Every block of code of every page runs as it stands, page by page, in an empty folder with the package installed.

Blocks that need the repository, a compiler or the rights of root carry a mark; they run in the gates, in a clone."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import page_runner
import pytest
from conftest import QUICK, ROOT
from page_runner import MARK, blocks_of

PROGRAMS = ROOT / "docs" / "examples.md"  # test_examples.py runs what it shows
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted({*ROOT.glob("docs/*.md")} - {PROGRAMS})]
# Changes of the sources ("diff", "cpp") are made by test_adding_laws.py.
LANGUAGES = {"python", "sh", "console", "yaml", "csv", "c", "matlab", "octave", "diff", "cpp", "xml", "text"}
RUN_BY_NODE = {"docs/webassembly.md": "js"}  # by test_wasm.py
NEEDS_A_CLONE = re.compile(r"\b(make|cmake|g\+\+|gcc|git|apt|sudo|clang-format)\b|(benchmarks|tests|cpp)/")


def is_shown(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def pages_with(**wanted: bool) -> list[Path]:
    (marked,) = wanted.values()
    return [
        page
        for page in PAGES
        if any(block.is_marked == marked and block.language != "diff" for block in blocks_of(page.read_text()))
    ]


def run_page(page: Path, folder: Path, *options: str, **environment: str) -> None:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        [sys.executable, page_runner.__file__, page, *options],
        cwd=folder,
        env={**os.environ, "PATH": path, **environment},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.sample(1)
@pytest.mark.parametrize("page", pages_with(marked=False), ids=is_shown)
def test_a_page_runs_in_an_empty_folder(page: Path, tmp_path: Path) -> None:
    if page.name == "python.md":
        pytest.importorskip("pandas")
        pytest.importorskip("xarray")
    run_page(page, tmp_path)


@pytest.fixture(scope="module")
def clone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("clone")
    subprocess.run(["git", "clone", "-q", ROOT, folder], check=True)
    return folder


@pytest.mark.gate
@pytest.mark.parametrize("page", pages_with(marked=True), ids=is_shown)
def test_marked_blocks_run_in_a_clone(page: Path, clone: Path) -> None:
    options = shlex.join(f"-D{name}={value}" for name, value in QUICK.items())
    run_page(clone / page.relative_to(ROOT), clone, "--clone", CMAKE_ARGS=options)


@pytest.mark.parametrize("page", PAGES, ids=is_shown)
def test_every_block_is_of_a_language_that_is_run_and_marked_where_it_must_be(page: Path) -> None:
    text = page.read_text()
    blocks = blocks_of(text)
    assert {block.language for block in blocks} <= LANGUAGES | {RUN_BY_NODE.get(is_shown(page), "sh")}
    assert text.count(MARK) == sum(block.is_marked for block in blocks) + text.count(f"`{MARK}`")
    for block in blocks:
        needs_a_clone = block.language in ("c", "cpp", "diff") or (
            block.language == "sh" and NEEDS_A_CLONE.search(block.text)
        )
        assert not needs_a_clone or block.is_marked, f"{page.name}:{block.line} needs the mark"


@pytest.mark.gate
@pytest.mark.skipif(not shutil.which("octave"), reason="needs octave")
def test_the_script_for_octave_prints_what_it_says(tmp_path: Path) -> None:
    page = ROOT / "docs/octave.md"
    run_page(page, tmp_path)
    script = (tmp_path / "show_log.m").read_text()
    done = subprocess.run(
        ["octave", "--no-gui", "--norc", "--quiet", "show_log.m"], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    promised = re.findall(r"^fprintf\(.*\); +% (.*)$", script, re.M)
    assert promised and done.stdout.splitlines() == promised


def test_a_block_that_fails_is_found(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    for block in ("```python\nprint(1)  # 2\n```", "```sh\nfalse\ntrue\n```", "```yaml\nformat: 1\nwal: {}\n```"):
        page.write_text(f"{block}\n")
        with pytest.raises(AssertionError, match=r"page\.md:2: this block fails"):
            run_page(page, tmp_path)
    page.write_text(f"{MARK}\n\n```sh\nfalse\n```\n")
    run_page(page, tmp_path)
