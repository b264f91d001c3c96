"""The index of the scenarios, their names, and their convention."""

from __future__ import annotations

import re
from pathlib import Path
from types import ModuleType

import arm3r_cpp as arm3r
import pytest
from conftest import scenario_files, script

ABOUT_THE_CONVENTION = {"slide_convention"}
MOST_BYTES = 10_000


@pytest.fixture(scope="module")
def index() -> ModuleType:
    """tools/scenario_index.py"""
    return script("tools/scenario_index.py")


def test_the_page_has_every_scenario_and_sweep_and_no_other(index: ModuleType) -> None:
    """The page as the script would write it now."""
    text, now = index.PAGE.read_text(), index.page()
    named, there = (set(re.findall(r"^\[`(\S+)`\]", page, re.MULTILINE)) for page in (text, now))
    hint = "`python tools/scenario_index.py` writes the page"
    assert there == {path.relative_to(index.SCENARIOS).as_posix() for path in index.SCENARIOS.rglob("*.yaml")}
    assert named == there, f"missing: {there - named}, not there: {named - there}; {hint}"
    assert text == now, hint


def test_every_scenario_has_a_small_picture_and_no_picture_is_left_over(index: ModuleType) -> None:
    wanted = {index.picture_of(path).name for path in scenario_files()}
    there = {path.name for path in index.PICTURES.iterdir()}
    assert there == wanted, f"missing: {wanted - there}, left over: {there - wanted}; run tools/scenario_index.py"
    for path in index.PICTURES.iterdir():
        assert path.read_bytes().startswith(b"\x89PNG") and path.stat().st_size < MOST_BYTES, path


def test_choices_of_the_pictures_name_scenarios(index: ModuleType) -> None:
    names = {path.stem for path in scenario_files()}
    assert set(index.CURVES) <= names and set(index.WINDOWS) <= names
    assert set(index.TITLES) == {path.parent.name for path in index.files()}


@pytest.mark.parametrize("name", ["plate_edge", "stiff_wall"])
def test_a_picture_is_drawn(index: ModuleType, name: str) -> None:
    """One of a whole run, one of a part of a run."""
    (path,) = (path for path in scenario_files() if path.stem == name)
    assert 1_000 < len(index.draw(path)) < MOST_BYTES


@pytest.mark.parametrize("path", scenario_files(), ids=lambda path: path.stem)
def test_names_and_first_sentences_say_what_is_shown(index: ModuleType, path: Path) -> None:
    """A name of words, with numbers in those of the lecture and of robots; a sentence of its own for each."""
    patterns = {"lecture": r"\d\d_[a-z_]+", "robots": r"[a-z]+(\d+e?)?(_[a-z]+)+"}
    assert re.fullmatch(patterns.get(path.parent.name, r"[a-z]{2,}(_[a-z]+)*"), path.stem)
    line = index.summary(path)
    assert line[-1] in ".:" and 20 < len(line) < 140
    assert not re.search(r"\b[BCXbcx]\d+[a-e]?\b", path.read_text()), "an id that is explained nowhere"
    assert [other for other in scenario_files() if index.summary(other) == line] == [path]


@pytest.mark.parametrize("path", scenario_files(), ids=lambda path: path.stem)
def test_one_convention_where_the_convention_is_not_the_subject(path: Path) -> None:
    """Real robots keep the angles of their files."""
    usual = "urdf" if path.parent.name == "robots" else "simscape"
    expected = "slide" if path.stem in ABOUT_THE_CONVENTION else usual
    assert arm3r.Scenario.load(path)["arm.convention"] == expected
