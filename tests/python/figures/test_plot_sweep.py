"""Figures of sweeps: which kind for which axes, what stands on them, and the command that writes them."""

from __future__ import annotations

import hashlib
import subprocess
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import pytest
from arm3r_cpp.commands import plot as plot_cli
from arm3r_cpp.plot.sweep_figure import sweep as draw
from arm3r_cpp.plot.sweep_figure import words_of
from matplotlib.figure import Figure

SCENARIO = """\
format: 1
wall: {point: [1.78, 0, 0], acts_on_arm: true}
controller: {type: gravity_compensation}
time: {stop: 1}
"""
METRICS = ["peak_force", "contact_time", "q2"]
STIFFNESS = {"key": "wall.contact.stiffness", "geomspace": [1e2, 1e4, 5]}
POINT = {"key": "wall.point[0]", "linspace": [1.6, 1.8, 3]}  # the nearest one begins inside: invalid
METHOD = {"key": "solver.method", "values": ["rk4", "dopri5"]}


@pytest.fixture
def table(tmp_path: Path) -> Any:
    def make(*axes: dict[str, Any], **keys: Any) -> arm3r.SweepTable:
        (tmp_path / "base.yaml").write_text(SCENARIO)
        given = {"format": 1, "scenario": str(tmp_path / "base.yaml"), "metrics": METRICS, "axes": list(axes), **keys}
        return arm3r.sweep(given, out=tmp_path / "out")

    return make


def legends(figure: Figure) -> set[str]:
    return {text.get_text() for legend in figure.legends for text in legend.get_texts()}


def test_one_axis_is_a_curve(table: Any) -> None:
    figure = draw(table(STIFFNESS))
    (ax,) = figure.axes
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("wall contact stiffness, N/m", "peak force, N")
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "linear")
    (line,) = ax.lines
    assert line.get_xdata().tolist() == pytest.approx([1e2, 316.22776601684, 1e3, 3162.2776601684, 1e4])
    assert (line.get_ydata() > 0).all()
    assert line.get_linestyle() == "-"


def test_listed_values_over_decades_get_a_logarithmic_axis(table: Any) -> None:
    figure = draw(table({"key": "wall.contact.stiffness", "values": [1e2, 1e3, 1e4]}))
    assert figure.axes[0].get_xscale() == "log"


def test_words_tell_lines_apart(table: Any) -> None:
    figure = draw(table(STIFFNESS, METHOD), metric="contact_time", log=True)
    assert legends(figure) == {"solver method = rk4", "solver method = dopri5"}
    assert figure.axes[0].get_yscale() == "log" and figure.axes[0].get_ylabel() == "contact time, s"
    assert len({(line.get_color(), line.get_linestyle()) for line in figure.axes[0].lines}) == 2


def test_lists_are_words_too(table: Any) -> None:
    figure = draw(table(STIFFNESS, {"key": "arm.damping", "values": [[0, 0, 0], [0.1, 0.1, 0.1]]}))
    assert legends(figure) == {"arm damping = [0, 0, 0]", "arm damping = [0.1, 0.1, 0.1]"}


def test_a_grid_of_two_is_a_heat_map_with_failed_runs_marked(table: Any) -> None:
    figure = draw(table(STIFFNESS, POINT))
    ax, bar = figure.axes
    (mesh,) = ax.collections
    assert mesh.get_array().shape == (3, 5) and mesh.get_array().mask.sum() == 5
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "linear")
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("wall contact stiffness, N/m", "wall point x, m")
    assert bar.get_ylabel() == "peak force, N"
    assert legends(figure) == {"invalid: 5"} and len(ax.lines[0].get_xdata()) == 5


def test_the_heat_maps_cells_lie_where_their_runs_are(table: Any) -> None:
    made = table(STIFFNESS, POINT)
    cells = draw(made).axes[0].collections[0].get_array()
    row = (made["wall.contact.stiffness"] == 1e4) & (made["wall.point[0]"] == 1.8)
    assert cells[2, 4] == made["peak_force"][row]


def test_drawn_axes_are_points_a_panel_each(table: Any) -> None:
    axes = {"key": "wall.contact.stiffness", "log_uniform": [1e2, 1e4]}, {"key": "wall.point[0]", "uniform": [1.6, 1.8]}
    figure = draw(table(*axes, mode="random", runs=40))
    assert [ax.get_xlabel() for ax in figure.axes] == ["wall contact stiffness, N/m", "wall point x, m"]
    assert [ax.get_xscale() for ax in figure.axes] == ["log", "linear"]
    assert figure.axes[0].lines[0].get_linestyle() == "None"
    assert any(text.startswith("invalid: ") for text in legends(figure))


def test_words_alone_stand_along_the_axis(table: Any) -> None:
    figure = draw(table(METHOD), metric="q2")
    assert figure.axes[0].get_xlabel() == "solver method"
    figure.draw_without_rendering()
    assert {label.get_text() for label in figure.axes[0].get_xticklabels()} == {"rk4", "dopri5"}


def test_the_legend_covers_no_data(table: Any) -> None:
    figure = draw(table(STIFFNESS, METHOD))
    figure.draw_without_rendering()
    box = figure.axes[0].get_window_extent()
    assert figure.legends and not any(legend.get_window_extent().padded(-2).overlaps(box) for legend in figure.legends)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"metric": "peak_forc"}, "peak_force"),
        ({"metric": "q2", "log": True}, "above 0"),
        ({"metric": "outcome"}, "kept"),
    ],
)
def test_what_cannot_be_drawn_is_said(table: Any, options: dict[str, Any], words: str) -> None:
    with pytest.raises(arm3r.UsageError, match=words):
        draw(table(STIFFNESS, {"key": "initial.q[1]", "values": [-0.5]}), **options)


LIMIT = {"key": "arm.torque_limit[0]", "values": [1, float("inf"), 5]}


@pytest.mark.parametrize("other", [[], [{"key": "time.stop", "values": [0.5, 1]}]])
def test_infinite_values_are_words(table: Any, other: list[dict[str, Any]], tmp_path: Path) -> None:
    figure = draw(table(LIMIT, *other), metric="q2")
    figure.savefig(tmp_path / "figure.png")
    shown = legends(figure) | {label.get_text() for label in figure.axes[0].get_xticklabels()}
    assert any("inf" in text for text in shown)


def test_a_sweep_that_kept_nothing_is_not_drawn(tmp_path: Path) -> None:
    plan = {"format": 1, "scenario": {}, "axes": [{"key": "time.stop", "values": [0]}], "metrics": ["outcome"]}
    with pytest.raises(arm3r.UsageError, match="kept no metric"):
        draw(arm3r.sweep(plan, out=tmp_path / "out"))


@pytest.mark.parametrize(
    ("key", "unit", "words"),
    [
        ("wall.contact.stiffness", "N/m", "wall contact stiffness"),
        ("wall.point[2]", "m", "wall point z"),
        ("wall.motion.velocity[1]", "m/s", "wall motion velocity y"),
        ("initial.q[1]", "rad", "initial q 2"),
        ("peak_force", "N", "peak force"),
    ],
)
def test_keys_become_words(key: str, unit: str, words: str) -> None:
    assert words_of(key, unit) == words


def test_a_figure_names_its_table(table: Any, tmp_path: Path) -> None:
    made = table(STIFFNESS)
    figure = draw(made, stamp=True)
    digest = hashlib.sha256(made.path.read_bytes()).hexdigest()
    (stamp,) = (text.get_text() for text in figure.texts)
    assert stamp.replace("\n", ", ") == f"scenario base, convention simscape, hash sha256:{digest}"
    figure.savefig(tmp_path / "figure.svg")
    assert digest in (tmp_path / "figure.svg").read_text()


# ---- the command ----------------------------------------------------------------------------------------------------


@pytest.mark.sample(1)
@pytest.mark.parametrize("suffix", ["png", "pdf", "svg"])
def test_the_command_writes_a_file(table: Any, tmp_path: Path, scripts: Path, suffix: str) -> None:
    folder, out = table(STIFFNESS).folder, tmp_path / f"figure.{suffix}"
    call = [scripts / "arm3r-plot", "sweep", folder, "-o", out, "--metric", "contact_time", "--log"]
    done = subprocess.run(call, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, f"{out}\n"), done.stderr
    assert out.stat().st_size > 5000


def test_exit_codes(table: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = str(table(STIFFNESS).folder)
    assert plot_cli.main(["sweep", str(tmp_path), "-o", str(tmp_path / "a.png")]) == 2
    assert "sweep.json" in capsys.readouterr().err
    assert plot_cli.main(["sweep", folder, "-o", str(tmp_path / "a.gif")]) == 2
    assert plot_cli.main(["sweep", folder, "-o", "/proc/nowhere/a.png"]) == 6
    assert plot_cli.main(["sweep", folder, "-o", str(tmp_path / "a.png"), "--metric", "x"]) == 2


def test_a_full_stdout_is_exit_6(table: Any, tmp_path: Path, scripts: Path) -> None:
    with open("/dev/full", "w") as full:
        call = [scripts / "arm3r-plot", "sweep", table(STIFFNESS).folder, "-o", tmp_path / "a.png"]
        done = subprocess.run(call, stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 6 and done.stderr.startswith("arm3r-plot: standard output cannot be written")
