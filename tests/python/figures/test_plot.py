"""Figures: which there are, what stands on them, and the command that writes them."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import arm3r_cpp as arm3r
import matplotlib
import numpy as np
import pytest
from arm3r_cpp.commands import plot as plot_cli
from arm3r_cpp.core.arm_line import arm_line
from arm3r_cpp.plot import style
from arm3r_cpp.plot.force_run import ForceRun
from conftest import Cli, scenario_files
from elbow_arms import WITH_OFFSETS, random_elbow_scenario, scenario_of
from elbow_truth import Truth
from figure_faults import crowded
from matplotlib.colors import same_color
from matplotlib.figure import Figure
from PIL import Image
from random_scenarios import sample_seed, yaml_of

WITHOUT_WALL = {"tip", "velocities", "torques", "energies", "strobe"}
WITH_WALL = WITHOUT_WALL | {"wall", "contact"}
BOUNCE = """
format: 1
wall: {point: [1.74, 0, 0], acts_on_arm: true}
controller: {type: gravity_compensation}
time: {stop: 1}
"""
FALL = "{format: 1, time: {stop: 0.5}}"


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
    assert [label.rsplit(", ")[-1] for label in labels] == ["deg", "mm", "mm", "mm", "N m", "N", "N"]
    assert figure.axes[-2].get_xlabel() == "t, s"
    assert figure.axes[-1].get_xlabel().startswith("time since the first contact, ")


def test_overview_without_a_wall_ends_with_energies(fall: arm3r.Run) -> None:
    assert arm3r.plot.overview(fall).axes[-1].get_ylabel() == "energy, J"


def test_the_lecture_has_its_figures(bounce: arm3r.Run, fall: arm3r.Run) -> None:
    for run, names in ((bounce, WITH_WALL), (fall, WITHOUT_WALL)):
        with pytest.raises(arm3r.UsageError, match="there are ") as told:
            arm3r.plot.lecture(run, panels=["none"])
        assert set(str(told.value).partition("there are ")[2].split(", ")) == names
    assert list(arm3r.plot.lecture(fall)) == ["tip", "velocities", "torques", "energies", "strobe"]


@pytest.mark.parametrize("name", sorted(WITH_WALL - {"strobe"}))
def test_legends_hide_nothing(bounce: arm3r.Run, name: str) -> None:
    assert not legend_covers_data(arm3r.plot.lecture(bounce, panels=[name])[name])


@pytest.mark.parametrize("name", sorted(WITH_WALL))
def test_every_axis_has_its_unit(bounce: arm3r.Run, name: str) -> None:
    for ax in arm3r.plot.lecture(bounce, panels=[name])[name].axes:
        assert ", " in ax.get_ylabel() or ax.get_ylabel() == "contact"


def test_events_are_marked_where_they_were_located(bounce: arm3r.Run) -> None:
    text = texts(arm3r.plot.lecture(bounce, panels=["contact"])["contact"])
    assert [event.type for event in bounce.events] == ["make", "break"]
    for event in bounce.events:
        assert f"{'contact begins' if event.type == 'make' else 'ends'} at {event.t:.4f} s" in text


def test_a_short_contact_fills_its_figure(bounce: arm3r.Run) -> None:
    make, lost = (event.t for event in bounce.events)
    low, high = arm3r.plot.lecture(bounce, panels=["contact"])["contact"].axes[0].get_xlim()
    assert low == pytest.approx(make - (lost - make) / 2)
    assert high == pytest.approx(lost + (lost - make) / 2)


def test_the_figure_of_a_contact_ends_with_the_run(bounce: arm3r.Run) -> None:
    cut = bounce.events[0].t + 0.01  # while there is contact
    scenario = arm3r.Scenario(BOUNCE)
    scenario["time.stop"] = cut
    figure = arm3r.plot.lecture(scenario.run(), panels=["contact"])["contact"]
    assert figure.axes[0].get_xlim()[1] == pytest.approx(cut)


def test_the_strobe_names_axes_and_forces(bounce: arm3r.Run) -> None:
    text = texts(arm3r.plot.lecture(bounce, panels=["strobe"])["strobe"])
    for part in ("$q_1$", "$q_2$", "$q_3$", "force on the wall", "force on the tip"):
        assert part in text


def test_the_strobe_names_the_axes_of_an_elbow_arm_where_they_are() -> None:
    run = scenario_of(WITH_OFFSETS, initial={"q": [0.4, -0.7, 1.1]}, time={"stop": 0.1}).run()
    ax = arm3r.plot.lecture(run, panels=["strobe"])["strobe"].axes[0]
    frames = Truth(WITH_OFFSETS).frames(run["q"][-1])
    reach = scenario_of(WITH_OFFSETS, initial={"q": [0, 0, 0]}).arm.reach
    names = {text.get_text(): text.get_position_3d() for text in ax.texts}
    for name, origin, axis in zip(("$q_1$", "$q_2$", "$q_3$"), frames.origins[1:], frames.axes, strict=True):
        assert names[name] == pytest.approx(origin + 0.4 * reach * axis)
    last = [line.get_data_3d() for line in ax.lines if line.get_lw() == 4 and same_color(line.get_color(), style.ARM)]
    assert np.transpose(last[-1])[[0, 1, 3]] == pytest.approx(np.array(frames.origins[1:]))


def test_arms_are_drawn_through_the_points_in_which_they_bend() -> None:
    """The truth's joints and tip are among them, and no two neighbours are one."""
    for number in range(30):
        keys = random_elbow_scenario(np.random.default_rng([sample_seed(), number]))
        arm, truth = arm3r.Scenario(yaml_of(keys)).arm, Truth(keys["arm"])
        q = np.random.default_rng(number).uniform(-4, 4, (5, 3))
        (points, joints), told = arm_line(arm, q), f"seed {sample_seed()}, scenario {number}"
        _, (_, base, shoulder, elbow), _ = truth.frames(q)
        expected = [base, shoulder, elbow, truth.tip_position(q)]
        assert points[:, [0, *joints, -1]] == pytest.approx(np.stack(expected, axis=1), abs=1e-12), told
        lengths = np.linalg.norm(np.diff(points, axis=1), axis=2)
        assert lengths.min() > 1e-9 and np.ptp(lengths, axis=0).max() < 1e-12, told


def test_every_peak_has_the_instant_of_the_summary(bounce: arm3r.Run) -> None:
    """Not that of a row: the largest force lies between two of them."""
    force, t = bounce.summary["peak_force"], bounce.summary["metrics"]["peak_force_time"]
    assert np.abs(bounce.t - t).min() > 1e-4
    drawn = [*arm3r.plot.lecture(bounce, panels=["strobe"]).values()]
    drawn += [arm3r.plot.overview(bounce, panels=["first_contact"]), arm3r.plot.force(bounce, panels=["force"])]
    for figure in drawn:
        found = re.findall(r"peak (\S+) N,? (?:at|t =) (\S+)", texts(figure))
        assert found == [(f"{force:.4g}", f"{t:.4f}")]


def test_a_colour_means_the_same_in_figures_and_on_the_page(root: Path) -> None:
    text = (root / "web" / "page" / "src" / "app" / "colours.js").read_text()
    page = dict(re.findall(r"^export const (\w+) = (\"#\w+\"|[A-Z]+);", text, re.M))
    ours = {name: getattr(style, name) for name in page}
    assert {"ARM", "TIP", "WALL", "ON_WALL", "ON_TIP", "REFERENCE", "MEASURED"} < set(page)
    assert {name: page.get(value, value).strip('"') for name, value in page.items()} == ours
    assert re.search(r"JOINTS = \[(.*)\]", text)[1].split(", ") == ["BLUE", "RED", "GREEN"]  # type: ignore[index]
    assert [look["color"] for look in style.TRIPLE] == [style.BLUE, style.RED, style.GREEN]
    others = [path for path in (root / "web" / "page").glob("s*/**/*.*s*") if path.name != "colours.js"]
    forces = re.compile(f"{style.WALL}|{style.ON_WALL}|{style.ON_TIP}", re.I)
    assert [path.name for path in others if forces.search(path.read_text())] == []


def test_the_strobe_has_the_colours_of_the_forces(bounce: arm3r.Run) -> None:
    (legend,) = arm3r.plot.lecture(bounce, panels=["strobe"])["strobe"].legends
    entries = zip(legend.legend_handles, legend.get_texts(), strict=True)
    found = {text.get_text().partition(",")[0]: handle for handle, text in entries if handle is not None}
    for word, colour in (("force on the wall", style.ON_WALL), ("force on the tip", style.ON_TIP)):
        assert same_color(found[word].get_color(), colour)


@pytest.mark.parametrize(
    ("pose", "degrees", "unit"),
    [("[0, -30 deg, 1]", None, "deg"), ("[0, -0.5, 1]", None, "rad"), ("[0, -0.5, 1]", True, "deg"),
     ("[0, 45.3 deg, 1]", False, "rad"), ("[0, 0, 0]", None, "rad")],
)  # fmt: skip
def test_angles_are_in_the_unit_of_the_scenario(pose: str, degrees: bool | None, unit: str) -> None:
    run = arm3r.Scenario(f"{{format: 1, initial: {{q: {pose}}}, time: {{stop: 0.1}}}}").run()
    ax = arm3r.plot.overview(run, panels=["angles"], degrees=degrees).axes[0]
    assert ax.get_ylabel() == f"joint angle, {unit}"
    assert ax.lines[2].get_ydata() == pytest.approx(np.degrees(run["q3"]) if unit == "deg" else run["q3"])


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0, "0"), (-2.5e-6, r"−2.5$\cdot$10$^{-6}$"), (3e7, r"3$\cdot$10$^{7}$"), (-0.0005, "−0.0005")],
)
def test_small_numbers_have_their_power_of_ten(value: float, text: str) -> None:
    assert style.in_full(value) == text


def test_a_measurement_is_drawn_in_the_unit_of_the_run(fall: arm3r.Run) -> None:
    log = {"t": fall.t, "q1": fall["q1"], "qd2": fall["qd2"], "tau1": fall["tau1"]}
    for degrees, unit, factor in ((None, "deg", np.degrees(1)), (False, "rad", 1.0)):
        figure = arm3r.plot.measured(log, [fall], degrees=degrees)
        names = [f"joint angle, {unit}", f"joint rate, {unit}/s", "torque, N m"]
        assert [ax.get_ylabel() for ax in figure.axes] == names
        for line in figure.axes[1].lines[:2]:
            assert line.get_ydata() == pytest.approx(factor * fall["qd2"])


def test_an_option_chooses_degrees(stored: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for option, unit in (("--degrees", "deg"), ("--radians", "rad")):
        out = tmp_path / f"{unit}.svg"
        assert plot_cli.main([str(stored), "--panels", "angles", option, "-o", str(out)]) == 0
        assert f"<!-- joint angle, {unit} -->" in out.read_text()
    assert plot_cli.main([str(stored), "--lecture", "--degrees", "-o", str(tmp_path)]) == 2
    assert "--degrees: the lecture's figures show no joint angles" in capsys.readouterr().err


def test_the_strobe_draws_an_infinite_wall_in_the_other_convention() -> None:
    scenario = arm3r.Scenario(BOUNCE)
    scenario["wall.size"] = "infinite"
    scenario["wall.normal"] = [0, 0, 1]
    scenario["wall.point"] = [0, 0, -1]
    scenario["arm.convention"] = "slide"
    assert "wall at" in texts(arm3r.plot.lecture(scenario.run(), panels=["strobe"])["strobe"])


def test_drawing_changes_no_settings(fall: arm3r.Run) -> None:
    before = dict(matplotlib.rcParams)
    arm3r.plot.overview(fall)
    assert dict(matplotlib.rcParams) == before


def test_matplotlib_is_imported_by_drawing_only(python: Cli) -> None:
    done = python(f"import sys, arm3r_cpp as a; a.plot; a.Scenario({FALL!r}).run(); print('matplotlib' in sys.modules)")
    assert done.stdout.strip() == "False", done.stderr


# ---- the user's own figures -----------------------------------------------------------------------------------------


def test_drawing_leaves_pyplot_to_the_user(bounce: arm3r.Run) -> None:
    import matplotlib.pyplot as plt

    own = plt.figure()
    arm3r.plot.overview(bounce, panels=["tip"])
    arm3r.plot.force(bounce, panels=["force"])
    arm3r.plot.compare([bounce, bounce], panels=["table"])
    arm3r.plot.lecture(bounce, panels=["tip", "strobe"])
    assert plt.gcf() is own and plt.get_fignums() == [own.number]
    plt.close(own)


def test_drawing_does_without_pyplot(python: Cli) -> None:
    code = f"""
import sys, arm3r_cpp as arm3r
run = arm3r.Scenario({FALL!r}).run()
arm3r.plot.overview(run).savefig("/dev/null", format="png")
print("matplotlib.pyplot" in sys.modules)"""
    assert python(code).stdout.strip() == "False"


WINDOWS = """
from matplotlib._pylab_helpers import Gcf
from matplotlib.backend_bases import FigureManagerBase
from matplotlib.backends.backend_agg import FigureCanvasAgg

class FigureManager(FigureManagerBase):
    def show(self):
        print("window", self.num)
    @classmethod
    def start_main_loop(cls):
        print("waits for", len(Gcf.figs))

class FigureCanvas(FigureCanvasAgg):
    manager_class = FigureManager
"""


def test_windows_open_and_are_waited_for(python: Cli, tmp_path: Path) -> None:
    """With a backend that tells what it is asked for in place of a screen."""
    (tmp_path / "windows.py").write_text(WINDOWS)
    code = f"""
import arm3r_cpp as arm3r, matplotlib.pyplot as plt
run = arm3r.Scenario({FALL!r}).run()
one, two = arm3r.plot.overview(run, panels=["tip"]), arm3r.plot.overview(run, panels=["angles"])
plt.show()
print("nothing so far")
arm3r.plot.show(one, two)
arm3r.plot.show(one)
one.savefig("/dev/null", format="png")
print(plt.get_fignums())"""
    done = python(code, MPLBACKEND="module://windows", PYTHONPATH=str(tmp_path))
    told = ["nothing so far", "window 1", "window 2", "waits for 2", "window 1", "waits for 1", "[]"]
    assert done.stdout.splitlines()[-len(told) :] == told, done.stderr
    assert "window" not in "".join(done.stdout.splitlines()[: -len(told)])


def test_without_a_screen_it_says_what_to_do(python: Cli) -> None:
    code = f"import arm3r_cpp as a; r = a.Scenario({FALL!r}).run(); a.plot.show(a.plot.overview(r, panels=['tip']))"
    done = python(code, MPLBACKEND="agg")
    assert "backend here is agg, which has no windows; save the figure instead: figure.savefig" in done.stderr


# ---- what a file says -----------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def origin(bounce: arm3r.Run) -> str:
    return f"scenario {bounce.summary['name']}, convention simscape, hash {bounce.summary['hash']}"


@pytest.fixture(scope="module")
def figures(bounce: arm3r.Run) -> list[Figure]:
    drawn = [arm3r.plot.overview(bounce, panels=["tip"]), arm3r.plot.force(bounce, panels=["force"])]
    return [*drawn, *arm3r.plot.lecture(bounce, panels=["tip", "strobe"]).values()]


def test_a_png_names_its_run(figures: list[Figure], origin: str, tmp_path: Path) -> None:
    for figure in figures:
        figure.savefig(tmp_path / "figure.png", dpi=30)
        with Image.open(tmp_path / "figure.png") as picture:
            assert picture.text["Description"] == origin


def test_an_svg_names_its_run(figures: list[Figure], origin: str, tmp_path: Path) -> None:
    figures[0].savefig(tmp_path / "figure.svg", metadata={"Rights": "mine"})
    text = (tmp_path / "figure.svg").read_text()
    assert f"<dc:description>{origin}</dc:description>" in text
    assert "mine" in text and "<dc:date>" not in text


def test_a_pdf_names_its_run_and_has_fonts_that_journals_take(
    figures: list[Figure], bounce: arm3r.Run, tmp_path: Path
) -> None:
    for figure in figures:
        figure.savefig(tmp_path / "figure.pdf")
        data = (tmp_path / "figure.pdf").read_bytes()
        assert b"/Type3" not in data
        assert b"/FontFile2" in data  # TrueType
        assert b"convention simscape" in data and bounce.summary["hash"].encode() in data


def test_other_formats_are_written_too(figures: list[Figure], tmp_path: Path) -> None:
    figures[0].savefig(tmp_path / "figure.eps")
    assert b"/FontType 42" in (tmp_path / "figure.eps").read_bytes()


# ---- the figures of the scenarios that come with it -----------------------------------------------------------------


def run_of(path: Path) -> arm3r.Run:
    scenario = arm3r.Scenario.load(path)
    scenario["checks"] = []
    return scenario.run()


def referee(path: Path) -> None:
    """The figure of a scenario has no fault that a referee would name, on a page and in a column."""
    run = run_of(path)
    draw = arm3r.plot.force if "force_ref" in run else arm3r.plot.overview
    for width in (6.3, 3.4):
        figure = draw(run, width=width)
        assert crowded(figure) == [], path.name
        assert figure.get_figheight() <= 9.0 + 1e-9, path.name


def test_figures_of_some_scenarios() -> None:
    print("ARM3R_SEED =", sample_seed())
    for path in np.random.default_rng(sample_seed()).choice(scenario_files(), 3, replace=False):
        referee(path)


@pytest.mark.gate
@pytest.mark.parametrize("path", scenario_files(), ids=lambda path: path.stem)
def test_figures_of_all_scenarios(path: Path) -> None:
    referee(path)


@pytest.mark.parametrize("path", scenario_files(), ids=lambda path: path.stem)
def test_the_path_error_is_one_quantity(path: Path) -> None:
    """The largest value in rows, as panels draw it, is that of the table, which knows the motion between rows."""
    run = run_of(path)
    if "tip_ref" not in run:
        return
    drawn = np.linalg.norm(list(ForceRun(run).path_error.values()), axis=0).max()
    assert drawn <= run.summary["metrics"]["tip_path_error_max"] * (1 + 1e-9) + 1e-12
    assert drawn >= 0.98 * run.summary["metrics"]["tip_path_error_max"] - 1e-8


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
        (["timeless.csv", "--force"], 2, "no JSON file beside it"),
        (["timeless.csv"], 2, "a column `t` or `time`"),
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
    Path("timeless.csv").write_text("q1,q2\n1,2\n")
    Path("empty.csv").touch()
    Path("text.txt").touch()
    Path("wrong.yaml").write_text("format: 1\ntime: {stop: -1}\n")
    assert plot_cli.main(arguments) == code
    error = capsys.readouterr().err
    assert error.startswith("arm3r-plot: ")
    assert words in error


def test_the_installed_command(stored: Path, scripts: Path) -> None:
    done = subprocess.run([scripts / "arm3r-plot", "--help"], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0
    assert "--lecture" in done.stdout
    assert subprocess.run([scripts / "arm3r-plot"], capture_output=True, timeout=600).returncode == 2
    plot = [scripts / "arm3r", "plot", stored, "-o", stored.parent]
    done = subprocess.run(plot, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
