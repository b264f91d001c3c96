"""What the program answers to names, endings, words and numbers that are not its own, and to runs that it refuses."""

from __future__ import annotations

import re
import subprocess
import sys
import warnings
from pathlib import Path
from random import Random
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp.commands import plot as plot_cli
from arm3r_cpp.core import advice
from arm3r_cpp.core.params import param_key, places
from arm3r_cpp.sweeps.table import SweepTable
from random_scenarios import sample_seed

HEAD = "format: 1\n"
SHORT = HEAD + "time: {stop: 0.02}\n"
ROOT = Path(__file__).parents[3]
OTHER_ENDINGS = (".mat", ".parquet", ".xlsx", ".html", ".bag", ".mcap", ".json", ".CSVV", ".csv.gz", "")
ROBOT_KEYS = ("arm.link4", "arm.link3.alpha", "dof", "urdf", "arm.dh", "joints", "links", "arm.n_joints", "arm.d4",
              "arm.a1", "robot", "arm.link2.d", "controller.model.joints")  # fmt: skip


def command(scripts: Path, folder: Path, *words: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([scripts / "arm3r", *map(str, words)], cwd=folder, capture_output=True, text=True)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "s.yaml").write_text(SHORT)
    (tmp_path / "b.yaml").write_text(SHORT)
    (tmp_path / "law.m").write_text("function tau = law(q)\n  tau = [0; 0; 0];\nend\n")
    (tmp_path / "sweep.yaml").write_text(HEAD + "scenario: s.yaml\naxes: [{key: time.stop, values: [0.01]}]\n")
    (tmp_path / "class").mkdir()
    return tmp_path


# ---- endings --------------------------------------------------------------------------------------------------------


def calls_with(ending: str) -> list[list[str]]:
    """Every call that names an output file, where this ending is none of those it writes."""
    calls = [["run", "s.yaml", "-o", f"out{ending}"], ["run", "s.yaml", "--controller", "law.m", "-o", f"out{ending}"]]
    calls += [["exercise", "mark", "class", "-o", f"out{ending}"], ["plot", "sweep", "s", "-o", f"out{ending}"]]
    if ending:  # else a folder, which these write too
        calls += [["run", "s.yaml", "b.yaml", "-o", f"out{ending}"], ["sweep", "sweep.yaml", "-o", f"out{ending}"]]
        calls += [["run", "s.yaml", "b.yaml", "--controller", "law.m", "-o", f"out{ending}"]]
        calls += [["plot", "s.yaml", "-o", f"out{ending}"], ["animate", "s.yaml", "-o", f"out{ending}"]]
        calls += [["examples", "--copy", f"out{ending}"]]
    return calls


@pytest.mark.sample(6)
@pytest.mark.parametrize(("call"), [call for ending in OTHER_ENDINGS for call in calls_with(ending)], ids=" ".join)
def test_an_ending_that_is_not_written_is_refused_before_the_work(scripts: Path, folder: Path, call: list[str]) -> None:
    before = {path.name for path in folder.iterdir()}
    done = command(scripts, folder, *call)
    assert done.returncode == 2 and len(done.stderr.splitlines()) == 1, done
    assert {path.name for path in folder.iterdir()} == before


def test_what_is_written_for_runs_is_named(scripts: Path, folder: Path) -> None:
    said = command(scripts, folder, "run", "s.yaml", "-o", "run.mat").stderr
    assert all(word in said for word in ("run.mat", ".mat", ".csv", ".npz", "-o -", "/"))
    for call in (["s.yaml"], ["s.yaml", "--controller", "law.m"]):
        assert command(scripts, folder, "run", *call, "-o", "new/below/").returncode == 0
        assert (folder / "new/below/s.csv").exists()
        assert command(scripts, folder, "run", *call, "-o", "run.npz").returncode == 0
        assert "q1" in np.load(folder / "run.npz")


@pytest.mark.parametrize("ending", [*OTHER_ENDINGS, ".txt"])
def test_a_run_in_python_is_written_as_its_name_says(tmp_path: Path, ending: str) -> None:
    run = arm3r.Scenario(SHORT).run()
    writers = {".csv": run.to_csv, ".npz": run.to_npz, ".html": run.to_html}
    for own, write in writers.items():
        if ending != own:
            with pytest.raises(arm3r.UsageError, match=re.escape(own)):
                write(tmp_path / f"run{ending}")
    assert not list(tmp_path.iterdir())


# ---- numbers that are suggested -------------------------------------------------------------------------------------

UNITS = ("N/m", "kN/m", "m", "cm", "mm", "s", "ms", "N", "kg", "g", "Hz", "m/s", "deg", "rad", "Nm", "furlong")
MISTAKES = (
    "{n} {unit}", "'{n} {unit}'", "'{n}'", "'{n},5'", "{n}{unit}", "0{n}", "0{n} {unit}", "'{n},5 {unit}'", "{n}_000",
    "{n}_000 {unit}", "{n}.", "{n}. {unit}", "{n}E1", "{n}E1 {unit}", "0x{n}", "\u2212{n}", "'0{n} deg'", "{n}.0",
    "'abc'", "{n}:30", "1.{n}.5", "'Yes'", "inf", "'{n} '",
)  # fmt: skip
SUGGESTED = re.compile(
    r"(?:write|use a point:|small e:|as -:|would be|exponent:) ([-+\d.][-+\de.]*(?: deg)?)(?: \(.*\))?$"
)


def suggestion(scenario: arm3r.Scenario, path: str, text: str) -> tuple[str, str]:
    """What the message on a text at a path suggests to write, and the message; "": nothing, or the text is accepted."""
    one = scenario.copy().quiet()
    one.edit(path, text, "--set")
    try:
        one.validate()
    except arm3r.ScenarioError as error:
        for problem in error.problems:
            if problem["path"].startswith(path):
                found = SUGGESTED.search(problem["hint"].split(" or ")[0])
                return (found[1] if found else ""), str(error)
    return "", ""


def test_a_number_that_a_message_suggests_is_a_number(scenario_with_all: arm3r.Scenario) -> None:
    """Its range may still be another; its syntax, quotes and unit are not refused next."""
    seed = sample_seed()
    draw = Random(seed)
    paths = [
        path
        for path, at in places().items()
        if len(at) == 1 and param_key(at[0]).kind in ("number", "integer", "angle")
    ]
    paths = [path for path in paths if path in scenario_with_all]
    suggested = 0
    for _ in range(400):
        path, mistake = draw.choice(paths), draw.choice(MISTAKES)
        text = mistake.format(n=draw.randint(1, 9), unit=draw.choice(UNITS))
        found, message = suggestion(scenario_with_all, path, text)
        if not found:
            continue
        suggested += 1
        one = scenario_with_all.copy().quiet()
        one.edit(path, found, "--set")
        try:
            one.validate()
        except arm3r.BudgetError:  # a number
            continue
        except arm3r.ScenarioError as error:
            codes = {problem["code"] for problem in error.problems if problem["path"].startswith(path)}
            assert not codes & {"number.syntax", "number.quoted", "number.whole", "scenario.type"}, (
                seed,
                message,
                str(error),
            )
    assert suggested > 50, seed


@pytest.fixture
def scenario_with_all() -> arm3r.Scenario:
    return arm3r.Scenario(
        HEAD + "wall: {motion: {type: sinusoid, amplitude: 0.1, frequency: 1}}\nsolver: {method: rk4}\n"
    )


@pytest.mark.parametrize(
    ("path", "text", "due"),
    [
        ("wall.contact.stiffness", "5000 N/m", "write 5000 (N/m)"),
        ("wall.contact.stiffness", "5 kN/m", "write 5000 (N/m)"),
        ("wall.contact.stiffness", "5 cm", "its unit is N/m"),
        ("time.stop", "1,5 s", "write 1.5 (s)"),
        ("initial.q", ["010 deg", 0, 0], "write 10 deg"),
        ("solver.max_steps", "5 ms", "this number has no unit"),
        ("solver.max_steps", "5.0", "5"),
    ],
)
def test_one_true_sentence_about_a_number(path: str, text: Any, due: str) -> None:
    scenario = arm3r.Scenario(HEAD + "wall: {}\n")
    scenario[path] = text
    with pytest.raises(arm3r.ScenarioError) as raised:
        scenario.validate()
    assert raised.value.problems[0]["hint"].endswith(due) and "has no quotes" not in str(raised.value)


@pytest.mark.parametrize(
    "text", ["wall:", "wall: {contact: spring}", "controller: joint_pd", "controller: PID", "solver: ode45",
             "wall: {acts_on_arm: yes}", "wall: {acts_on_arm: 'TRUE'}", "wall: {size: inf}",
             "wall: {size: [inf, inf]}"],
)  # fmt: skip
def test_words_that_a_message_suggests_are_accepted(text: str) -> None:
    with pytest.raises(arm3r.ScenarioError) as raised:
        arm3r.Scenario(f"{HEAD}{text}\n").validate()
    problem = raised.value.problems[0]
    found = re.search(r"write (?:`\w+: (.*?)`|(\w+))", problem["hint"])
    assert found, problem
    scenario = arm3r.Scenario(HEAD + "wall: {}\n")
    scenario.edit(problem["path"].split("[")[0], found[1] or found[2], "--set")
    scenario.quiet().validate()


# ---- names of other programs ----------------------------------------------------------------------------------------


def pairs() -> list[tuple[str, str]]:
    """The pairs of the page for people who come from Simulink."""
    text = (ROOT / "docs/from_simulink.md").read_text().partition("| written | here |")[2].partition("\n\n")[0]
    lines = [re.findall(r"`([^`]*)`", line) for line in text.splitlines()[2:]]
    return [(typed, line[-1]) for line in lines for typed in line[:-1]]


@pytest.mark.parametrize(("typed", "here"), pairs())
def test_a_name_of_another_program_is_answered(typed: str, here: str) -> None:
    if found := re.fullmatch(r"([a-z_.]+): (\w+)", here):
        scenario = arm3r.Scenario(HEAD + "wall: {}\n")
        scenario.edit(found[1], f'"{typed}"', "--set")
        with pytest.raises(arm3r.ScenarioError, match=f"did you mean {found[2]}\\?"):
            scenario.validate()
        return
    owner, _, name = typed.partition(".")
    scenario = arm3r.Scenario(SHORT)
    there = {"arm3r": arm3r, "scenario": scenario, "arm": scenario.arm, "run": scenario.run()}
    with pytest.raises(AttributeError, match=re.escape(here)):
        getattr(there[owner], name)
    assert not hasattr(there[owner], name)


def test_enough_names_are_answered() -> None:
    assert len(pairs()) > 35


def test_names_that_python_asks_for_are_not_answered_with_lists() -> None:
    scenario = arm3r.Scenario(SHORT)
    for thing in (scenario, scenario.arm, scenario.run(), arm3r.Arm, arm3r.Run, arm3r.Scenario):
        assert not hasattr(thing, "__array__") and not hasattr(thing, "_ipython_canary_")
        with pytest.raises(AttributeError) as raised:
            thing._nothing  # noqa: B018
        assert len(str(raised.value)) < 80


@pytest.mark.parametrize("key", ROBOT_KEYS)
def test_keys_of_other_robots_get_the_sentence_of_the_questions_and_answers(key: str) -> None:
    faq = " ".join((ROOT / "docs/faq.md").read_text().split())
    scenario = arm3r.Scenario(HEAD + "controller: {type: joint_pd}\n")
    with pytest.raises(arm3r.ScenarioError) as raised:
        scenario[key] = 6
    for words in raised.value.problems[0]["hint"].split("; "):
        assert words in faq and "arm3r" in words
    with pytest.raises(arm3r.UsageError, match="arms with three joints"):
        scenario[key]


# ---- refused runs, slow methods -------------------------------------------------------------------------------------


@pytest.mark.parametrize("values", [[-1.0, -2.0, -3.0], [-1.0, 1.0]])
def test_a_batch_without_a_valid_run_says_why_and_keeps_its_shape(values: list[float]) -> None:
    scenario = arm3r.Scenario(HEAD + "time: {stop: 0.1, log_every: 0.01}\n")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        batch = scenario.batch({"arm.link2.length": values}, columns=["q"])
    assert batch.rows["q"].shape == (len(values), 11, 3) and batch.rows.t.shape == (len(values), 11)
    assert np.isnan(batch.rows["q"][~batch.ok]).all()
    assert [(one.runs, "arm.link2.length" in one.message) for one in batch.refusals()] == [((~batch.ok).sum(), True)]
    said = [str(one.message) for one in caught if "no run of this batch is valid" in str(one.message)]
    assert len(said) == (not batch.ok.any()) and all("3 invalid, such as" in one and "got -1" in one for one in said)


def test_a_sweep_counts_the_reasons_of_its_refused_runs(scripts: Path, folder: Path) -> None:
    axes = "axes: [{key: arm.link2.length, values: [-1, 1, -2]}, {key: arm.link3.length, values: [-1, 1]}]"
    (folder / "sweep.yaml").write_text(f"{HEAD}scenario: s.yaml\nshard: 2\n{axes}\n")
    done = command(scripts, folder, "sweep", "sweep.yaml", "-o", "out")
    assert done.returncode == 7 and "5 not ok: 5 invalid" in done.stdout
    assert re.search(r"4 invalid, such as: error\[scenario.range\]: arm.link2.length: .* got -1", done.stdout)
    assert re.search(r"1 invalid, such as: error\[scenario.range\]: arm.link3.length", done.stdout)
    assert sum(one.runs for one in SweepTable(folder / "out").refusals) == 5


def test_a_method_that_is_much_faster_is_named() -> None:
    scenario = arm3r.Scenario.example("force_control/hybrid_first_contact")
    scenario["sampling"], scenario["solver"] = {"rate": 1000}, {"method": "rodas4"}
    found = re.match(r"solver.method: (rk4|dopri5)\b.* about (\d+) times faster than rodas4", advice.sentence(scenario))
    assert found and int(found[2]) >= 3
    scenario["solver"] = {"method": "rk4"}
    one = advice.Advice(scenario)
    one._start -= 60
    assert one.after(1, 1000) == ""


def test_advice_is_given_once_and_only_where_much_is_left() -> None:
    scenario = arm3r.Scenario.example("force_control/hybrid_first_contact")
    scenario["sampling"], scenario["solver"] = {"rate": 1000}, {"method": "rodas4"}
    for ago, done, due in ((0.0, 1, False), (60.0, 990, False), (60.0, 10, True), (60.0, 0, True)):
        one = advice.Advice(scenario)
        one._start -= ago
        assert bool(one.after(done, 1000)) == due
        assert one.after(done, 1000) == ""


# ---- measurements ---------------------------------------------------------------------------------------------------


def log(path: Path, time: str = "time", separator: str = ",", extra: str = "") -> Path:
    rows = [[0.0, 0.1, -0.5], [0.01, 0.11, -0.51], [0.02, 0.1, -0.52]]
    lines = [[time, "q1", "tau2 [N m]", *([extra] if extra else [])]]
    for row in rows:
        cells = [str(cell) if separator == "," else str(cell).replace(".", ",") for cell in row]
        lines.append([*cells, *(["x"] if extra else [])])
    path.write_text("\n".join(separator.join(line) for line in lines) + "\n", encoding="utf-8-sig")
    return path


@pytest.mark.sample(2)
@pytest.mark.parametrize(("time", "separator"), [("time", ","), ("t", ";"), ("Time [s]", "\t"), ("t (s)", ",")])
def test_a_measurement_is_drawn_beside_a_run(
    folder: Path, time: str, separator: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    log(folder / "log.csv", time, separator, extra="motor_volts")
    arm3r.Scenario.load("s.yaml").run().to_csv("run.csv")
    for words in (["--compare", "run.csv", "log.csv"], ["run.csv", "--compare", "log.csv"], ["log.csv"],
                  ["--compare", "s.yaml", "log.csv", "--panels", "tau"]):  # fmt: skip
        with pytest.warns() as told:
            assert plot_cli.main([*words, "-o", "figure.svg"]) == 0
        said = " ".join(str(one.message) for one in told)
        assert "not drawn" in said and "motor_volts" in said
    run = arm3r.Run.load(folder / "run.csv")
    figure = arm3r.plot.measured({"t": [0.0, 0.02], "q2": [0.0, 0.1]}, [run])
    assert len(figure.axes) == 1 and len(figure.axes[0].lines) >= 2


@pytest.mark.parametrize(
    ("text", "due"),
    [
        ("x,q1\n0,1\n1,1\n", "a column `t` or `time`"),
        ("t,angle\n0,1\n1,1\n", "such as q1"),
        ("t,q1\n0,1\n1,a\n", "log.csv:3: q1 is a number, got 'a'"),
        ("t,q1\n1,1\n0,1\n", "does not decrease"),
        ("t,q1,q1\n0,1,1\n1,1,1\n", "needed once"),
        ("t,q1\n0,1\n1\n", "log.csv:3: a row has 2 numbers, got 1"),
        ("t,time,q1\n0,1,1\n1,1,1\n", "needed once"),
        ("", "no rows"),
    ],
)
def test_what_is_no_measurement_is_refused_in_a_line(
    folder: Path, text: str, due: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    Path("log.csv").write_text(text)
    assert plot_cli.main(["--compare", "s.yaml", "log.csv", "-o", "figure.png"]) == 2
    said = capsys.readouterr().err
    assert due in said and len(said.splitlines()) == 1, said


# ---- the controller beside yours, pages, figures, hints --------------------------------------------------------------


def test_the_controller_beside_yours_is_called_the_scenarios(folder: Path) -> None:
    scenario = arm3r.Scenario(SHORT + "controller: {type: gravity_compensation}\n")
    beside = scenario.run_beside(folder / "law.m")
    texts = [text.get_text() for ax in beside.figure().axes if ax.get_legend() for text in ax.get_legend().get_texts()]
    assert "the scenario's at" in str(beside) and any("the scenario's" in text for text in texts)
    assert not [text for text in [str(beside), *texts] if "true" in text]


def test_every_page_is_installed_and_printed(scripts: Path, tmp_path: Path) -> None:
    listed = command(scripts, tmp_path, "docs").stdout.splitlines()
    pages = {path.stem: path for path in [*(ROOT / "docs").glob("*.md"), ROOT / "README.md", ROOT / "CHANGELOG.md"]}
    assert {line.split()[0] for line in listed} == set(pages)
    for name in ("verify", "docs/verify.md", "VERIFY", "verify.md#other-arms"):
        assert command(scripts, tmp_path, "docs", name).stdout == pages["verify"].read_text()
    done = command(scripts, tmp_path, "docs", "verfy")
    assert done.returncode == 2 and "did you mean verify?" in done.stderr


def test_no_help_points_to_a_file_that_is_not_installed(scripts: Path, tmp_path: Path) -> None:
    programs = re.findall(r"^arm3r-(\w+) =", (ROOT / "pyproject.toml").read_text(), re.MULTILINE)
    helps = [command(scripts, tmp_path, name, "--help").stdout for name in ("run", "check", *programs)]
    assert "docs [NAME]" in command(scripts, tmp_path, "--help").stdout
    for text in helps:
        assert text and ".md" not in text
        for page in re.findall(r"`arm3r\s+docs\s+(\w+)`", text):
            assert (ROOT / f"docs/{page}.md").exists()
    for thing in (arm3r.Scenario.run, arm3r.Arm.linearize, arm3r.Trust, arm3r.ClosedForm):
        assert ".md" not in (thing.__doc__ or "")


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("use", "is_said"),
    [
        ("plt.show()", True),
        ("pass", True),
        ("figure.savefig('a.png')", False),
        ("figure.canvas.draw()", False),
        ("figure._repr_png_()", False),
        ("import pytest", False),
        ("import IPython", False),
    ],
)
def test_a_script_says_that_a_figure_was_not_seen(tmp_path: Path, use: str, is_said: bool) -> None:
    script = (
        "import matplotlib; matplotlib.use('Agg')\nimport matplotlib.pyplot as plt, arm3r_cpp as arm3r\n"
        f"figure = arm3r.plot.overview(arm3r.Scenario({SHORT!r}).run())\n{use}\n"
    )
    done = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True, check=True)
    lines = [line for line in done.stderr.splitlines() if "neither shown nor saved" in line]
    assert len(lines) == is_said and done.stdout == ""


def test_a_script_that_fails_is_not_told_of_figures(tmp_path: Path) -> None:
    script = f"import arm3r_cpp as arm3r\nf = arm3r.plot.overview(arm3r.Scenario({SHORT!r}).run())\n1 / 0\n"
    done = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True)
    assert "ZeroDivisionError" in done.stderr and "nor saved" not in done.stderr


def test_no_hint_teaches_a_negative_stiffness(scripts: Path, tmp_path: Path) -> None:
    given = command(scripts, tmp_path, "exercise", "show", "impedance", "--given").stdout
    (tmp_path / "impedance.py").write_text(given)
    lines = command(
        scripts, tmp_path, "exercise", "check", "impedance", "impedance.py", "--hint", "3"
    ).stdout.splitlines()
    assert "the error has the wrong sign" in lines[1]
    assert not [line for line in lines if re.search(r"-300|-\s*K\b|\(-D\)|-40", line.replace("(-(x - x_d))", ""))], (
        lines
    )
    assert any("x - x_d" in line and "line 16" in line for line in lines)
