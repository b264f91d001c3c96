"""Five visitors: each types what README and the pages behind it show, in an empty folder, and gets what they want."""

from __future__ import annotations

import os
import re
import shlex
import signal
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest
from arm3r_cpp.live.page import FOLDER
from conftest import ROOT
from page_runner import blocks_of
from wheel_files import wheel

README = (ROOT / "README.md").read_text()
LINKED = [ROOT / target for target in re.findall(r"\]\((docs/\w+\.md)\)", README)]
INSTALL = "python -m pip install arm3r_cpp-*.whl"
HAS_PAGE = (FOLDER / "live.html").is_file()


class Visitor:
    """Somebody in an empty folder, who types only what is shown."""

    def __init__(self, folder: Path, programs: Path) -> None:
        self.folder, self.typed = folder, [INSTALL]
        path = f"{programs}{os.pathsep}{os.environ['PATH']}"
        self.environment = {**os.environ, "PATH": path, "BROWSER": "true"}

    def types(self, command: str) -> str:
        """What a command prints, which README or a page that it links shows."""
        assert any(command in page for page in (README, *(path.read_text() for path in LINKED))), command
        self.typed.append(command)
        done = subprocess.run(
            command, shell=True, cwd=self.folder, env=self.environment, capture_output=True, text=True, timeout=300
        )
        assert done.returncode in (0, 11), done.stderr
        return done.stdout

    def serves(self, command: str) -> Iterator[str]:
        """The address that a command serves until it is stopped."""
        assert command in README
        self.typed.append(command)
        with subprocess.Popen(
            shlex.split(command), cwd=self.folder, env=self.environment, stdout=subprocess.PIPE, text=True
        ) as served:
            assert served.stdout
            yield next(found[0] for line in served.stdout if (found := re.search(r"http://\S+", line)))
            served.send_signal(signal.SIGINT)


@pytest.fixture(params=["installed", pytest.param("wheel", marks=[pytest.mark.gate, pytest.mark.needs("wheels")])])
def visitor(request: pytest.FixtureRequest, tmp_path: Path) -> Visitor:
    """In the environment of the tests, or in a new one that has nothing but the wheel."""
    programs = Path(sys.executable).parent
    if request.param == "wheel":
        python = sys.executable if sys.prefix == sys.base_prefix else f"{sys.base_prefix}/bin/python3"
        subprocess.run([python, "-m", "venv", tmp_path / "arm"], check=True)
        programs = tmp_path / "arm/bin"
        subprocess.run([programs / "python", "-m", "pip", "install", "-q", wheel("linux-x86_64")], check=True)
    (tmp_path / "empty").mkdir()
    return Visitor(tmp_path / "empty", programs)


def test_the_file_to_install_is_what_the_install_page_names_first() -> None:
    page = (ROOT / "docs/install.md").read_text()
    assert "docs/install.md" in README and f"## From a wheel\n\n`{INSTALL}`" in page


def test_the_readme_is_one_page() -> None:
    assert len(README.splitlines()) <= 120
    film = ROOT / "docs/images/first_ten_seconds.gif"
    assert film.stat().st_size < 1e6 and f"]({film.relative_to(ROOT)})" in README


def test_a_student_comes_to_the_named_term_in_three_commands(visitor: Visitor) -> None:
    (formula,) = [block for block in blocks_of(README) if block.language == "matlab"]
    (visitor.folder / "my_gravity.m").write_text(formula.text)
    said = visitor.types("arm3r verify my_gravity.m")
    assert "t3 reads -1/2 m3 g a3 C2, should be -1/2 m3 g a3 C23" in said and "line 4" in said
    assert len(visitor.typed) <= 3


def test_a_teacher_comes_to_marks_in_five_commands(visitor: Visitor) -> None:
    assert "gravity_constant" in visitor.types("arm3r exercise list")
    visitor.types("arm3r exercise show gravity_constant")
    for name in ("anna", "ben"):  # what two students hand in
        (visitor.folder / "FOLDER" / name).mkdir(parents=True)
        law = "{type: gravity_compensation}" if name == "anna" else "{type: gravity_compensation, gravity: 9.81}"
        (visitor.folder / f"FOLDER/{name}/gravity_constant.yaml").write_text(f"format: 1\ncontroller: {law}\n")
    visitor.types("arm3r exercise mark FOLDER -o marks.csv")
    rows = (visitor.folder / "marks.csv").read_text().splitlines()
    assert any(row.startswith("anna,gravity_constant,right") for row in rows)
    assert any(row.startswith("ben,gravity_constant,wrong") for row in rows)
    assert len(visitor.typed) <= 5


def test_a_researcher_comes_to_a_figure_and_its_bound_in_four_commands(visitor: Visitor) -> None:
    visitor.types("arm3r examples --copy scenarios")
    said = visitor.types("arm3r run scenarios/force_control/hybrid_first_contact.yaml --trust -o press.csv")
    assert "closed form 20.0004463 N  apart by 0.00045, allowed  0.00045" in said and "joint angles right to" in said
    visitor.types("arm3r-plot press.csv -o figures/")
    assert list((visitor.folder / "figures").glob("*.png"))
    assert len(visitor.typed) <= 4


def test_an_engineer_comes_to_a_map_of_delay_and_damping_in_four_commands(visitor: Visitor) -> None:
    visitor.types("arm3r examples --copy scenarios")
    said = visitor.types("arm3r-sweep scenarios/sweeps/delay_and_damping.yaml -o out/sweep")
    assert "273 runs" in said
    visitor.types("arm3r-plot sweep out/sweep -o map.png --metric force_error_rms --log")
    assert (visitor.folder / "map.png").read_bytes().startswith(b"\x89PNG")
    assert len(visitor.typed) <= 4


@pytest.mark.skipif(not HAS_PAGE, reason="the page is not built: make page")
def test_a_reader_comes_to_the_bounce_in_the_page_in_two_commands(visitor: Visitor) -> None:
    for address in visitor.serves("arm3r live contact/restitution"):
        page = urllib.request.urlopen(address, timeout=30).read().decode()
        assert "hunt_crossley" in page
    assert len(visitor.typed) <= 2
