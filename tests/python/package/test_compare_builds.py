"""benchmarks/compare_builds.py: the installed build beside itself is the same, and what is changed is reported."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

COLUMN = "moving_wall.yaml by rk4: column q2, rad"


@pytest.fixture
def benchmark(root: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], ModuleType]:
    """benchmark(name): a module of benchmarks/, whose modules import each other by their bare names."""
    monkeypatch.syspath_prepend(root / "benchmarks")
    return import_module


@pytest.fixture
def collected(benchmark, root: Path) -> list[dict[str, str]]:
    """The results of two scenarios, twice."""
    results = benchmark("build_results").scenario_results
    paths = [root / "scenarios" / name for name in ("moving_wall.yaml", "lecture/12_wall_acts_on_arm.yaml")]
    return [dict(pair for path in paths for pair in results(path, ("rk4",))) for _ in range(2)]


def test_a_build_is_the_same_as_itself(benchmark, collected, capsys: pytest.CaptureFixture[str]) -> None:
    before, after = collected
    assert COLUMN in before and "moving_wall.yaml as it is: summary.events[0].t" in before
    assert not benchmark("compare_builds").report(before, after)
    assert f"{len(before)} results compared, 0 differ" in capsys.readouterr().out


def test_a_changed_column_is_reported(benchmark, collected, capsys: pytest.CaptureFixture[str]) -> None:
    before, after = collected
    after[COLUMN] = "other bits"
    assert benchmark("compare_builds").report(before, after)
    assert f"differs: {COLUMN}\n    old: {before[COLUMN]}\n    new: other bits\n" in capsys.readouterr().out


def test_the_last_bit_of_a_column_changes_its_hash(benchmark) -> None:
    digest = benchmark("build_results").digest
    column = np.linspace(0.1, 0.7, 5)
    other = column.copy()
    other[3] = np.nextafter(other[3], 1)
    assert digest(column) == digest(column.copy()) != digest(other)


def test_the_functions_of_an_arm_are_results(benchmark) -> None:
    answers = dict(benchmark("build_results").arm_functions())
    assert {"Arm.mass_matrix", "Arm.jacobian", "Arm.points"} <= set(answers) and "Arm.from_urdf" not in answers


def test_the_first_line_that_differs_of_a_page_is_shown(benchmark, capsys: pytest.CaptureFixture[str]) -> None:
    assert benchmark("compare_builds").report({"page": "one\ntwo\nthree"}, {"page": "one\nzwei\ndrei"})
    assert "    old: two\n    new: zwei\n" in capsys.readouterr().out


def test_no_page_depends_on_the_folder_of_the_build(benchmark) -> None:
    surface = benchmark("build_surface")
    pages = dict(surface.pages())
    assert "PACKAGE" in pages["page: arm3r template"]
    assert [name for name, text in pages.items() if str(surface.PACKAGE) in text] == []


def test_what_only_one_build_has_is_named_and_no_difference(benchmark, capsys: pytest.CaptureFixture[str]) -> None:
    assert not benchmark("compare_builds").report({"a: old": "1", "b": "2"}, {"b": "2", "a: new": "3", "c: new": "4"})
    printed = capsys.readouterr().out
    assert "only the old build has: old (1 times)" in printed
    assert "only the new build has: new (2 times)" in printed


@pytest.mark.parametrize("after, more", [(1004, False), (1006, True), (500, False)])
def test_a_job_may_take_half_a_percent_more(benchmark, after: float, more: bool) -> None:
    assert benchmark("compare_builds").report_instructions({"step": 1000}, {"step": after}) == more


def test_every_job_that_is_counted_runs(benchmark) -> None:
    for job in benchmark("instruction_jobs").JOBS.values():
        job.do(2)


def test_every_broken_scenario_is_refused_by_python_and_by_the_executable(benchmark) -> None:
    surface = benchmark("build_surface")
    said = dict(surface.messages())
    assert len(said) == 2 * len(surface.BROKEN)
    for name, text in said.items():
        if name.endswith("in Python"):
            assert "broken.yaml:" in text, name
        else:
            assert "exit code 0" not in text and "<stdin>:" in text, name


def test_counts_by_two_versions_of_python_are_called_so(benchmark) -> None:
    note = benchmark("compare_builds").other_python
    assert note("3.11.2\n", "3.11.2\n") == ""
    assert "3.11.2 before, 3.11.7 after" in note("3.11.2\n", "3.11.7\n")
