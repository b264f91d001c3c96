"""Walls that follow a table: with velocities and accelerations, or by the smoothest curve through positions alone."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.interpolate import make_interp_spline

T = [0.1, 0.3, 0.55, 0.6, 1.1]
S = [0.0, 0.07, -0.02, -0.03, 0.11]
AT_REST = ([(1, 0.0), (2, 0.0)], [(1, 0.0), (2, 0.0)])


def scenario(**motion: object) -> arm3r.Scenario:
    wall = {"point": [2.5, 0, 0], "normal": [-1, 0, 0], "motion": {"type": "table", **motion}}
    made = arm3r.Scenario("{format: 1, controller: {type: gravity_compensation}, time: {stop: 1.3, log_every: 0.005}}")
    made["wall"] = wall
    return made


def test_positions_alone_give_the_smoothest_curve_from_rest_to_rest() -> None:
    run = scenario(t=T, s=S).run()
    curve = make_interp_spline(T, S, k=5, bc_type=AT_REST)
    along = curve(np.clip(run.t, T[0], T[-1]))  # the wall stands still before and after it
    assert_allclose(run["wall_x"], 2.5 - along, rtol=0, atol=1e-14)


def test_the_velocities_and_accelerations_of_that_curve_give_the_same_motion() -> None:
    curve = make_interp_spline(T, S, k=5, bc_type=AT_REST)
    v, a = curve.derivative(1)(T), curve.derivative(2)(T)
    told = scenario(t=T, s=S, v=v.tolist(), a=a.tolist()).run()
    assert_allclose(told["wall_x"], scenario(t=T, s=S).run()["wall_x"], rtol=0, atol=1e-14)


def test_a_ramp_is_a_table_of_two_points() -> None:
    ramp = scenario(t=T, s=S)
    ramp["wall.motion"] = {"type": "ramp", "distance": 0.2, "start": 0.2, "duration": 0.7}
    table = scenario(t=[0.2, 0.9], s=[0.0, 0.2])
    assert_allclose(table.run()["wall_x"], ramp.run()["wall_x"], rtol=0, atol=1e-15)


@pytest.mark.parametrize("given", ["v", "a"])
def test_one_of_velocity_and_acceleration_is_not_enough(given: str) -> None:
    other = {"v": "a", "a": "v"}[given]
    with pytest.raises(arm3r.ScenarioError, match=rf"wall\.motion\.{other}: not as long .* or the position alone"):
        scenario(t=T, s=S, **{given: [0.0] * len(T)}).run()


def test_all_values_written_out_are_the_same_scenario() -> None:
    first = scenario(t=T, s=S)
    again = arm3r.Scenario(first.to_yaml())
    assert again.run().summary["hash"] == first.run().summary["hash"]


def test_a_batch_varies_the_points() -> None:
    moved = [0.05, 0.07, 0.09]
    batch = scenario(t=T, s=S).batch({"wall.motion.s[1]": moved}, columns=["wall_x"])
    for number, value in enumerate(moved):
        alone = scenario(t=T, s=[S[0], value, *S[2:]]).run()
        assert np.array_equal(batch.rows["wall_x"][number], alone["wall_x"])


# ---- tables of any length, in a file ---------------------------------------------------------------------------------

PRESSED = """
format: 1
initial: {q: [0.12, 0.4, -0.9]}
controller: {type: gravity_compensation}
wall: {point: [1.72, 0, 0], size: infinite, acts_on_arm: true, motion: {type: table, %s}}
solver: {%s}
time: {stop: 1.5, log_every: 0.01}
"""
METHODS = ["method: dopri5", "method: rodas4", "method: auto", "method: rk4, step: 0.005"]


def points(count: int, *, start: float = 0.0) -> tuple[list[float], list[float]]:
    t = np.linspace(0, 1.4, count)
    return (t + start).tolist(), (0.06 * np.sin(3 * t) + 0.01 * np.cos(11 * t) - 0.01).tolist()


def pressed(count: int, method: str = METHODS[0]) -> arm3r.Scenario:
    t, s = points(count)
    return arm3r.Scenario(PRESSED % (f"t: {t}, s: {s}", method))


@pytest.mark.parametrize("count", [17, 400])
def test_many_points_lie_on_the_smoothest_curve(count: int) -> None:
    run = pressed(count).run()
    curve = make_interp_spline(*points(count), k=5, bc_type=AT_REST)
    assert_allclose(run["wall_x"], 1.72 - curve(np.clip(run.t, 0, 1.4)), rtol=0, atol=1e-12)


@pytest.mark.parametrize("method", METHODS)
def test_a_batch_follows_a_long_table_as_the_runs_alone(method: str) -> None:
    scenario = pressed(60, method)
    stiffness = np.linspace(200, 3000, 11)
    batch = scenario.batch({"wall.contact.stiffness": stiffness}, columns=["q1", "force"])
    for number, value in enumerate(stiffness):
        alone = scenario.copy()
        alone["wall.contact.stiffness"] = value
        run = alone.run()
        assert batch["peak_force"][number] == run.summary["peak_force"] > 1
        assert np.array_equal(batch.rows["force"][number], run["force"])


def test_a_long_table_cut_to_sixteen_points_is_the_short_one() -> None:
    """A seventeenth point behind the end of the run, on the curve, changes the curve before it by little."""
    t, s = points(16)
    v, a = [0.1] * 16, [0.2] * 16
    short = arm3r.Scenario(PRESSED % (f"t: {t}, s: {s}, v: {v}, a: {a}", METHODS[0]))
    longer = arm3r.Scenario(PRESSED % (f"t: {[*t, 9]}, s: {[*s, 0]}, v: {[*v, 0]}, a: {[*a, 0]}", METHODS[0]))
    short["time.stop"] = longer["time.stop"] = 1.39
    assert np.array_equal(short.run()["q2"], longer.run()["q2"])


@pytest.mark.parametrize(
    ("header", "form", "ending"),
    [
        ("t,s", "{0!r},{1!r}", "\n"),
        ("", "{0!r},{1!r}", "\n"),
        ("\ufeff# measured\n\n s ; t ", "{1!r};{0!r}", "\r\n"),
        ('"n"\t"s"\t"t"', "7\t{1!r}\t{0!r}", "\n"),
        ("t s", "  {0!r}   {1!r} ", "\n"),
    ],
)
def test_files_as_people_have_them(tmp_path: Path, header: str, form: str, ending: str) -> None:
    t, s = points(40)
    lines = [header] * bool(header) + [form.format(*pair) for pair in zip(t, s, strict=True)]
    (tmp_path / "motion.csv").write_bytes((ending.join(lines) + ending).encode())
    (tmp_path / "wall.yaml").write_text(PRESSED % ("file: motion.csv", METHODS[0]))
    scenario = arm3r.Scenario.load(tmp_path / "wall.yaml")
    told = scenario.run()
    assert told.summary["hash"] == pressed(40).run().summary["hash"]
    for again in (arm3r.Scenario(scenario.to_yaml()), pickle.loads(pickle.dumps(scenario))):
        (tmp_path / "motion.csv").write_text("t,s\n0,0\n1,0\n")  # all that it says is in the scenario
        assert again.run().summary["hash"] == told.summary["hash"]
    assert "# motion.csv" in scenario.to_yaml(annotate=True)


def test_velocities_and_accelerations_of_a_file(tmp_path: Path) -> None:
    t, s = points(30)
    curve = make_interp_spline(t, s, k=5, bc_type=AT_REST)
    table = np.c_[t, s, curve.derivative(1)(t), curve.derivative(2)(t)]
    np.savetxt(tmp_path / "motion.csv", table, delimiter=",", header="t,s,v,a", comments="", fmt="%.17g")
    scenario = arm3r.Scenario(PRESSED % ("file: motion.csv", METHODS[0]), file=str(tmp_path / "wall.yaml"))
    assert_allclose(scenario.run()["wall_x"], pressed(30).run()["wall_x"], rtol=0, atol=1e-12)


def test_a_reference_from_a_file(tmp_path: Path) -> None:
    t = np.linspace(0, 1, 50)
    path = np.c_[t, 1.6 + 0.02 * np.sin(t), 0.2 + 0.03 * t, 0.1 * t**2]
    np.savetxt(tmp_path / "path.csv", path, delimiter=",", header="t,x,y,z", comments="", fmt="%.17g")
    text = "{format: 1, initial: {q: [0.12, 0.4, -0.9]}, controller: {type: impedance}, time: {stop: 1.2}}"
    scenario = arm3r.Scenario(text, file=str(tmp_path / "s.yaml"))
    scenario["reference"] = {"type": "table", "file": "path.csv"}
    run = scenario.run()
    for i, axis in enumerate("xyz"):
        curve = make_interp_spline(t, path[:, i + 1], k=5, bc_type=AT_REST)
        assert_allclose(run[f"tip_ref_{axis}"], curve(np.clip(run.t, 0, 1)), rtol=0, atol=1e-12)


HEAD = "t,s\n0,0\n"
WRONG = {
    "no such file": (None, r"wall.yaml:5:\d+: .*wall.motion.file: cannot be read: No such file .*got motion.csv"),
    "empty": ("", r"motion.csv: .*the file is empty, allowed columns t s v a"),
    "no name": ("time,s\n0,0\n1,1\n", r"motion.csv:1: .*no column t, got time, s, allowed columns t s v a; name"),
    "two of a name": ("t,s,s\n0,0,0\n1,1,1\n", r"motion.csv:1: .*two columns have one name, got s"),
    "a word": (HEAD + "1,ten\n", r"motion.csv:3:3: .*wall.motion.s\[1\]: not a number, got ten"),
    "an empty cell": (HEAD + "1,\n", r"motion.csv:3:3: .*wall.motion.s\[1\]: not a number"),
    "nan": (HEAD + "1,nan\n", r"motion.csv:3:3: .*wall.motion.s\[1\]: .*got nan"),
    "a short line": (
        HEAD + "1\n2,0\n",
        r"motion.csv:3: .*another number of columns than the first, got 1, allowed 2",
    ),
    "one point": (HEAD, r"motion.csv:1: .*wall.motion.t: expects a list of 2 or more numbers"),
    "turning back": (
        HEAD + "2,1\n1,1\n",
        r"motion.csv:4: .*wall.motion.t\[2\]: the instants of a table must increase",
    ),
    "out of range": (HEAD + "2,1e9\n", r"motion.csv:3:3: .*wall.motion.s\[1\]: out of range"),
    "columns without names": ("0,1,2,3,4\n1,1,2,3,4\n", r"motion.csv:1: .*cannot tell which columns.*name them in"),
    "one column": ("0\n1\n", r"motion.csv:1: .*no column s, got 1 column"),
    "too long": (
        "t,s\n" + "".join(f"{i},0\n" for i in range(20_001)),
        r"motion.csv:20002: .*too many points.*every second",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_is_wrong_with_a_file_is_told_by_its_line(tmp_path: Path, case: str) -> None:
    text, told = WRONG[case]
    if text is not None:
        (tmp_path / "motion.csv").write_text(text)
    (tmp_path / "wall.yaml").write_text(PRESSED % ("file: motion.csv", METHODS[0]))
    with pytest.raises(arm3r.ScenarioError, match=told) as caught:
        arm3r.Scenario.load(tmp_path / "wall.yaml").run()
    assert "this must be given" not in str(caught.value)  # nothing is said twice


def test_a_file_without_a_name_is_a_file_that_cannot_be_read() -> None:
    with pytest.raises(arm3r.ScenarioError, match=r"wall\.motion\.file: cannot be read: the file name is empty"):
        arm3r.Scenario(PRESSED % ('file: ""', METHODS[0]), file="wall.yaml").validate()


def test_a_list_beside_the_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "motion.csv").write_text(HEAD + "1,0.1\n")
    scenario = arm3r.Scenario(PRESSED % ("file: motion.csv, t: [0, 1]", METHODS[0]), file=str(tmp_path / "wall.yaml"))
    with pytest.raises(arm3r.ScenarioError, match=r"wall.motion.t: a list beside the file.*take out `file` or this"):
        scenario.run()


def test_neither_list_nor_file() -> None:
    with pytest.raises(arm3r.ScenarioError, match=r"wall.motion.t: this must be given, .*2 or more .*file"):
        arm3r.Scenario(PRESSED % ("s: [0, 1]", METHODS[0])).run()


def test_numbers_of_a_long_list_cannot_be_varied_one_by_one() -> None:
    with pytest.raises(arm3r.UsageError, match=r"wall.motion.s has 40 numbers; a list can be varied up to 16"):
        pressed(40).batch({"wall.motion.s[3]": [0.1, 0.2]})


@pytest.mark.parametrize(
    "behind",
    [[3.0], [0, 2, 1, 1], [-1, 17, *[0] * 17], [0, 1e18, 1], [np.nan, 17, *[0] * 17], ["t", 99, 0], ["t", 3, 0, 1, 2]],
)
def test_what_stands_behind_the_numbers_must_be_lists(behind: list[Any]) -> None:
    place = float(arm3r.param_index("wall.motion.t[0]"))
    numbers = [place if word == "t" else word for word in behind]
    with pytest.raises(arm3r.Arm3rError, match=r"wrong number of parameters|more for long tables alone"):
        arm3r.Arm(np.concatenate([arm3r.param_defaults(), numbers]))


def test_a_batch_varies_the_file(tmp_path: Path) -> None:
    for name, count in (("a", 20), ("b", 60)):
        np.savetxt(tmp_path / f"{name}.csv", np.transpose(points(count)), delimiter=",", fmt="%.17g")
    scenario = arm3r.Scenario(PRESSED % ("file: a.csv", METHODS[0]), file=str(tmp_path / "wall.yaml"))
    for base in (scenario, arm3r.Scenario(scenario.to_yaml(), file=str(tmp_path / "wall.yaml"))):
        peaks = base.batch({"wall.motion.file": ["a.csv", "b.csv"]})["peak_force"]
        assert peaks.tolist() == [pressed(count).run().summary["peak_force"] for count in (20, 60)]
    with pytest.raises(arm3r.UsageError, match=r"wall.motion.file: names of files are needed"):
        scenario.batch({"wall.motion.file": [1.0, 2.0]})
