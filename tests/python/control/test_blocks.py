"""Functions in files as controllers: what they are given, beside which controller they run, and what goes wrong."""

from __future__ import annotations

import json
import os
import re
import subprocess
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from arm3r_cpp import examples
from arm3r_cpp.blocks.block import Block
from arm3r_cpp.blocks.inputs import NUMBERS

TEXT = """
format: 1
arm:
  base_height: 0.1
  link2: {length: 0.8, mass: 1.3, com: 0.33, inertia: [0.01, 0.1, 0.105]}
  link3: {length: 0.55, mass: 0.7, com: 0.21, inertia: [0.01, 0.03, 0.035]}
initial: {q: [0.3, -0.4, 0.9], qd: [0.2, 0.1, -0.3]}
wall: {point: [1.18, 0.3, 0.1], motion: {type: fixed}, acts_on_arm: true}
time: {stop: 0.4, log_every: 0.01}
"""
GRAVITY = """
function [t3, t2, t1] = fcn(q3, q2, q1, a2, m2, m3, l2, l3, g)
  t3 = SIGN*m3*g*l3*cos(q2 + q3);
  t2 = SIGN*(m2*l2 + m3*a2)*g*cos(q2) + t3;
  t1 = 0;
end
"""
PD = """
import numpy as np

def law(q, qd, tau_g):
    return 40*(np.array([0.5, -0.2, 0.7]) - q) - 6*qd + tau_g
"""


@pytest.fixture
def scenario() -> arm3r.Scenario:
    return arm3r.Scenario(TEXT)


@pytest.fixture
def file(tmp_path: Path) -> Any:
    """file(name, text): a file's path."""

    def write(name: str, text: str) -> Path:
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


def same(one: arm3r.Run, other: arm3r.Run) -> bool:
    return one.columns == other.columns and all(np.array_equal(one[name], other[name]) for name in one)


# ---- what a function is given ---------------------------------------------------------------------------------------


def test_it_gets_what_a_law_in_python_sees(scenario: arm3r.Scenario, file: Any) -> None:
    """By the same names, and each component by the name of its column."""
    parts = ["q1", "qd3", "f_on_tip_x", "wall_normal_z", "tau_g2", "tip_y", "f", "dq"]
    names = [*NUMBERS, *parts, "state"]
    all_of_them = ", ".join(f"{name}={name}" for name in names)
    text = f"seen = []\ndef law({', '.join(names)}):\n    seen.append(dict({all_of_them}))\n    return tau_g - qd\n"
    path = file("sees.py", text)
    law = Block.read(path).law(scenario)
    checked = 0

    def both(t: float, state: arm3r.LawState) -> Any:
        nonlocal checked
        returned = law(t, state)
        seen = law._call.__closure__ and seen_by(law)
        for name in NUMBERS:
            assert np.array_equal(seen[name], getattr(state, name)), name
        expected = [state.q[0], state.qd[2], state.f_on_tip[0], state.wall_normal[2], state.tau_g[1], state.tip[1],
                    state.f_on_tip, state.qd]  # fmt: skip
        for name, value in zip(parts, expected, strict=True):
            assert np.array_equal(seen[name], value), name
        checked += 1
        return returned

    run = scenario.run(controller=both)
    assert checked == 401 and same(run, scenario.run(controller=lambda t, state: state.tau_g - state.qd))


def seen_by(law: Any) -> dict[str, Any]:
    """What the function of test_it_gets_what_a_law_in_python_sees has written down last."""
    function = next(cell.cell_contents for cell in law._call.__closure__ if hasattr(cell.cell_contents, "__globals__"))
    return function.__globals__["seen"][-1]


def test_matlab_and_python_give_the_same_bits(scenario: arm3r.Scenario, file: Any) -> None:
    """Also of powers, of scalars and of vectors."""
    matlab = """
function tau = fcn(q, qd, f, jacobian, t)
  a = [3; 2; 1];
  p = q(1)^2 + q(2)^3/7 + (t + 1)^0.5;
  tau = jacobian'*(2*f) - a.*qd + sin(q) + [p; cos(t); -q(2)/3] - qd.^2;
end
"""
    python = """
import numpy as np
def law(t, q, qd, f_on_tip, jacobian):
    a = np.array([3, 2, 1])
    p = q[0]**2 + q[1]**3/7 + (t + 1)**0.5
    return jacobian.T @ (2*f_on_tip) - a*qd + np.sin(q) + np.array([p, np.cos(t), -q[1]/3]) - qd**2
"""
    runs = [scenario.run(controller=path) for path in (file("a.m", matlab), file("b.py", python))]
    assert same(*runs) and np.ptp(runs[0]["tau"]) > 0.1


def test_outputs_are_put_in_order_by_their_names(scenario: arm3r.Scenario, file: Any) -> None:
    """Of the lecture: [t3, t2, t1] = fcn(q3, q2, q1). In Python, where the arguments have the same order."""
    lecture = file("a.m", "function [t3, t2, t1] = fcn(q3, q2, q1)\n  t1 = 1*q1; t2 = 2*q2; t3 = 3*q3;\nend\n")
    python = file("b.py", "def f(q3, q2, q1):\n    t1, t2, t3 = 1*q1, 2*q2, 3*q3\n    return t3, t2, t1\n")
    for path in (lecture, python):
        run = scenario.run(controller=path)
        assert np.array_equal(run["tau"][0], run["q"][0] * [1, 2, 3])


def test_numbers_of_the_arm_come_by_their_names_and_defaults_stay(scenario: arm3r.Scenario, file: Any) -> None:
    path = file("a.py", "def law(q, a2, a3, m2, m3, l2, l3, g, d1, gain=7, other=None):\n"
                "    assert (a2, a3, g, d1, gain, other) == (0.8, 0.55, 9.80665, 0.1, 7, None)\n"
                "    return [m2, m3, l2 - l3]\n")  # fmt: skip
    assert scenario.run(controller=path)["tau"][0] == pytest.approx([1.3, 0.7, 0.33 - 0.21], abs=1e-12)


def test_each_run_executes_the_file_anew(scenario: arm3r.Scenario, file: Any) -> None:
    path = file("a.py", "calls = []\ndef law(q):\n    calls.append(0)\n    return [len(calls), 0, 0]\n")
    assert same(scenario.run(controller=path), scenario.run(controller=path))


def test_a_file_finds_modules_beside_it(scenario: arm3r.Scenario, file: Any, monkeypatch: Any) -> None:
    file("my_gains_of_a_test.py", "stiffness = 4.0\n")
    path = file("a.py", "from my_gains_of_a_test import stiffness\ndef law(q):\n    return -stiffness*q\n")
    run = scenario.run(controller=path)
    assert np.array_equal(run["tau"][0], -4 * run["q"][0])


# ---- beside the true one --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("convention, sign", [("simscape", -1), ("slide", 1)])
def test_a_right_gravity_torque_and_one_of_the_other_convention(
    scenario: arm3r.Scenario, file: Any, convention: str, sign: int
) -> None:
    scenario["arm.convention"] = convention
    beside = scenario.run_beside(file("right.m", GRAVITY.replace("SIGN", str(sign))))
    assert beside.true_name == "gravity_compensation" and beside.failure is None
    assert all(difference.size < 1e-9 for difference in beside.differences.values()), beside.differences
    assert "opposite" not in str(beside)
    wrong = scenario.run_beside(file("wrong.m", GRAVITY.replace("SIGN", str(-sign))))
    assert wrong.differences["q"].size > 0.1
    assert f"The scenario's convention is {convention}: is the function in the other one?" in str(wrong)


@pytest.mark.parametrize("sampling", ["{rate: 200}", "{rate: 500, delay: 1.5}", None])
def test_the_true_one_computes_at_the_same_samples(scenario: arm3r.Scenario, file: Any, sampling: str | None) -> None:
    """A law that is written out in Python is the built-in one, with period and delay."""
    scenario.update({"controller": {"type": "joint_pd", "joint_stiffness": [40] * 3, "joint_damping": [6] * 3},
                     "reference": {"type": "point", "q": [0.5, -0.2, 0.7]}})  # fmt: skip
    if sampling:
        scenario.edit("sampling", sampling, "test")
    beside = scenario.run_beside(file("pd.py", PD))
    assert beside.true_name == "joint_pd" and beside.rows == 41
    assert np.ptp(beside.yours["q1"]) > 0.05
    assert all(difference.size < 1e-9 for difference in beside.differences.values()), beside.differences


@pytest.mark.parametrize("controller, of_angles, of_rates", [
    ({"type": "none"}, "gravity_compensation", ""),
    ({"type": "user"}, "gravity_compensation", ""),
    ({"type": "constant", "torque": [0, 1, 2]}, "gravity_compensation", "constant"),
    ({"type": "gravity_compensation"}, "gravity_compensation", "gravity_compensation"),
    ({"type": "joint_pd"}, "joint_pd", "joint_pd"),
    ({"type": "stiffness"}, "stiffness", "stiffness"),
])  # fmt: skip
def test_which_one_is_the_true_one(
    scenario: arm3r.Scenario, file: Any, controller: dict[str, Any], of_angles: str, of_rates: str
) -> None:
    scenario.update({"controller": controller, "time.stop": 0.02})
    for arguments, expected in (("q3, q1, q2, m3", of_angles), ("q, qd", of_rates)):
        beside = scenario.run_beside(file("a.py", f"def law({arguments}):\n    return [0, 0, 0]\n"))
        assert beside.true_name == expected and (beside.true is None) == (expected == "")
        assert ("no controller of its own" in str(beside)) == (expected == "")


def test_largest_differences_are_those_of_the_columns(scenario: arm3r.Scenario, file: Any) -> None:
    beside = scenario.run_beside(file("a.py", "def law(q):\n    return [0.1, 0, 0]\n"))
    for name, column in {"q": "q", "tip": "tip", "tau": "tau", "force": "f_on_wall"}.items():
        apart = np.sqrt(((beside.yours[column] - beside.true[column]) ** 2).sum(axis=1))
        assert beside.differences[name].size == pytest.approx(apart.max(), rel=1e-12)
        assert beside.yours.t[np.argmax(apart)] == beside.differences[name].t


def test_every_scenario_of_the_installation_takes_a_function(file: Any) -> None:
    """For two rows: wherever there is a controller, it runs at the samples of the function, too."""
    path = file("a.py", "def law(q, qd, tau_g):\n    return tau_g - qd\n")
    for name in (name for name in examples.names() if not name.startswith("sweeps/")):
        scenario = arm3r.Scenario.example(name)
        start = scenario["time.start"]
        scenario.update({"checks": [], "time": {"start": start, "stop": start + 0.02, "log_every": 0.01}})
        beside = scenario.run_beside(path)
        assert beside.failure is None and (beside.true is None) == (scenario["controller.type"] == "none"), name
        assert beside.true is None or (beside.rows == 3 and beside.true.outcome == "ok"), name


def test_a_callable_runs_beside_too(scenario: arm3r.Scenario) -> None:
    scenario["controller"] = {"type": "gravity_compensation"}
    beside = scenario.run_beside(lambda t, state: state.tau_g)
    assert beside.true_name == "gravity_compensation" and beside.differences["q"].size < 1e-9


@pytest.mark.parametrize("has_wall", [True, False])
def test_the_figure_shows_both_and_the_difference(scenario: arm3r.Scenario, file: Any, has_wall: bool) -> None:
    scenario["wall.motion"] = {"type": "constant", "velocity": 0.3}
    if not has_wall:
        scenario["wall"] = None
    beside = scenario.run_beside(file("a.m", GRAVITY.replace("SIGN", "-0.7")))
    figure = beside.figure(stamp=True, width=5, degrees=True)
    labels = [ax.get_ylabel().replace("\n", " ") for ax in figure.axes]
    assert [label.split(",")[0] for label in labels] == [
        "joint angle", "difference", "torque", "difference", *["contact force"] * has_wall, "tips apart"]  # fmt: skip
    drawn = {(line.get_label(), len(line.get_xdata())) for line in figure.axes[0].lines}
    assert len([1 for _, count in drawn if count]) >= 4
    difference = figure.axes[1].lines[1].get_ydata()
    assert labels[:2] == ["joint angle, deg", "difference, deg"]
    assert np.allclose(difference, np.degrees(beside.yours["q2"] - beside.true["q2"]))
    assert beside.figure().axes[0].get_ylabel() == "joint angle, rad"  # as the scenario's pose is given
    assert len(figure.origins) == 2


# ---- in many runs ---------------------------------------------------------------------------------------------------


def test_a_row_of_a_batch_has_the_bits_of_that_run_alone(scenario: arm3r.Scenario, file: Any) -> None:
    """With sampling and delay, in both languages; the function gets the numbers of that run's arm."""
    scenario.update({"controller": {"type": "user"}, "sampling": {"rate": 250, "delay": 0.5}})
    scenario["wall.motion"] = {"type": "constant", "velocity": 1.0}
    counts = "n = []\ndef law(q, qd, a2, f):\n    n.append(1)\n    return [a2*len(n)/100, -a2, -f[2]]\n"
    paths = [file("a.m", GRAVITY.replace("SIGN", "-1")), file("b.py", counts)]
    lengths = [0.7, 0.75, 0.8]
    for path in paths:
        batch = scenario.batch({"arm.link2.length": lengths, "wall.contact.stiffness": [[1e3], [3e3]]}, controller=path)
        assert batch.shape == (2, 3) and batch.ok.all() and len(set(batch["q2"].ravel())) == 6
        for i, j in np.ndindex(2, 3):
            alone = scenario.copy()
            alone.update({"arm.link2.length": lengths[j], "wall.contact.stiffness": [1e3, 3e3][i]})
            run = alone.run(controller=path)
            for name in ("q1", "q2", "tip_x", "peak_force", "energy_dissipated"):
                assert batch[name][i, j] == {**run.summary["metrics"], **run.summary}[name], name
            assert same(batch.run((i, j)), run)


def test_a_fault_in_a_batch_names_run_and_line(scenario: arm3r.Scenario, file: Any) -> None:
    path = file("a.py", "def law(q, a2):\n    return [1 / (a2 - 0.9), 0, 0]\n")
    with pytest.raises(arm3r.ControllerError, match=r"run 1, at tick 0, t = 0 s: .*a\.py:2: law raised Zero") as raised:
        scenario.batch({"arm.link2.length": [0.8, 0.9, 1.0]}, controller=path)
    assert raised.value.index == (1,)
    path = file("b.py", "raise OSError('no gains')\ndef law(q):\n    return q\n")
    with pytest.raises(arm3r.ControllerError, match=r"b\.py:1: law raised OSError: no gains"):
        scenario.batch({"arm.link2.length": [0.8]}, controller=path)


def test_a_sweep_has_the_bits_of_single_runs(scenario: arm3r.Scenario, file: Any, tmp_path: Path) -> None:
    plan = {"format": 1, "scenario": "s.yaml", "axes": [{"key": "arm.link2.length", "values": [0.7, 0.75, 0.8]}],
            "metrics": ["q1", "q2"], "statistics": [{"column": "tau2", "of": "max"}], "shard": 2}  # fmt: skip
    file("s.yaml", scenario.to_yaml())
    path = file("a.m", GRAVITY.replace("SIGN", "-0.9"))
    table = arm3r.sweep(arm3r.Sweep(plan, file=str(tmp_path / "sweep.yaml")), out=tmp_path / "out", controller=path)
    for row, length in enumerate([0.7, 0.75, 0.8]):
        scenario["arm.link2.length"] = length
        run = scenario.run(controller=path)
        assert table["q2"][row] == run["q2"][-1] and table["tau2.max"][row] == run["tau2"].max()
    plan_with_gain = {**plan, "axes": [{"key": "controller.joint_stiffness[0]", "values": [1, 2]}]}
    scenario["controller"] = {"type": "joint_pd"}
    file("pd.yaml", scenario.to_yaml())
    with pytest.raises(arm3r.UsageError, match="belongs to the scenario's controller"):
        arm3r.sweep(arm3r.Sweep({**plan_with_gain, "scenario": "pd.yaml"}, file=str(tmp_path / "sweep.yaml")),
                    out=tmp_path / "gain", controller=path)  # fmt: skip
    other = file("b.m", GRAVITY.replace("SIGN", "-0.8"))
    for controller in (other, None):
        with pytest.raises(arm3r.IncompatibleError, match="controller"):
            arm3r.sweep(arm3r.Sweep(plan, file=str(tmp_path / "sweep.yaml")), out=tmp_path / "out", resume=True,
                        controller=controller)  # fmt: skip


# ---- what can go wrong ----------------------------------------------------------------------------------------------

FAULTS = {
    "raises.py": (
        "def law(t):\n    x = t\n    return [1 / (x - 0.003), 0, 0]\n",
        0.003,
        ":3: law raised ZeroDivisionError: ",
    ),
    "nan.py": ("\ndef law(q):\n    return [0, float('nan'), 0]\n", 0, ":2: law returned [0.0, nan, 0.0]; three finite"),
    "shape.py": ("def law(q):\n    return [[1, 2, 3]] * 3\n", 0, ":1: law returned "),
    "two.py": ("def law(q):\n    return 1.0, 2.0\n", 0, ":1: law returned [1.0, 2.0]; three finite numbers"),
    "none.py": ("def law(q):\n    pass\n", 0, ":1: law returned None; three finite numbers"),
    "text.py": ("def law(q):\n    return 'left'\n", 0, ":1: law returned 'left'; three finite numbers"),
    "deep.py": ("def inner(q):\n    return q[5]\ndef law(q):\n    return inner(q)\n", 0, ":2: law raised IndexError: "),
    "exits.py": ("def law(q):\n    raise ValueError('two\\nlines')\n", 0, ":2: law raised ValueError: two"),
    "leaves.py": ("def law(q):\n    raise SystemExit(0)\n", 0, ":1: law raised RuntimeError: it called exit()"),
    "singular.m": ("function tau = f(q, t)\n  a = zeros(3,3);\n  tau = inv(a)*q;\nend\n", 0, ":3: f: Singular matrix"),
    "index.m": ("function tau = f(q)\n  tau = [q(7); 0; 0];\nend\n", 0, ":2: f: index 7 is out of range"),
    "matrix.m": ("function J = f(q)\n  J = eye(3);\nend\n", 0, ":1: f returned an array of 3 x 3 numbers; three"),
    "outputs.m": ("function [t1, t2] = f(q)\n  t1 = 1; t2 = 2;\nend\n", 0, ":1: f returned [1.0, 2.0]; three finite"),
    "pole.m": ("function tau = f(t)\n  tau = [1/(t - 0.003); 0; 0];\nend\n", 0.003, ":1: f returned [inf, 0.0, 0.0];"),
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_one_line_with_its_place(scenario: arm3r.Scenario, file: Any, name: str) -> None:
    text, t, words = FAULTS[name]
    path = file(name, text)
    with pytest.raises(arm3r.ControllerError) as raised, np.errstate(all="ignore"):
        scenario.run(controller=path)
    message = str(raised.value)
    assert f"at tick {round(1000 * t)}, t = {t:g} s: {path}{words}" in message and "\n" not in message
    assert raised.value.t == t and raised.value.run.outcome == "controller"
    beside = scenario.run_beside(path)
    assert str(beside.failure) == message
    assert beside.figure() is not None if beside.rows > 1 else True


UNREADABLE = {
    "a.py": ("def law(q, tipp):\n    return q\n", "a.py:1: the argument tipp is not known; did you mean tip? "),
    "b.py": ("\n\ndef law(q, gain):\n    return q\n", "b.py:3: the argument gain is not known; a controller gets tick"),
    "c.py": ("def law(q:\n", "c.py:1: this is not Python"),
    "d.py": ("x = 1\n", "d.py: there is no function"),
    "e.m": ("function tau = f(q)\n  while q(1) > 0\n", "e.m:2:"),
    "g.m": ("function tau = f(state)\n  tau = state;\nend\n", "g.m:1: the argument state is not known"),
    "f.txt": ("", "f.txt: a controller is a function in a file named .m or .py"),
}


@pytest.mark.parametrize("name", UNREADABLE)
def test_a_file_that_cannot_be_read_says_why(scenario: arm3r.Scenario, file: Any, name: str) -> None:
    text, words = UNREADABLE[name]
    path = file(name, text)
    for use in (scenario.run, scenario.run_beside):
        with pytest.raises(arm3r.UsageError, match=re.escape(words)):
            use(controller=path)
    with pytest.raises(arm3r.UsageError, match=re.escape(words)):
        scenario.batch({"wall.contact.stiffness": [1.0]}, controller=path)


# ---- the command ----------------------------------------------------------------------------------------------------


@pytest.fixture
def command(scripts: Path, tmp_path: Path) -> Any:
    """command("run", ...): `arm3r run ...` in a folder with s.yaml, right.m and wrong.py."""
    (tmp_path / "s.yaml").write_text(TEXT + "checks: [{name: still, column: q2, of: range, below: 0.5}]\n")
    (tmp_path / "right.m").write_text(GRAVITY.replace("SIGN", "-1"))
    (tmp_path / "wrong.py").write_text("def law(q1, q2, q3):\n    print('called')\n    return q1, 0, 30\n")
    path = f"{scripts}{os.pathsep}{os.environ['PATH']}"

    def call(*words: object, **options: Any) -> subprocess.CompletedProcess[str]:
        return subprocess.run(["arm3r", *map(str, words)], cwd=tmp_path, capture_output=True, text=True,
                              env={**os.environ, "PATH": path}, **options)  # fmt: skip

    return call


def test_the_command_runs_both_and_says_how_far_apart_they_are(command: Any, tmp_path: Path) -> None:
    done = command("run", "s.yaml", "--controller", "right.m", "-o", "out.csv")
    assert done.returncode == 0, done.stderr
    assert re.search(r"^  controller +right\.m: fcn\(q3, q2, q1, a2", done.stdout, re.M)
    assert re.search(r"^  compared with +gravity_compensation at the same samples$", done.stdout, re.M)
    assert re.search(r"^  joint angles, rad .* \S+ at \S+ s$", done.stdout, re.M)
    expected = arm3r.Scenario.load(tmp_path / "s.yaml").run(controller=tmp_path / "right.m")
    assert same(arm3r.Run.load(tmp_path / "out.csv"), expected)
    done = command("run", "s.yaml", "--controller", "wrong.py:law")
    assert done.returncode == 10 and "FAIL  still" in done.stdout
    assert "called" not in done.stdout and "called" in done.stderr


def test_the_command_obeys_all_options_of_run(command: Any, tmp_path: Path) -> None:
    words = ["--controller=wrong.py", "--no-checks", "--set", "time.stop=0.2", "--set=name=short", "--json"]
    done = command("--json", "run", *words, "s.yaml")
    summary = json.loads(done.stdout)
    assert done.returncode == 0 and summary["t_end"] == 0.2 and summary["name"] == "short" and not summary["checks"]
    assert summary["beside"]["true_controller"] == "gravity_compensation"
    assert summary["beside"]["differences"]["q"]["largest"] > 0.1
    done = command("run", "-o-", "--no-checks", "--controller", "wrong.py", "--", "s.yaml")
    assert done.stdout.startswith("t,q1,") and "compared with" in done.stderr
    done = command("run", "-", "--controller", "right.m", input=(tmp_path / "s.yaml").read_text())
    assert done.returncode == 0, done.stderr
    (tmp_path / "other.yaml").write_text(TEXT)
    done = command("run", "s.yaml", "other.yaml", "--controller", "right.m", "-o", "both", "--json")
    assert [one["outcome"] for one in json.loads(done.stdout)] == ["ok", "ok"]
    assert sorted(path.name for path in (tmp_path / "both").glob("*.csv")) == ["other.csv", "s.csv"]


@pytest.mark.sample(5)
@pytest.mark.parametrize("words, code, message", [
    (["s.yaml", "--controller", "none.m"], 2, "none.m: this file cannot be read: No such file"),
    (["s.yaml", "--controller"], 2, "--controller needs a value"),
    (["s.yaml", "--controller", "a", "--controller", "b"], 2, "--controller is given twice"),
    (["s.yaml", "--controller", "right.m", "-o", "s.yaml"], 2, "this would overwrite s.yaml"),
    (["s.yaml", "--controller", "right.m", "-o", "right.m"], 2, "this would overwrite right.m"),
    (["s.yaml", "--controller", "right.m", "-o", "no/folder/x.csv"], 6, "no/folder"),
    (["s.yaml", "--controller", "right.m", "--set", "time.stopp=1"], 3, "did you mean stop?"),
    (["s.yaml", "--controller", "hangs.py", "--time-limit", "0.5"], 5, "is used up in the controller hangs.py: law"),
    (["s.yaml", "--controller", "raises.py"], 8, "raises.py:2: law raised ZeroDivisionError"),
    (["s.yaml", "--controller", "import.py"], 8, "import.py:1: law raised ModuleNotFoundError: No module named 'nope_"),
    (["s.yaml", "--controller", "leaves.py"], 8, "leaves.py:1: law raised SystemExit: 0"),
    (["absent.yaml", "--controller", "right.m"], 2, "absent.yaml"),
])  # fmt: skip
def test_exit_codes(command: Any, file: Any, words: list[str], code: int, message: str) -> None:
    file("hangs.py", "def law(q):\n    while True:\n        pass\n")
    file("raises.py", "def law(t):\n    return [0, 0, 1/(t - 0.1)]\n")
    file("leaves.py", "raise SystemExit(0)\ndef law(q):\n    return q\n")
    file("import.py", "import nope_not_there\ndef law(q):\n    return q\n")
    done = command("run", *words, timeout=600)
    assert done.returncode == code and message in done.stderr and "Traceback" not in done.stderr, done.stderr
    assert len([line for line in done.stderr.splitlines() if line.strip()]) <= 2


def test_without_the_python_package_it_is_one_line(executable: Path, tmp_path: Path) -> None:
    """The executable alone, copied elsewhere: it does not start anything it does not have."""
    (tmp_path / "s.yaml").write_text(TEXT)
    alone = tmp_path / "bin" / "arm3r"
    alone.parent.mkdir()
    alone.symlink_to(executable)
    done = subprocess.run([alone, "run", "s.yaml", "--controller", "x.m"], cwd=tmp_path, capture_output=True, text=True,
                          env={"PATH": "/nowhere"})  # fmt: skip
    assert done.returncode == 2 and len(done.stderr.splitlines()) == 1
    assert "pip install" in done.stderr and done.stdout == ""


def test_the_help_says_in_whose_trust_the_code_runs(command: Any) -> None:
    for words in (["run"], ["plot"], ["sweep"]):
        text = " ".join(command(*words, "--help").stdout.split())
        assert "--controller FILE[:FUNCTION]" in text and "executed without confinement" in text


def test_plot_draws_both(command: Any, tmp_path: Path) -> None:
    done = command("plot", "s.yaml", "--controller", "wrong.py", "-o", "out.pdf")
    assert done.returncode == 0 and (tmp_path / "out.pdf").read_bytes().startswith(b"%PDF")
    assert command("plot", "s.csv", "--controller", "wrong.py").returncode == 2
