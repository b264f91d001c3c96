"""Figures: which there are, what stands on them, and the command that writes them."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import arm3r_cpp as arm3r
import matplotlib
import pytest

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from arm3r_cpp.commands import plot as plot_cli
from conftest import Cli
from matplotlib.figure import Figure

WITHOUT_WALL = {"tip", "velocities", "torques", "energies", "strobe"}
WITH_WALL = WITHOUT_WALL | {"wall", "contact"}
BOUNCE = """
format: 1
wall: {point: [1.74, 0, 0], acts_on_arm: true}
controller: {type: gravity_compensation}
time: {stop: 1}
"""
FALL = "{format: 1, time: {stop: 0.5}}"


@pytest.fixture(autouse=True)
def no_figure_stays_open() -> Iterator[None]:
    yield
    plt.close("all")


@pytest.fixture(scope="module")
def bounce() -> arm3r.Run:
    return arm3r.Scenario(BOUNCE).run()


@pytest.fixture(scope="module")
def fall() -> arm3r.Run:
    return arm3r.Scenario(FALL).run()


@pytest.fixture
def stored(bounce: arm3r.Run, tmp_path: Path) -> Path:
    bounce.to_csv(tmp_path / "bounce.csv")
    return tmp_path / "bounce.csv"


def texts(figure: Figure) -> str:
    return "\n".join(text.get_text() for text in figure.findobj(matplotlib.text.Text))


def legend_covers_data(figure: Figure) -> bool:
    figure.draw_without_rendering()
    boxes = [ax.get_window_extent() for ax in figure.axes]
    legends = [ax.get_legend() for ax in figure.axes if ax.get_legend()] + figure.legends
    return any(legend.get_window_extent().padded(-2).overlaps(box) for legend in legends for box in boxes)


# ---- figures --------------------------------------------------------------------------------------------------------


def test_overview_is_a_figure_with_units(bounce: arm3r.Run) -> None:
    figure = arm3r.plot.overview(bounce)
    assert isinstance(figure, Figure)
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert [label.rsplit(", ")[-1] for label in labels] == ["rad", "m", "N m", "N"]
    assert figure.axes[-1].get_xlabel() == "t, s"


def test_overview_without_a_wall_ends_with_energies(fall: arm3r.Run) -> None:
    assert arm3r.plot.overview(fall).axes[-1].get_ylabel() == "energy, J"


def test_the_lecture_has_its_figures(bounce: arm3r.Run, fall: arm3r.Run) -> None:
    assert set(arm3r.plot.lecture(bounce)) == WITH_WALL
    assert set(arm3r.plot.lecture(fall)) == WITHOUT_WALL


@pytest.mark.parametrize("name", sorted(WITH_WALL - {"strobe"}))
def test_legends_hide_nothing(bounce: arm3r.Run, name: str) -> None:
    assert not legend_covers_data(arm3r.plot.lecture(bounce)[name])


@pytest.mark.parametrize("name", sorted(WITH_WALL))
def test_every_axis_has_its_unit(bounce: arm3r.Run, name: str) -> None:
    for ax in arm3r.plot.lecture(bounce)[name].axes:
        assert ", " in ax.get_ylabel() or ax.get_ylabel() == "contact"


def test_events_are_marked_where_they_were_located(bounce: arm3r.Run) -> None:
    text = texts(arm3r.plot.lecture(bounce)["contact"])
    assert [event.type for event in bounce.events] == ["make", "break"]
    for event in bounce.events:
        assert f"{event.type} at {event.t:.4f} s" in text


def test_a_short_contact_fills_its_figure(bounce: arm3r.Run) -> None:
    make, lost = (event.t for event in bounce.events)
    low, high = arm3r.plot.lecture(bounce)["contact"].axes[0].get_xlim()
    assert low == pytest.approx(make - (lost - make) / 2)
    assert high == pytest.approx(lost + (lost - make) / 2)


def test_the_strobe_names_axes_and_forces(bounce: arm3r.Run) -> None:
    text = texts(arm3r.plot.lecture(bounce)["strobe"])
    for part in ("$q_1$", "$q_2$", "$q_3$", "force on the wall", "force on the tip"):
        assert part in text


def test_the_strobe_draws_an_infinite_wall_in_the_other_convention() -> None:
    scenario = arm3r.Scenario(BOUNCE)
    scenario["wall.size"] = "infinite"
    scenario["wall.normal"] = [0, 0, 1]
    scenario["wall.point"] = [0, 0, -1]
    scenario["arm.convention"] = "slide"
    assert "wall at" in texts(arm3r.plot.lecture(scenario.run())["strobe"])


def test_drawing_changes_no_settings(fall: arm3r.Run) -> None:
    before = dict(matplotlib.rcParams)
    arm3r.plot.overview(fall)
    assert dict(matplotlib.rcParams) == before


def test_matplotlib_is_imported_by_drawing_only(python: Cli) -> None:
    done = python(f"import sys, arm3r_cpp as a; a.plot; a.Scenario({FALL!r}).run(); print('matplotlib' in sys.modules)")
    assert done.stdout.strip() == "False", done.stderr


# ---- arm3r-plot -----------------------------------------------------------------------------------------------------


def test_overview_of_a_csv_into_a_file(stored: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = stored.with_name("figure.pdf")
    assert plot_cli.main([str(stored), "-o", str(target)]) == 0
    assert target.read_bytes().startswith(b"%PDF")
    assert capsys.readouterr().out.splitlines() == [str(target)]


def test_lecture_figures_of_a_csv_into_a_new_folder(stored: Path) -> None:
    out = stored.with_name("figures")
    assert plot_cli.main([str(stored), "--lecture", "-o", str(out), "--format", "svg"]) == 0
    assert {path.name for path in out.iterdir()} == {f"bounce_{name}.svg" for name in WITH_WALL}


def test_a_scenario_is_run_and_drawn_here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "fall.yaml").write_text(FALL)
    monkeypatch.chdir(tmp_path)
    assert plot_cli.main(["fall.yaml"]) == 0
    assert (tmp_path / "fall.png").read_bytes().startswith(b"\x89PNG")


def test_what_there_is_of_a_run_that_failed_is_drawn(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "short.yaml").write_text("{format: 1, solver: {max_steps: 20}, time: {stop: 5}}")
    assert plot_cli.main([str(tmp_path / "short.yaml"), "-o", str(tmp_path)]) == 5
    assert (tmp_path / "short.png").exists()
    assert "max_steps" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["missing.csv"], 2, "missing.csv"),
        (["missing.yaml"], 2, "missing.yaml"),
        (["text.txt"], 2, "text.txt"),
        (["bounce.csv", "-o", "figure.jpg"], 2, "png, pdf, svg"),
        (["bounce.csv", "-o", "figure.png", "--format", "pdf"], 2, "not pdf"),
        (["bounce.csv", "-o", "figure.png", "--lecture"], 2, "folder"),
        (["alone.csv"], 2, "alone.json"),
        (["empty.csv"], 2, "empty.csv"),
        (["wrong.yaml"], 3, "stop"),
        (["bounce.csv", "-o", "bounce.csv/figure.png"], 6, "bounce.csv"),
    ],
)
def test_failures_say_why_and_exit_like_arm3r(
    arguments: list[str],
    code: int,
    words: str,
    stored: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(stored.parent)
    shutil.copy("bounce.csv", "alone.csv")
    Path("empty.csv").touch()
    Path("text.txt").touch()
    Path("wrong.yaml").write_text("format: 1\ntime: {stop: -1}\n")
    assert plot_cli.main(arguments) == code
    error = capsys.readouterr().err
    assert error.startswith("arm3r-plot: ")
    assert words in error


def test_the_installed_command(stored: Path, scripts: Path) -> None:
    done = subprocess.run([scripts / "arm3r-plot", "--help"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0
    assert "--lecture" in done.stdout
    assert subprocess.run([scripts / "arm3r-plot"], capture_output=True, timeout=60).returncode == 2
    plot = [scripts / "arm3r", "plot", stored, "-o", stored.parent]
    done = subprocess.run(plot, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
